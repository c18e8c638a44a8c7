// Grippers: the actuator that opens the claws, and the sensor of what they do. What is held is decided between the
// robots' actuators and the physics, for all grippers together.
#include "hal/device/gripper.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

constexpr ErrorText kGripping{"failure_prob",
                              100 * 1e-3,
                              hal::unit::none,
                              {0.0, 1.0},
                              "Probability, in each tick, that open claws fail to hold what is before them."};
using Gripping = OneError<kGripping>;

class GripperActuator final : public EachActuator<GripperActuator, hal::GripperDrive, Gripping, GripState> {
 public:
  using Part = hal::GripperPart;
  using EachActuator::EachActuator;

  void obey(const RobotAt& robot, const hal::GripperDrive& drive) const noexcept {
    GripState& grip = kept_[robot.i];
    const bool able = obeys(robot.context, robot.i);
    if (!led_from_outside(robot.context, robot.i)) grip.aperture_rad = able ? drive.aperture_rad : 0.0;
    grip.wants = able && drive.locks();
    grip.slips = grip.wants && errors_.amount > 0.0 && to_unit(robot.draw(Stream::GripperSlip)[0]) < errors_.amount;
  }
};

// --- sensor ---

constexpr ErrorText kApertureNoise{"noise_range", 20 * 1e-3, hal::unit::rad, hal::kNotNegative,
                                   "Uniform noise of +-this on the aperture."};
using ApertureNoise = OneError<kApertureNoise>;

class GripperSensor final : public EachSensor<GripperSensor, hal::Gripper, ApertureNoise, GripState> {
 public:
  using Part = hal::GripperPart;
  using EachSensor::EachSensor;

  void read(const RobotAt& robot, hal::Gripper& port) const noexcept {
    double aperture_rad = kept_[robot.i].aperture_rad;
    if (errors_.amount > 0.0) aperture_rad += errors_.amount * to_symmetric(robot.draw(Stream::GripperNoise)[0]);
    port.aperture_rad = static_cast<float>(aperture_rad);
    port.holding = kept_[robot.i].holding();
    port.busy = false;
  }
};

}  // namespace

std::vector<DeviceType> gripper_types() {
  std::vector<DeviceType> types;
  add_levels<GripperActuator>(types, "Open claws hold what is before them; failures where asked for.",
                              "Open claws hold what is before them.",
                              "Open claws hold what is before them, not always at once.");
  for (DeviceType& type : types) type.joints = kJointsOfGrips;
  add_levels<GripperSensor>(types, "Aperture and whether something is held; noise where asked for.",
                            "Aperture and whether something is held.",
                            "Aperture with uniform noise, and whether something is held.");
  return types;
}

}  // namespace tandem::core
