/*
 * Reports the readings of whatever sensors the experiment gives to a foot-bot, at one step, and drives its other actuators.
 */
#ifndef CORPUS_DEVICES_H
#define CORPUS_DEVICES_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_base_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_distance_scanner_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_gripper_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_light_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_motor_ground_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_turret_encoder_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_battery_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_colored_blob_perspective_camera_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

using namespace argos;

class CDevices : public CCI_Controller {
public:
   CDevices();
   virtual void Init(TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();

private:
   template <typename T>
   void Tell(const std::string& str_key, const T& t_value) const;
   template <typename READINGS>
   void TellRing(const std::string& str_key, const READINGS& t_readings) const;
   template <typename READINGS>
   void TellGround(const std::string& str_key, const READINGS& t_readings) const;
   void TellMessages();
   void TellBlobs();
   void TellScans();
   void TellRest();

   CCI_FootBotProximitySensor* m_pcProximity;
   CCI_FootBotLightSensor* m_pcLight;
   CCI_FootBotBaseGroundSensor* m_pcBaseGround;
   CCI_FootBotMotorGroundSensor* m_pcMotorGround;
   CCI_RangeAndBearingSensor* m_pcRABSens;
   CCI_RangeAndBearingActuator* m_pcRABAct;
   CCI_LEDsActuator* m_pcLEDs;
   CCI_ColoredBlobOmnidirectionalCameraSensor* m_pcOmni;
   CCI_ColoredBlobPerspectiveCameraSensor* m_pcPerspective;
   CCI_FootBotDistanceScannerActuator* m_pcScanAct;
   CCI_FootBotDistanceScannerSensor* m_pcScan;
   CCI_FootBotTurretActuator* m_pcTurret;
   CCI_FootBotTurretEncoderSensor* m_pcTurretEncoder;
   CCI_FootBotGripperActuator* m_pcGripper;
   CCI_PositioningSensor* m_pcPosition;
   CCI_BatterySensor* m_pcBattery;
   UInt32 m_unStep, m_unReport;
   UInt8 m_unSays;
   CColor m_cColor;
};

#endif
