#include "swarm.h"

#include <argos3/core/utility/configuration/argos_configuration.h>
#include <cmath>

CSwarm::CSwarm() : m_pcWheels(NULL), m_pcRABAct(NULL), m_pcRABSens(NULL) {}

void CSwarm::SInteraction::Init(TConfigurationNode& t_node) {
   GetNodeAttribute(t_node, "target_distance", TargetDistance);
   GetNodeAttribute(t_node, "gain", Gain);
   GetNodeAttribute(t_node, "exponent", Exponent);
}

/* Positive is a pull */
Real CSwarm::SInteraction::Force(Real f_distance) const {
   const Real fRatio = std::pow(TargetDistance / f_distance, Exponent);
   return Gain / f_distance * (fRatio - fRatio * fRatio);
}

void CSwarm::SWheels::Init(TConfigurationNode& t_node) {
   CDegrees cAngle;
   GetNodeAttribute(t_node, "hard_turn", cAngle);
   HardTurn = ToRadians(cAngle);
   GetNodeAttribute(t_node, "max_speed", MaxSpeed);
}

void CSwarm::Init(TConfigurationNode& t_node) {
   m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
   m_pcRABAct = GetActuator<CCI_RangeAndBearingActuator>("range_and_bearing");
   m_pcRABSens = GetSensor<CCI_RangeAndBearingSensor>("range_and_bearing");
   try {
      m_sInteraction.Init(GetNode(t_node, "interaction"));
      m_sWheels.Init(GetNode(t_node, "wheels"));
   } catch (CARGoSException& ex) {
      THROW_ARGOSEXCEPTION_NESTED("Error initializing the swarm controller of \"" << GetId() << "\"", ex);
   }
}

void CSwarm::Reset() {
   m_pcRABAct->ClearData();
}

CVector2 CSwarm::Neighbors() const {
   CVector2 cSum;
   const CCI_RangeAndBearingSensor::TReadings& tReadings = m_pcRABSens->GetReadings();
   for (size_t i = 0; i < tReadings.size(); ++i) {
      const Real fForce = m_sInteraction.Force(Max<Real>(tReadings[i].Range, 1.0));
      cSum += CVector2(fForce, tReadings[i].HorizontalBearing);
   }
   if (!tReadings.empty()) {
      cSum /= tReadings.size();
   }
   return cSum;
}

void CSwarm::Drive(const CVector2& c_heading) {
   CRadians cHeading = c_heading.Angle();
   cHeading.SignedNormalize();
   const Real fSpeed = Min<Real>(c_heading.Length(), m_sWheels.MaxSpeed);
   if (Abs(cHeading) > m_sWheels.HardTurn) {
      const Real fTurn = cHeading > CRadians::ZERO ? fSpeed : -fSpeed;
      m_pcWheels->SetLinearVelocity(-fTurn, fTurn);
      return;
   }
   const Real fSlower = fSpeed * (1.0 - 2.0 * cHeading.GetAbsoluteValue() / CRadians::PI.GetValue());
   if (cHeading > CRadians::ZERO) {
      m_pcWheels->SetLinearVelocity(fSlower, fSpeed);
   } else {
      m_pcWheels->SetLinearVelocity(fSpeed, fSlower);
   }
}

void CSwarm::ControlStep() {
   m_pcRABAct->SetData(0, 1);
   Drive(Neighbors());
}

REGISTER_CONTROLLER(CSwarm, "swarm_controller")
