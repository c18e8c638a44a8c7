// Sensors of flight: state and speed of a flying robot, and its distance to ground and ceiling.
#include "core/device/altitude.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/device/flight.hpp"

namespace tandem::core {
namespace {

struct NoOptions {
  void describe(hal::ParamVisitor&) {}
};

// --- flight state ---

template <int kPerMille>
struct VelocityNoise {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::m_s, hal::kNotNegative,
             "Standard deviation of the velocity on each axis, and of the turn rate in rad/s.");
  }
};

class FlightStateSensor final : public Sensor {
 public:
  FlightStateSensor(double noise_m_s, const BlockColumns& columns)
      : noise_m_s_(noise_m_s), pilots_(columns.find<PilotState>()) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* states = static_cast<hal::FlightState*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::FlightState& port = states[i];
      stamp(context, port);
      port.phase = pilots_[i].phase;
      port.failsafe = hal::FlightFailsafe::None;
      port.velocity = b.motion[row].v_m_s;
      port.yaw_rad_s = b.motion[row].w_rad_s[2];
      if (noise_m_s_ == 0.0) continue;
      const auto bits = draw(context.seed, b.entity[row], Stream::FlightStateNoise, context.tick);
      const auto xy = to_normal(bits[0], bits[1]);
      const auto zw = to_normal(bits[2], bits[3]);
      port.velocity[0] += noise_m_s_ * xy[0];
      port.velocity[1] += noise_m_s_ * xy[1];
      port.velocity[2] += noise_m_s_ * zw[0];
      port.yaw_rad_s += noise_m_s_ * zw[1];
    }
  }

 private:
  double noise_m_s_;
  const PilotState* pilots_;
};

template <class Options>
BlockFactory<Sensor> make_state(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_std_dev; }) noise = options.noise_std_dev;
  const auto make = [noise](const BlockColumns& columns) {
    return std::make_unique<FlightStateSensor>(noise, columns);
  };
  return {make, {keeps<PilotState>()}};
}

template <class Options>
DeviceType state_type(std::string_view implementation, std::string_view summary) {
  return sensor_type(hal::FlightState::kName, implementation, summary, &has<hal::Quadrotor>, &make_state<Options>,
                     &describe_options<Options>);
}

// --- altimeter ---

template <int kPerMille>
struct EchoNoise {
  double noise_std_dev_m = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev_m, hal::unit::m, hal::kNotNegative,
             "Standard deviation of each distance; none becomes negative.");
  }
};

class AltimeterSensor final : public Sensor {
 public:
  AltimeterSensor(double farthest_m, double noise_m) : farthest_m_(farthest_m), noise_m_(noise_m) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* altimeters = static_cast<hal::Altimeter*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::Altimeter& port = altimeters[i];
      stamp(context, port);
      if ((b.flags[row] & kAlive) == 0) continue;
      std::array<double, 2> error{};
      if (noise_m_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::AltimeterNoise, context.tick);
        error = to_normal(bits[0], bits[1]);
      }
      port.ground_m = echo(room_below_m(context.stores, row, true), error[0]);
      port.ceiling_m = echo(room_above_m(context.stores, row), error[1]);
    }
  }

 private:
  float echo(double distance_m, double error) const noexcept {
    if (distance_m > farthest_m_) return -1.0F;
    return static_cast<float>(std::max(0.0, distance_m + noise_m_ * error));
  }

  double farthest_m_;
  double noise_m_;
};

template <class Options>
BlockFactory<Sensor> make_altimeter(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_std_dev_m; }) noise = options.noise_std_dev_m;
  return [farthest = setup.kind.part<hal::AltimeterPart>()->range_m, noise](const BlockColumns&) {
    return std::make_unique<AltimeterSensor>(farthest, noise);
  };
}

template <class Options>
DeviceType altimeter_type(std::string_view implementation, std::string_view summary) {
  return sensor_type(hal::Altimeter::kName, implementation, summary, &has<hal::AltimeterPart>, &make_altimeter<Options>,
                     &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> flight_sensor_types() {
  return {state_type<VelocityNoise<0>>("default", "Phase, fail-safe and velocity; noise where asked for."),
          state_type<NoOptions>("ideal", "Phase, fail-safe and velocity."),
          state_type<VelocityNoise<20>>("noisy", "Phase, fail-safe and velocity, with noise."),
          altimeter_type<EchoNoise<0>>("default", "Distances straight down and up; noise where asked for."),
          altimeter_type<NoOptions>("ideal", "Distances straight down and up."),
          altimeter_type<EchoNoise<10>>("noisy", "Distances straight down and up, with noise.")};
}

}  // namespace tandem::core
