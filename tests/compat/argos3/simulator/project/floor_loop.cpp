// A dark stripe that moves with the clock; what robots see of it.
#include <argos3/core/simulator/entity/floor_entity.h>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

#include "walker.h"

class CFloorLoop : public CLoopFunctions {
 public:
  virtual void Init(TConfigurationNode& t_tree) {
    GetNodeAttribute(GetNode(t_tree, "stripe"), "every", m_unEvery);
    m_pcFloor = &GetSpace().GetFloorEntity();
  }
  virtual CColor GetFloorColor(const CVector2& c_at) {
    return m_bDark && c_at.GetX() < 0.0 ? CColor::BLACK : CColor::WHITE;
  }
  virtual void PreStep() {
    const bool bDark = GetSpace().GetSimulationClock() % m_unEvery == 0;
    if (bDark == m_bDark) return;
    m_bDark = bDark;
    m_pcFloor->SetChanged();
  }
  virtual void PostStep() {
    CSpace::TMapPerType& tRobots = GetSpace().GetEntitiesByType("foot-bot");
    for (CSpace::TMapPerType::iterator it = tRobots.begin(); it != tRobots.end(); ++it) {
      CFootBotEntity& cRobot = *any_cast<CFootBotEntity*>(it->second);
      CWalker& cWalker = dynamic_cast<CWalker&>(cRobot.GetControllableEntity().GetController());
      const bool bOnStripe = cRobot.GetEmbodiedEntity().GetOriginAnchor().Position.GetX() < -0.1;
      const bool bSeesDark = cWalker.m_fFloor < 0.5;
      if (bSeesDark != (m_bDark && bOnStripe)) ++m_unWrong;
      if (bSeesDark) ++m_unDark;
    }
  }
  virtual void PostExperiment() {
    LOG << "wrong " << m_unWrong << " dark " << m_unDark << std::endl;
    const CColor cColor = m_pcFloor->GetColorAtPoint(0.5, 0.0);
    LOG << "colour " << cColor.GetRed() << std::endl;
  }

 private:
  CFloorEntity* m_pcFloor = nullptr;
  UInt32 m_unEvery = 1, m_unWrong = 0, m_unDark = 0;
  bool m_bDark = false;
};

REGISTER_LOOP_FUNCTIONS(CFloorLoop, "floor")
