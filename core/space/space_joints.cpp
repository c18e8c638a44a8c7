// Joints, lamps and sounds of a space.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/space/space.hpp"
#include "core/space/space_errors.hpp"
#include "core/space/stores.hpp"
#include "hal/angle.hpp"
#include "hal/check.hpp"
#include "hal/finite.hpp"

namespace tandem::core {

hal::Result<BodyKey> Space::key_of(const BodyId& body) const {
  if (body.robot.valid()) {
    if (!contains(body.robot)) return gone("robot");
    return BodyKey::robot(stores_->row_of(body.robot));
  }
  if (!contains(body.object)) return gone("object");
  if (!stores_->objects[body.object.index].movable) {
    return hal::Error{"object '" + stores_->objects[body.object.index].id +
                      "' is not movable: only what engines move can be joined"};
  }
  return BodyKey::object(body.object.index);
}

namespace {

/// What is wrong with how a joint is to hold; null: nothing.
const char* flaw_of(const JointForm& form) noexcept {
  const auto& axis = form.axis;
  if (form.kind != JointKind::Fixed && form.kind != JointKind::Turning && form.kind != JointKind::Sliding)
    return "a joint is fixed, turning or sliding";
  if (form.kind == JointKind::Sliding &&
      !(std::fabs(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2] - 1.0) < 1e-6))
    return "the axis of a sliding joint needs the length 1";
  if (form.limited && !(form.low <= form.high && std::isfinite(form.low) && std::isfinite(form.high)))
    return "the limits of a joint need to be finite, the lower one first";
  if (form.limited && form.kind == JointKind::Turning &&
      !(form.low > -std::numbers::pi && form.high < std::numbers::pi))
    return "the limits of a turning joint need to lie between half a turn to the right and to the left";
  if (!(form.motor_most >= 0.0 && std::isfinite(form.motor_most) && std::isfinite(form.motor_speed)))
    return "the motor of a joint needs a finite strength from 0 and a finite speed";
  return nullptr;
}

/// Of a body, with z of its base.
Pose place_of(const SpaceStores& s, BodyKey body) noexcept {
  const std::size_t i = body.index();
  if (body.is_object()) {
    const Object& o = s.objects[i];
    return {o.x_m, o.y_m, o.z_low_m, o.cos_h, o.sin_h};
  }
  return {s.bodies.x_m[i], s.bodies.y_m[i], s.base_m(i), s.bodies.cos_h[i], s.bodies.sin_h[i]};
}

}  // namespace

hal::Result<JointId> Space::join(BodyId a, BodyId b, const std::array<double, 3>& p_W, const JointForm& form) {
  const hal::Result<BodyKey> key_a = key_of(a);
  if (!key_a.ok()) return key_a.error();
  const hal::Result<BodyKey> key_b = key_of(b);
  if (!key_b.ok()) return key_b.error();
  if (key_a.value() == key_b.value()) return hal::Error{"a body cannot be joined to itself"};
  if (!hal::all_finite(p_W)) return hal::Error{"the point of a joint is not finite"};
  if (const char* flaw = flaw_of(form); flaw != nullptr) return hal::Error{flaw};
  return editor_ == nullptr ? no_world() : editor_->join(key_a.value(), key_b.value(), p_W, form);
}

hal::Status Space::drive(JointId joint, double speed) {
  if (!contains(joint)) return gone("joint");
  JointForm& form = stores_->joints[joint.index].form;
  if (!(form.motor_most > 0.0)) return hal::Error{"the joint has no motor: make it with motor_most above 0"};
  if (!std::isfinite(speed)) return hal::Error{"the speed for a joint is not finite"};
  form.motor_speed = speed;
  return {};
}

double Space::place(JointId id) const noexcept {
  if (!contains(id)) return 0.0;
  const Joint& joint = stores_->joints[id.index];
  const Pose a = place_of(*stores_, joint.a);
  const Pose b = place_of(*stores_, joint.b);
  if (joint.form.kind == JointKind::Turning)
    return std::atan2(b.sin_h * a.cos_h - b.cos_h * a.sin_h, b.cos_h * a.cos_h + b.sin_h * a.sin_h);
  if (joint.form.kind != JointKind::Sliding) return 0.0;
  const double x = b.x_m + b.cos_h * joint.bx_m - b.sin_h * joint.by_m - a.x_m;
  const double y = b.y_m + b.sin_h * joint.bx_m + b.cos_h * joint.by_m - a.y_m;
  const auto& axis = joint.form.axis;
  return axis[0] * (a.cos_h * x + a.sin_h * y - joint.ax_m) + axis[1] * (a.cos_h * y - a.sin_h * x - joint.ay_m) +
         axis[2] * (b.z_m + joint.bz_m - a.z_m - joint.az_m);
}

void Space::release(JointId joint) noexcept {
  if (!contains(joint)) return;
  stores_->joints[joint.index].alive = false;
  stores_->bodies_changed = true;
}

bool Space::contains(JointId joint) const noexcept {
  const auto& joints = stores_->joints;
  return joint.index < joints.size() && joints[joint.index].alive && joints[joint.index].generation == joint.generation;
}

void Space::release_joints_of(BodyKey body) noexcept {
  for (Joint& joint : stores_->joints) {
    if (joint.a == body || joint.b == body) joint.alive = false;
  }
}

const std::vector<LightSource>& Space::lights() const noexcept {
  return stores_->lights;
}
const std::vector<SoundSource>& Space::sounds() const noexcept {
  return stores_->sounds;
}

hal::Result<std::size_t> Space::add_light(const LightSource& light) {
  if (light.id.empty() || had(light.id)) return taken(light.id);
  stores_->lights.push_back(light);
  stores_->lights.back().alive = true;
  stores_->altered = true;
  return stores_->lights.size() - 1;
}

hal::Result<std::size_t> Space::add_sound(const SoundSource& sound) {
  if (sound.id.empty() || had(sound.id)) return taken(sound.id);
  stores_->sounds.push_back(sound);
  stores_->sounds.back().alive = true;
  stores_->altered = true;
  return stores_->sounds.size() - 1;
}

void Space::set_light(std::size_t i, const LightSource& light) {
  TANDEM_CHECK(i < stores_->lights.size(), "set_light: there is no light of that number");
  stores_->lights[i] = light;
  stores_->altered = true;
}

void Space::set_sound(std::size_t i, const SoundSource& sound) {
  TANDEM_CHECK(i < stores_->sounds.size(), "set_sound: there is no sound of that number");
  stores_->sounds[i] = sound;
  stores_->altered = true;
}

void Space::remove_light(std::size_t i) {
  TANDEM_CHECK(i < stores_->lights.size(), "remove_light: there is no light of that number");
  stores_->lights[i].alive = false;
  stores_->altered = true;
}

void Space::remove_sound(std::size_t i) {
  TANDEM_CHECK(i < stores_->sounds.size(), "remove_sound: there is no sound of that number");
  stores_->sounds[i].alive = false;
  stores_->altered = true;
}

}  // namespace tandem::core
