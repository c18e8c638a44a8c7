// A place and a heading to fly to.
#ifndef TANDEM_ARGOS3_CI_QUADROTOR_POSITION_ACTUATOR_H
#define TANDEM_ARGOS3_CI_QUADROTOR_POSITION_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

/// What is relative needs the sensor `positioning` in the configuration. @throws CARGoSException otherwise
class CCI_QuadRotorPositionActuator : public CCI_Actuator {
 public:
  virtual void SetAbsolutePosition(const CVector3& position) = 0;
  virtual void SetRelativePosition(const CVector3& position) = 0;
  virtual void SetAbsoluteYaw(const CRadians& yaw) = 0;
  virtual void SetRelativeYaw(const CRadians& yaw) = 0;
};

}  // namespace argos

#endif
