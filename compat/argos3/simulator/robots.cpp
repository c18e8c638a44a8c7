// Robots and their devices.
#include <algorithm>
#include <argos3/plugins/robots/e-puck/simulator/epuck_entity.h>
#include <argos3/plugins/robots/eye-bot/simulator/eyebot_entity.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/media/led_medium.h>
#include <argos3/plugins/simulator/media/rab_medium.h>

#include "compat/argos3/simulator/session.hpp"

namespace argos {

using tandem::compat::argos3::Body;
using tandem::compat::argos3::in_world;
using tandem::compat::argos3::Led;
using tandem::compat::argos3::place_of;
using tandem::compat::argos3::refuse;
using tandem::compat::argos3::Rgb8;
using tandem::compat::argos3::Session;
using tandem::compat::argos3::world;

namespace {

/// Of the robot, box or cylinder whose component this is; NONE: it is not in the world.
Body body_of(const CEntity& component) {
  auto* const root = dynamic_cast<CComposableEntity*>(const_cast<CEntity*>(&component.GetRootEntity()));
  if (root == nullptr || !root->HasComponent("body")) return {};
  const Body body = root->GetComponent<CEmbodiedEntity>("body").GetBody();
  return in_world(body) ? body : Body();
}

Rgb8 rgb_of(const CColor& color) {
  return {color.GetRed(), color.GetGreen(), color.GetBlue()};
}

}  // namespace

// --- LEDs ---

CLEDEntity::CLEDEntity(CComposableEntity* parent) : CLEDEntity(parent, "led_0", CVector3(), CColor::BLACK) {}
CLEDEntity::CLEDEntity(CComposableEntity* parent, const std::string& id, const CVector3& position, const CColor& color)
    : CPositionalEntity(parent, id, position), m_cColor(color), m_cInitColor(color) {}
CLEDEntity::~CLEDEntity() {}

const CColor& CLEDEntity::GetColor() const {
  if (m_pcOwner == nullptr) return m_cColor;
  const Body body = body_of(*m_pcOwner);
  if (body.Kind == Body::NONE || m_bUnlisted) return m_cColor;
  const std::vector<Led> leds = world().leds(body);
  if (m_unNumber < leds.size())
    m_cColor.Set(leds[m_unNumber].color.r, leds[m_unNumber].color.g, leds[m_unNumber].color.b);
  return m_cColor;
}
void CLEDEntity::SetColor(const CColor& color) {
  m_cColor = color;
  if (m_pcOwner == nullptr) return;
  const Body body = body_of(*m_pcOwner);
  if (body.Kind != Body::NONE) m_bUnlisted = !world().set_led(body, m_unNumber, rgb_of(color));
}
std::string CLEDEntity::GetTypeDescription() const {
  return "led";
}
CAny CLEDEntity::AsAny() {
  return CAny(this);
}

CLEDEquippedEntity::CLEDEquippedEntity(CComposableEntity* parent) : CLEDEquippedEntity(parent, "leds_0") {}
CLEDEquippedEntity::CLEDEquippedEntity(CComposableEntity* parent, const std::string& id)
    : CComposableEntity(parent, id) {}
CLEDEquippedEntity::~CLEDEquippedEntity() {
  for (SActuator* const led : m_tLEDs) delete led;
}
void CLEDEquippedEntity::AddLED(const CVector3& offset, SAnchor& anchor, const CColor& color) {
  if (body_of(*this).Kind != Body::NONE)
    refuse(GetRootEntity().GetId(), "LEDs are added before it is added to the space");
  auto* const led = new CLEDEntity(this, "led_" + std::to_string(m_tLEDs.size()), offset, color);
  led->m_pcOwner = this;
  led->m_unNumber = static_cast<UInt32>(m_tLEDs.size());
  AddComponent(*led);
  m_tLEDs.push_back(new SActuator(*led, offset, anchor));
}
/// Those of what is in the world already.
void CLEDEquippedEntity::FindLEDs() {
  const Body body = body_of(*this);
  if (!m_tLEDs.empty() || body.Kind == Body::NONE) return;
  SAnchor& anchor =
      static_cast<CComposableEntity&>(GetRootEntity()).GetComponent<CEmbodiedEntity>("body").GetOriginAnchor();
  for (const Led& found : world().leds(body)) {
    const CVector3 offset(found.x_m, found.y_m, found.z_m);
    auto* const led = new CLEDEntity(this, "led_" + std::to_string(m_tLEDs.size()), offset,
                                     CColor(found.color.r, found.color.g, found.color.b));
    led->m_pcOwner = this;
    led->m_unNumber = static_cast<UInt32>(m_tLEDs.size());
    AddComponent(*led);
    m_tLEDs.push_back(new SActuator(*led, offset, anchor));
  }
}
CLEDEquippedEntity::SActuator::TList& CLEDEquippedEntity::GetLEDs() {
  FindLEDs();
  return m_tLEDs;
}
CLEDEntity& CLEDEquippedEntity::GetLED(UInt32 number) {
  FindLEDs();
  if (number >= m_tLEDs.size())
    refuse(GetRootEntity().GetId(),
           "it has no LED " + std::to_string(number) + " but " + std::to_string(m_tLEDs.size()) + " of them");
  return m_tLEDs[number]->LED;
}
const CVector3& CLEDEquippedEntity::GetLEDOffset(size_t number) {
  GetLED(static_cast<UInt32>(number));
  return m_tLEDs[number]->Offset;
}
void CLEDEquippedEntity::SetLEDColor(UInt32 number, const CColor& color) {
  GetLED(number).SetColor(color);
}
void CLEDEquippedEntity::SetAllLEDsColors(const CColor& color) {
  for (SActuator* const led : GetLEDs()) led->LED.SetColor(color);
}
void CLEDEquippedEntity::SetAllLEDsColors(const std::vector<CColor>& colors) {
  for (std::size_t i = 0; i < colors.size(); ++i) SetLEDColor(static_cast<UInt32>(i), colors[i]);
}
std::string CLEDEquippedEntity::GetTypeDescription() const {
  return "leds";
}
CAny CLEDEquippedEntity::AsAny() {
  return CAny(this);
}

// --- range-and-bearing ---

CRABEquippedEntity::CRABEquippedEntity(CComposableEntity* parent) : CPositionalEntity(parent, "rab_0") {}
CRABEquippedEntity::~CRABEquippedEntity() {}
CEmbodiedEntity& CRABEquippedEntity::GetEntityBody() {
  return static_cast<CComposableEntity&>(GetRootEntity()).GetComponent<CEmbodiedEntity>("body");
}
size_t CRABEquippedEntity::GetMsgSize() const {
  return world().rab_bytes(body_of(*this));
}
CByteArray& CRABEquippedEntity::GetData() {
  const std::vector<std::uint8_t> bytes = world().message(body_of(*this));
  m_cData.Resize(bytes.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) m_cData[i] = bytes[i];
  return m_cData;
}
void CRABEquippedEntity::SetData(const CByteArray& data) {
  std::vector<std::uint8_t> bytes(data.Size());
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = data[i];
  if (!world().set_message(body_of(*this), bytes))
    refuse(GetRootEntity().GetId(),
           "its configuration lists no actuator range_and_bearing, or the message is too long");
}
void CRABEquippedEntity::ClearData() {
  world().set_message(body_of(*this), std::vector<std::uint8_t>(GetMsgSize(), 0));
}
Real CRABEquippedEntity::GetRange() const {
  return world().rab_range_m(body_of(*this));
}
const SAnchor& CRABEquippedEntity::GetAnchor() const {
  return const_cast<CRABEquippedEntity*>(this)->GetEntityBody().GetOriginAnchor();
}
std::string CRABEquippedEntity::GetTypeDescription() const {
  return "rab";
}
CAny CRABEquippedEntity::AsAny() {
  return CAny(this);
}

CLEDMedium::~CLEDMedium() {}
CRABMedium::~CRABMedium() {}
const CRABEquippedEntity::TSet& CRABMedium::GetRABsCommunicatingWith(CRABEquippedEntity& entity) const {
  CRABEquippedEntity::TSet& near = entity.m_tNear;
  near.clear();
  const CVector3 here = entity.GetAnchor().Position;
  for (const auto& entry : CSimulator::GetInstance().GetSpace().GetEntitiesByType("rab")) {
    auto* const other = any_cast<CRABEquippedEntity*>(entry.second);
    if (other != &entity && Distance(here, other->GetAnchor().Position) < Min(entity.GetRange(), other->GetRange()))
      near.insert(other);
  }
  return near;
}

// --- wheels and battery ---

CWheeledEntity::CWheeledEntity(CComposableEntity* parent, const std::string& id, size_t) : CEntity(parent, id) {}
CWheeledEntity::~CWheeledEntity() {}
const CVector3* CWheeledEntity::GetWheelPositions() const {
  const Real half = 0.5 * world().wheel_base_m(body_of(*this));
  m_cPositions[0].Set(0.0, half, 0.0);
  m_cPositions[1].Set(0.0, -half, 0.0);
  return m_cPositions;
}
const CVector3& CWheeledEntity::GetWheelPosition(size_t number) const {
  if (number > 1) refuse(GetRootEntity().GetId(), "it has two wheels, 0 and 1");
  return GetWheelPositions()[number];
}
const Real* CWheeledEntity::GetWheelVelocities() const {
  const auto speeds = world().wheels_m_s(body_of(*this));
  std::copy(speeds.begin(), speeds.end(), m_fVelocities);
  return m_fVelocities;
}
Real CWheeledEntity::GetWheelVelocity(size_t number) const {
  if (number > 1) refuse(GetRootEntity().GetId(), "it has two wheels, 0 and 1");
  return GetWheelVelocities()[number];
}
void CWheeledEntity::SetVelocities(Real* speeds) {
  if (!world().set_wheels_m_s(body_of(*this), {speeds[0], speeds[1]}))
    refuse(GetRootEntity().GetId(), "its configuration lists no actuator differential_steering");
}
std::string CWheeledEntity::GetTypeDescription() const {
  return "wheels";
}
CAny CWheeledEntity::AsAny() {
  return CAny(this);
}

CBatteryEquippedEntity::CBatteryEquippedEntity(CComposableEntity* parent, const std::string& id)
    : CEntity(parent, id) {}
CBatteryEquippedEntity::~CBatteryEquippedEntity() {}
Real CBatteryEquippedEntity::GetAvailableCharge() const {
  return world().battery(body_of(*this));
}
void CBatteryEquippedEntity::SetAvailableCharge(Real charge) {
  const std::string why = world().set_battery(body_of(*this), charge);
  if (!why.empty()) refuse(GetRootEntity().GetId(), why);
}
std::string CBatteryEquippedEntity::GetTypeDescription() const {
  return "battery";
}
CAny CBatteryEquippedEntity::AsAny() {
  return CAny(this);
}

// --- robots ---

CRobotEntity::CRobotEntity(const std::string& kind, const std::string& id, const std::string& controller,
                           const CVector3& position, const CQuaternion& orientation)
    : CComposableEntity(nullptr, id),
      m_strKind(kind),
      m_pcController(new CControllableEntity(this, "controller_0")),
      m_pcBody(new CEmbodiedEntity(this, "body_0", position, orientation)),
      m_pcLEDs(new CLEDEquippedEntity(this, "leds_0")),
      m_pcRAB(new CRABEquippedEntity(this)),
      m_pcBattery(new CBatteryEquippedEntity(this, "battery_0")),
      m_pcWheels(kind == "eye-bot" ? nullptr : new CWheeledEntity(this, "wheels_0", 2)) {
  m_pcController->SetController(controller);
  const std::initializer_list<CEntity*> parts = {m_pcController, m_pcBody, m_pcLEDs, m_pcRAB, m_pcBattery, m_pcWheels};
  for (CEntity* const component : parts) {
    if (component != nullptr) AddComponent(*component);
  }
  if (kind == "foot-bot") m_pcBody->AddAnchor("turret");
}
CRobotEntity::~CRobotEntity() {}
CWheeledEntity& CRobotEntity::Wheels() {
  return *m_pcWheels;
}
CAny CRobotEntity::AsAny() {
  return CAny(this);
}
void CRobotEntity::JoinWorld() {
  Body added;
  const std::string why =
      world().add_robot({{}, GetId(), m_strKind, m_pcController->GetControllerId()},
                        place_of(m_pcBody->GetInitPosition(), m_pcBody->GetInitOrientation()), added);
  if (!why.empty()) refuse(GetId(), why);
  m_pcBody->SetBody(added);
  m_strIdInWorld = world().id_in_world(added);
}
void CRobotEntity::LeaveWorld() {
  const Body body = body_of(*this);
  if (body.Kind != Body::NONE) world().remove(body);
}
bool CRobotEntity::FindInWorld() {
  const Body found = world().find_robot(GetId());
  if (found.Kind == Body::NONE) return false;
  m_pcBody->SetBody(found);
  m_strIdInWorld = GetId();
  return true;
}

namespace {

/// Radio, cameras and battery of a robot that loop functions make are those of the file's robots: said once.
void note_unused(const char* kind, const std::string& id, bool asks_for_others) {
  static bool said = false;
  if (!asks_for_others || said || !Session::get().entered()) return;
  said = true;
  world().warn(std::string(kind) + " '" + id +
               "' asks its constructor for a radio, cameras or a battery of its own: it gets those of the file's first "
               "robot of its kind and configuration (rab_range, rab_data_size, <battery> there)");
}

}  // namespace

CFootBotEntity::CFootBotEntity() : CRobotEntity("foot-bot", "", "") {}
CFootBotEntity::CFootBotEntity(const std::string& id, const std::string& controller, const CVector3& position,
                               const CQuaternion& orientation, Real rab_range, size_t rab_data_size,
                               const std::string& battery_model, const CRadians&, bool, const CRadians&, Real, Real)
    : CRobotEntity("foot-bot", id, controller, position, orientation) {
  note_unused("foot-bot", id, rab_range != 3.0 || rab_data_size != 10 || !battery_model.empty());
}
CFootBotEntity::~CFootBotEntity() {}
CAny CFootBotEntity::AsAny() {
  return CAny(this);
}

CEPuckEntity::CEPuckEntity() : CRobotEntity("e-puck", "", "") {}
CEPuckEntity::CEPuckEntity(const std::string& id, const std::string& controller, const CVector3& position,
                           const CQuaternion& orientation, Real rab_range, size_t rab_data_size,
                           const std::string& battery_model)
    : CRobotEntity("e-puck", id, controller, position, orientation) {
  note_unused("e-puck", id, Abs(rab_range - 0.8) > 1e-6 || rab_data_size != 2 || !battery_model.empty());
}
CEPuckEntity::~CEPuckEntity() {}
CAny CEPuckEntity::AsAny() {
  return CAny(this);
}

CEyeBotEntity::CEyeBotEntity() : CRobotEntity("eye-bot", "", "") {}
CEyeBotEntity::CEyeBotEntity(const std::string& id, const std::string& controller, const CVector3& position,
                             const CQuaternion& orientation, Real rab_range, size_t rab_data_size,
                             const std::string& battery_model, const CRadians&, Real, Real)
    : CRobotEntity("eye-bot", id, controller, position, orientation) {
  note_unused("eye-bot", id, rab_range != 3.0 || rab_data_size != 10 || !battery_model.empty());
}
CEyeBotEntity::~CEyeBotEntity() {}
CAny CEyeBotEntity::AsAny() {
  return CAny(this);
}

}  // namespace argos
