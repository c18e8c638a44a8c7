// The space: entities of the world that runs.
#include <algorithm>
#include <argos3/core/simulator/entity/floor_entity.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/eye-bot/simulator/eyebot_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/entities/box_entity.h>
#include <argos3/plugins/simulator/entities/cylinder_entity.h>
#include <argos3/plugins/simulator/entities/light_entity.h>
#include <memory>
#include <mutex>
#include <regex>
#include <set>

#include "compat/argos3/facade/controllers.hpp"
#include "compat/argos3/simulator/session.hpp"

namespace argos {

namespace compat = tandem::compat::argos3;

using compat::refuse;
using compat::Session;
using compat::world;

struct CSpace::SState {
  CEntity::TVector All, Roots;
  CEntity::TMap ById;
  TMapPerTypePerId ByType;
  ssize_t NextIndex = 0;
  CFloorEntity* Floor = nullptr;
  std::vector<const CEmbodiedEntity*> Bodies;
  // Removed in this phase: loops over the maps and vectors may stand at them.
  std::vector<CEntity*> RemovedRoots;
  std::set<const CEntity*> Removed;
  std::map<std::string, std::vector<std::string>> RemovedKeys;  // by type
  bool VectorsHoldRemoved = false;
  bool IsFilled = false;                            ///< entities are made when they are asked for
  std::recursive_mutex Filling;                     ///< controllers may ask, on any thread
  std::set<std::string> FromFile, FromFileRemoved;  // ids
  CVector3 Size, Center;
  CRange<CVector3> Limits;

  SState() : Limits(CVector3(), CVector3(1.0, 1.0, 1.0)) {}

  void Enter(CEntity& entity) {
    const std::string key = entity.GetContext() + entity.GetId();
    All.push_back(&entity);
    if (!entity.HasParent()) Roots.push_back(&entity);
    if (const auto* const body = dynamic_cast<CEmbodiedEntity*>(&entity)) Bodies.push_back(body);
    entity.SetIndex(NextIndex++);
    ById[key] = &entity;
    TMapPerType& of_type = ByType[entity.GetTypeDescription()];
    std::vector<std::string>& gone = RemovedKeys[entity.GetTypeDescription()];
    gone.erase(std::remove(gone.begin(), gone.end(), key), gone.end());
    of_type[key] = entity.AsAny();
    if (auto* const composed = dynamic_cast<CComposableEntity*>(&entity)) {
      for (CEntity* const component : composed->GetComponentVector()) Enter(*component);
    }
  }

  void Leave(CEntity& entity) {
    const std::string key = entity.GetContext() + entity.GetId();
    const auto found = ById.find(key);
    if (found != ById.end() && found->second == &entity) ById.erase(found);
    RemovedKeys[entity.GetTypeDescription()].push_back(key);
    Removed.insert(&entity);
    VectorsHoldRemoved = true;
    if (auto* const composed = dynamic_cast<CComposableEntity*>(&entity)) {
      for (CEntity* const component : composed->GetComponentVector()) Leave(*component);
    }
  }

  void SweepVectors() {
    if (!VectorsHoldRemoved) return;
    const auto gone = [this](const CEntity* entity) { return Removed.count(entity) != 0; };
    All.erase(std::remove_if(All.begin(), All.end(), gone), All.end());
    Roots.erase(std::remove_if(Roots.begin(), Roots.end(), gone), Roots.end());
    Bodies.erase(std::remove_if(Bodies.begin(), Bodies.end(), gone), Bodies.end());
    VectorsHoldRemoved = false;
  }

  void SweepType(const std::string& type) {
    const auto gone = RemovedKeys.find(type);
    if (gone == RemovedKeys.end() || gone->second.empty()) return;
    TMapPerType& of_type = ByType[type];
    for (const std::string& key : gone->second) of_type.erase(key);
    gone->second.clear();
  }
};

CSpace::CSpace() : m_psState(new SState) {}
CSpace::~CSpace() {
  delete m_psState;
}

CSpace::SState& CSpace::Filled() const {
  if (Session::get().entered()) CSpaceAccess::Fill(const_cast<CSpace&>(*this));
  return *m_psState;
}

UInt32 CSpace::GetNumberEntities() {
  return static_cast<UInt32>(GetEntityVector().size());
}
CEntity::TVector& CSpace::GetEntityVector() {
  Filled().SweepVectors();
  return Filled().All;
}
CEntity::TVector& CSpace::GetRootEntityVector() {
  Filled().SweepVectors();
  return Filled().Roots;
}
CEntity::TMap& CSpace::GetEntityMapPerId() {
  return Filled().ById;
}
CSpace::TMapPerTypePerId& CSpace::GetEntityMapPerTypePerId() {
  for (const auto& entry : Filled().ByType) Filled().SweepType(entry.first);
  return Filled().ByType;
}
CEntity& CSpace::GetEntity(const std::string& id) {
  const auto found = Filled().ById.find(id);
  if (found == Filled().ById.end()) refuse(id, "there is no entity of this id in the space");
  return *found->second;
}
void CSpace::GetEntitiesMatching(CEntity::TVector& found, const std::string& pattern) {
  const std::regex wanted(pattern, std::regex::extended);
  for (CEntity* const entity : GetEntityVector()) {
    if (std::regex_match(entity->GetId(), wanted)) found.push_back(entity);
  }
}

CSpace::TMapPerType& CSpace::GetEntitiesByType(const std::string& type) {
  const auto found = Filled().ByType.find(type);
  if (found == Filled().ByType.end()) {
    world();  // says when no experiment runs
    std::string there;
    for (const auto& entry : Filled().ByType) there += (there.empty() ? "" : ", ") + entry.first;
    THROW_ARGOSEXCEPTION("there are no entities of type \"" << type << "\" in the space; there are: " << there)
  }
  Filled().SweepType(type);
  return found->second;
}
const CSpace::TMapPerType& CSpace::GetEntitiesByType(const std::string& type) const {
  return const_cast<CSpace*>(this)->GetEntitiesByType(type);
}

CFloorEntity& CSpace::GetFloorEntity() {
  if (Filled().Floor == nullptr)
    THROW_ARGOSEXCEPTION(
        "the arena has no floor: add <floor id=\"floor\" source=\"loop_functions\" "
        "pixels_per_meter=\"50\"/> to <arena>")
  return *Filled().Floor;
}

void CSpace::AddEntity(CEntity& entity) {
  const auto taken = Filled().ById.find(entity.GetId());
  if (taken != Filled().ById.end())
    refuse(entity.GetId(), "an entity of type \"" + taken->second->GetTypeDescription() + "\" has this id already");
  entity.JoinWorld();
  Filled().Enter(entity);
  if (!entity.IsEnabled()) entity.SetEnabled(false);
}

void CSpace::RemoveEntity(CEntity& entity) {
  const auto found = Filled().ById.find(entity.GetContext() + entity.GetId());
  if (found == Filled().ById.end() || found->second != &entity || entity.HasParent())
    refuse(entity.GetId(), entity.HasParent() ? "it is a part of another entity, and is removed with it"
                                              : "it is not in the space, or no more");
  if (&entity == Filled().Floor) refuse(entity.GetId(), "the floor cannot be removed");
  if (Filled().FromFile.count(entity.GetId()) != 0) Filled().FromFileRemoved.insert(entity.GetId());
  entity.LeaveWorld();
  Filled().Leave(entity);
  Filled().RemovedRoots.push_back(&entity);
}

void CSpace::IterateOverControllableEntities(const TControllableEntityIterCBType& call) {
  for (CEntity* const entity : CEntity::TVector(GetRootEntityVector())) {
    auto* const robot = dynamic_cast<CRobotEntity*>(entity);
    if (robot != nullptr) call(&robot->GetControllableEntity());
  }
}

UInt32 CSpace::GetSimulationClock() const {
  return Session::get().entered() ? world().clock() : 0;
}
const CVector3& CSpace::GetArenaSize() const {
  world();
  return Filled().Size;
}
const CVector3& CSpace::GetArenaCenter() const {
  world();
  return Filled().Center;
}
const CRange<CVector3>& CSpace::GetArenaLimits() const {
  world();
  return Filled().Limits;
}

// --- for the session ---

namespace {

std::unique_ptr<CEntity> entity_of(const compat::WorldDoor::Named& one) {
  const CVector3 p = compat::vector_of(world().place(one.body));
  const CQuaternion q = compat::quaternion_of(world().place(one.body));
  if (one.kind == "box" || one.kind == "cylinder") {
    const compat::Form form = world().form(one.body);
    if (form.box)
      return std::unique_ptr<CEntity>(new CBoxEntity(
          one.id, p, q, form.movable, CVector3(2.0 * form.half_x_m, 2.0 * form.half_y_m, form.height_m), form.mass_kg));
    return std::unique_ptr<CEntity>(
        new CCylinderEntity(one.id, p, q, form.movable, form.radius_m, form.height_m, form.mass_kg));
  }
  if (one.kind == "foot-bot") return std::unique_ptr<CEntity>(new CFootBotEntity(one.id, one.controller, p, q));
  if (one.kind == "e-puck") return std::unique_ptr<CEntity>(new CEPuckEntity(one.id, one.controller, p, q));
  if (one.kind == "eye-bot") return std::unique_ptr<CEntity>(new CEyeBotEntity(one.id, one.controller, p, q));
  return std::unique_ptr<CEntity>(new CRobotEntity(one.kind, one.id, one.controller, p, q));
}

/// Whether the file has a floor; `painted`: by loop functions.
bool file_has_floor(bool& painted) {
  TConfigurationNode& root = CSimulator::GetInstance().GetConfigurationRoot();
  TConfigurationNode* const arena = root.FirstChildElement("arena", false);
  TConfigurationNode* const floor = arena == nullptr ? nullptr : arena->FirstChildElement("floor", false);
  const std::string source = floor == nullptr ? std::string() : floor->GetAttribute("source");
  painted = source == "loop_functions";
  return painted || source == "image";  // else it is the grey one of every arena
}

}  // namespace

void CSpaceAccess::Fill(CSpace& space) {
  CSpace::SState& s = *space.m_psState;
  const std::lock_guard lock(s.Filling);
  if (s.IsFilled) return;
  s.IsFilled = true;
  s.Size.Set(world().arena_size());
  s.Center.Set(world().arena_center());
  s.Limits.Set(s.Center - s.Size * 0.5, s.Center + s.Size * 0.5);
  if (file_has_floor(Session::get().painted)) s.Enter(*(s.Floor = new CFloorEntity));
  const auto enter = [&](const compat::WorldDoor::Named& one) {
    CEntity* const entity = entity_of(one).release();
    s.Enter(*entity);
    entity->FindInWorld();
    s.FromFile.insert(one.id);
  };
  for (const compat::WorldDoor::Named& object : world().objects()) enter(object);
  for (const auto& lamp : world().lamps()) {
    const compat::Lamp& l = lamp.second;
    auto* const light =
        new CLightEntity(l.id, CVector3(l.x_m, l.y_m, l.z_m), CColor(l.color.r, l.color.g, l.color.b), l.intensity);
    s.Enter(*light);
    light->FindInWorld();
    s.FromFile.insert(l.id);
  }
  for (const compat::WorldDoor::Named& robot : world().robots()) enter(robot);
}

void CSpaceAccess::FindAgain(CSpace& space) {
  CSpace::SState& s = *space.m_psState;
  if (!s.IsFilled) return;
  for (const std::string& id : s.FromFileRemoved) {
    for (const compat::Body& body : {world().find_robot(id), world().find_object(id)}) {
      if (body.Kind != compat::Body::NONE) world().remove(body);
    }
    for (const auto& lamp : world().lamps()) {
      if (lamp.second.id == id) world().remove_lamp(lamp.first);
    }
  }
  for (CEntity* const entity : CEntity::TVector(space.GetRootEntityVector())) {
    if (!entity->FindInWorld()) {
      if (const auto* const robot = dynamic_cast<CRobotEntity*>(entity)) compat::keep_controller(robot->GetIdInWorld());
      entity->JoinWorld();
    }
    entity->Reset();
    if (!entity->IsEnabled()) entity->SetEnabled(false);
  }
}

void CSpaceAccess::Look(CSpace& space) {
  CSpace::SState& s = *space.m_psState;
  for (const CEmbodiedEntity* const body : s.Bodies) body->ReadWorld();
}

void CSpaceAccess::Sweep(CSpace& space) {
  CSpace::SState& s = *space.m_psState;
  if (s.RemovedRoots.empty()) return;
  s.SweepVectors();
  for (const auto& entry : s.RemovedKeys) s.SweepType(entry.first);
  s.RemovedKeys.clear();
  for (CEntity* const entity : s.RemovedRoots) {
    entity->Destroy();
    if (const auto* const robot = dynamic_cast<CRobotEntity*>(entity)) compat::end_controller(robot->GetIdInWorld());
    delete entity;
  }
  s.RemovedRoots.clear();
  s.Removed.clear();
}

void CSpaceAccess::Clear(CSpace& space) {
  Sweep(space);
  for (CEntity* const entity : CEntity::TVector(space.m_psState->Roots)) delete entity;
  delete space.m_psState;
  space.m_psState = new CSpace::SState;
}

}  // namespace argos
