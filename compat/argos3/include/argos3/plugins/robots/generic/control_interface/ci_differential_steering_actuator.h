// Two wheels.
#ifndef TANDEM_ARGOS3_CI_DIFFERENTIAL_STEERING_ACTUATOR_H
#define TANDEM_ARGOS3_CI_DIFFERENTIAL_STEERING_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>

namespace argos {

class CCI_DifferentialSteeringActuator : public CCI_Actuator {
 public:
  /// In cm/s. A robot drives no faster than it can.
  virtual void SetLinearVelocity(Real left, Real right) = 0;
};

}  // namespace argos

#endif
