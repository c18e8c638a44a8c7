#include "walker.h"

#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>

void CWalker::Init(TConfigurationNode& t_tree) {
  m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
  m_pcPlace = GetSensor<CCI_PositioningSensor>("positioning");
  if (HasSensor("footbot_base_ground")) m_pcGround = GetSensor<CCI_FootBotBaseGroundSensor>("footbot_base_ground");
  GetNodeAttributeOrDefault(t_tree, "speed", m_fSpeed, m_fSpeed);
}

void CWalker::ControlStep() {
  ++m_unSteps;
  m_cSeen = m_pcPlace->GetReading().Position;
  if (m_pcGround != nullptr) m_fFloor = m_pcGround->GetReadings()[0].Value;
  m_unClock = CSimulator::GetInstance().GetSpace().GetSimulationClock();
  m_pcWheels->SetLinearVelocity(m_fSpeed, m_fSpeed);
}

REGISTER_CONTROLLER(CWalker, "walker")
