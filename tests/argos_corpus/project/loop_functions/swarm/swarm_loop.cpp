#include "swarm_loop.h"

#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

void CSwarmLoop::Init(TConfigurationNode& t_tree) {
   GetNodeAttributeOrDefault(t_tree, "link", m_fLink, m_fLink);
}

std::vector<CVector2> CSwarmLoop::Positions() {
   std::vector<CVector2> vecPositions;
   CSpace::TMapPerType& tFootBots = GetSpace().GetEntitiesByType("foot-bot");
   for (CSpace::TMapPerType::iterator it = tFootBots.begin(); it != tFootBots.end(); ++it) {
      const CVector3& cPosition = any_cast<CFootBotEntity*>(it->second)->GetEmbodiedEntity().GetOriginAnchor().Position;
      vecPositions.push_back(CVector2(cPosition.GetX(), cPosition.GetY()));
      LOG << "RESULT " << it->first << ".at " << cPosition.GetX() << " " << cPosition.GetY() << std::endl;
   }
   return vecPositions;
}

/* Robots nearer than a link belong together */
UInt32 CSwarmLoop::Clusters(const std::vector<CVector2>& vec_positions) const {
   std::vector<bool> vecSeen(vec_positions.size(), false);
   UInt32 unClusters = 0;
   for (size_t i = 0; i < vec_positions.size(); ++i) {
      if (vecSeen[i]) continue;
      ++unClusters;
      std::vector<size_t> vecOpen(1, i);
      vecSeen[i] = true;
      while (!vecOpen.empty()) {
         const size_t unAt = vecOpen.back();
         vecOpen.pop_back();
         for (size_t j = 0; j < vec_positions.size(); ++j) {
            if (!vecSeen[j] && Distance(vec_positions[unAt], vec_positions[j]) < m_fLink) {
               vecSeen[j] = true;
               vecOpen.push_back(j);
            }
         }
      }
   }
   return unClusters;
}

void CSwarmLoop::PostExperiment() {
   const std::vector<CVector2> vecPositions = Positions();
   CVector2 cCentroid;
   for (size_t i = 0; i < vecPositions.size(); ++i) {
      cCentroid += vecPositions[i];
   }
   cCentroid /= vecPositions.size();
   Real fRadius = 0.0;
   for (size_t i = 0; i < vecPositions.size(); ++i) {
      fRadius += Distance(vecPositions[i], cCentroid);
   }
   LOG << "RESULT swarm.robots " << vecPositions.size() << std::endl;
   LOG << "RESULT swarm.clusters " << Clusters(vecPositions) << std::endl;
   LOG << "RESULT swarm.radius_m " << fRadius / vecPositions.size() << std::endl;
}

REGISTER_LOOP_FUNCTIONS(CSwarmLoop, "swarm_loop")
