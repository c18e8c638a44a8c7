#include "core/space/space.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/space/stores.hpp"
#include "hal/check.hpp"

namespace tandem::core {

double Pose::heading_rad() const noexcept {
  return std::atan2(sin_h, cos_h);
}

double Object::reach_m() const noexcept {
  return kind == Kind::Cylinder ? radius_m : std::hypot(half_x_m, half_y_m);
}

void Bodies::resize(std::size_t rows) {
  for (auto* array : {&x_m, &y_m, &sin_h, &left_m_s, &right_m_s, &left_m, &right_m}) array->resize(rows, 0.0);
  cos_h.resize(rows, 1.0);
  radius_m.resize(rows, 0.0F);
  flags.resize(rows, 0);
  entity.resize(rows, 0xFFFFFFFFU);
  region.resize(rows, 0);
  if (has_motion) motion.resize(rows);
  if (!flight.empty()) flight.resize(rows);
  if (!turrets.empty()) turrets.resize(rows);
  if (!grips.empty()) grips.resize(rows);
  if (!scanners.empty()) scanners.resize(rows);
  if (!hidden_rolls.empty()) hidden_rolls.resize(rows);
}

void Bodies::reserve(std::size_t rows) {
  for (auto* array : {&x_m, &y_m, &cos_h, &sin_h, &left_m_s, &right_m_s, &left_m, &right_m}) array->reserve(rows);
  radius_m.reserve(rows);
  flags.reserve(rows);
  entity.reserve(rows);
  region.reserve(rows);
  if (has_motion) motion.reserve(rows);
}

Space::Space() : stores_(std::make_unique<SpaceStores>()) {}
Space::~Space() = default;

std::size_t Space::robot_count() const noexcept {
  return stores_->living.size();
}

RobotId Space::robot(std::size_t i) const noexcept {
  const std::uint32_t entity = stores_->living[i];
  return {entity, stores_->robots[entity].generation};
}

RobotId Space::find_robot(std::string_view id) const noexcept {
  for (const NameRange& range : stores_->names) {
    if (!id.starts_with(range.prefix)) continue;
    std::uint32_t entity = range.first_entity;
    const std::string_view digits = id.substr(range.prefix.size());
    if (range.base < 0) {
      if (!digits.empty()) continue;
    } else {
      std::int64_t number = 0;
      const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
      const bool plain =
          status == std::errc{} && end == digits.data() + digits.size() && (digits.size() == 1 || digits[0] != '0');
      if (!plain || number < range.base || number >= range.base + range.count) continue;
      entity += static_cast<std::uint32_t>(number - range.base);
    }
    if (stores_->robots[entity].alive) return {entity, stores_->robots[entity].generation};
  }
  return {};
}

std::string Space::robot_name(RobotId robot) const {
  const RobotEntity& e = stores_->robots[robot.index];
  const std::string& prefix = stores_->names[e.item].prefix;
  return e.number < 0 ? prefix : prefix + std::to_string(e.number);
}

const hal::DataSheet& Space::data_sheet(RobotId robot) const noexcept {
  return *stores_->groups[stores_->blocks[stores_->robots[robot.index].block].group].sheet;
}

Pose Space::pose(RobotId robot) const noexcept {
  const std::size_t row = stores_->row_of(robot);
  const Bodies& b = stores_->bodies;
  return {b.x_m[row], b.y_m[row], b.motion.empty() ? 0.0 : b.motion[row].z_m, b.cos_h[row], b.sin_h[row]};
}

void Space::set_pose(RobotId robot, const Pose& pose) noexcept {
  const std::size_t row = stores_->row_of(robot);
  Bodies& b = stores_->bodies;
  b.x_m[row] = pose.x_m;
  b.y_m[row] = pose.y_m;
  b.cos_h[row] = pose.cos_h;
  b.sin_h[row] = pose.sin_h;
  if (!b.motion.empty()) {
    const double yaw_rad = pose.heading_rad();
    b.motion[row].z_m = pose.z_m;
    b.motion[row].q_WB = {std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad)};
  }
  b.flags[row] |= kMoved;
  stores_->bodies_changed = true;
}

void Space::remove_robot(RobotId robot) noexcept {
  RobotEntity& e = stores_->robots[robot.index];
  if (!e.alive || e.generation != robot.generation) return;
  set_halted(robot, true);
  const std::size_t row = stores_->row_of(robot);
  stores_->bodies.flags[row] = 0;
  stores_->bodies.left_m_s[row] = 0.0;
  stores_->bodies.right_m_s[row] = 0.0;
  if (!stores_->broadcasts.empty()) stores_->broadcasts[row].sending = 0;
  e.alive = false;
  ++e.generation;
  stores_->bodies_changed = true;
  std::erase(stores_->living, robot.index);
}

double Space::turret_rad(RobotId robot) const noexcept {
  const Bodies& b = stores_->bodies;
  return b.turrets.empty() ? 0.0 : b.turrets[stores_->row_of(robot)].angle_rad;
}

bool Space::holding(RobotId robot) const noexcept {
  const Bodies& b = stores_->bodies;
  return !b.grips.empty() && b.grips[stores_->row_of(robot)].holding();
}

bool Space::halted(RobotId robot) const noexcept {
  const RobotEntity& e = stores_->robots[robot.index];
  return stores_->blocks[e.block].halted[e.slot] != 0;
}

void Space::set_halted(RobotId robot, bool halted) noexcept {
  const RobotEntity& e = stores_->robots[robot.index];
  stores_->blocks[e.block].halted[e.slot] = halted ? 1 : 0;
  if (halted) {
    // Every actuator to its safe value.
    const RobotBlock& block = stores_->blocks[e.block];
    const RobotGroup& group = stores_->groups[block.group];
    for (std::size_t i = 0; i < group.ports.size(); ++i) {
      const hal::PortType& type = *group.ports[i];
      if (type.role == hal::Role::Actuator) type.reset(block.ports[i] + e.slot * type.size);
    }
  }
}

bool Space::external(RobotId robot) const noexcept {
  return (stores_->bodies.flags[stores_->row_of(robot)] & kExternal) != 0;
}

void Space::set_external(RobotId robot, bool external) noexcept {
  std::uint8_t& flags = stores_->bodies.flags[stores_->row_of(robot)];
  flags = static_cast<std::uint8_t>(external ? flags | kExternal : flags & ~kExternal);
}

const void* Space::port(RobotId robot, const hal::PortType& type) const noexcept {
  const RobotEntity& e = stores_->robots[robot.index];
  const RobotBlock& block = stores_->blocks[e.block];
  const RobotGroup& group = stores_->groups[block.group];
  for (std::size_t i = 0; i < group.ports.size(); ++i) {
    if (group.ports[i]->layout == type.layout && group.ports[i]->role == type.role) {
      return block.ports[i] + e.slot * type.size;
    }
  }
  return nullptr;
}

void* Space::port(RobotId robot, const hal::PortType& type) noexcept {
  return const_cast<void*>(static_cast<const Space*>(this)->port(robot, type));
}

std::vector<const hal::PortType*> Space::ports(RobotId robot) const {
  return stores_->groups[stores_->blocks[stores_->robots[robot.index].block].group].ports;
}

const std::vector<Object>& Space::objects() const noexcept {
  return stores_->objects;
}
const std::vector<LightSource>& Space::lights() const noexcept {
  return stores_->lights;
}
const std::vector<SoundSource>& Space::sounds() const noexcept {
  return stores_->sounds;
}

void Space::set_light(std::size_t i, const LightSource& light) {
  TANDEM_CHECK(i < stores_->lights.size(), "set_light: there is no light of that number");
  stores_->lights[i] = light;
}

void Space::set_sound(std::size_t i, const SoundSource& sound) {
  TANDEM_CHECK(i < stores_->sounds.size(), "set_sound: there is no sound of that number");
  stores_->sounds[i] = sound;
}

double Space::arena_size_x_m() const noexcept {
  return stores_->max_x_m - stores_->min_x_m;
}
double Space::arena_size_y_m() const noexcept {
  return stores_->max_y_m - stores_->min_y_m;
}
double Space::arena_center_x_m() const noexcept {
  return 0.5 * (stores_->max_x_m + stores_->min_x_m);
}
double Space::arena_center_y_m() const noexcept {
  return 0.5 * (stores_->max_y_m + stores_->min_y_m);
}
double Space::floor(double x_m, double y_m) const noexcept {
  return static_cast<double>(stores_->floor.at(x_m, y_m));
}
void Space::repaint_floor() noexcept {
  stores_->repaint_floor = true;
}

}  // namespace tandem::core
