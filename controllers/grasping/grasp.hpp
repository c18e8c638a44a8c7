// Grasps a thing that a foot-bot's proximity sensors see.
#pragma once
#include <span>

#include "controllers/steering/nearby.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot.hpp"

namespace tandem::controllers {

/// Turns to the nearest thing that is no robot, drives up to it and opens the claws. The turret must look forward.
///
/// What is broader than `broadest_m`, or does not let itself be gripped, is an obstacle. Robots are known by their
/// range-and-bearing messages, so all should send some.
class Grasp {
 public:
  enum class Outcome { Working, Held, Obstacle, Lost };

  /// Takes proximity, gripper, range-and-bearing and clock sensors, wheels and gripper.
  /// @throws hal::DeviceError when one is missing
  Grasp(hal::Robot& robot, double broadest_m);

  /// The nearest thing that is no robot.
  Thing thing() const noexcept;
  /// Begins a new attempt.
  void start() noexcept;
  /// Goes on with it, writing wheels and gripper. Obstacle and Lost close the claws and stand still.
  Outcome step() noexcept;
  void let_go() noexcept { claws_.unlock(); }
  bool holding() const noexcept { return gripper_.holding; }

 private:
  Outcome give_up(Outcome outcome) noexcept;

  const hal::Proximity& proximity_;
  const hal::RangeAndBearing& heard_;
  const hal::Gripper& gripper_;
  const hal::Clock& clock_;
  hal::WheelSpeeds& wheels_;
  hal::GripperDrive& claws_;
  std::span<const hal::Mount> mounts_;
  double broadest_m_;
  double reach_m_;
  hal::TimeNs started_ns_ = 0;
  hal::TimeNs opened_ns_ = 0;
};

}  // namespace tandem::controllers
