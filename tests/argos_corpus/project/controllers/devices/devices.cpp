#include "devices.h"

#include <algorithm>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <iomanip>
#include <sstream>

CDevices::CDevices()
    : m_pcProximity(NULL),
      m_pcLight(NULL),
      m_pcBaseGround(NULL),
      m_pcMotorGround(NULL),
      m_pcRABSens(NULL),
      m_pcRABAct(NULL),
      m_pcLEDs(NULL),
      m_pcOmni(NULL),
      m_pcPerspective(NULL),
      m_pcScanAct(NULL),
      m_pcScan(NULL),
      m_pcTurret(NULL),
      m_pcTurretEncoder(NULL),
      m_pcGripper(NULL),
      m_pcPosition(NULL),
      m_pcBattery(NULL),
      m_unStep(0),
      m_unReport(4),
      m_unSays(0),
      m_cColor(CColor::BLACK) {}

void CDevices::Init(TConfigurationNode& t_node) {
   if (HasSensor("footbot_proximity")) m_pcProximity = GetSensor<CCI_FootBotProximitySensor>("footbot_proximity");
   if (HasSensor("footbot_light")) m_pcLight = GetSensor<CCI_FootBotLightSensor>("footbot_light");
   if (HasSensor("footbot_base_ground")) m_pcBaseGround = GetSensor<CCI_FootBotBaseGroundSensor>("footbot_base_ground");
   if (HasSensor("footbot_motor_ground"))
      m_pcMotorGround = GetSensor<CCI_FootBotMotorGroundSensor>("footbot_motor_ground");
   if (HasSensor("range_and_bearing")) m_pcRABSens = GetSensor<CCI_RangeAndBearingSensor>("range_and_bearing");
   if (HasActuator("range_and_bearing")) m_pcRABAct = GetActuator<CCI_RangeAndBearingActuator>("range_and_bearing");
   if (HasActuator("leds")) m_pcLEDs = GetActuator<CCI_LEDsActuator>("leds");
   if (HasSensor("colored_blob_omnidirectional_camera")) {
      m_pcOmni = GetSensor<CCI_ColoredBlobOmnidirectionalCameraSensor>("colored_blob_omnidirectional_camera");
      m_pcOmni->Enable();
   }
   if (HasSensor("colored_blob_perspective_camera")) {
      m_pcPerspective = GetSensor<CCI_ColoredBlobPerspectiveCameraSensor>("colored_blob_perspective_camera");
      m_pcPerspective->Enable();
   }
   if (HasActuator("footbot_distance_scanner")) {
      m_pcScanAct = GetActuator<CCI_FootBotDistanceScannerActuator>("footbot_distance_scanner");
      m_pcScan = GetSensor<CCI_FootBotDistanceScannerSensor>("footbot_distance_scanner");
      m_pcScanAct->Enable();
      m_pcScanAct->SetAngle(CRadians::ZERO);
   }
   if (HasActuator("footbot_turret")) {
      m_pcTurret = GetActuator<CCI_FootBotTurretActuator>("footbot_turret");
      m_pcTurretEncoder = GetSensor<CCI_FootBotTurretEncoderSensor>("footbot_turret_encoder");
      m_pcTurret->SetPositionControlMode();
   }
   if (HasActuator("footbot_gripper")) m_pcGripper = GetActuator<CCI_FootBotGripperActuator>("footbot_gripper");
   if (HasSensor("positioning")) m_pcPosition = GetSensor<CCI_PositioningSensor>("positioning");
   if (HasSensor("battery")) m_pcBattery = GetSensor<CCI_BatterySensor>("battery");
   GetNodeAttributeOrDefault(t_node, "report", m_unReport, m_unReport);
   GetNodeAttributeOrDefault(t_node, "says", m_unSays, m_unSays);
   GetNodeAttributeOrDefault(t_node, "color", m_cColor, m_cColor);
   Reset();
}

void CDevices::Reset() {
   m_unStep = 0;
   if (m_pcLEDs != NULL) {
      m_pcLEDs->SetAllColors(m_cColor);
   }
   if (m_pcRABAct != NULL) {
      m_pcRABAct->ClearData();
      m_pcRABAct->SetData(0, m_unSays);
   }
}

template <typename T>
void CDevices::Tell(const std::string& str_key, const T& t_value) const {
   LOG << "RESULT " << GetId() << "." << str_key << " " << t_value << std::endl;
}

/* Number of readings, the strongest, its angle in degrees, and the angle of the first */
template <typename READINGS>
void CDevices::TellRing(const std::string& str_key, const READINGS& t_readings) const {
   size_t unBest = 0;
   CVector2 cSum;
   for (size_t i = 0; i < t_readings.size(); ++i) {
      cSum += CVector2(t_readings[i].Value, t_readings[i].Angle);
      if (t_readings[i].Value > t_readings[unBest].Value) {
         unBest = i;
      }
   }
   cSum /= t_readings.size();
   CRadians cBest(t_readings[unBest].Angle);
   Tell(str_key + ".number", t_readings.size());
   Tell(str_key + ".first_deg", ToDegrees(t_readings[0].Angle).GetValue());
   Tell(str_key + ".second_deg", ToDegrees(t_readings[1].Angle).GetValue());
   Tell(str_key + ".best", unBest);
   Tell(str_key + ".best_deg", ToDegrees(cBest.UnsignedNormalize()).GetValue());
   Tell(str_key + ".best_value", t_readings[unBest].Value);
   Tell(str_key + ".in_range", CRange<Real>(0.0, 1.0).WithinMinBoundIncludedMaxBoundIncluded(t_readings[unBest].Value));
   Tell(str_key + ".sum_deg", ToDegrees(cSum.Angle()).GetValue());
}

template <typename READINGS>
void CDevices::TellGround(const std::string& str_key, const READINGS& t_readings) const {
   std::ostringstream cOut;
   for (size_t i = 0; i < t_readings.size(); ++i) {
      cOut << " " << std::fixed << std::setprecision(2) << t_readings[i].Value;
   }
   Tell(str_key, cOut.str().substr(1));
}

void CDevices::TellMessages() {
   const CCI_RangeAndBearingSensor::TReadings& tReadings = m_pcRABSens->GetReadings();
   Tell("rab.number", tReadings.size());
   for (size_t i = 0; i < tReadings.size(); ++i) {
      const std::string strKey = "rab." + ToString(static_cast<UInt32>(tReadings[i].Data[0]));
      Tell(strKey + ".cm", tReadings[i].Range);
      Tell(strKey + ".deg", ToDegrees(tReadings[i].HorizontalBearing).GetValue());
      Tell(strKey + ".size", tReadings[i].Data.Size());
      Tell(strKey + ".last", static_cast<UInt32>(tReadings[i].Data[9]));
   }
}

void CDevices::TellBlobs() {
   const CCI_ColoredBlobOmnidirectionalCameraSensor::SReadings& sReadings = m_pcOmni->GetReadings();
   UInt32 unRed = 0;
   CVector2 cPlace;
   for (size_t i = 0; i < sReadings.BlobList.size(); ++i) {
      if (sReadings.BlobList[i]->Color == CColor::RED) {
         ++unRed;
         cPlace += CVector2(sReadings.BlobList[i]->Distance, sReadings.BlobList[i]->Angle);
      }
   }
   Tell("blobs.some", unRed > 0);
   if (unRed > 0) {
      cPlace /= unRed;
      Tell("blobs.cm", cPlace.Length());
      Tell("blobs.deg", ToDegrees(cPlace.Angle()).GetValue());
   }
}

void CDevices::TellScans() {
   const CCI_FootBotDistanceScannerSensor::TReadingsMap& tShort = m_pcScan->GetShortReadingsMap();
   const CCI_FootBotDistanceScannerSensor::TReadingsMap& tLong = m_pcScan->GetLongReadingsMap();
   Tell("scan.short", !tShort.empty());
   Tell("scan.long", !tLong.empty());
   Real fNearest = 1000.0;
   CCI_FootBotDistanceScannerSensor::TReadingsMap::const_iterator it;
   for (it = tLong.begin(); it != tLong.end(); ++it) {
      if (it->second > 0.0) {
         fNearest = Min(fNearest, it->second);
      }
   }
   Tell("scan.cm", fNearest);
}

void CDevices::TellRest() {
   if (m_pcTurretEncoder != NULL) {
      Tell("turret.deg", ToDegrees(m_pcTurretEncoder->GetRotation()).GetValue());
   }
   if (m_pcPosition != NULL) {
      CRadians cZ, cY, cX;
      m_pcPosition->GetReading().Orientation.ToEulerAngles(cZ, cY, cX);
      const CVector3& cPosition = m_pcPosition->GetReading().Position;
      Tell("position_cm", ToString(Round(cPosition.GetX() * 100.0)) + " " + ToString(Round(cPosition.GetY() * 100.0)));
      Tell("yaw", ToDegrees(cZ).GetValue());
   }
   if (m_pcBattery != NULL) {
      Tell("battery", m_pcBattery->GetReading().AvailableCharge);
      Tell("battery.time", m_pcBattery->GetReading().TimeLeft);
   }
   if (m_pcLEDs != NULL) {
      Tell("leds", m_pcLEDs->GetNumLEDs());
   }
   if (m_pcPerspective != NULL) {
      Tell("camera.blobs", m_pcPerspective->GetReadings().BlobList.size());
   }
}

void CDevices::ControlStep() {
   ++m_unStep;
   if (m_pcTurret != NULL) {
      m_pcTurret->SetRotation(CRadians::PI_OVER_TWO);
   }
   if (m_pcGripper != NULL) {
      m_pcGripper->LockPositive();
   }
   if (m_pcRABAct != NULL) {
      m_pcRABAct->SetData(9, static_cast<UInt8>(m_unStep));
   }
   if (m_unStep % m_unReport != 0) {
      return;
   }
   if (m_pcProximity != NULL) TellRing("proximity", m_pcProximity->GetReadings());
   if (m_pcLight != NULL) TellRing("light", m_pcLight->GetReadings());
   if (m_pcBaseGround != NULL) TellGround("base@" + ToString(m_unStep), m_pcBaseGround->GetReadings());
   if (m_pcMotorGround != NULL) TellGround("motor@" + ToString(m_unStep), m_pcMotorGround->GetReadings());
   if (m_pcRABSens != NULL) TellMessages();
   if (m_pcOmni != NULL) TellBlobs();
   if (m_pcScan != NULL) TellScans();
   TellRest();
}

REGISTER_CONTROLLER(CDevices, "devices_controller")
