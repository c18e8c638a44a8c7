// The e-puck's wheels.
#ifndef TANDEM_ARGOS3_CI_EPUCK_WHEELS_ACTUATOR_H
#define TANDEM_ARGOS3_CI_EPUCK_WHEELS_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>

namespace argos {

class CCI_EPuckWheelsActuator : public CCI_Actuator {
 public:
  static const Real MAX_VELOCITY_CM_SEC;
  static const Real MIN_VELOCITY_CM_SEC;
  /// In cm/s. A robot drives no faster than it can.
  virtual void SetLinearVelocity(Real left, Real right) = 0;
};

}  // namespace argos

#endif
