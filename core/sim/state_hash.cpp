#include "core/sim/state_hash.hpp"

#include <cstring>

namespace tandem::core {
namespace {

/// Mixes a value into a hash; every bit of the value reaches every bit of the result [finaliser of Murmur3].
std::uint64_t mix(std::uint64_t hash, std::uint64_t value) noexcept {
  std::uint64_t x = hash ^ (value + 0x9E3779B97F4A7C15ULL + (hash << 6) + (hash >> 2));
  x = (x ^ (x >> 33)) * 0xFF51AFD7ED558CCDULL;
  x = (x ^ (x >> 33)) * 0xC4CEB9FE1A85EC53ULL;
  return x ^ (x >> 33);
}

std::uint64_t bits_of(double value) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::uint64_t mix_motion(std::uint64_t hash, const Motion& m) noexcept {
  hash = mix(hash, bits_of(m.z_m));
  for (const double value : m.q_WB) hash = mix(hash, bits_of(value));
  for (const double value : m.v_m_s) hash = mix(hash, bits_of(value));
  for (const double value : m.w_rad_s) hash = mix(hash, bits_of(value));
  return hash;
}

std::uint64_t mix_mechanisms(std::uint64_t hash, const Bodies& b, std::size_t row) noexcept {
  if (!b.turrets.empty()) {
    const TurretState& t = b.turrets[row];
    hash = mix(hash, static_cast<std::uint64_t>(t.mode));
    for (const double value : {t.target, t.angle_rad, t.speed_rad_s}) hash = mix(hash, bits_of(value));
  }
  if (!b.grips.empty()) {
    const GripState& g = b.grips[row];
    hash = mix(mix(hash, g.holding() ? 1 : 0), g.grips);
    for (const double value : {g.aperture_rad, g.turn_rad}) hash = mix(hash, bits_of(value));
  }
  if (!b.scanners.empty()) {
    const ScannerState& s = b.scanners[row];
    hash = mix(mix(hash, static_cast<std::uint64_t>(s.mode)), bits_of(s.angle_rad));
  }
  if (!b.hidden_rolls.empty()) {
    const HiddenRoll& h = b.hidden_rolls[row];
    for (const double value : {h.left_m, h.right_m, h.left_m_s, h.right_m_s}) hash = mix(hash, bits_of(value));
  }
  if (!b.heads.empty()) {
    const HeadState& h = b.heads[row];
    hash = mix(mix(mix(hash, bits_of(h.pan_rad)), bits_of(h.tilt_rad)), h.laser ? 1 : 0);
  }
  if (!b.rotors.empty() && b.rotors[row].spun) {
    for (const double value : b.rotors[row].thrust_N) hash = mix(hash, bits_of(value));
  }
  return hash;
}

std::uint64_t mix_pilot(std::uint64_t hash, const PilotState& p) noexcept {
  hash = mix(mix(hash, static_cast<std::uint64_t>(p.phase)), static_cast<std::uint64_t>(p.order));
  hash = mix(mix(hash, p.started ? 1 : 0), p.stuck_ticks);
  for (const double value : {p.place_m[0], p.place_m[1], p.place_m[2], p.heading_rad}) hash = mix(hash, bits_of(value));
  return hash;
}

/// What stays as the file has it unless a hook changes it.
std::uint64_t mix_scenery(std::uint64_t hash, const SpaceStores& s) noexcept {
  hash = mix(hash, s.robots.size());  // decides what numbers the next robot draws
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.alive || o.movable) continue;
    hash = mix(hash, i);
    for (const double value :
         {o.x_m, o.y_m, o.cos_h, o.sin_h, o.half_x_m, o.half_y_m, o.radius_m, o.z_low_m, o.z_high_m})
      hash = mix(hash, bits_of(value));
  }
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.lit()) continue;
    hash = mix(hash, i);
    for (const ObjectLed& led : o.leds) {
      for (const double value : {led.x_m, led.y_m, led.z_m}) hash = mix(hash, bits_of(value));
      hash = mix(hash, static_cast<std::uint64_t>(led.color.r | led.color.g << 8U | led.color.b << 16U));
    }
  }
  for (const LightSource& light : s.lights) {
    if (!light.alive) continue;
    for (const double value : {light.x_m, light.y_m, light.z_m, light.intensity}) hash = mix(hash, bits_of(value));
  }
  for (const SoundSource& sound : s.sounds) {
    if (!sound.alive) continue;
    for (const double value : {sound.x_m, sound.y_m, sound.z_m, sound.level}) hash = mix(hash, bits_of(value));
  }
  return hash;
}

}  // namespace

std::uint64_t hash_of_state(const SpaceStores& s, std::uint64_t seed, hal::Tick tick) noexcept {
  const Bodies& b = s.bodies;
  std::uint64_t hash = mix(seed, static_cast<std::uint64_t>(tick));
  for (const std::uint32_t entity : s.living) {
    const RobotEntity& e = s.robots[entity];
    const RobotBlock& block = s.blocks[e.block];
    const RobotGroup& group = s.groups[block.group];
    const std::size_t row = block.first_row + e.slot;
    hash = mix(hash, entity);
    for (const auto* quantity : {&b.x_m, &b.y_m, &b.cos_h, &b.sin_h, &b.left_m, &b.right_m})
      hash = mix(hash, bits_of((*quantity)[row]));
    hash = mix(hash, block.halted[e.slot]);
    if (!b.motion.empty()) {
      hash = mix(hash, b.region[row]);
      hash = mix_motion(hash, b.motion[row]);
    }
    if (!b.flight.empty()) {
      const FlightCommand& f = b.flight[row];
      hash = mix(hash, static_cast<std::uint64_t>(f.mode));
      for (const double value : {f.target[0], f.target[1], f.target[2], f.yaw}) hash = mix(hash, bits_of(value));
    }
    if (group.flight_task >= 0) hash = mix_pilot(hash, b.pilots[row]);
    hash = mix_mechanisms(hash, b, row);
    // Every port as the controller saw and left it, but the padding between fields.
    for (std::size_t i = 0; i < group.ports.size(); ++i) {
      const hal::PortType& type = *group.ports[i];
      const void* port = block.ports[i] + e.slot * type.size;
      for (const hal::Field& field : type.fields) {
        for (std::size_t k = 0; k < hal::used_count(type, port, field); ++k)
          hash = mix(hash, bits_of(hal::get_value(port, field, k)));
      }
    }
  }
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.movable || !o.alive) continue;
    hash = mix(mix(hash, i), s.object_region[i]);
    for (const double value : {o.x_m, o.y_m, o.cos_h, o.sin_h, o.z_low_m}) hash = mix(hash, bits_of(value));
    hash = mix_motion(hash, s.object_motion[i]);
  }
  for (const Joint& joint : s.joints) {
    if (!joint.alive) continue;
    hash = mix(mix(hash, joint.a.value), joint.b.value);
    for (const double value :
         {joint.ax_m, joint.ay_m, joint.az_m, joint.bx_m, joint.by_m, joint.bz_m, joint.heading_rad})
      hash = mix(hash, bits_of(value));
    if (joint.motor_torque_Nm > 0.0) hash = mix(mix(hash, bits_of(joint.motor_torque_Nm)), bits_of(joint.motor_rad_s));
  }
  return s.altered ? mix_scenery(hash, s) : hash;
}

}  // namespace tandem::core
