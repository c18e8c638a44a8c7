#include "trials_loop.h"

void CTrialsLoop::Init(TConfigurationNode&) {
  m_pcRNG = CRandom::CreateRNG("argos");
  m_pcRobot = new CFootBotEntity("mine", "walk", CVector3(-1, 0, 0), CQuaternion());
  AddEntity(*m_pcRobot);
  m_pcWalker = &dynamic_cast<CWalker&>(m_pcRobot->GetControllableEntity().GetController());
  m_fDrawn = m_pcRNG->Uniform(CRange<Real>(0, 1));
}

void CTrialsLoop::Reset() {
  m_fDrawn = m_pcRNG->Uniform(CRange<Real>(0, 1));
}

REGISTER_LOOP_FUNCTIONS(CTrialsLoop, "trials")
