#include "poses_loop.h"

#include <algorithm>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/eye-bot/simulator/eyebot_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <controllers/wheels/wheels.h>

void CPosesLoop::Init(TConfigurationNode& t_tree) {
   TConfigurationNodeIterator itReport("report");
   for (itReport = itReport.begin(&t_tree); itReport != itReport.end(); ++itReport) {
      UInt32 unTick;
      GetNodeAttribute(*itReport, "tick", unTick);
      m_vecTicks.push_back(unTick);
   }
   if (m_vecTicks.empty()) {
      THROW_ARGOSEXCEPTION("There is no <report tick=\"...\"/>");
   }
}

void CPosesLoop::Report(const std::string& str_id, const CEmbodiedEntity& c_body) {
   const SAnchor& sAnchor = c_body.GetOriginAnchor();
   CRadians cZ, cY, cX;
   sAnchor.Orientation.ToEulerAngles(cZ, cY, cX);
   const CVector2 cPosition(sAnchor.Position.GetX(), sAnchor.Position.GetY());
   if (GetSpace().GetSimulationClock() == m_vecTicks.front()) {
      m_mapFirst[str_id] = cPosition;
      m_mapFirstYaw[str_id] = cZ;
      return;
   }
   const std::string strTick = ToString(GetSpace().GetSimulationClock());
   LOG << "RESULT " << str_id << ".moved_cm@" << strTick << " " << Distance(cPosition, m_mapFirst[str_id]) * 100.0
       << std::endl;
   LOG << "RESULT " << str_id << ".turned_deg@" << strTick << " "
       << ToDegrees(NormalizedDifference(cZ, m_mapFirstYaw[str_id])).GetValue() << std::endl;
   LOG << "RESULT " << str_id << ".height_m@" << strTick << " " << sAnchor.Position.GetZ() << std::endl;
}

void CPosesLoop::PostStep() {
   if (std::find(m_vecTicks.begin(), m_vecTicks.end(), GetSpace().GetSimulationClock()) == m_vecTicks.end()) {
      return;
   }
   try {
      CSpace::TMapPerType& tFootBots = GetSpace().GetEntitiesByType("foot-bot");
      for (CSpace::TMapPerType::iterator it = tFootBots.begin(); it != tFootBots.end(); ++it) {
         CFootBotEntity* pcFootBot = any_cast<CFootBotEntity*>(it->second);
         Report(pcFootBot->GetId(), pcFootBot->GetEmbodiedEntity());
         CWheels* pcController = dynamic_cast<CWheels*>(&pcFootBot->GetControllableEntity().GetController());
         if (pcController != NULL && GetSpace().GetSimulationClock() == m_vecTicks.back()) {
            LOG << "RESULT " << pcFootBot->GetId() << ".odometer_cm " << pcController->GetLeftDistance() << " "
                << pcController->GetRightDistance() << std::endl;
         }
      }
   } catch (CARGoSException&) {
      /* There is no foot-bot */
   }
   try {
      CSpace::TMapPerType& tEPucks = GetSpace().GetEntitiesByType("e-puck");
      for (CSpace::TMapPerType::iterator it = tEPucks.begin(); it != tEPucks.end(); ++it) {
         CEPuckEntity* pcEPuck = any_cast<CEPuckEntity*>(it->second);
         Report(pcEPuck->GetId(), pcEPuck->GetEmbodiedEntity());
      }
   } catch (CARGoSException&) {
      /* There is no e-puck */
   }
   try {
      CSpace::TMapPerType& tEyeBots = GetSpace().GetEntitiesByType("eye-bot");
      for (CSpace::TMapPerType::iterator it = tEyeBots.begin(); it != tEyeBots.end(); ++it) {
         CEyeBotEntity* pcEyeBot = any_cast<CEyeBotEntity*>(it->second);
         Report(pcEyeBot->GetId(), pcEyeBot->GetEmbodiedEntity());
      }
   } catch (CARGoSException&) {
      /* There is no eye-bot */
   }
}

REGISTER_LOOP_FUNCTIONS(CPosesLoop, "poses_loop")
