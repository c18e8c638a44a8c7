#include "epuck_lab.h"

#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/logging/argos_log.h>

CEPuckLab::CEPuckLab()
    : m_pcWheels(NULL),
      m_pcProximity(NULL),
      m_pcLight(NULL),
      m_pcGround(NULL),
      m_pcRABAct(NULL),
      m_pcRABSens(NULL),
      m_pcRGB(NULL),
      m_pcBase(NULL),
      m_pcCamera(NULL),
      m_fLeft(0.0f),
      m_fRight(0.0f),
      m_unSays(0),
      m_unStep(0) {}

void CEPuckLab::Init(TConfigurationNode& t_node) {
   m_pcWheels = GetActuator<CCI_EPuckWheelsActuator>("epuck_wheels");
   m_pcProximity = GetSensor<CCI_EPuckProximitySensor>("epuck_proximity");
   m_pcGround = GetSensor<CCI_EPuckGroundSensor>("epuck_ground");
   try {
      m_pcRABAct = GetActuator<CCI_EPuckRangeAndBearingActuator>("epuck_range_and_bearing");
      m_pcRABSens = GetSensor<CCI_EPuckRangeAndBearingSensor>("epuck_range_and_bearing");
      m_pcRGB = GetActuator<CCI_EPuckRGBLEDsActuator>("epuck_rgb_leds");
      if (HasActuator("epuck_base_leds")) {
         m_pcBase = GetActuator<CCI_EPuckBaseLEDsActuator>("epuck_base_leds");
      }
      m_pcCamera = GetSensor<CCI_EPuckOmnidirectionalCameraSensor>("epuck_omnidirectional_camera");
      m_pcLight = GetSensor<CCI_EPuckLightSensor>("epuck_light");
   } catch (CARGoSException&) {
      LOGERR << "[" << GetId() << "] has not every device" << std::endl;
   }
   GetNodeAttributeOrDefault(t_node, "left", m_fLeft, m_fLeft);
   GetNodeAttributeOrDefault(t_node, "right", m_fRight, m_fRight);
   GetNodeAttributeOrDefault(t_node, "says", m_unSays, m_unSays);
}

void CEPuckLab::Reset() {
   m_unStep = 0;
}

template <typename T>
void CEPuckLab::Tell(const std::string& str_key, const T& t_value) const {
   LOG << "RESULT " << GetId() << "." << str_key << " " << t_value << std::endl;
}

void CEPuckLab::Report() {
   std::string strAngles;
   size_t unBest = 0;
   for (size_t i = 0; i < m_pcProximity->GetReadings().size(); ++i) {
      CRadians cAngle(m_pcProximity->GetReading(i).Angle);
      strAngles += " " + ToString(Round(ToDegrees(cAngle.UnsignedNormalize()).GetValue()));
      if (m_pcProximity->GetReading(i).Value > m_pcProximity->GetReading(unBest).Value) {
         unBest = i;
      }
   }
   Tell("angles", strAngles.substr(1));
   Tell("best", unBest);
   const CCI_EPuckGroundSensor::SReadings& sGround = m_pcGround->GetReadings();
   Tell("ground", ToString(sGround.Left) + " " + ToString(sGround.Center) + " " + ToString(sGround.Right));
   if (m_pcRABSens != NULL) {
      const CCI_EPuckRangeAndBearingSensor::TPackets& tPackets = m_pcRABSens->GetPackets();
      Tell("packets", tPackets.size());
      if (!tPackets.empty()) {
         const CCI_EPuckRangeAndBearingSensor::SReceivedPacket& sLast = *tPackets.back();
         CRadians cBearing(sLast.Bearing);
         Tell("packet.says",
              ToString(static_cast<UInt32>(sLast.Data[0])) + " " + ToString(static_cast<UInt32>(sLast.Data[3])));
         Tell("packet.cm", sLast.Range);
         Tell("packet.deg", ToDegrees(cBearing.SignedNormalize()).GetValue());
      }
   }
   if (m_pcCamera != NULL) {
      const CCI_EPuckOmnidirectionalCameraSensor::SReadings& sReadings = m_pcCamera->GetReadings();
      UInt32 unCyan = 0;
      for (size_t i = 0; i < sReadings.BlobList.size(); ++i) {
         if (sReadings.BlobList[i]->Color == CColor::CYAN) {
            ++unCyan;
         }
      }
      Tell("cyan", unCyan > 0);
   }
   if (m_pcLight != NULL) {
      Tell("light", m_pcLight->GetReadings().size());
   }
}

void CEPuckLab::ControlStep() {
   ++m_unStep;
   if (m_pcRABAct != NULL) {
      const CCI_EPuckRangeAndBearingActuator::TData tData = {m_unSays, 2, 3, 4};
      m_pcRABAct->SetData(tData);
   }
   if (m_pcRGB != NULL) {
      m_pcRGB->SetColors(CColor::CYAN);
      if (m_pcBase != NULL) {
         m_pcBase->SwitchLEDs(true);
      }
      m_pcCamera->Enable();
   }
   m_pcWheels->SetLinearVelocity(m_fLeft, m_fRight);
   if (m_unStep == 10) {
      Report();
      if (m_pcRABSens != NULL) {
         m_pcRABSens->ClearPackets();
      }
   }
}

REGISTER_CONTROLLER(CEPuckLab, "epuck_lab_controller")
