// Sensors of flight: state and speed of a flying robot, and its distance to ground and ceiling.
#include "core/device/altitude.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/device/flight.hpp"

namespace tandem::core {
namespace {

// --- flight state ---

struct VelocityNoise {
  double noise_std_dev = 0.0;
  static VelocityNoise noisy() { return {.noise_std_dev = 20 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::m_s, hal::kNotNegative,
             "Standard deviation of the velocity on each axis, and of the turn rate in rad/s.");
  }
};

class FlightStateSensor final : public Sensor {
 public:
  using Port = hal::FlightState;
  using Part = hal::Quadrotor;
  using Errors = VelocityNoise;
  using Kept = PilotState;

  FlightStateSensor(const DeviceSetup&, const Errors& errors, const BlockColumns& columns)
      : noise_m_s_(errors.noise_std_dev), pilots_(columns.find<PilotState>()) {}

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

// --- altimeter ---

struct EchoNoise {
  double noise_std_dev_m = 0.0;
  static EchoNoise noisy() { return {.noise_std_dev_m = 10 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev_m, hal::unit::m, hal::kNotNegative,
             "Standard deviation of each distance; none becomes negative.");
  }
};

class AltimeterSensor final : public Sensor {
 public:
  using Port = hal::Altimeter;
  using Part = hal::AltimeterPart;
  using Errors = EchoNoise;

  AltimeterSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : farthest_m_(setup.kind.part<Part>()->range_m), noise_m_(errors.noise_std_dev_m) {}

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

}  // namespace

std::vector<DeviceType> flight_sensor_types() {
  std::vector<DeviceType> types;
  add_levels<FlightStateSensor>(types, "Phase, fail-safe and velocity; noise where asked for.",
                                "Phase, fail-safe and velocity.", "Phase, fail-safe and velocity, with noise.");
  add_levels<AltimeterSensor>(types, "Distances straight down and up; noise where asked for.",
                              "Distances straight down and up.", "Distances straight down and up, with noise.");
  return types;
}

}  // namespace tandem::core
