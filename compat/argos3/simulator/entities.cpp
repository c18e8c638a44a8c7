// Entities and their parts that are not of one kind of thing.
#include <algorithm>
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/simulator/entity/floor_entity.h>
#include <argos3/core/simulator/entity/positional_entity.h>
#include <argos3/core/simulator/medium/medium.h>
#include <argos3/core/simulator/visualization/visualization.h>
#include <argos3/plugins/robots/generic/simulator/robot_entity.h>

#include "compat/argos3/facade/controllers.hpp"
#include "compat/argos3/simulator/session.hpp"

namespace argos {

using tandem::compat::argos3::in_world;
using tandem::compat::argos3::refuse;
using tandem::compat::argos3::Session;
using tandem::compat::argos3::world;

// --- CEntity ---

CEntity::CEntity(CComposableEntity* pc_parent) : m_pcParent(pc_parent) {}
CEntity::CEntity(CComposableEntity* pc_parent, const std::string& str_id) : m_pcParent(pc_parent), m_strId(str_id) {}
CEntity::~CEntity() {
  Session::get().forget(*this);
}

void CEntity::Init(TConfigurationNode&) {
  THROW_ARGOSEXCEPTION("Entity \"" << m_strId << "\" cannot be made of an element; use its constructor");
}
void CEntity::Reset() {}
void CEntity::Destroy() {}
void CEntity::Update() {}

std::string CEntity::GetContext() const {
  return m_pcParent == nullptr ? std::string() : m_pcParent->GetContext() + m_pcParent->GetId() + ".";
}

CEntity& CEntity::GetRootEntity() {
  return m_pcParent == nullptr ? *this : m_pcParent->GetRootEntity();
}
const CEntity& CEntity::GetRootEntity() const {
  return const_cast<CEntity*>(this)->GetRootEntity();
}
CComposableEntity& CEntity::GetParent() {
  if (m_pcParent == nullptr) refuse(m_strId, "it is no part of another entity");
  return *m_pcParent;
}
const CComposableEntity& CEntity::GetParent() const {
  return const_cast<CEntity*>(this)->GetParent();
}
std::string CEntity::GetTypeDescription() const {
  return "entity";
}
void CEntity::SetEnabled(bool b_enabled) {
  m_bEnabled = b_enabled;
}
CAny CEntity::AsAny() {
  return CAny(this);
}
void CEntity::JoinWorld() {
  refuse(m_strId,
         "an entity of type \"" + GetTypeDescription() + "\" cannot be added; robots, boxes, cylinders and lights can");
}
void CEntity::LeaveWorld() {}
bool CEntity::FindInWorld() {
  return true;
}

// --- CComposableEntity ---

CComposableEntity::CComposableEntity(CComposableEntity* pc_parent) : CEntity(pc_parent) {}
CComposableEntity::CComposableEntity(CComposableEntity* pc_parent, const std::string& str_id)
    : CEntity(pc_parent, str_id) {}
CComposableEntity::~CComposableEntity() {
  for (CEntity* const component : m_vecComponents) delete component;
}
void CComposableEntity::Reset() {
  for (CEntity* const component : m_vecComponents) component->Reset();
}
void CComposableEntity::Update() {
  UpdateComponents();
}
void CComposableEntity::UpdateComponents() {}
std::string CComposableEntity::GetTypeDescription() const {
  return "composite";
}
void CComposableEntity::SetEnabled(bool b_enabled) {
  CEntity::SetEnabled(b_enabled);
  for (CEntity* const component : m_vecComponents) component->SetEnabled(b_enabled);
}
void CComposableEntity::AddComponent(CEntity& c_component) {
  c_component.SetParent(*this);
  m_mapComponents.emplace(c_component.GetTypeDescription(), &c_component);
  m_vecComponents.push_back(&c_component);
}

CEntity::TMultiMap::iterator CComposableEntity::FindComponent(const std::string& str_component) {
  const std::size_t bracket = str_component.find('[');
  if (bracket == std::string::npos || str_component.back() != ']') return m_mapComponents.find(str_component);
  const std::string id = str_component.substr(bracket + 1, str_component.size() - bracket - 2);
  const auto range = m_mapComponents.equal_range(str_component.substr(0, bracket));
  const auto found =
      std::find_if(range.first, range.second, [&](const auto& entry) { return entry.second->GetId() == id; });
  return found == range.second ? m_mapComponents.end() : found;
}

CEntity& CComposableEntity::GetComponent(const std::string& str_component) {
  const auto found = FindComponent(str_component);
  if (found != m_mapComponents.end()) return *found->second;
  std::string there;
  for (const CEntity* const component : m_vecComponents)
    there += (there.empty() ? "" : ", ") + component->GetTypeDescription() + "[" + component->GetId() + "]";
  refuse(GetId(), "it has no component \"" + str_component + "\"; it has: " + (there.empty() ? "none" : there));
}

bool CComposableEntity::HasComponent(const std::string& str_component) {
  return FindComponent(str_component) != m_mapComponents.end();
}

CEntity& CComposableEntity::RemoveComponent(const std::string& str_component) {
  CEntity& component = GetComponent(str_component);
  m_mapComponents.erase(FindComponent(str_component));
  m_vecComponents.erase(std::find(m_vecComponents.begin(), m_vecComponents.end(), &component));
  return component;
}
CAny CComposableEntity::AsAny() {
  return CAny(this);
}

// --- CPositionalEntity ---

CPositionalEntity::CPositionalEntity(CComposableEntity* pc_parent) : CEntity(pc_parent) {}
CPositionalEntity::CPositionalEntity(CComposableEntity* pc_parent, const std::string& str_id,
                                     const CVector3& c_position, const CQuaternion& c_orientation)
    : CEntity(pc_parent, str_id),
      m_cPosition(c_position),
      m_cInitPosition(c_position),
      m_cOrientation(c_orientation),
      m_cInitOrientation(c_orientation) {}
CPositionalEntity::~CPositionalEntity() {}
void CPositionalEntity::Reset() {
  m_cPosition = m_cInitPosition;
  m_cOrientation = m_cInitOrientation;
}
void CPositionalEntity::MoveTo(const CVector3& c_position, const CQuaternion& c_orientation) {
  m_cPosition = c_position;
  m_cOrientation = c_orientation;
}
std::string CPositionalEntity::GetTypeDescription() const {
  return "position";
}
CAny CPositionalEntity::AsAny() {
  return CAny(this);
}

// --- CControllableEntity ---

CControllableEntity::CControllableEntity(CComposableEntity* pc_parent) : CEntity(pc_parent) {}
CControllableEntity::CControllableEntity(CComposableEntity* pc_parent, const std::string& str_id)
    : CEntity(pc_parent, str_id) {}
CControllableEntity::~CControllableEntity() {}

CCI_Controller& CControllableEntity::GetController() {
  const CEntity& robot = GetRootEntity();
  const auto* const known = dynamic_cast<const CRobotEntity*>(&robot);
  CCI_Controller* const found =
      known == nullptr ? nullptr : tandem::compat::argos3::controller_of(known->GetIdInWorld());
  if (found != nullptr) return *found;
  refuse(robot.GetId(), "it has no ARGoS controller: it is not in the space, or its configuration \"" +
                            m_strConfiguration + "\" names a controller of Tandem's own");
}
const CCI_Controller& CControllableEntity::GetController() const {
  return const_cast<CControllableEntity*>(this)->GetController();
}
std::string CControllableEntity::GetTypeDescription() const {
  return "controller";
}
void CControllableEntity::SetEnabled(bool b_enabled) {
  CEntity::SetEnabled(b_enabled);
  auto* const robot = dynamic_cast<CRobotEntity*>(&GetRootEntity());
  if (robot != nullptr && in_world(robot->GetEmbodiedEntity().GetBody()))
    world().halt(robot->GetEmbodiedEntity().GetBody(), !b_enabled);
}
CAny CControllableEntity::AsAny() {
  return CAny(this);
}

// --- CFloorEntity ---

CFloorEntity::CFloorEntity(const std::string& str_id) : CEntity(nullptr, str_id) {}
CFloorEntity::~CFloorEntity() {}
CColor CFloorEntity::GetColorAtPoint(Real f_x, Real f_y) {
  if (Session::get().painted) return Session::get().loop_functions().GetFloorColor(CVector2(f_x, f_y));
  const auto grey = static_cast<UInt8>(std::clamp(world().floor(f_x, f_y), 0.0, 1.0) * 255.0 + 0.5);
  return CColor(grey, grey, grey);
}
bool CFloorEntity::HasChanged() const {
  return m_bChanged && m_unChangedAt == world().clock();
}
void CFloorEntity::SetChanged() {
  m_bChanged = true;
  m_unChangedAt = world().clock();
  world().repaint_floor();
}
std::string CFloorEntity::GetTypeDescription() const {
  return "floor";
}
CAny CFloorEntity::AsAny() {
  return CAny(this);
}

CMedium::~CMedium() {}
CVisualization::~CVisualization() {}

}  // namespace argos
