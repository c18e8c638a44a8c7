#include "order_loop.h"

#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <controllers/order/order.h>

void COrderLoop::Init(TConfigurationNode& t_tree) {
   GetNodeAttributeOrDefault(t_tree, "end", m_unEnd, m_unEnd);
   COrder::Calls += " loop.Init";
   LOG << "RESULT clock.Init " << GetSpace().GetSimulationClock() << std::endl;
}

void COrderLoop::Reset() {
   COrder::Calls += " loop.Reset";
   LOG << "RESULT clock.Reset " << GetSpace().GetSimulationClock() << std::endl;
}

Real COrderLoop::TrueX() {
   CFootBotEntity& cRobot = *any_cast<CFootBotEntity*>(GetSpace().GetEntitiesByType("foot-bot")["fb0"]);
   return cRobot.GetEmbodiedEntity().GetOriginAnchor().Position.GetX();
}

void COrderLoop::PreStep() {
   COrder::Calls += " PreStep";
   if (GetSpace().GetSimulationClock() == 3) {
      LOG << "RESULT prestep.x_mm " << ToString(Round(TrueX() * 1000.0)) << std::endl;
   }
}

void COrderLoop::PostStep() {
   COrder::Calls += " PostStep";
   const UInt32 unClock = GetSpace().GetSimulationClock();
   CFootBotEntity& cRobot = *any_cast<CFootBotEntity*>(GetSpace().GetEntitiesByType("foot-bot")["fb0"]);
   COrder& cController = dynamic_cast<COrder&>(cRobot.GetControllableEntity().GetController());
   if (unClock == 1) {
      LOG << "RESULT clock.first " << unClock << std::endl;
      LOG << "RESULT order " << COrder::Calls << std::endl;
      LOG << "RESULT rest.x_mm " << Round(TrueX() * 1000.0) << std::endl;
   }
   if (unClock == 3) {
      LOG << "RESULT poststep.x_mm " << Round(TrueX() * 1000.0) << std::endl;
      LOG << "RESULT sensed.x_mm " << Round(cController.GetSensedX() * 1000.0) << std::endl;
   }
   COrder::Calls = "";
}

bool COrderLoop::IsExperimentFinished() {
   return GetSpace().GetSimulationClock() >= m_unEnd;
}

void COrderLoop::PostExperiment() {
   LOG << "RESULT end.clock " << GetSpace().GetSimulationClock() << std::endl;
   LOG << "RESULT end.max_clock " << GetSimulator().GetMaxSimulationClock() << std::endl;
}

void COrderLoop::Destroy() {
   LOG << "RESULT destroyed yes" << std::endl;
}

REGISTER_LOOP_FUNCTIONS(COrderLoop, "order_loop")
