#ifndef TRIALS_LOOP_H
#define TRIALS_LOOP_H
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/utility/math/rng.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

#include "walker.h"

/// One robot of its own, which starts anew in every trial.
class CTrialsLoop : public CLoopFunctions {
 public:
  virtual void Init(TConfigurationNode& t_tree);
  virtual void Reset();
  virtual void PostExperiment() { ++m_unEnds; }
  void SetSpeed(Real f_speed) { m_pcWalker->m_fSpeed = f_speed; }
  Real Reached() { return m_pcRobot->GetEmbodiedEntity().GetOriginAnchor().Position.GetX(); }
  UInt32 Ends() const { return m_unEnds; }
  UInt32 Resets() const { return m_pcWalker->m_unResets; }
  Real Drawn() const { return m_fDrawn; }

 private:
  CFootBotEntity* m_pcRobot = nullptr;
  CWalker* m_pcWalker = nullptr;
  CRandom::CRNG* m_pcRNG = nullptr;
  UInt32 m_unEnds = 0;
  Real m_fDrawn = 0;
};

#endif
