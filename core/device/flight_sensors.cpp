// Sensors of flight: state and speed of a flying robot, and its distance to ground and ceiling.
#include "core/device/altitude.hpp"
#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/device/flight.hpp"

namespace tandem::core {
namespace {

// --- flight state ---

constexpr ErrorText kVelocityNoise{"noise_std_dev", 20 * 1e-3, hal::unit::m_s, hal::kNotNegative,
                                   "Standard deviation of the velocity on each axis, and of the turn rate in rad/s."};
using VelocityNoise = OneError<kVelocityNoise>;

class FlightStateSensor final : public EachSensor<FlightStateSensor, hal::FlightState, VelocityNoise, PilotState> {
 public:
  using Part = hal::Quadrotor;
  using EachSensor::EachSensor;

  void read(const RobotAt& robot, hal::FlightState& port) const noexcept {
    const Motion& motion = robot.bodies().motion[robot.row()];
    port.phase = kept_[robot.i].phase;
    port.failsafe = hal::FlightFailsafe::None;
    port.velocity = motion.v_m_s;
    port.yaw_rad_s = motion.w_rad_s[2];
    if (errors_.amount == 0.0) return;
    const auto bits = robot.draw(Stream::FlightStateNoise);
    const auto xy = to_normal(bits[0], bits[1]);
    const auto zw = to_normal(bits[2], bits[3]);
    port.velocity[0] += errors_.amount * xy[0];
    port.velocity[1] += errors_.amount * xy[1];
    port.velocity[2] += errors_.amount * zw[0];
    port.yaw_rad_s += errors_.amount * zw[1];
  }
};

// --- altimeter ---

constexpr ErrorText kEchoNoise{"noise_std_dev", 10 * 1e-3, hal::unit::m, hal::kNotNegative,
                               "Standard deviation of each distance; none becomes negative."};
using EchoNoise = OneError<kEchoNoise>;

class AltimeterSensor final : public EachSensor<AltimeterSensor, hal::Altimeter, EchoNoise> {
 public:
  using Part = hal::AltimeterPart;

  AltimeterSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns), farthest_m_(setup.kind.part<Part>()->range_m) {}

  void read(const RobotAt& robot, hal::Altimeter& port) const noexcept {
    if ((robot.bodies().flags[robot.row()] & kAlive) == 0) return;
    std::array<double, 2> error{};
    if (errors_.amount > 0.0) {
      const auto bits = robot.draw(Stream::AltimeterNoise);
      error = to_normal(bits[0], bits[1]);
    }
    port.ground_m = echo(room_below_m(robot.context.stores, robot.row(), true), error[0]);
    port.ceiling_m = echo(room_above_m(robot.context.stores, robot.row()), error[1]);
  }

 private:
  float echo(double distance_m, double error) const noexcept {
    if (distance_m > farthest_m_) return -1.0F;
    return static_cast<float>(std::max(0.0, distance_m + errors_.amount * error));
  }

  double farthest_m_;
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
