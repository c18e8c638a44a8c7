#include "settings_loop.h"

#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/logging/argos_log.h>

void CSettingsLoop::Init(TConfigurationNode& t_tree) {
   TConfigurationNode& tForaging = GetNode(t_tree, "foraging");
   UInt32 unItems;
   CRange<Real> cSide;
   GetNodeAttribute(tForaging, "items", unItems);
   GetNodeAttribute(tForaging, "side", cSide);
   GetNodeAttribute(tForaging, "output", m_strOutput);
   m_cOutput.open(m_strOutput.c_str(), std::ios_base::trunc | std::ios_base::out);
   if (m_cOutput.fail()) {
      THROW_ARGOSEXCEPTION("Error opening file \"" << m_strOutput << "\"");
   }
   m_cOutput << "# clock\titems" << std::endl;
   LOG << "RESULT loop.items " << unItems << std::endl;
   LOG << "RESULT loop.side " << cSide << std::endl;

   TConfigurationNode& tRoot = GetSimulator().GetConfigurationRoot();
   TConfigurationNode& tExperiment = GetNode(GetNode(tRoot, "framework"), "experiment");
   Real fLength;
   GetNodeAttribute(tExperiment, "length", fLength);
   LOG << "RESULT root.length " << fLength << std::endl;
   LOG << "RESULT clock.tick " << CPhysicsEngine::GetSimulationClockTick() << std::endl;
   LOG << "RESULT clock.inverse " << CPhysicsEngine::GetInverseSimulationClockTick() << std::endl;
   LOG << "RESULT max.clock " << CSimulator::GetInstance().GetMaxSimulationClock() << std::endl;
   LOG << "RESULT seed " << CSimulator::GetInstance().GetRandomSeed() << std::endl;
   CLoopFunctions& cLoop = CSimulator::GetInstance().GetLoopFunctions();
   LOG << "RESULT loop.same " << (dynamic_cast<CSettingsLoop*>(&cLoop) == this) << std::endl;
   LOGERR << "RESULT logerr written" << std::endl;
   DEBUG("RESULT debug %d\n", 5);
   LOG.Flush();
   LOGERR.Flush();
}

void CSettingsLoop::PostStep() {
   m_cOutput << GetSpace().GetSimulationClock() << "\t" << 3 << std::endl;
   if (GetSpace().GetSimulationClock() == 4) {
      GetSimulator().Terminate();
   }
}

void CSettingsLoop::PostExperiment() {
   m_cOutput.close();
   std::ifstream cIn(m_strOutput.c_str());
   UInt32 unLines = 0;
   for (std::string strLine; std::getline(cIn, strLine);) {
      ++unLines;
   }
   LOG << "RESULT file.lines " << unLines << std::endl;
   LOG << "RESULT end.clock " << GetSpace().GetSimulationClock() << std::endl;
}

REGISTER_LOOP_FUNCTIONS(CSettingsLoop, "settings_loop")
