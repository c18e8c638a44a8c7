// A velocity and a turn rate to fly with.
#ifndef TANDEM_ARGOS3_CI_QUADROTOR_SPEED_ACTUATOR_H
#define TANDEM_ARGOS3_CI_QUADROTOR_SPEED_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CCI_QuadRotorSpeedActuator : public CCI_Actuator {
 public:
  /// In m/s.
  virtual void SetLinearVelocity(const CVector3& velocity) = 0;
  /// A second.
  virtual void SetRotationalSpeed(const CRadians& speed) = 0;
};

}  // namespace argos

#endif
