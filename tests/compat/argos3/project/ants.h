#ifndef ANTS_H
#define ANTS_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>

using namespace argos;

// The same class in both libraries.
class CAnt : public CCI_Controller {
 public:
  CAnt();
  virtual ~CAnt() {}
  virtual void Init(TConfigurationNode& t_node);
  virtual void ControlStep();
  virtual std::string GetColony() const;

 private:
  CCI_DifferentialSteeringActuator* m_pcWheels;
  Real m_fVelocity;
};

#endif
