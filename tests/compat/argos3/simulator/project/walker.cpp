#include "walker.h"

#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

void CWalker::Init(TConfigurationNode& t_tree) {
  m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
  m_pcPlace = GetSensor<CCI_PositioningSensor>("positioning");
  if (HasSensor("footbot_base_ground")) m_pcGround = GetSensor<CCI_FootBotBaseGroundSensor>("footbot_base_ground");
  if (HasActuator("range_and_bearing")) m_pcSend = GetActuator<CCI_RangeAndBearingActuator>("range_and_bearing");
  if (HasSensor("range_and_bearing")) m_pcHear = GetSensor<CCI_RangeAndBearingSensor>("range_and_bearing");
  GetNodeAttributeOrDefault(t_tree, "speed", m_fSpeed, m_fSpeed);
  GetNodeAttributeOrDefault(t_tree, "watches", m_bWatches, m_bWatches);
}

void CWalker::ControlStep() {
  ++m_unSteps;
  m_cSeen = m_pcPlace->GetReading().Position;
  if (m_pcGround != nullptr) m_fFloor = m_pcGround->GetReadings()[0].Value;
  m_unClock = CSimulator::GetInstance().GetSpace().GetSimulationClock();
  if (m_bWatches) Watch();
  if (m_pcSend != nullptr) m_pcSend->SetData(0, 7);
  if (m_pcHear != nullptr) m_tHeard = m_pcHear->GetReadings();
  m_pcWheels->SetLinearVelocity(m_fSpeed, m_fSpeed);
}

/// Goes the faster the farther the others have come.
void CWalker::Watch() {
  CSpace& cSpace = CSimulator::GetInstance().GetSpace();
  CSpace::TMapPerType& tRobots = cSpace.GetEntitiesByType("foot-bot");
  Real fWay = 0.0;
  for (CSpace::TMapPerType::iterator it = tRobots.begin(); it != tRobots.end(); ++it) {
    const CEmbodiedEntity& cBody = any_cast<CFootBotEntity*>(it->second)->GetEmbodiedEntity();
    const CVector3& cAt = cBody.GetOriginAnchor().Position;
    fWay += cAt.GetX() - cSpace.GetArenaLimits().GetMin().GetX() + cBody.GetBoundingBox().MaxCorner.GetY();
    if (it->first == GetId() && Distance(cAt, m_cSeen) > 1e-9) LOGERR << "WRONG: it is elsewhere" << std::endl;
  }
  m_fSpeed = 2.0 + fWay / static_cast<Real>(tRobots.size());
}

REGISTER_CONTROLLER(CWalker, "walker")
