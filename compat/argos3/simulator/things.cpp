// Boxes, cylinders and lamps.
#include <argos3/plugins/simulator/entities/box_entity.h>
#include <argos3/plugins/simulator/entities/cylinder_entity.h>
#include <argos3/plugins/simulator/entities/light_entity.h>

#include "compat/argos3/simulator/session.hpp"

namespace argos {

using tandem::compat::argos3::Body;
using tandem::compat::argos3::Form;
using tandem::compat::argos3::in_world;
using tandem::compat::argos3::Lamp;
using tandem::compat::argos3::Led;
using tandem::compat::argos3::place_of;
using tandem::compat::argos3::refuse;
using tandem::compat::argos3::Session;
using tandem::compat::argos3::world;

namespace {

std::vector<Led> leds_of(CLEDEquippedEntity& leds) {
  std::vector<Led> all;
  for (const CLEDEquippedEntity::SActuator* const one : leds.GetLEDs()) {
    const CColor& c = one->LED.GetColor();
    all.push_back(
        {one->Offset.GetX(), one->Offset.GetY(), one->Offset.GetZ(), {c.GetRed(), c.GetGreen(), c.GetBlue()}});
  }
  return all;
}

void join(const std::string& id, CEmbodiedEntity& body, CLEDEquippedEntity& leds, Form form) {
  Body added;
  form.movable = body.IsMovable();
  const std::string why =
      world().add_object(id, form, place_of(body.GetInitPosition(), body.GetInitOrientation()), leds_of(leds), added);
  if (!why.empty()) refuse(id, why);
  body.SetBody(added);
}

void leave(CEmbodiedEntity& body) {
  if (in_world(body.GetBody())) world().remove(body.GetBody());
}

bool find(const std::string& id, CEmbodiedEntity& body) {
  const Body found = world().find_object(id);
  if (found.Kind == Body::NONE) return false;
  body.SetBody(found);
  return true;
}

/// Of a body that is in the world, when it is.
template <class Change>
void change(const std::string& id, const CEmbodiedEntity& body, Change&& change_form) {
  if (!in_world(body.GetBody())) return;
  Form form = world().form(body.GetBody());
  change_form(form);
  const std::string why = world().change(body.GetBody(), form);
  if (!why.empty()) refuse(id, why);
}

void darken(CLEDEquippedEntity& leds) {
  leds.SetAllLEDsColors(CColor::BLACK);
}

}  // namespace

// --- boxes ---

CBoxEntity::CBoxEntity() : CBoxEntity("", CVector3(), CQuaternion(), false, CVector3(1.0, 1.0, 1.0)) {}
CBoxEntity::CBoxEntity(const std::string& id, const CVector3& position, const CQuaternion& orientation, bool movable,
                       const CVector3& size, Real mass)
    : CComposableEntity(nullptr, id),
      m_pcBody(new CEmbodiedEntity(this, "body_0", position, orientation, movable)),
      m_pcLEDs(new CLEDEquippedEntity(this, "leds_0")),
      m_cSize(size),
      m_fMass(mass) {
  AddComponent(*m_pcBody);
  AddComponent(*m_pcLEDs);
}
CBoxEntity::~CBoxEntity() {}
void CBoxEntity::EnableLEDs(CLEDMedium&) {}
void CBoxEntity::DisableLEDs() {
  darken(*m_pcLEDs);
}
void CBoxEntity::AddLED(const CVector3& offset, const CColor& color) {
  m_pcLEDs->AddLED(offset, m_pcBody->GetOriginAnchor(), color);
}
void CBoxEntity::Resize(const CVector3& size) {
  change(GetId(), *m_pcBody, [&](Form& form) {
    form.half_x_m = 0.5 * size.GetX();
    form.half_y_m = 0.5 * size.GetY();
    form.height_m = size.GetZ();
  });
  m_cSize = size;
}
void CBoxEntity::SetMass(Real mass) {
  change(GetId(), *m_pcBody, [&](Form& form) { form.mass_kg = mass; });
  m_fMass = mass;
}
std::string CBoxEntity::GetTypeDescription() const {
  return "box";
}
CAny CBoxEntity::AsAny() {
  return CAny(this);
}
void CBoxEntity::JoinWorld() {
  Form form;
  form.box = true;
  form.half_x_m = 0.5 * m_cSize.GetX();
  form.half_y_m = 0.5 * m_cSize.GetY();
  form.height_m = m_cSize.GetZ();
  form.mass_kg = m_fMass;
  join(GetId(), *m_pcBody, *m_pcLEDs, form);
}
void CBoxEntity::LeaveWorld() {
  leave(*m_pcBody);
}
bool CBoxEntity::FindInWorld() {
  return find(GetId(), *m_pcBody);
}

// --- cylinders ---

CCylinderEntity::CCylinderEntity() : CCylinderEntity("", CVector3(), CQuaternion(), false, 0.5, 1.0) {}
CCylinderEntity::CCylinderEntity(const std::string& id, const CVector3& position, const CQuaternion& orientation,
                                 bool movable, Real radius, Real height, Real mass)
    : CComposableEntity(nullptr, id),
      m_pcBody(new CEmbodiedEntity(this, "body_0", position, orientation, movable)),
      m_pcLEDs(new CLEDEquippedEntity(this, "leds_0")),
      m_fRadius(radius),
      m_fHeight(height),
      m_fMass(mass) {
  AddComponent(*m_pcBody);
  AddComponent(*m_pcLEDs);
}
CCylinderEntity::~CCylinderEntity() {}
void CCylinderEntity::EnableLEDs(CLEDMedium&) {}
void CCylinderEntity::DisableLEDs() {
  darken(*m_pcLEDs);
}
void CCylinderEntity::AddLED(const CVector3& offset, const CColor& color) {
  m_pcLEDs->AddLED(offset, m_pcBody->GetOriginAnchor(), color);
}
void CCylinderEntity::Resize(Real radius, Real height) {
  change(GetId(), *m_pcBody, [&](Form& form) {
    form.radius_m = radius;
    form.height_m = height;
  });
  m_fRadius = radius;
  m_fHeight = height;
}
void CCylinderEntity::SetMass(Real mass) {
  change(GetId(), *m_pcBody, [&](Form& form) { form.mass_kg = mass; });
  m_fMass = mass;
}
std::string CCylinderEntity::GetTypeDescription() const {
  return "cylinder";
}
CAny CCylinderEntity::AsAny() {
  return CAny(this);
}
void CCylinderEntity::JoinWorld() {
  Form form;
  form.radius_m = m_fRadius;
  form.height_m = m_fHeight;
  form.mass_kg = m_fMass;
  join(GetId(), *m_pcBody, *m_pcLEDs, form);
}
void CCylinderEntity::LeaveWorld() {
  leave(*m_pcBody);
}
bool CCylinderEntity::FindInWorld() {
  return find(GetId(), *m_pcBody);
}

// --- lamps ---

CLightEntity::CLightEntity() : CLightEntity("", CVector3(), CColor::YELLOW, 1.0) {}
CLightEntity::CLightEntity(const std::string& id, const CVector3& position, const CColor& color, Real intensity)
    : CLEDEntity(nullptr, id, position, color), m_fIntensity(intensity), m_unLight(0) {}
CLightEntity::~CLightEntity() {}

namespace {

Lamp lamp_of(const CLightEntity& light) {
  const CVector3& p = light.GetPosition();
  const CColor& c = light.GetColor();
  return {light.GetId(),
          p.GetX(),
          p.GetY(),
          p.GetZ(),
          light.IsEnabled() ? light.GetIntensity() : 0.0,
          {c.GetRed(), c.GetGreen(), c.GetBlue()}};
}

}  // namespace

void CLightEntity::WriteWorld() {
  if (m_bInWorld && Session::get().entered()) world().set_lamp(m_unLight, lamp_of(*this));
}
void CLightEntity::SetIntensity(Real intensity) {
  m_fIntensity = intensity;
  WriteWorld();
}
void CLightEntity::SetColor(const CColor& color) {
  m_cColor = color;
  WriteWorld();
}
void CLightEntity::MoveTo(const CVector3& position, const CQuaternion& orientation) {
  CPositionalEntity::MoveTo(position, orientation);
  WriteWorld();
}
void CLightEntity::SetEnabled(bool enabled) {
  CEntity::SetEnabled(enabled);
  WriteWorld();
}
void CLightEntity::Reset() {
  CPositionalEntity::Reset();
  m_cColor = m_cInitColor;
  WriteWorld();
}
std::string CLightEntity::GetTypeDescription() const {
  return "light";
}
CAny CLightEntity::AsAny() {
  return CAny(this);
}
void CLightEntity::JoinWorld() {
  const std::string why = world().add_lamp(lamp_of(*this), m_unLight);
  if (!why.empty()) refuse(GetId(), why);
  m_bInWorld = true;
}
void CLightEntity::LeaveWorld() {
  if (m_bInWorld) world().remove_lamp(m_unLight);
  m_bInWorld = false;
}
bool CLightEntity::FindInWorld() {
  m_bInWorld = false;
  for (const auto& entry : world().lamps()) {
    if (entry.second.id != GetId()) continue;
    m_unLight = entry.first;
    m_bInWorld = true;
  }
  return m_bInWorld;
}

}  // namespace argos
