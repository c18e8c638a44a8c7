// Wheels: the actuator that drives the engine, and the encoders that count what was rolled.
#include "hal/device/wheels.hpp"

#include "core/device/types.hpp"
#include "core/random/random.hpp"

namespace tandem::core {
namespace {

bool has_wheels(const hal::DataSheet& sheet) {
  return sheet.wheel_base_m > 0.0;
}

// --- actuator ---

struct IdealWheels {
  void describe(hal::ParamVisitor&) {}
};

/// ARGoS' three knobs: speed' = factor * (speed + bias) * (1 + noise).
template <int kPerMille>
struct WheelErrors {
  double bias_left_m_s = 0.0, bias_right_m_s = 0.0;
  double factor_left = 1.0, factor_right = 1.0;
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("bias_left", bias_left_m_s, hal::unit::cm_s, hal::kAny, "Added to the left wheel's speed while it turns.");
    v.number("bias_right", bias_right_m_s, hal::unit::cm_s, hal::kAny,
             "Added to the right wheel's speed while it turns.");
    v.number("factor_left", factor_left, hal::unit::none, hal::kNotNegative, "Multiplies the left wheel's speed.");
    v.number("factor_right", factor_right, hal::unit::none, hal::kNotNegative, "Multiplies the right wheel's speed.");
    v.number("noise_std_dev", noise_std_dev, hal::unit::none, {0.0, 1.0},
             "Standard deviation of each wheel's relative speed error, drawn every tick.");
  }
};

class WheelActuator final : public Actuator {
 public:
  explicit WheelActuator(const WheelErrors<0>& errors) : errors_(errors) {
    exact_ = errors.bias_left_m_s == 0.0 && errors.bias_right_m_s == 0.0 && errors.factor_left == 1.0 &&
             errors.factor_right == 1.0 && errors.noise_std_dev == 0.0;
  }

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* wheels = static_cast<const hal::WheelSpeeds*>(ports);
    Bodies& b = stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      const bool drives = (b.flags[row] & (kAlive | kExternal)) == kAlive && context.block.halted[i] == 0;
      double left = drives ? wheels[i].left_m_s : 0.0;
      double right = drives ? wheels[i].right_m_s : 0.0;
      if (!exact_ && drives) distort(context, b.entity[row], left, right);
      b.left_m_s[row] = left;
      b.right_m_s[row] = right;
    }
  }

 private:
  void distort(const DeviceContext& context, std::uint32_t entity, double& left, double& right) const noexcept {
    const auto bits = draw(context.seed, entity, Stream::WheelNoise, context.tick);
    const auto noise = to_normal(bits[0], bits[1]);
    if (left != 0.0)
      left = errors_.factor_left * (left + errors_.bias_left_m_s) * (1.0 + errors_.noise_std_dev * noise[0]);
    if (right != 0.0)
      right = errors_.factor_right * (right + errors_.bias_right_m_s) * (1.0 + errors_.noise_std_dev * noise[1]);
  }

  WheelErrors<0> errors_;
  bool exact_ = true;
};

template <class Options>
Recipe<Actuator> make_wheels(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  WheelErrors<0> errors;
  if constexpr (requires { options.noise_std_dev; }) {
    errors = {options.bias_left_m_s, options.bias_right_m_s, options.factor_left, options.factor_right,
              options.noise_std_dev};
  }
  return [errors](std::size_t) { return std::make_unique<WheelActuator>(errors); };
}

template <class Options>
DeviceType wheels_type(std::string_view implementation, std::string_view summary) {
  return actuator_type("differential_steering", implementation, summary, &has_wheels, &make_wheels<Options>,
                       &describe_options<Options>);
}

// --- encoders ---

struct IdealEncoders {
  void describe(hal::ParamVisitor&) {}
};

template <int kPerMille>
struct EncoderErrors {
  double vel_noise_m_s = kPerMille * 1e-5;
  double dist_noise_m = kPerMille * 1e-6;
  void describe(hal::ParamVisitor& v) {
    v.number("vel_noise_range", vel_noise_m_s, hal::unit::cm_s, hal::kNotNegative,
             "Uniform noise of +-this on each speed.");
    v.number("dist_noise_range", dist_noise_m, hal::unit::cm, hal::kNotNegative,
             "Uniform noise of +-this on the distance rolled in each tick; it adds up.");
  }
};

class EncoderSensor final : public Sensor {
 public:
  EncoderSensor(const EncoderErrors<0>& errors, std::size_t capacity) : errors_(errors) {
    if (errors.dist_noise_m > 0.0) drift_m_.resize(2 * capacity, 0.0);
  }

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* encoders = static_cast<hal::WheelEncoders*>(ports);
    const Bodies& b = context.stores.bodies;
    const bool noisy = errors_.vel_noise_m_s > 0.0 || errors_.dist_noise_m > 0.0;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::WheelEncoders& port = encoders[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.left_m = b.left_m[row];
      port.right_m = b.right_m[row];
      port.left_m_s = static_cast<float>(b.left_m_s[row]);
      port.right_m_s = static_cast<float>(b.right_m_s[row]);
      if (noisy) add_noise(context, b.entity[row], i, port);
    }
  }

 private:
  void add_noise(const DeviceContext& context, std::uint32_t entity, std::size_t i, hal::WheelEncoders& port) noexcept {
    const auto bits = draw(context.seed, entity, Stream::EncoderNoise, context.tick);
    const auto symmetric = [&bits](std::size_t k) { return 2.0 * to_unit(bits[k]) - 1.0; };
    port.left_m_s += static_cast<float>(errors_.vel_noise_m_s * symmetric(0));
    port.right_m_s += static_cast<float>(errors_.vel_noise_m_s * symmetric(1));
    if (drift_m_.empty()) return;
    drift_m_[2 * i] += errors_.dist_noise_m * symmetric(2);
    drift_m_[2 * i + 1] += errors_.dist_noise_m * symmetric(3);
    port.left_m += drift_m_[2 * i];
    port.right_m += drift_m_[2 * i + 1];
  }

  EncoderErrors<0> errors_;
  std::vector<double> drift_m_;  // left, right of each row
};

template <class Options>
Recipe<Sensor> make_encoders(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  EncoderErrors<0> errors;
  if constexpr (requires { options.dist_noise_m; }) errors = {options.vel_noise_m_s, options.dist_noise_m};
  return [errors](std::size_t capacity) { return std::make_unique<EncoderSensor>(errors, capacity); };
}

template <class Options>
DeviceType encoder_type(std::string_view implementation, std::string_view summary) {
  return sensor_type("wheel_encoders", implementation, summary, &has_wheels, &make_encoders<Options>,
                     &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> wheel_types() {
  return {wheels_type<WheelErrors<0>>("default", "The commanded speeds, with bias, factor and noise where asked for."),
          wheels_type<IdealWheels>("ideal", "The commanded speeds, exactly."),
          wheels_type<WheelErrors<50>>("noisy", "Each wheel with a relative error of its own every tick."),
          encoder_type<EncoderErrors<0>>("default", "What the wheels rolled, with noise where asked for."),
          encoder_type<IdealEncoders>("ideal", "What the wheels rolled."),
          encoder_type<EncoderErrors<100>>("noisy", "What the wheels rolled, with noise that adds up.")};
}

}  // namespace tandem::core
