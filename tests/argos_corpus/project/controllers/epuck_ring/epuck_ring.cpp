#include "epuck_ring.h"

#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/vector2.h>

CEPuckRing::CEPuckRing()
    : m_pcWheels(NULL),
      m_pcProximity(NULL),
      m_pcLEDs(NULL),
      m_pcGround(NULL),
      m_fWheelVelocity(2.5f),
      m_unStep(0),
      m_bReport(false) {}

void CEPuckRing::Init(TConfigurationNode& t_node) {
   m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
   m_pcProximity = GetSensor<CCI_EPuckProximitySensor>("epuck_proximity");
   if (HasActuator("leds")) {
      m_pcLEDs = GetActuator<CCI_LEDsActuator>("leds");
   }
   if (HasSensor("ground")) {
      m_pcGround = GetSensor<CCI_GroundSensor>("ground");
   }
   GetNodeAttributeOrDefault(t_node, "velocity", m_fWheelVelocity, m_fWheelVelocity);
   GetNodeAttributeOrDefault(t_node, "report", m_bReport, m_bReport);
}

void CEPuckRing::Reset() {
   m_unStep = 0;
}

void CEPuckRing::ControlStep() {
   const CCI_EPuckProximitySensor::TReadings& tReadings = m_pcProximity->GetReadings();
   ++m_unStep;
   if (m_bReport && m_unStep == 3) {
      size_t unBest = 0;
      std::string strAngles;
      for (size_t i = 0; i < tReadings.size(); ++i) {
         CRadians cAngle(tReadings[i].Angle);
         strAngles += " " + ToString(Round(ToDegrees(cAngle.UnsignedNormalize()).GetValue()));
         if (tReadings[i].Value > tReadings[unBest].Value) {
            unBest = i;
         }
      }
      LOG << "RESULT " << GetId() << ".angles" << strAngles << std::endl;
      LOG << "RESULT " << GetId() << ".best " << unBest << std::endl;
      LOG << "RESULT " << GetId() << ".value " << tReadings[unBest].Value << std::endl;
      if (m_pcGround != NULL) {
         LOG << "RESULT " << GetId() << ".ground " << m_pcGround->GetReadings().size() << " "
             << m_pcGround->GetReadings()[0] << std::endl;
      }
      if (m_pcLEDs != NULL) {
         LOG << "RESULT " << GetId() << ".leds " << m_pcLEDs->GetNumLEDs() << std::endl;
      }
   }
   /* The two sensors in front on either side */
   const Real fLeft = Max(tReadings[0].Value, tReadings[1].Value);
   const Real fRight = Max(tReadings[7].Value, tReadings[6].Value);
   if (fLeft == 0.0f && fRight == 0.0f) {
      m_pcWheels->SetLinearVelocity(m_fWheelVelocity, m_fWheelVelocity);
   } else if (fLeft > fRight) {
      m_pcWheels->SetLinearVelocity(m_fWheelVelocity, -m_fWheelVelocity);
   } else {
      m_pcWheels->SetLinearVelocity(-m_fWheelVelocity, m_fWheelVelocity);
   }
   if (m_pcLEDs != NULL) {
      m_pcLEDs->SetSingleColor(0, fLeft > 0.0f || fRight > 0.0f ? CColor::RED : CColor::BLACK);
   }
}

REGISTER_CONTROLLER(CEPuckRing, "epuck_ring_controller")
