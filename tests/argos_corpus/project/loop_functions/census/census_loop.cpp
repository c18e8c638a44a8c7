#include "census_loop.h"

#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <vector>

void CCensusLoop::Init(TConfigurationNode& t_tree) {
   GetNodeAttributeOrDefault(t_tree, "trouble", m_strTrouble, m_strTrouble);
   if (m_strTrouble == "init") {
      THROW_ARGOSEXCEPTION("trouble while the loop functions are initialized");
   }
   Tell("foot-bot");
   Tell("e-puck");
   Tell("box");
   Tell("cylinder");
}

/* Number, ids in their order, and the smallest and largest x and y in cm */
void CCensusLoop::Tell(const std::string& str_type) {
   CRange<Real> cX(-0.0001, 0.0001), cY(-0.0001, 0.0001);
   std::string strIds;
   UInt32 unNumber = 0;
   CEntity::TVector& tRoots = GetSpace().GetRootEntityVector();
   for (size_t i = 0; i < tRoots.size(); ++i) {
      if (tRoots[i]->GetTypeDescription() != str_type) {
         continue;
      }
      CComposableEntity& cEntity = dynamic_cast<CComposableEntity&>(*tRoots[i]);
      const CVector3& cPosition = cEntity.GetComponent<CEmbodiedEntity>("body").GetOriginAnchor().Position;
      cX.Set(Min<Real>(cX.GetMin(), cPosition.GetX()), Max<Real>(cX.GetMax(), cPosition.GetX()));
      cY.Set(Min<Real>(cY.GetMin(), cPosition.GetY()), Max<Real>(cY.GetMax(), cPosition.GetY()));
      strIds += " " + cEntity.GetId();
      ++unNumber;
   }
   LOG << "RESULT " << str_type << ".number " << unNumber << std::endl;
   LOG << "RESULT " << str_type << ".ids" << strIds << std::endl;
   LOG << "RESULT " << str_type << ".x_cm " << Round(cX.GetMin() * 100.0) << " " << Round(cX.GetMax() * 100.0)
       << std::endl;
   LOG << "RESULT " << str_type << ".y_cm " << Round(cY.GetMin() * 100.0) << " " << Round(cY.GetMax() * 100.0)
       << std::endl;
}

void CCensusLoop::PostStep() {
   if (GetSpace().GetSimulationClock() != 3) {
      return;
   }
   if (m_strTrouble == "cast") {
      CEntity& cEntity = GetSpace().GetEntity("fb0");
      dynamic_cast<CEPuckEntity&>(cEntity).GetEmbodiedEntity();
   }
   if (m_strTrouble == "missing") {
      GetSpace().GetEntity("nowhere");
   }
   if (m_strTrouble == "remove") {
      /* Their ids first: removing an entity invalidates iterators */
      std::vector<std::string> vecIds;
      CSpace::TMapPerType& tFootBots = GetSpace().GetEntitiesByType("foot-bot");
      for (CSpace::TMapPerType::iterator it = tFootBots.begin(); it != tFootBots.end(); ++it) {
         vecIds.push_back(it->first);
      }
      for (size_t i = 0; i < vecIds.size(); ++i) {
         RemoveEntity(vecIds[i]);
      }
   }
}

void CCensusLoop::PostExperiment() {
   LOG << "RESULT end.clock " << GetSpace().GetSimulationClock() << std::endl;
   LOG << "RESULT end.foot-bots " << GetSpace().GetEntitiesByType("foot-bot").size() << std::endl;
}

REGISTER_LOOP_FUNCTIONS(CCensusLoop, "census_loop")
