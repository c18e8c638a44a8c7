#include "core/space/space.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/scenario/scenario.hpp"
#include "core/space/space_errors.hpp"
#include "core/space/stores.hpp"
#include "hal/finite.hpp"

namespace tandem::core {

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
  const std::optional<std::uint32_t> entity = stores_->find_entity(id);
  if (!entity || !stores_->robots[*entity].alive) return {};
  return {*entity, stores_->robots[*entity].generation};
}

bool Space::contains(RobotId robot) const noexcept {
  return stores_->contains(robot);
}

bool Space::had(std::string_view id) const noexcept {
  const auto same = [&](const auto& thing) { return thing.id == id; };
  const SpaceStores& s = *stores_;
  return s.find_entity(id).has_value() || s.object_numbers.contains(std::string(id)) ||
         std::any_of(s.lights.begin(), s.lights.end(), same) || std::any_of(s.sounds.begin(), s.sounds.end(), same);
}

hal::Error gone(const char* what) {
  return {std::string("there is no such ") + what +
          ", or no more: it was removed, or added after the moment that the "
          "run went back to"};
}

hal::Error taken(const std::string& id) {
  return id.empty()
             ? hal::Error{"an id must not be empty"}
             : hal::Error{"the id '" + id + "' is taken, or was by something that has been removed; give another"};
}

hal::Error no_world() {
  return {"this space belongs to no world: nothing can be added to it"};
}

namespace {

hal::Error no_field(std::string_view name, const SpaceStores& s) {
  std::vector<std::string> names;
  for (const Fields::Entry& entry : s.fields.all()) names.push_back(entry.name);
  return {"there is no field '" + std::string(name) + "'; there are: " + listed(names) + did_you_mean(name, names)};
}

hal::Error without_battery(const std::string& robot) {
  return {"robot '" + robot + "' has no battery: its controller takes no sensor of that name"};
}

/// What its configuration counts as full.
double full_charge(const SpaceStores& s, RobotId robot) noexcept {
  return s.groups[s.blocks[s.robots[robot.index].block].group].item->battery.full_charge;
}

}  // namespace

hal::Result<RobotId> Space::add_robot(const NewRobot& wanted) {
  if (wanted.id.empty() || had(wanted.id)) return taken(wanted.id);
  return editor_ == nullptr ? no_world() : editor_->add_robot(wanted);
}

std::string Space::robot_name(RobotId robot) const {
  if (robot.index >= stores_->robots.size()) return {};
  const RobotEntity& e = stores_->robots[robot.index];
  const std::string& prefix = stores_->names[e.item].prefix;
  return e.number < 0 ? prefix : prefix + std::to_string(e.number);
}

const hal::RobotKind& Space::kind(RobotId robot) const noexcept {
  static const hal::RobotKind none;
  if (robot.index >= stores_->robots.size()) return none;
  return *stores_->groups[stores_->blocks[stores_->robots[robot.index].block].group].kind;
}

Pose Space::pose(RobotId robot) const noexcept {
  if (!contains(robot)) return {};
  const std::size_t row = stores_->row_of(robot);
  const Bodies& b = stores_->bodies;
  return {b.x_m[row], b.y_m[row], b.motion.empty() ? 0.0 : b.motion[row].z_m, b.cos_h[row], b.sin_h[row]};
}

void Space::set_pose(RobotId robot, const Pose& pose) noexcept {
  if (!contains(robot)) return;
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
  stores_->touch(BodyKey::robot(row));
}

Velocity Space::velocity(RobotId robot) const noexcept {
  if (!contains(robot)) return {};
  const std::size_t row = stores_->row_of(robot);
  const Bodies& b = stores_->bodies;
  const std::uint16_t region = b.region[row];
  if (!b.motion.empty() && region != kNoRegion && stores_->regions[region].listed)
    return {b.motion[row].v_m_s, b.motion[row].w_rad_s};
  const hal::DifferentialDrive* const drive = kind(robot).drive();
  const double speed = 0.5 * (b.left_m_s[row] + b.right_m_s[row]);
  const double turn = drive != nullptr ? (b.right_m_s[row] - b.left_m_s[row]) / drive->wheel_base_m : 0.0;
  return {{b.cos_h[row] * speed, b.sin_h[row] * speed, 0.0}, {0.0, 0.0, turn}};
}

hal::Status Space::set_velocity(RobotId robot, const Velocity& velocity) {
  if (!contains(robot)) return gone("robot");
  if (!hal::all_finite(velocity.v_m_s) || !hal::all_finite(velocity.w_rad_s))
    return hal::Error{"the velocity for robot '" + robot_name(robot) + "' is not finite"};
  const std::size_t row = stores_->row_of(robot);
  Bodies& b = stores_->bodies;
  const std::uint16_t region = b.region[row];
  if (b.motion.empty() || region == kNoRegion || !stores_->regions[region].listed) {
    return hal::Error{"the engine of robot '" + robot_name(robot) +
                      "' keeps no velocities; command its wheels instead, or give it an engine with forces"};
  }
  b.motion[row].v_m_s = velocity.v_m_s;
  b.motion[row].w_rad_s = velocity.w_rad_s;
  return {};
}

hal::Result<double> Space::battery(RobotId robot) const {
  if (!contains(robot)) return gone("robot");
  const auto* kept = state<ChargeState>(robot);
  if (kept == nullptr) return without_battery(robot_name(robot));
  const double full = full_charge(*stores_, robot);
  return full > 0.0 ? kept->charge / full : 0.0;
}

hal::Status Space::set_battery(RobotId robot, double charge) {
  if (!contains(robot)) return gone("robot");
  if (!(charge >= 0.0 && charge <= 1.0)) return hal::Error{"a battery's charge is a part of the full one, 0 to 1"};
  auto* kept = state<ChargeState>(robot);
  if (kept == nullptr) return without_battery(robot_name(robot));
  kept->charge = charge * full_charge(*stores_, robot);
  return {};
}

void Space::remove_robot(RobotId robot) noexcept {
  if (!contains(robot)) return;
  SpaceStores& s = *stores_;
  RobotEntity& e = s.robots[robot.index];
  RobotBlock& block = s.blocks[e.block];
  RobotGroup& group = s.groups[block.group];
  const std::size_t row = s.row_of(robot);
  set_halted(robot, true, HaltOwner::Removed);
  if (block.constructed[e.slot] != 0) group.controller->destroy(block.controller(e.slot));
  block.constructed[e.slot] = 0;
  if (e.slot < block.params.size()) block.params[e.slot].reset();
  // A twin keeps pointers to its robot's ports: nobody else ever gets these.
  if ((s.bodies.flags[row] & kExternal) == 0) group.free_slots.push_back({e.block, e.slot});
  s.bodies.flags[row] = 0;
  s.bodies.left_m_s[row] = 0.0;
  s.bodies.right_m_s[row] = 0.0;
  e.alive = false;
  ++e.generation;
  release_joints_of(BodyKey::robot(row));
  s.bodies_changed = true;
  s.living.erase(std::lower_bound(s.living.begin(), s.living.end(), robot.index));
}

void* Space::state(RobotId robot, const hal::RowType& type) const noexcept {
  if (!contains(robot)) return nullptr;
  const RobotEntity& e = stores_->robots[robot.index];
  for (const KeptColumn& column : stores_->groups[stores_->blocks[e.block].group].columns) {
    if (column.type->name == type.name && column.type->layout == type.layout)
      return column.arrays->array(e.block) + e.slot * type.size;
  }
  return nullptr;
}

double Space::turret_rad(RobotId robot) const noexcept {
  const auto* turret = state<TurretState>(robot);
  return turret == nullptr ? 0.0 : turret->angle_rad;
}

bool Space::holding(RobotId robot) const noexcept {
  const auto* grip = state<GripState>(robot);
  return grip != nullptr && grip->holding();
}

bool Space::halted(RobotId robot) const noexcept {
  if (!contains(robot)) return true;
  const RobotEntity& e = stores_->robots[robot.index];
  return stores_->blocks[e.block].halted[e.slot] != 0;
}

bool Space::halted_by(RobotId robot, HaltOwner owner) const noexcept {
  if (!contains(robot)) return owner == HaltOwner::Removed;
  const RobotEntity& e = stores_->robots[robot.index];
  const std::uint8_t held = stores_->blocks[e.block].halted[e.slot];
  return (held & bit(owner)) != 0 || (owner == HaltOwner::Controller && (held & kThrewInThisTick) != 0);
}

void Space::set_halted(RobotId robot, bool halted, HaltOwner owner) noexcept {
  if (!contains(robot)) return;
  const RobotEntity& e = stores_->robots[robot.index];
  std::uint8_t& held = stores_->blocks[e.block].halted[e.slot];
  held = static_cast<std::uint8_t>(halted ? held | bit(owner) : held & ~bit(owner));
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
  return contains(robot) && (stores_->bodies.flags[stores_->row_of(robot)] & kExternal) != 0;
}

void Space::set_external(RobotId robot, bool external) noexcept {
  if (!contains(robot)) return;
  std::uint8_t& flags = stores_->bodies.flags[stores_->row_of(robot)];
  flags = static_cast<std::uint8_t>(external ? flags | kExternal : flags & ~kExternal);
  stores_->robots[robot.index].real_senses = 0;
  stores_->twins = stores_->twins || external;
}

void Space::set_real_senses(RobotId robot, std::uint8_t senses) noexcept {
  if (external(robot)) stores_->robots[robot.index].real_senses = senses;
}

const void* Space::port(RobotId robot, const hal::PortType& type) const noexcept {
  if (!contains(robot)) return nullptr;
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
  if (robot.index >= stores_->robots.size()) return {};
  return stores_->groups[stores_->blocks[stores_->robots[robot.index].block].group].ports;
}

std::span<const hal::PublishedField> Space::published(RobotId robot) const noexcept {
  if (!contains(robot)) return {};
  return stores_->groups[stores_->blocks[stores_->robots[robot.index].block].group].published;
}

hal::Result<const hal::PublishedField*> Space::find_published(RobotId robot, std::string_view name) const {
  if (!contains(robot)) return gone("robot");
  std::string known;
  for (const hal::PublishedField& field : published(robot)) {
    if (field.name == name) return &field;
    known += (known.empty() ? "" : ", ") + field.name;
  }
  return hal::Error{"the controller of robot '" + robot_name(robot) + "' publishes no '" + std::string(name) +
                    "'; it publishes: " + (known.empty() ? "nothing" : known)};
}

hal::Result<double> Space::published_value(RobotId robot, std::string_view name) const {
  const auto field = find_published(robot, name);
  if (!field.ok()) return field.error();
  return hal::value_of(*field.value(), stores_->controller_of(robot));
}

hal::Result<std::string> Space::published_text(RobotId robot, std::string_view name) const {
  const auto field = find_published(robot, name);
  if (!field.ok()) return field.error();
  return hal::text_of(*field.value(), stores_->controller_of(robot));
}

void* Space::controller(RobotId robot, std::string_view class_name, std::size_t size) {
  if (!contains(robot)) return nullptr;
  const RobotBlock& block = stores_->blocks[stores_->robots[robot.index].block];
  const hal::ControllerType& type = *stores_->groups[block.group].controller;
  if (type.class_name != class_name) return nullptr;
  if (type.size != size) {
    throw std::runtime_error("the class " + std::string(class_name) + " has " + std::to_string(size) +
                             " bytes in the hook's library and " + std::to_string(type.size) +
                             " in that of the controller '" + std::string(type.name) +
                             "'; rebuild both from one header");
  }
  return stores_->controller_of(robot);
}

Sketch& Space::sketch() noexcept {
  return stores_->sketch;
}

const Sketch& Space::sketch() const noexcept {
  return stores_->sketch;
}

const std::vector<Object>& Space::objects() const noexcept {
  return stores_->objects;
}

ObjectId Space::object(std::size_t number) const noexcept {
  if (number >= stores_->objects.size()) return {};
  return {static_cast<std::uint32_t>(number), stores_->objects[number].generation};
}

ObjectId Space::find_object(std::string_view id) const noexcept {
  const auto found = stores_->object_numbers.find(std::string(id));
  return found == stores_->object_numbers.end() || !stores_->objects[found->second].alive ? ObjectId{}
                                                                                          : object(found->second);
}

bool Space::contains(ObjectId object) const noexcept {
  return stores_->contains(object);
}

hal::Result<ObjectId> Space::add_object(const Object& wanted) {
  if (wanted.id.empty() || had(wanted.id)) return taken(wanted.id);
  return editor_ == nullptr ? no_world() : editor_->add_object(wanted);
}

hal::Status Space::set_object(ObjectId object, const Object& changed) {
  if (!contains(object)) return gone("object");
  return editor_ == nullptr ? no_world() : editor_->set_object(object, changed);
}

hal::Status Space::room_for(RobotId robot, const Pose& pose) const {
  if (!contains(robot)) return gone("robot");
  return editor_ == nullptr ? no_world() : editor_->room_for(BodyKey::robot(stores_->row_of(robot)), pose);
}

hal::Status Space::room_for(ObjectId object, const Pose& pose) const {
  if (!contains(object)) return gone("object");
  return editor_ == nullptr ? no_world() : editor_->room_for(BodyKey::object(object.index), pose);
}

hal::Status Space::set_object_led(ObjectId object, std::size_t led, hal::Rgb color) {
  if (!contains(object)) return gone("object");
  SpaceStores& s = *stores_;
  Object& bearer = s.objects[object.index];
  if (led >= bearer.leds.size()) {
    return hal::Error{"object '" + bearer.id + "' has " + std::to_string(bearer.leds.size()) +
                      " LEDs; there is no number " + std::to_string(led)};
  }
  bearer.leds[led].color = color;
  s.altered = true;
  ++s.object_leds_version;
  return {};
}

void Space::remove_object(ObjectId object) noexcept {
  if (!contains(object)) return;
  SpaceStores& s = *stores_;
  Object& gone_one = s.objects[object.index];
  gone_one.alive = false;
  release_joints_of(BodyKey::object(object.index));
  s.bodies_changed = true;
  if (gone_one.movable) return;
  ++s.immovables_version;
  s.altered = true;
}

Velocity Space::object_velocity(ObjectId object) const noexcept {
  if (!contains(object)) return {};
  const Motion& motion = stores_->object_motion[object.index];
  return {motion.v_m_s, motion.w_rad_s};
}

hal::Status Space::set_object_velocity(ObjectId object, const Velocity& velocity) {
  if (!contains(object)) return gone("object");
  const std::string& id = stores_->objects[object.index].id;
  if (!stores_->objects[object.index].movable) return hal::Error{"object '" + id + "' is not movable"};
  if (!hal::all_finite(velocity.v_m_s) || !hal::all_finite(velocity.w_rad_s))
    return hal::Error{"the velocity for object '" + id + "' is not finite"};
  stores_->object_motion[object.index].v_m_s = velocity.v_m_s;
  stores_->object_motion[object.index].w_rad_s = velocity.w_rad_s;
  return {};
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
hal::Result<double> Space::field(std::string_view name, double x_m, double y_m, double z_m) const {
  const Field* field = stores_->fields.find(name);
  if (field == nullptr) return no_field(name, *stores_);
  return field->at(*stores_, x_m, y_m, z_m);
}
hal::Status Space::repaint(std::string_view name) {
  Field* field = stores_->fields.find(name);
  if (field == nullptr) return no_field(name, *stores_);
  field->repaint();
  return {};
}
double Space::floor(double x_m, double y_m) const noexcept {
  const Field* floor = stores_->fields.find("floor");
  return floor == nullptr ? 0.5 : floor->at(*stores_, x_m, y_m, 0.0);
}
void Space::repaint_floor() noexcept {
  if (Field* floor = stores_->fields.find("floor"); floor != nullptr) floor->repaint();
}

}  // namespace tandem::core
