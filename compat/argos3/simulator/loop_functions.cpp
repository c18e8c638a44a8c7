#include <argos3/core/simulator/loop_functions.h>

#include "compat/argos3/simulator/session.hpp"

namespace argos {

CLoopFunctions::CLoopFunctions() : m_cSimulator(CSimulator::GetInstance()), m_cSpace(m_cSimulator.GetSpace()) {}
CLoopFunctions::~CLoopFunctions() {}

void CLoopFunctions::MoveEntity(CPositionalEntity& entity, const CVector3& position, const CQuaternion& orientation) {
  entity.MoveTo(position, orientation);
}
bool CLoopFunctions::MoveEntity(CEmbodiedEntity& entity, const CVector3& position, const CQuaternion& orientation,
                                bool check_only, bool ignore_collisions) {
  return entity.MoveTo(position, orientation, check_only, ignore_collisions);
}
void CLoopFunctions::AddEntity(CEntity& entity) {
  m_cSpace.AddEntity(entity);
}
void CLoopFunctions::RemoveEntity(const std::string& id) {
  m_cSpace.RemoveEntity(m_cSpace.GetEntity(id));
}
void CLoopFunctions::RemoveEntity(CEntity& entity) {
  m_cSpace.RemoveEntity(entity);
}

}  // namespace argos
