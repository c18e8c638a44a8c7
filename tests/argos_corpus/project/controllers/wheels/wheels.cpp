#include "wheels.h"

#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/logging/argos_log.h>

CWheels::CWheels()
    : m_pcWheels(NULL),
      m_pcEncoder(NULL),
      m_fLeft(10.0f),
      m_fRight(10.0f),
      m_fLeftDistance(0.0f),
      m_fRightDistance(0.0f),
      m_unSteps(0),
      m_unUntil(0) {}

void CWheels::Init(TConfigurationNode& t_node) {
   m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
   if (HasSensor("differential_steering")) {
      m_pcEncoder = GetSensor<CCI_DifferentialSteeringSensor>("differential_steering");
   }
   try {
      TConfigurationNode& tSpeeds = GetNode(t_node, "speeds");
      GetNodeAttribute(tSpeeds, "left", m_fLeft);
      GetNodeAttribute(tSpeeds, "right", m_fRight);
      GetNodeAttributeOrDefault(t_node, "until", m_unUntil, m_unUntil);
   } catch (CARGoSException& ex) {
      THROW_ARGOSEXCEPTION_NESTED("Error parsing the parameters of the wheels of " << GetId(), ex);
   }
   Reset();
}

void CWheels::ControlStep() {
   if (m_pcEncoder != NULL) {
      const CCI_DifferentialSteeringSensor::SReading& sReading = m_pcEncoder->GetReading();
      m_fLeftDistance += sReading.CoveredDistanceLeftWheel;
      m_fRightDistance += sReading.CoveredDistanceRightWheel;
      if (m_unSteps == 20) {
         RLOG << "RESULT " << GetId() << ".speed " << sReading.VelocityLeftWheel << " " << sReading.VelocityRightWheel
              << std::endl;
         RLOG << "RESULT " << GetId() << ".covered " << sReading.CoveredDistanceLeftWheel << " "
              << sReading.CoveredDistanceRightWheel << std::endl;
         RLOG << "RESULT " << GetId() << ".axis " << sReading.WheelAxisLength << std::endl;
      }
   }
   ++m_unSteps;
   if (m_unUntil > 0 && m_unSteps > m_unUntil) {
      m_pcWheels->SetLinearVelocity(0.0f, 0.0f);
   } else {
      m_pcWheels->SetLinearVelocity(m_fLeft, m_fRight);
   }
}

void CWheels::Reset() {
   m_fLeftDistance = 0.0f;
   m_fRightDistance = 0.0f;
   m_unSteps = 0;
}

void CWheels::Destroy() {
   RLOG << "RESULT " << GetId() << ".destroyed after " << m_unSteps << std::endl;
}

REGISTER_CONTROLLER(CWheels, "wheels_controller")
