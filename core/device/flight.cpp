// Flight: the actuators that take where, how fast, how and whether to fly, and the sensor that tells where the robot
// is.
#include "hal/device/flight.hpp"

#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"

namespace tandem::core {
namespace {

// --- actuators ---

struct IdealFlight {
  void describe(hal::ParamVisitor&) {}
};

template <int kPerMille>
struct TargetErrors {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::m, hal::kNotNegative,
             "Standard deviation of the target on each axis, drawn every tick.");
  }
};

template <int kPerMille>
struct VelocityErrors {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::m_s, hal::kNotNegative,
             "Standard deviation of the velocity on each axis, drawn every tick.");
  }
};

template <int kPerMille>
struct AttitudeErrors {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::rad, hal::kNotNegative,
             "Standard deviation of roll and pitch, and of the thrust in parts of the weight, drawn every tick.");
  }
};

template <int kPerMille>
struct TaskErrors {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::none, {0.0, 0.3},
             "Standard deviation of the relative error of the speed to climb or sink with, drawn every tick.");
  }
};

/// Three errors with this standard deviation.
std::array<double, 3> errors(const DeviceContext& context, std::size_t row, Stream stream, double std_dev) noexcept {
  const auto bits = draw(context.seed, context.stores.bodies.entity[row], stream, context.tick);
  const auto xy = to_normal(bits[0], bits[1]);
  return {std_dev * xy[0], std_dev * xy[1], std_dev * to_normal(bits[2], bits[3])[0]};
}

/// Each flight actuator notes what its port asks for; which of them counts is seen once all have
/// (core/device/piloting).
class PositionActuator final : public Actuator {
 public:
  PositionActuator(double noise_m, const BlockColumns& columns)
      : noise_m_(noise_m), setpoints_(columns.find<FlightSetpoint>()) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    const auto* targets = static_cast<const hal::QuadrotorPosition*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      FlightSetpoint& setpoint = setpoints_[i];
      setpoint.to_place = !targets[i].hold;
      setpoint.target_m = targets[i].target;
      setpoint.heading_rad = targets[i].yaw_rad;
      if (noise_m_ == 0.0 || !setpoint.to_place) continue;
      const auto error = errors(context, row, Stream::FlightNoise, noise_m_);
      for (std::size_t k = 0; k < 3; ++k) setpoint.target_m[k] += error[k];
    }
  }

 private:
  double noise_m_;
  FlightSetpoint* setpoints_;
};

class SpeedActuator final : public Actuator {
 public:
  SpeedActuator(double noise_m_s, const BlockColumns& columns)
      : noise_m_s_(noise_m_s), setpoints_(columns.find<FlightSetpoint>()) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    const auto* speeds = static_cast<const hal::QuadrotorSpeed*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      FlightSetpoint& setpoint = setpoints_[i];
      setpoint.velocity_m_s = speeds[i].velocity;
      setpoint.turn_rad_s = speeds[i].yaw_rad_s;
      if (noise_m_s_ == 0.0) continue;
      const auto error = errors(context, row, Stream::FlightNoise, noise_m_s_);
      for (std::size_t k = 0; k < 3; ++k) setpoint.velocity_m_s[k] += error[k];
    }
  }

 private:
  double noise_m_s_;
  FlightSetpoint* setpoints_;
};

class AttitudeActuator final : public Actuator {
 public:
  AttitudeActuator(double noise, const BlockColumns& columns)
      : noise_(noise), setpoints_(columns.find<FlightSetpoint>()) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    const auto* attitudes = static_cast<const hal::QuadrotorAttitude*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::QuadrotorAttitude& setpoint = setpoints_[i].attitude;
      setpoint = attitudes[i];
      if (noise_ == 0.0 || !setpoint.active) continue;
      const auto error = errors(context, row, Stream::AttitudeNoise, noise_);
      setpoint.roll_rad += error[0];
      setpoint.pitch_rad += error[1];
      setpoint.thrust = std::max(0.0, setpoint.thrust + error[2]);
    }
  }

 private:
  double noise_;
  FlightSetpoint* setpoints_;
};

class TaskActuator final : public Actuator {
 public:
  TaskActuator(double noise, const BlockColumns& columns) : noise_(noise), setpoints_(columns.find<FlightSetpoint>()) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    const auto* tasks = static_cast<const hal::FlightTask*>(ports);
    const hal::Quadrotor& flight = *context.group.kind->flight();
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::FlightTask& setpoint = setpoints_[i].task;
      setpoint = tasks[i];
      if (noise_ == 0.0) continue;
      if (setpoint.speed_m_s == 0.0)
        setpoint.speed_m_s = setpoint.order == hal::FlightOrder::Land ? flight.sink_m_s : flight.climb_m_s;
      setpoint.speed_m_s *= std::max(0.1, 1.0 + errors(context, row, Stream::TaskNoise, noise_)[0]);
    }
  }

 private:
  double noise_;
  FlightSetpoint* setpoints_;
};

template <class Device, class Options>
BlockFactory<Actuator> make_flight(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_std_dev; }) noise = options.noise_std_dev;
  const auto make = [noise](const BlockColumns& columns) { return std::make_unique<Device>(noise, columns); };
  return {make, {keeps<FlightSetpoint>(), keeps<PilotState>()}};
}

template <class Device, class Options>
DeviceType flight_type(std::string_view device, std::string_view implementation, std::string_view summary) {
  return actuator_type(device, implementation, summary, &has<hal::Quadrotor>, &make_flight<Device, Options>,
                       &describe_options<Options>);
}

// --- positioning ---

struct IdealPlace {
  void describe(hal::ParamVisitor&) {}
};

/// ARGoS' three ranges. Orientation: the angle and each part of the axis that the body is turned about.
template <int kPerMille>
struct PlaceErrors {
  double pos_noise_m = kPerMille * 1e-3;
  double angle_noise_rad = kPerMille * 1e-3;
  double axis_noise = 0.0;
  void describe(hal::ParamVisitor& v) {
    v.number("pos_noise_range", pos_noise_m, hal::unit::m, hal::kNotNegative,
             "Uniform noise of +-this on each coordinate.");
    v.number("angle_noise_range", angle_noise_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on the angle that the body is turned by.");
    v.number("axis_noise_range", axis_noise, hal::unit::none, {0.0, 0.5},
             "Uniform noise of +-this on each part of the axis that the body is turned about.");
  }
};

class PositioningSensor final : public Sensor {
 public:
  explicit PositioningSensor(const PlaceErrors<0>& errors) : errors_(errors) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* places = static_cast<hal::Positioning*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::Positioning& port = places[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.p_WB = {b.x_m[row], b.y_m[row], context.stores.base_m(row)};
      port.q_WB = b.motion.empty() ? upright(b.cos_h[row], b.sin_h[row]) : b.motion[row].q_WB;
      if (errors_.pos_noise_m > 0.0 || errors_.angle_noise_rad > 0.0 || errors_.axis_noise > 0.0)
        add_noise(context, b.entity[row], port);
    }
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
    const auto symmetric = [](std::uint32_t bits) { return 2.0 * to_unit(bits) - 1.0; };
    for (std::size_t k = 0; k < 3; ++k) port.p_WB[k] += errors_.pos_noise_m * symmetric(place[k]);
    if (errors_.angle_noise_rad == 0.0 && errors_.axis_noise == 0.0) return;
    auto& q = port.q_WB;
    const double s = std::sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const double angle = 2.0 * std::atan2(s, q[0]) + errors_.angle_noise_rad * symmetric(place[3]);
    std::array<double, 3> axis{0.0, 0.0, 1.0};  // of a body that is not turned: the vertical
    if (s > 1e-12) axis = {q[1] / s, q[2] / s, q[3] / s};
    for (std::size_t k = 0; k < 3; ++k) axis[k] += errors_.axis_noise * symmetric(turn[k]);
    const double length = std::sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);  // at least 0.13
    const double part = std::sin(0.5 * angle) / length;
    q = {std::cos(0.5 * angle), part * axis[0], part * axis[1], part * axis[2]};
  }

  PlaceErrors<0> errors_;
};

template <class Options>
BlockFactory<Sensor> make_positioning(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  PlaceErrors<0> errors;
  if constexpr (requires { options.pos_noise_m; })
    errors = {options.pos_noise_m, options.angle_noise_rad, options.axis_noise};
  return [errors](const BlockColumns&) { return std::make_unique<PositioningSensor>(errors); };
}

template <class Options>
DeviceType positioning_type(std::string_view implementation, std::string_view summary) {
  return sensor_type(
      hal::Positioning::kName, implementation, summary, [](const hal::RobotKind&) { return true; },
      &make_positioning<Options>, &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> flight_types() {
  constexpr std::string_view kPosition = hal::QuadrotorPosition::kName;
  constexpr std::string_view kSpeed = hal::QuadrotorSpeed::kName;
  constexpr std::string_view kAttitude = hal::QuadrotorAttitude::kName;
  constexpr std::string_view kTask = hal::FlightTask::kName;
  using Position = PositionActuator;
  using Speed = SpeedActuator;
  using Attitude = AttitudeActuator;
  using Task = TaskActuator;
  return {flight_type<Position, TargetErrors<0>>(kPosition, "default", "Flies to a place; noise where asked for."),
          flight_type<Position, IdealFlight>(kPosition, "ideal", "Flies to a place."),
          flight_type<Position, TargetErrors<10>>(kPosition, "noisy", "Flies to a place that wanders."),
          flight_type<Speed, VelocityErrors<0>>(kSpeed, "default", "Flies at a velocity; noise where asked for."),
          flight_type<Speed, IdealFlight>(kSpeed, "ideal", "Flies at a velocity."),
          flight_type<Speed, VelocityErrors<20>>(kSpeed, "noisy", "Flies at a velocity, with an error every tick."),
          flight_type<Attitude, AttitudeErrors<0>>(kAttitude, "default", "Leans as told; noise where asked for."),
          flight_type<Attitude, IdealFlight>(kAttitude, "ideal", "Leans as told."),
          flight_type<Attitude, AttitudeErrors<10>>(kAttitude, "noisy", "Leans with an error every tick."),
          flight_type<Task, TaskErrors<0>>(kTask, "default",
                                           "Takes off, lands, holds on to the ceiling; noise where "
                                           "asked for."),
          flight_type<Task, IdealFlight>(kTask, "ideal", "Takes off, lands, holds on to the ceiling."),
          flight_type<Task, TaskErrors<50>>(kTask, "noisy", "The same, with an error of its speed every tick."),
          positioning_type<PlaceErrors<0>>("default", "Place and orientation; noise where asked for."),
          positioning_type<IdealPlace>("ideal", "Place and orientation."),
          positioning_type<PlaceErrors<10>>("noisy", "Place and orientation, with uniform noise.")};
}

}  // namespace tandem::core
