// A gripper.
#ifndef TANDEM_ARGOS3_CI_GRIPPER_ACTUATOR_H
#define TANDEM_ARGOS3_CI_GRIPPER_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>

namespace argos {

class CCI_GripperActuator : public CCI_Actuator {
 public:
  /// 0 open, 1 locked; from a half on it holds.
  virtual void SetLockState(Real state) = 0;
  virtual void Lock() = 0;
  virtual void Unlock() = 0;
};

}  // namespace argos

#endif
