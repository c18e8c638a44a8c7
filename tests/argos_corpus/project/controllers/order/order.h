/*
 * Reports when ARGoS calls it.
 */
#ifndef CORPUS_ORDER_CONTROLLER_H
#define CORPUS_ORDER_CONTROLLER_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>

class COrder : public argos::CCI_Controller {
public:
   COrder() : m_pcWheels(NULL), m_pcPosition(NULL) {}
   virtual ~COrder() {}
   virtual void Init(argos::TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();

   /* Calls in the order of time, shared with the loop functions */
   static std::string Calls;
   /* The x that was sensed last, in m */
   argos::Real GetSensedX() const {
      return m_cSensed.GetX();
   }

private:
   argos::CCI_DifferentialSteeringActuator* m_pcWheels;
   argos::CCI_PositioningSensor* m_pcPosition;
   argos::CVector3 m_cSensed;
};

#endif
