// Flight: the actuators that take where, how fast, how and whether to fly, and the sensor that tells where the robot
// is.
#include "hal/device/flight.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"

namespace tandem::core {
namespace {

// --- actuators ---

constexpr ErrorText kTargetErrors{"noise_std_dev", 10 * 1e-3, hal::unit::m, hal::kNotNegative,
                                  "Standard deviation of the target on each axis, drawn every tick."};
using TargetErrors = OneError<kTargetErrors>;

constexpr ErrorText kVelocityErrors{"noise_std_dev", 20 * 1e-3, hal::unit::m_s, hal::kNotNegative,
                                    "Standard deviation of the velocity on each axis, drawn every tick."};
using VelocityErrors = OneError<kVelocityErrors>;

constexpr ErrorText kAttitudeErrors{
    "noise_std_dev", 10 * 1e-3, hal::unit::rad, hal::kNotNegative,
    "Standard deviation of roll and pitch, and of the thrust in parts of the weight, drawn every tick."};
using AttitudeErrors = OneError<kAttitudeErrors>;

constexpr ErrorText kTaskErrors{
    "noise_std_dev",
    50 * 1e-3,
    hal::unit::none,
    {0.0, 0.3},
    "Standard deviation of the relative error of the speed to climb or sink with, drawn every tick."};
using TaskErrors = OneError<kTaskErrors>;

/// Three errors with this standard deviation.
std::array<double, 3> errors(const RobotAt& robot, Stream stream, double std_dev) noexcept {
  const auto bits = robot.draw(stream);
  const auto xy = to_normal(bits[0], bits[1]);
  return {std_dev * xy[0], std_dev * xy[1], std_dev * to_normal(bits[2], bits[3])[0]};
}

/// Each flight actuator notes what its port asks for; which of them counts is seen once all have
/// (core/device/piloting).
template <class Self, class OfPort, class OfErrors>
class FlightActuator : public EachActuator<Self, OfPort, OfErrors, FlightSetpoint> {
 public:
  using Part = hal::Quadrotor;
  using FlightActuator::EachActuator::EachActuator;

  static void prepare(BlockFactory<Actuator>& factory, const DeviceSetup&, const OfErrors&) {
    factory.columns = {keeps<FlightSetpoint>(), keeps<PilotState>()};
  }
};

class PositionActuator final : public FlightActuator<PositionActuator, hal::QuadrotorPosition, TargetErrors> {
 public:
  using FlightActuator::FlightActuator;

  void obey(const RobotAt& robot, const hal::QuadrotorPosition& target) const noexcept {
    FlightSetpoint& setpoint = kept_[robot.i];
    setpoint.to_place = !target.hold;
    setpoint.target_m = target.target;
    setpoint.heading_rad = target.yaw_rad;
    if (errors_.amount == 0.0 || !setpoint.to_place) return;
    const auto error = errors(robot, Stream::FlightNoise, errors_.amount);
    for (std::size_t k = 0; k < 3; ++k) setpoint.target_m[k] += error[k];
  }
};

class SpeedActuator final : public FlightActuator<SpeedActuator, hal::QuadrotorSpeed, VelocityErrors> {
 public:
  using FlightActuator::FlightActuator;

  void obey(const RobotAt& robot, const hal::QuadrotorSpeed& speed) const noexcept {
    FlightSetpoint& setpoint = kept_[robot.i];
    setpoint.velocity_m_s = speed.velocity;
    setpoint.turn_rad_s = speed.yaw_rad_s;
    if (errors_.amount == 0.0) return;
    const auto error = errors(robot, Stream::FlightNoise, errors_.amount);
    for (std::size_t k = 0; k < 3; ++k) setpoint.velocity_m_s[k] += error[k];
  }
};

class AttitudeActuator final : public FlightActuator<AttitudeActuator, hal::QuadrotorAttitude, AttitudeErrors> {
 public:
  using FlightActuator::FlightActuator;

  void obey(const RobotAt& robot, const hal::QuadrotorAttitude& attitude) const noexcept {
    hal::QuadrotorAttitude& setpoint = kept_[robot.i].attitude;
    setpoint = attitude;
    if (errors_.amount == 0.0 || !setpoint.active) return;
    const auto error = errors(robot, Stream::AttitudeNoise, errors_.amount);
    setpoint.roll_rad += error[0];
    setpoint.pitch_rad += error[1];
    setpoint.thrust = std::max(0.0, setpoint.thrust + error[2]);
  }
};

class TaskActuator final : public FlightActuator<TaskActuator, hal::FlightTask, TaskErrors> {
 public:
  using FlightActuator::FlightActuator;

  void obey(const RobotAt& robot, const hal::FlightTask& task) const noexcept {
    const hal::Quadrotor& flight = *robot.context.group.kind->flight();
    hal::FlightTask& setpoint = kept_[robot.i].task;
    setpoint = task;
    if (errors_.amount == 0.0) return;
    if (setpoint.speed_m_s == 0.0)
      setpoint.speed_m_s = setpoint.order == hal::FlightOrder::Land ? flight.sink_m_s : flight.climb_m_s;
    setpoint.speed_m_s *= std::max(0.1, 1.0 + errors(robot, Stream::TaskNoise, errors_.amount)[0]);
  }
};

// --- positioning ---

/// ARGoS' three ranges. Orientation: the angle and each part of the axis that the body is turned about.
struct PlaceErrors {
  hal::Interval pos_noise_m = {}, angle_noise_rad = {}, axis_noise = {};
  static PlaceErrors noisy() {
    return {.pos_noise_m = hal::Interval::around(10 * 1e-3), .angle_noise_rad = hal::Interval::around(10 * 1e-3)};
  }
  void describe(hal::ParamVisitor& v) {
    v.interval("pos_noise_range", pos_noise_m, hal::unit::m, "Uniform noise on each coordinate.");
    v.interval("angle_noise_range", angle_noise_rad, hal::unit::rad,
               "Uniform noise on the angle that the body is turned by.");
    v.interval("axis_noise_range", axis_noise, hal::unit::none,
               "Uniform noise on each part of the axis that the body is turned about.", {-0.5, 0.5});
  }
};

class PositioningSensor final : public EachSensor<PositioningSensor, hal::Positioning, PlaceErrors> {
 public:
  using EachSensor::EachSensor;

  void read(const RobotAt& robot, hal::Positioning& port) const noexcept {
    const Bodies& b = robot.bodies();
    const std::size_t row = robot.row();
    port.p_WB = {b.x_m[row], b.y_m[row], robot.context.stores.base_m(row)};
    port.q_WB = b.motion.empty() ? upright(b.cos_h[row], b.sin_h[row]) : b.motion[row].q_WB;
    if (!errors_.pos_noise_m.empty() || !errors_.angle_noise_rad.empty() || !errors_.axis_noise.empty())
      add_noise(robot.context, b.entity[row], port);
  }

 private:
  /// Turned about the vertical only. Bodies in the plane have no quaternion of their own.
  static std::array<double, 4> upright(double cos_h, double sin_h) noexcept {
    const double half_rad = 0.5 * std::atan2(sin_h, cos_h);
    return {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
  }

  void add_noise(const DeviceContext& context, std::uint32_t entity, hal::Positioning& port) const noexcept {
    const auto place = draw(context.seed, entity, Stream::PositioningNoise, context.tick, 0);
    const auto turn = draw(context.seed, entity, Stream::PositioningNoise, context.tick, 1);
    for (std::size_t k = 0; k < 3; ++k) port.p_WB[k] += errors_.pos_noise_m.at(to_symmetric(place[k]));
    if (errors_.angle_noise_rad.empty() && errors_.axis_noise.empty()) return;
    auto& q = port.q_WB;
    const double s = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double angle = 2.0 * std::atan2(s, q[0]) + errors_.angle_noise_rad.at(to_symmetric(place[3]));
    std::array<double, 3> axis{0.0, 0.0, 1.0};  // of a body that is not turned: the vertical
    if (s > 1e-12) axis = {q[1] / s, q[2] / s, q[3] / s};
    for (std::size_t k = 0; k < 3; ++k) axis[k] += errors_.axis_noise.at(to_symmetric(turn[k]));
    const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);  // at least 0.13
    const double part = std::sin(0.5 * angle) / length;
    q = {std::cos(0.5 * angle), part * axis[0], part * axis[1], part * axis[2]};
  }
};

}  // namespace

std::vector<DeviceType> flight_types() {
  std::vector<DeviceType> types;
  add_levels<PositionActuator>(types, "Flies to a place; noise where asked for.", "Flies to a place.",
                               "Flies to a place that wanders.");
  add_levels<SpeedActuator>(types, "Flies at a velocity; noise where asked for.", "Flies at a velocity.",
                            "Flies at a velocity, with an error every tick.");
  add_levels<AttitudeActuator>(types, "Leans as told; noise where asked for.", "Leans as told.",
                               "Leans with an error every tick.");
  add_levels<TaskActuator>(types, "Takes off, lands, holds on to the ceiling; noise where asked for.",
                           "Takes off, lands, holds on to the ceiling.",
                           "The same, with an error of its speed every tick.");
  add_levels<PositioningSensor>(types, "Place and orientation; noise where asked for.", "Place and orientation.",
                                "Place and orientation, with uniform noise.");
  return types;
}

}  // namespace tandem::core
