// Turrets: the actuator that turns them, and the encoder that tells where they look.
#include "hal/device/turret.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

constexpr ErrorText kTurretErrors{"noise_std_dev",
                                  50 * 1e-3,
                                  hal::unit::none,
                                  {0.0, 1.0},
                                  "Standard deviation of the turn rate's relative error, drawn every tick."};
using TurretErrors = OneError<kTurretErrors>;

/// Turns what carries no load at once; a turret that holds something is turned by the physics engine.
class TurretActuator final : public EachActuator<TurretActuator, hal::TurretDrive, TurretErrors, TurretState> {
 public:
  using Part = hal::TurretPart;

  TurretActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachActuator(setup, errors, columns),
        fastest_rad_s_(setup.kind.part<Part>()->turn_rad_s),
        grips_(columns.find<GripState>()) {}

  void obey(const RobotAt& robot, const hal::TurretDrive& drive) const noexcept {
    if (led_from_outside(robot.context, robot.i)) return;
    command(robot, drive, kept_[robot.i]);
    if (grips_ == nullptr || !grips_[robot.i].holding()) turn(kept_[robot.i], robot.context.tick_s);
  }

 private:
  void command(const RobotAt& robot, const hal::TurretDrive& drive, TurretState& turret) const noexcept {
    turret.mode = obeys(robot.context, robot.i) ? drive.mode : hal::TurretMode::Off;
    turret.target = turret.mode == hal::TurretMode::Position ? drive.angle_rad : drive.speed_rad_s;
    if (errors_.amount == 0.0 || turret.mode != hal::TurretMode::Speed) return;
    const auto bits = robot.draw(Stream::TurretNoise);
    turret.target *= 1.0 + errors_.amount * to_normal(bits[0], bits[1])[0];
  }
  void turn(TurretState& turret, double tick_s) const noexcept {
    double step_rad = 0.0;
    if (turret.mode == hal::TurretMode::Speed) step_rad = turret.target * tick_s;
    if (turret.mode == hal::TurretMode::Position) {
      const double most_rad = fastest_rad_s_ * tick_s;
      step_rad = std::clamp(hal::wrapped(turret.target - turret.angle_rad), -most_rad, most_rad);
    }
    turret.angle_rad = hal::wrapped(turret.angle_rad + step_rad);
    turret.speed_rad_s = step_rad / tick_s;
  }

  double fastest_rad_s_;
  const GripState* grips_;  // null: they have no grippers
};

// --- encoder ---

constexpr ErrorText kAngleNoise{"noise_range", 10 * 1e-3, hal::unit::rad, hal::kNotNegative,
                                "Uniform noise of +-this on the angle."};
using AngleNoise = OneError<kAngleNoise>;

class TurretEncoderSensor final : public EachSensor<TurretEncoderSensor, hal::TurretEncoder, AngleNoise, TurretState> {
 public:
  using Part = hal::TurretPart;
  using EachSensor::EachSensor;

  void read(const RobotAt& robot, hal::TurretEncoder& port) const noexcept {
    port.angle_rad = kept_[robot.i].angle_rad;
    port.speed_rad_s = static_cast<float>(kept_[robot.i].speed_rad_s);
    if (errors_.amount == 0.0) return;
    const auto bits = robot.draw(Stream::TurretEncoderNoise);
    port.angle_rad = hal::wrapped(port.angle_rad + errors_.amount * to_symmetric(bits[0]));
  }
};

}  // namespace

std::vector<DeviceType> turret_types() {
  std::vector<DeviceType> types;
  add_levels<TurretActuator>(types, "Turns as told; errors where asked for.", "Turns as told.",
                             "Turns with an error of its speed every tick.");
  add_levels<TurretEncoderSensor>(types, "The turret's angle; noise where asked for.", "The turret's angle.",
                                  "The turret's angle, with uniform noise.");
  return types;
}

}  // namespace tandem::core
