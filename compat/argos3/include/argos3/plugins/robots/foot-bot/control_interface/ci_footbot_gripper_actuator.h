// The foot-bot's gripper.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_GRIPPER_ACTUATOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_GRIPPER_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_FootBotGripperActuator : public CCI_Actuator {
 public:
  static CRadians UNLOCKED;
  static CRadians LOCKED_POSITIVE;
  static CRadians LOCKED_NEGATIVE;

  /// From LOCKED_NEGATIVE to LOCKED_POSITIVE.
  virtual void SetAperture(const CRadians& aperture) = 0;
  // Our gripper knows by itself whether it holds something: the gripper sensor tells.
  virtual void EnableCheckForObjectGrippedRoutine() = 0;
  virtual void DisableCheckForObjectGrippedRoutine() = 0;
  void LockPositive() { SetAperture(LOCKED_POSITIVE); }
  void LockNegative() { SetAperture(LOCKED_NEGATIVE); }
  void Unlock() { SetAperture(UNLOCKED); }
};

}  // namespace argos

#endif
