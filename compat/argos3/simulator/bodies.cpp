// Bodies: where they are, what they touch.
#include <algorithm>
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/simulator/space/space.h>
#include <cmath>
#include <mutex>

#include "compat/argos3/simulator/session.hpp"

namespace argos {

using tandem::compat::argos3::Form;
using tandem::compat::argos3::in_world;
using tandem::compat::argos3::Place;
using tandem::compat::argos3::place_of;
using tandem::compat::argos3::refuse;
using tandem::compat::argos3::world;

CEmbodiedEntity::CEmbodiedEntity(CComposableEntity* pc_parent) : CEmbodiedEntity(pc_parent, "body_0") {}
CEmbodiedEntity::CEmbodiedEntity(CComposableEntity* pc_parent, const std::string& str_id, const CVector3& c_position,
                                 const CQuaternion& c_orientation, bool b_movable)
    : CEntity(pc_parent, str_id),
      m_psOriginAnchor(new SAnchor(*this, "origin", 0, CVector3(), CQuaternion(), c_position, c_orientation)),
      m_cInitPosition(c_position),
      m_cInitOrientation(c_orientation),
      m_bMovable(b_movable) {
  m_mapAnchors.emplace("origin", m_psOriginAnchor);
}
CEmbodiedEntity::~CEmbodiedEntity() {
  for (const auto& entry : m_mapAnchors) delete entry.second;
}

namespace {

std::mutex bounding;  // controllers may ask, on any thread

std::string owner_of(const CEmbodiedEntity& body) {
  return body.GetRootEntity().GetId();
}

}  // namespace

bool CEmbodiedEntity::IsMovable() const {
  return in_world(m_sBody) ? world().form(m_sBody).movable : m_bMovable;
}
void CEmbodiedEntity::SetMovable(bool b_movable) {
  if (m_sBody.Kind == SBody::ROBOT) refuse(owner_of(*this), "a robot is movable; Disable() makes it stand");
  m_bMovable = b_movable;
  if (!in_world(m_sBody)) return;
  Form form = world().form(m_sBody);
  form.movable = b_movable;
  const std::string why = world().change(m_sBody, form);
  if (!why.empty()) refuse(owner_of(*this), why);
}

SAnchor& CEmbodiedEntity::AddAnchor(const std::string& str_id, const CVector3& c_offset_position,
                                    const CQuaternion& c_offset_orientation) {
  if (m_mapAnchors.count(str_id) != 0) refuse(owner_of(*this), "it has an anchor \"" + str_id + "\" already");
  auto* const anchor =
      new SAnchor(*this, str_id, static_cast<UInt32>(m_mapAnchors.size()), c_offset_position, c_offset_orientation);
  m_mapAnchors.emplace(str_id, anchor);
  ReadWorld();
  return *anchor;
}
void CEmbodiedEntity::EnableAnchor(const std::string& str_id) {
  ++GetAnchor(str_id).InUseCount;
}
void CEmbodiedEntity::DisableAnchor(const std::string& str_id) {
  SAnchor& anchor = GetAnchor(str_id);
  if (anchor.InUseCount > 0) --anchor.InUseCount;
}
bool CEmbodiedEntity::IsAnchorEnabled(const std::string& str_id) {
  return str_id == "origin" || GetAnchor(str_id).InUseCount > 0;
}
SAnchor& CEmbodiedEntity::GetAnchor(const std::string& str_id) {
  const auto found = m_mapAnchors.find(str_id);
  if (found != m_mapAnchors.end()) return *found->second;
  std::string there;
  for (const auto& entry : m_mapAnchors) there += (there.empty() ? "" : ", ") + entry.first;
  refuse(owner_of(*this), "it has no anchor \"" + str_id + "\"; it has: " + there);
}
const SAnchor& CEmbodiedEntity::GetAnchor(const std::string& str_id) const {
  return const_cast<CEmbodiedEntity*>(this)->GetAnchor(str_id);
}

void CEmbodiedEntity::SetBody(const SBody& s_body) {
  m_sBody = s_body;
  ReadWorld();
}

void CEmbodiedEntity::ReadWorld() const {
  SAnchor& origin = *m_psOriginAnchor;
  if (in_world(m_sBody)) {
    const Place place = world().place(m_sBody);
    origin.Position = tandem::compat::argos3::vector_of(place);
    origin.Orientation = tandem::compat::argos3::quaternion_of(place);
  }
  if (m_mapAnchors.size() == 1) return;
  for (const auto& entry : m_mapAnchors) {
    SAnchor& anchor = *entry.second;
    if (&anchor == &origin) continue;
    CVector3 offset = anchor.OffsetPosition;
    anchor.Position = origin.Position + offset.Rotate(origin.Orientation);
    anchor.Orientation = origin.Orientation * anchor.OffsetOrientation;
    if (anchor.Id == "turret" && in_world(m_sBody))
      anchor.Orientation *= CQuaternion(CRadians(world().turret_rad(m_sBody)), CVector3::Z);
  }
}

const SBoundingBox& CEmbodiedEntity::GetBoundingBox() const {
  const std::lock_guard lock(bounding);
  const_cast<CEmbodiedEntity*>(this)->CalculateBoundingBox();
  return m_sBoundingBox;
}
void CEmbodiedEntity::CalculateBoundingBox() {
  const CVector3& p = GetOriginAnchor().Position;
  const Form form = in_world(m_sBody) ? world().form(m_sBody) : Form();
  double x_m = form.radius_m, y_m = form.radius_m;
  if (form.box) {
    CRadians z, y, x;
    m_psOriginAnchor->Orientation.ToEulerAngles(z, y, x);
    const double c = std::fabs(std::cos(z.GetValue())), s = std::fabs(std::sin(z.GetValue()));
    x_m = c * form.half_x_m + s * form.half_y_m;
    y_m = s * form.half_x_m + c * form.half_y_m;
  }
  m_sBoundingBox.MinCorner.Set(p.GetX() - x_m, p.GetY() - y_m, p.GetZ());
  m_sBoundingBox.MaxCorner.Set(p.GetX() + x_m, p.GetY() + y_m, p.GetZ() + form.height_m);
}

bool CEmbodiedEntity::MoveTo(const CVector3& c_position, const CQuaternion& c_orientation, bool b_check_only,
                             bool b_ignore_collisions) {
  const Place place = place_of(c_position, c_orientation);
  if (!in_world(m_sBody)) {
    if (b_check_only) return true;
    m_psOriginAnchor->Position = m_cInitPosition = c_position;
    m_psOriginAnchor->Orientation = m_cInitOrientation = c_orientation;
    return true;
  }
  if (!b_ignore_collisions && !world().room(m_sBody, place).empty()) return false;
  if (!b_check_only) {
    world().put(m_sBody, place);
    ReadWorld();
  }
  return true;
}

bool CEmbodiedEntity::IsCollidingWithSomething() const {
  return in_world(m_sBody) && !world().room(m_sBody, world().place(m_sBody)).empty();
}
std::string CEmbodiedEntity::GetTypeDescription() const {
  return "body";
}
void CEmbodiedEntity::Reset() {
  ReadWorld();
}
CAny CEmbodiedEntity::AsAny() {
  return CAny(this);
}

bool operator==(const SAnchor* ps_anchor, const std::string& str_id) {
  return ps_anchor->Id == str_id;
}

// --- rays ---

namespace {

/// Where the ray enters the body; below 0: it does not. A ray that starts inside enters at its start.
double entry_of(const CRay3& ray, const Place& place, const Form& form) {
  const Place turn{0, 0, 0, place.w, -place.x, -place.y, -place.z};
  const CQuaternion back(turn.w, turn.x, turn.y, turn.z);
  CVector3 from = ray.GetStart() - CVector3(place.x_m, place.y_m, place.z_m);
  CVector3 to = ray.GetEnd() - CVector3(place.x_m, place.y_m, place.z_m);
  from.Rotate(back);
  to.Rotate(back);
  const CVector3 way = to - from;
  double enter = 0.0, leave = 1.0;
  const auto cut = [&](double start, double step, double low, double high) {
    if (step == 0.0) {
      if (start < low || start > high) leave = -1.0;
      return;
    }
    const double a = (low - start) / step, b = (high - start) / step;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  };
  cut(from.GetZ(), way.GetZ(), 0.0, form.height_m);
  if (form.box) {
    cut(from.GetX(), way.GetX(), -form.half_x_m, form.half_x_m);
    cut(from.GetY(), way.GetY(), -form.half_y_m, form.half_y_m);
    return enter <= leave ? enter : -1.0;
  }
  const double a = way.GetX() * way.GetX() + way.GetY() * way.GetY();
  const double b = from.GetX() * way.GetX() + from.GetY() * way.GetY();
  const double c = from.GetX() * from.GetX() + from.GetY() * from.GetY() - form.radius_m * form.radius_m;
  if (a == 0.0) return c <= 0.0 && enter <= leave ? enter : -1.0;
  const double root = b * b - a * c;
  if (root < 0.0) return -1.0;
  enter = std::max(enter, (-b - std::sqrt(root)) / a);
  leave = std::min(leave, (-b + std::sqrt(root)) / a);
  return enter <= leave ? enter : -1.0;
}

TEmbodiedEntityIntersectionData hits(const CRay3& ray, const CEmbodiedEntity* without) {
  TEmbodiedEntityIntersectionData found;
  for (CEntity* const entity : CSimulator::GetInstance().GetSpace().GetRootEntityVector()) {
    auto* const composed = dynamic_cast<CComposableEntity*>(entity);
    if (composed == nullptr || !composed->HasComponent("body")) continue;
    auto& body = composed->GetComponent<CEmbodiedEntity>("body");
    if (&body == without || !in_world(body.GetBody())) continue;
    const double t = entry_of(ray, world().place(body.GetBody()), world().form(body.GetBody()));
    if (t >= 0.0) found.emplace_back(&body, t);
  }
  std::stable_sort(found.begin(), found.end());
  return found;
}

bool nearest(SEmbodiedEntityIntersectionItem& item, const CRay3& ray, const CEmbodiedEntity* without) {
  const TEmbodiedEntityIntersectionData found = hits(ray, without);
  item = found.empty() ? SEmbodiedEntityIntersectionItem() : found.front();
  return !found.empty();
}

}  // namespace

bool GetEmbodiedEntitiesIntersectedByRay(TEmbodiedEntityIntersectionData& t_data, const CRay3& c_ray) {
  t_data = hits(c_ray, nullptr);
  return !t_data.empty();
}
bool GetClosestEmbodiedEntityIntersectedByRay(SEmbodiedEntityIntersectionItem& s_item, const CRay3& c_ray) {
  return nearest(s_item, c_ray, nullptr);
}
bool GetClosestEmbodiedEntityIntersectedByRay(SEmbodiedEntityIntersectionItem& s_item, const CRay3& c_ray,
                                              CEmbodiedEntity& c_entity) {
  return nearest(s_item, c_ray, &c_entity);
}

Real CPhysicsEngine::GetSimulationClockTick() {
  return 1.0 / world().ticks_per_second();
}
Real CPhysicsEngine::GetInverseSimulationClockTick() {
  return world().ticks_per_second();
}

}  // namespace argos
