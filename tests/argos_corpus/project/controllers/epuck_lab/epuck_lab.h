/*
 * E-puck of the separate plug-in: its own wheels, infrared, ground, range and bearing, colored LEDs, camera.
 */
#ifndef CORPUS_EPUCK_LAB_H
#define CORPUS_EPUCK_LAB_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_base_leds_actuator.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_ground_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_light_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_proximity_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_range_and_bearing_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_rgb_leds_actuator.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h>

using namespace argos;

class CEPuckLab : public CCI_Controller {
public:
   CEPuckLab();
   virtual void Init(TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();

private:
   template <typename T>
   void Tell(const std::string& str_key, const T& t_value) const;
   void Report();

   CCI_EPuckWheelsActuator* m_pcWheels;
   CCI_EPuckProximitySensor* m_pcProximity;
   CCI_EPuckLightSensor* m_pcLight;
   CCI_EPuckGroundSensor* m_pcGround;
   CCI_EPuckRangeAndBearingActuator* m_pcRABAct;
   CCI_EPuckRangeAndBearingSensor* m_pcRABSens;
   CCI_EPuckRGBLEDsActuator* m_pcRGB;
   CCI_EPuckBaseLEDsActuator* m_pcBase;
   CCI_EPuckOmnidirectionalCameraSensor* m_pcCamera;
   Real m_fLeft, m_fRight;
   UInt8 m_unSays;
   UInt32 m_unStep;
};

#endif
