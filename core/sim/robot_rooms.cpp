// Robots that are added while a run goes on: a slot in a group, a row, a controller, or nothing of it.
#include <algorithm>

#include "core/sim/engine_factory.hpp"
#include "core/sim/robot_factory.hpp"
#include "core/sim/robot_kit.hpp"

namespace tandem::core {
namespace {

constexpr std::uint32_t kNobody = 0xFFFFFFFFU;

}  // namespace

hal::Error RobotFactory::cannot_be_made(const RobotItem& item, const Problems& problems) {
  return hal::Error{"robot '" + item.id + "' cannot be made: " + errors_of(problems)};
}

/// Its ports, as they are before anything was read or commanded.
void RobotFactory::reset_row(const RobotGroup& group, RobotBlock& block, std::size_t slot) {
  for (std::size_t p = 0; p < block.ports.size(); ++p) {
    const hal::PortType& type = *group.ports[p];
    type.reset(block.ports[p] + slot * type.size);
  }
}

/// The first group of that kit: parameters are each robot's own.
hal::Result<std::size_t> RobotFactory::group_for(const RobotItem& item) {
  std::vector<RobotGroup>& groups = stores_.groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (same_kit(*groups[g].item, item)) return g;
  }
  groups.emplace_back().item = std::make_shared<RobotItem>(item);
  Problems problems;
  if (prepare_group(groups.size() - 1, problems)) return groups.size() - 1;
  groups.pop_back();
  return cannot_be_made(item, problems);
}

Slot RobotFactory::free_slot(std::size_t g) {
  constexpr std::size_t kFirstBlock = 32;
  RobotGroup& group = stores_.groups[g];
  if (!group.free_slots.empty()) {
    const Slot slot = group.free_slots.back();
    group.free_slots.pop_back();
    return slot;
  }
  std::size_t capacity = kFirstBlock;
  if (!group.blocks.empty()) {
    RobotBlock& last = stores_.blocks[group.blocks.back()];
    if (last.used < last.capacity)
      return {static_cast<std::uint32_t>(group.blocks.back()), static_cast<std::uint32_t>(last.used++)};
    capacity = std::clamp(2 * last.capacity, kFirstBlock, kBlockRows);
  }
  const std::uint32_t block = add_block(g, capacity);
  stores_.blocks[block].used = 1;
  return {block, 0};
}

/// Whether the robot's region has the joints that its controller's devices need.
hal::Status RobotFactory::can_hold(Slot at) const {
  const RobotBlock& block = stores_.blocks[at.block];
  const std::size_t row = block.first_row + at.slot;
  const Region& region = stores_.regions[stores_.bodies.region[row]];
  const DeviceType* device = device_without_joints(stores_.groups[block.group], region.joints);
  if (device == nullptr) return {};
  return hal::Error{"robot '" + stores_.names[stores_.robots[stores_.bodies.entity[row]].item].prefix + "' has a " +
                    std::string(device->device) + ", but " + lacks_joints(loader_.catalog(), region, device->joints)};
}

/// Undoes a robot that did not come to be: the entity that was appended last.
void RobotFactory::give_back(std::size_t g, Slot slot, const Taken& before, std::uint32_t entity_before) {
  RobotBlock& block = stores_.blocks[slot.block];
  RobotGroup& group = stores_.groups[g];
  group.ports.resize(before.ports);
  group.published.resize(before.published);
  if (block.ports.size() > before.ports) {  // their arrays are the last of its own
    block.own_arrays.resize(block.own_arrays.size() - (block.ports.size() - before.ports));
    block.ports.resize(before.ports);
  }
  stores_.bodies.flags[block.first_row + slot.slot] = 0;
  stores_.bodies.entity[block.first_row + slot.slot] = entity_before;
  block.halted[slot.slot] = bit(HaltOwner::Removed);
  if (slot.slot + 1U == block.used && entity_before == kNobody) {
    --block.used;  // nobody was ever there
  } else {
    group.free_slots.push_back(slot);
  }
  stores_.robots.pop_back();
  stores_.names.pop_back();
}

/// A slot for a robot of that kit, and the parameters of its controller.
hal::Result<RobotFactory::Room> RobotFactory::room_for(const RobotItem& item) {
  const hal::Result<std::size_t> found = group_for(item);
  if (!found.ok()) return found.error();
  const std::size_t g = found.value();
  Room room{g, {}, stores_.groups[g].params, !same_params(stores_.groups[g].item->params, item.params), {}};
  if (room.own_params) {
    Problems problems;
    room.params = read_params(stores_.groups[g], item, scenario_, problems);
    if (has_errors(problems)) return cannot_be_made(item, problems);
  }
  room.slot = free_slot(g);
  if (devices_.blocks.size() < stores_.blocks.size()) {
    complete(g);
    media_.fit(stores_);
  }
  room.before = {stores_.groups[g].ports.size(), stores_.groups[g].published.size()};
  return room;
}

/// The row as a new one would be.
void RobotFactory::begin_row(const Room& room) {
  const Slot slot = room.slot;
  RobotBlock& block = stores_.blocks[slot.block];
  Bodies& b = stores_.bodies;
  const std::size_t row = block.first_row + slot.slot;
  for (auto* array : {&b.left_m_s, &b.right_m_s, &b.left_m, &b.right_m}) (*array)[row] = 0.0;
  if (!b.motion.empty()) b.motion[row] = {};
  for (const KeptColumn& column : stores_.groups[room.group].columns) column.start(slot.block, slot.slot);
  reset_row(stores_.groups[room.group], block, slot.slot);
  block.halted[slot.slot] = 0;
}

/// Once its controller is there.
void RobotFactory::end_row(Room& room) {
  RobotBlock& home = stores_.blocks[room.slot.block];
  const std::size_t slot = room.slot.slot;
  if (room.own_params && home.params.size() <= slot) home.params.resize(slot + 1U);
  if (slot < home.params.size()) home.params[slot] = room.own_params ? std::move(room.params) : nullptr;
  if (stores_.groups[room.group].ports.size() > room.before.ports) {  // it took ports that no other has
    complete(room.group);
    media_.fit(stores_);
  }
}

hal::Result<RobotId> RobotFactory::add(const RobotItem& item, const Pose& pose,
                                       const std::function<hal::Status(std::size_t row)>& accepts) {
  hal::Result<Room> found = room_for(item);
  if (!found.ok()) return found.error();
  Room& room = found.value();
  const std::size_t g = room.group;
  const Slot slot = room.slot;
  const auto entity = static_cast<std::uint32_t>(stores_.robots.size());
  stores_.names.push_back({item.id, -1, entity, 1});
  RobotEntity made;
  made.item = static_cast<std::uint32_t>(stores_.names.size() - 1);
  stores_.robots.push_back(made);

  RobotBlock& block = stores_.blocks[slot.block];
  Bodies& b = stores_.bodies;
  const std::size_t row = block.first_row + slot.slot;
  const std::uint32_t entity_before = b.entity[row];
  begin_row(room);
  place({made.item, entity, pose.x_m, pose.y_m, pose.z_m, pose.heading_rad()}, slot);
  b.cos_h[row] = pose.cos_h;
  b.sin_h[row] = pose.sin_h;

  hal::Status fits = accepts(row);
  if (fits.ok()) {
    const std::string why = construct(slot, room.params);
    if (!why.empty()) fits = hal::Error{why};
  }
  if (fits.ok() && !(fits = can_hold(slot)).ok()) {
    stores_.groups[g].controller->destroy(block.controller(slot.slot));
    block.constructed[slot.slot] = 0;
  }
  if (!fits.ok()) {
    give_back(g, slot, room.before, entity_before);
    return fits.error();
  }
  end_row(room);
  stores_.robots[entity].generation = ++stores_.generations;
  stores_.living.push_back(entity);
  stores_.added_robots.emplace(item.id, entity);
  stores_.altered = true;
  stores_.touch(BodyKey::robot(row));
  return RobotId{entity, stores_.robots[entity].generation};
}

void destroy_controllers(SpaceStores& stores) noexcept {
  for (RobotBlock& block : stores.blocks) destroy_controllers(stores, block);
}

namespace {

void name_destructor(const void* type, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  out << "a controller of class '" << static_cast<const hal::ControllerType*>(type)->name << "', in its destructor,";
}

}  // namespace

void destroy_controllers(SpaceStores& stores, RobotBlock& block) noexcept {
  const hal::PluginCall call(&name_destructor, stores.groups[block.group].controller);
  for (std::size_t slot = 0; slot < block.capacity; ++slot) {
    if (block.constructed[slot] != 0) stores.groups[block.group].controller->destroy(block.controller(slot));
    block.constructed[slot] = 0;
  }
}

}  // namespace tandem::core
