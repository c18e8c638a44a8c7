// A controller that does what its parameter says with every device that it has, and tells readings.
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_ground_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_light_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_omnidirectional_camera_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_proximity_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_range_and_bearing_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_rgb_leds_actuator.h>
#include <argos3/plugins/robots/eye-bot/control_interface/ci_eyebot_light_sensor.h>
#include <argos3/plugins/robots/eye-bot/control_interface/ci_eyebot_proximity_sensor.h>
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
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_ground_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_light_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_quadrotor_speed_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

using namespace argos;

class CReadings : public CCI_Controller {
 public:
  void Init(TConfigurationNode& t_node) override {
    GetNodeAttributeOrDefault(t_node, "left", m_fLeft, 0.0);
    GetNodeAttributeOrDefault(t_node, "right", m_fRight, 0.0);
    GetNodeAttributeOrDefault(t_node, "from", m_unFrom, 0U);
    Act("differential_steering", m_pcWheels);
    Act("range_and_bearing", m_pcSend);
    Act("epuck_range_and_bearing", m_pcEPuckSend);
    Act("leds", m_pcLEDs);
    Act("epuck_rgb_leds", m_pcRGB);
    Act("footbot_turret", m_pcTurret);
    Act("footbot_gripper", m_pcGripper);
    Act("footbot_distance_scanner", m_pcScanner);
    Act("quadrotor_position", m_pcFlyTo);
    Act("quadrotor_speed", m_pcFlyWith);
    if (m_pcLEDs != nullptr) m_pcLEDs->SetAllColors(CColor::RED);
    if (m_pcRGB != nullptr) m_pcRGB->SetColor(0, CColor::GREEN);
    if (m_pcGripper != nullptr) m_pcGripper->LockNegative();
    if (m_pcScanner != nullptr) {
      m_pcScanner->Enable();
      m_pcScanner->SetRPM(30.0);
    }
    if (m_pcTurret != nullptr) m_pcTurret->SetActiveWithRotation(CRadians::PI_OVER_TWO);
    if (m_pcFlyTo != nullptr) m_pcFlyTo->SetAbsolutePosition(CVector3(0.0, 0.0, 1.5));
    if (m_pcEPuckSend != nullptr) {
      const UInt8 punData[4] = {7, 8, 9, 10};
      m_pcEPuckSend->SetData(punData);
    }
    if (HasSensor("colored_blob_omnidirectional_camera"))
      GetSensor<CCI_ColoredBlobOmnidirectionalCameraSensor>("colored_blob_omnidirectional_camera")->Enable();
    if (HasSensor("colored_blob_perspective_camera"))
      GetSensor<CCI_ColoredBlobPerspectiveCameraSensor>("colored_blob_perspective_camera")->Enable();
  }
  void ControlStep() override {
    if (m_pcWheels != nullptr) m_pcWheels->SetLinearVelocity(m_fLeft, m_fRight);
    if (m_pcSend != nullptr) {
      m_pcSend->SetData(0, 200);
      m_pcSend->SetData(m_pcSend->GetSize() - 1, 5);
    }
    if (m_pcFlyWith != nullptr) m_pcFlyWith->SetLinearVelocity(CVector3(0.1, 0.0, 0.0));
    if (m_unSteps++ < m_unFrom) return;  // logs take some lines a second
    Ring<CCI_FootBotProximitySensor>("footbot_proximity");
    Ring<CCI_EPuckProximitySensor>("epuck_proximity");
    Ring<CCI_EyeBotProximitySensor>("eyebot_proximity");
    Ring<CCI_FootBotLightSensor>("footbot_light");
    Ring<CCI_EPuckLightSensor>("epuck_light");
    Ring<CCI_EyeBotLightSensor>("eyebot_light");
    Plain<CCI_ProximitySensor>("proximity");
    Plain<CCI_LightSensor>("light");
    Plain<CCI_GroundSensor>("ground");
    Grounds<CCI_FootBotBaseGroundSensor>("footbot_base_ground");
    Grounds<CCI_FootBotMotorGroundSensor>("footbot_motor_ground");
    if (HasSensor("epuck_ground")) {
      const CCI_EPuckGroundSensor::SReadings& s = GetSensor<CCI_EPuckGroundSensor>("epuck_ground")->GetReadings();
      LOG << "epuck_ground " << s.Left << " " << s.Center << " " << s.Right << std::endl;
    }
    if (HasSensor("differential_steering")) {
      const CCI_DifferentialSteeringSensor::SReading& s =
          GetSensor<CCI_DifferentialSteeringSensor>("differential_steering")->GetReading();
      LOG << "wheels " << s.VelocityLeftWheel << " " << s.CoveredDistanceRightWheel << " " << s.WheelAxisLength
          << std::endl;
    }
    if (HasSensor("positioning")) {
      const CCI_PositioningSensor::SReading& s = GetSensor<CCI_PositioningSensor>("positioning")->GetReading();
      LOG << "place " << s.Position << " " << s.Orientation << std::endl;
    }
    if (HasSensor("battery"))
      LOG << "battery " << GetSensor<CCI_BatterySensor>("battery")->GetReading().AvailableCharge << std::endl;
    if (HasSensor("footbot_turret_encoder"))
      LOG << "turret " << GetSensor<CCI_FootBotTurretEncoderSensor>("footbot_turret_encoder")->GetRotation().GetValue()
          << std::endl;
    if (HasSensor("footbot_distance_scanner")) {
      CCI_FootBotDistanceScannerSensor* pc = GetSensor<CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
      LOG << "scanner " << pc->GetShortReadingsMap().size() << " " << pc->GetLongReadingsMap().size() << " "
          << pc->GetReadingsMap().size() << std::endl;
    }
    Messages();
    Blobs<CCI_ColoredBlobOmnidirectionalCameraSensor>("colored_blob_omnidirectional_camera");
    Blobs<CCI_EPuckOmnidirectionalCameraSensor>("epuck_omnidirectional_camera");
    if (HasSensor("colored_blob_perspective_camera")) {
      const auto& s =
          GetSensor<CCI_ColoredBlobPerspectiveCameraSensor>("colored_blob_perspective_camera")->GetReadings();
      LOG << "image " << s.BlobList.size() << std::endl;
    }
  }

 private:
  template <class Actuator>
  void Act(const std::string& strName, Actuator*& pcActuator) {
    if (HasActuator(strName)) pcActuator = GetActuator<Actuator>(strName);
  }
  template <class Sensor>
  void Ring(const std::string& strName) {
    if (!HasSensor(strName)) return;
    LOG << strName;
    for (const auto& s : GetSensor<Sensor>(strName)->GetReadings())
      LOG << " " << ToDegrees(s.Angle).GetValue() << "=" << s.Value;
    LOG << std::endl;
  }
  template <class Sensor>
  void Plain(const std::string& strName) {
    if (!HasSensor(strName)) return;
    LOG << strName;
    for (const Real f : GetSensor<Sensor>(strName)->GetReadings()) LOG << " " << f;
    LOG << std::endl;
  }
  template <class Sensor>
  void Grounds(const std::string& strName) {
    if (!HasSensor(strName)) return;
    LOG << strName;
    for (const auto& s : GetSensor<Sensor>(strName)->GetReadings()) LOG << " " << s.Offset << "=" << s.Value;
    LOG << std::endl;
  }
  template <class Sensor>
  void Blobs(const std::string& strName) {
    if (!HasSensor(strName)) return;
    const auto& sReadings = GetSensor<Sensor>(strName)->GetReadings();
    LOG << "blobs " << sReadings.BlobList.size();
    for (const auto* ps : sReadings.BlobList) LOG << " " << ps->Color << "@" << ps->Distance;
    LOG << std::endl;
  }
  void Messages() {
    if (HasSensor("range_and_bearing")) {
      for (const auto& s : GetSensor<CCI_RangeAndBearingSensor>("range_and_bearing")->GetReadings())
        LOG << "heard " << s.Range << " " << s.HorizontalBearing.GetValue() << " " << s.Data << std::endl;
    }
    if (HasSensor("epuck_range_and_bearing")) {
      CCI_EPuckRangeAndBearingSensor* pc = GetSensor<CCI_EPuckRangeAndBearingSensor>("epuck_range_and_bearing");
      for (const auto* ps : pc->GetPackets()) LOG << "packet " << *ps << std::endl;
      pc->ClearPackets();
    }
  }

  Real m_fLeft = 0.0, m_fRight = 0.0;
  UInt32 m_unFrom = 0, m_unSteps = 0;
  CCI_DifferentialSteeringActuator* m_pcWheels = nullptr;
  CCI_RangeAndBearingActuator* m_pcSend = nullptr;
  CCI_EPuckRangeAndBearingActuator* m_pcEPuckSend = nullptr;
  CCI_LEDsActuator* m_pcLEDs = nullptr;
  CCI_EPuckRGBLEDsActuator* m_pcRGB = nullptr;
  CCI_FootBotTurretActuator* m_pcTurret = nullptr;
  CCI_FootBotGripperActuator* m_pcGripper = nullptr;
  CCI_FootBotDistanceScannerActuator* m_pcScanner = nullptr;
  CCI_QuadRotorPositionActuator* m_pcFlyTo = nullptr;
  CCI_QuadRotorSpeedActuator* m_pcFlyWith = nullptr;
};

REGISTER_CONTROLLER(CReadings, "readings")
