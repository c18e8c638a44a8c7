// Writes down what each phase of a tick sees.
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

#include "walker.h"

class COrderLoop : public CLoopFunctions {
 public:
  virtual void Init(TConfigurationNode&) {
    m_pcRobot = any_cast<CFootBotEntity*>(GetSpace().GetEntitiesByType("foot-bot").begin()->second);
    Tell("Init");
  }
  virtual void Reset() { Tell("Reset"); }
  virtual void Destroy() { LOG << "Destroy" << std::endl; }
  virtual void PreStep() { Tell("PreStep"); }
  virtual void PostStep() {
    Tell("PostStep");
    if (GetSpace().GetSimulationClock() == 2) GetSimulator().Terminate();
  }
  virtual bool IsExperimentFinished() {
    Tell("IsExperimentFinished");
    return false;
  }
  virtual void PostExperiment() { Tell("PostExperiment"); }

 private:
  /// The phase, the clock, where the robot is, where it saw itself, its steps, the clock that it saw; in mm.
  void Tell(const char* phase) {
    CWalker& cWalker = dynamic_cast<CWalker&>(m_pcRobot->GetControllableEntity().GetController());
    LOG << phase << " clock=" << GetSpace().GetSimulationClock()
        << " at=" << Round(1000 * m_pcRobot->GetEmbodiedEntity().GetOriginAnchor().Position.GetX())
        << " seen=" << Round(1000 * cWalker.m_cSeen.GetX()) << " steps=" << cWalker.m_unSteps
        << " its_clock=" << cWalker.m_unClock << std::endl;
  }
  CFootBotEntity* m_pcRobot = nullptr;
};

REGISTER_LOOP_FUNCTIONS(COrderLoop, "order")
