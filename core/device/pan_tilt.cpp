// The head that a camera hangs in: the actuator that turns it, and the encoder that tells where it looks.
#include "hal/device/pan_tilt.hpp"

#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

struct Ideal {
  void describe(hal::ParamVisitor&) {}
};

// --- actuator ---

template <int kPerMille>
struct AimErrors {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::rad, hal::kNotNegative,
             "Standard deviation of both angles that the head turns to, drawn every tick.");
  }
};

/// Turns about both axes at once, pan the shorter way round.
class HeadActuator final : public Actuator {
 public:
  HeadActuator(const hal::HeadPart& part, double noise_rad, const BlockColumns& columns)
      : part_(part), noise_rad_(noise_rad), heads_(columns.find<HeadState>()) {}

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* drives = static_cast<const hal::PanTiltDrive*>(ports);
    const double most_rad = part_.turn_rad_s * context.tick_s;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      if (led_from_outside(context, i)) continue;
      const std::size_t row = context.block.first_row + i;
      hal::PanTiltDrive drive = obeys(context, i) ? drives[i] : hal::PanTiltDrive{};
      if (noise_rad_ > 0.0) {
        const auto bits = draw(context.seed, stores.bodies.entity[row], Stream::HeadNoise, context.tick);
        const auto error = to_normal(bits[0], bits[1]);
        drive.pan_rad += noise_rad_ * error[0];
        drive.tilt_rad += noise_rad_ * error[1];
      }
      HeadState& head = heads_[i];
      const double tilt = std::clamp(drive.tilt_rad, -part_.max_tilt_rad, part_.max_tilt_rad);
      head.pan_rad =
          hal::wrapped(head.pan_rad + std::clamp(hal::wrapped(drive.pan_rad - head.pan_rad), -most_rad, most_rad));
      head.tilt_rad += std::clamp(tilt - head.tilt_rad, -most_rad, most_rad);
      head.laser = drive.laser;
    }
  }

 private:
  const hal::HeadPart& part_;
  double noise_rad_;
  HeadState* heads_;
};

template <class Options>
BlockFactory<Actuator> make_head(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_std_dev; }) noise = options.noise_std_dev;
  const auto make = [&part = *setup.kind.part<hal::HeadPart>(), noise](const BlockColumns& columns) {
    return std::make_unique<HeadActuator>(part, noise, columns);
  };
  return {make, {keeps<HeadState>()}};
}

template <class Options>
DeviceType head_type(std::string_view implementation, std::string_view summary) {
  return actuator_type(hal::PanTiltDrive::kName, implementation, summary, &has<hal::HeadPart>, &make_head<Options>,
                       &describe_options<Options>);
}

// --- encoder ---

template <int kPerMille>
struct AngleNoise {
  double noise_range_rad = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on both angles.");
  }
};

class HeadEncoderSensor final : public Sensor {
 public:
  HeadEncoderSensor(double noise_rad, const BlockColumns& columns)
      : noise_rad_(noise_rad), heads_(columns.find<HeadState>()) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* encoders = static_cast<hal::PanTiltEncoder*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      stamp(context, encoders[i]);
      double pan_rad = heads_[i].pan_rad;
      double tilt_rad = heads_[i].tilt_rad;
      if (noise_rad_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::HeadEncoderNoise, context.tick);
        pan_rad = hal::wrapped(pan_rad + noise_rad_ * to_symmetric(bits[0]));
        tilt_rad += noise_rad_ * to_symmetric(bits[1]);
      }
      encoders[i].pan_rad = pan_rad;
      encoders[i].tilt_rad = tilt_rad;
    }
  }

 private:
  double noise_rad_;
  const HeadState* heads_;
};

template <class Options>
BlockFactory<Sensor> make_encoder(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_range_rad; }) noise = options.noise_range_rad;
  const auto make = [noise](const BlockColumns& columns) {
    return std::make_unique<HeadEncoderSensor>(noise, columns);
  };
  return {make, {keeps<HeadState>()}};
}

template <class Options>
DeviceType encoder_type(std::string_view implementation, std::string_view summary) {
  return sensor_type(hal::PanTiltEncoder::kName, implementation, summary, &has<hal::HeadPart>, &make_encoder<Options>,
                     &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> pan_tilt_types() {
  return {head_type<AimErrors<0>>("default", "Turns as fast as it can; errors where asked for."),
          head_type<Ideal>("ideal", "Turns as fast as it can."),
          head_type<AimErrors<10>>("noisy", "Turns to angles with an error every tick."),
          encoder_type<AngleNoise<0>>("default", "Both angles; noise where asked for."),
          encoder_type<Ideal>("ideal", "Both angles."),
          encoder_type<AngleNoise<10>>("noisy", "Both angles, with uniform noise.")};
}

}  // namespace tandem::core
