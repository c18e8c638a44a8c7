/*
 * E-puck of ARGoS' own plug-in: turns away from what its infrared ring sees, reports the ring.
 */
#ifndef CORPUS_EPUCK_RING_H
#define CORPUS_EPUCK_RING_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_ground_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>

using namespace argos;

class CEPuckRing : public CCI_Controller {
public:
   CEPuckRing();
   virtual void Init(TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();

private:
   CCI_DifferentialSteeringActuator* m_pcWheels;
   CCI_EPuckProximitySensor* m_pcProximity;
   CCI_LEDsActuator* m_pcLEDs;
   CCI_GroundSensor* m_pcGround;
   Real m_fWheelVelocity;
   UInt32 m_unStep;
   bool m_bReport;
};

#endif
