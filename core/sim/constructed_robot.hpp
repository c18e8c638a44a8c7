// The robot as its controller's constructor sees it, and the arrays that its ports lie in.
#pragma once
#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/device/device.hpp"
#include "core/space/stores.hpp"
#include "hal/device_list.hpp"

namespace tandem::core {

inline constexpr std::size_t kCacheLine = 64;

/// Zeroed memory for a block: of the slab at the start, of its own (`slab` null) while the run goes on, because a
/// snapshot may be the last that needs it.
inline std::byte* make_array(RobotBlock& block, Slab* slab, std::size_t size, std::size_t type_align) {
  const std::size_t align = std::max(type_align, kCacheLine);
  if (slab != nullptr) return slab->take(size, align);
  auto* const array = static_cast<std::byte*>(allocate_large(size, align));
  block.own_arrays.emplace_back(array, [size, align](std::byte* p) { free_large(p, size, align); });
  std::memset(array, 0, size);
  return array;
}

inline void reset_ports(const hal::PortType& type, RobotBlock& block, std::size_t port) {
  for (std::size_t i = 0; i < block.capacity; ++i) type.reset(block.ports[port] + i * type.size);
}

/// Gives the block an array for each port of its group that it has none for yet. At the start (`slab` given) the arrays
/// of a group's blocks are parts of one, of `start_rows` rows: who looks at the whole group finds its robots in a row.
inline void add_port_arrays(SpaceStores& stores, const RobotGroup& group, RobotBlock& block, Slab* slab,
                            std::size_t start_rows) {
  RobotBlock& first = stores.blocks[group.blocks.front()];
  if (slab != nullptr && &block != &first) add_port_arrays(stores, group, first, slab, start_rows);
  for (std::size_t p = block.ports.size(); p < group.ports.size(); ++p) {
    const hal::PortType& type = *group.ports[p];
    if (slab != nullptr && &block != &first) {
      block.ports.push_back(first.ports[p] + (block.first_row - first.first_row) * type.size);
    } else {
      const std::size_t rows = slab != nullptr ? start_rows : block.capacity;
      block.ports.push_back(make_array(block, slab, type.size * rows, type.align));
    }
    reset_ports(type, block, p);
  }
}

/// A controller constructor's view of the robot that it is to drive.
class ConstructedRobot final : public hal::Robot, public hal::DeviceList {
 public:
  ConstructedRobot(const Scenario& scenario, const hal::Catalog& catalog, SpaceStores& stores, RobotGroup& group,
                   RobotBlock& block, Slab* slab, std::size_t start_rows, std::uint64_t run_seed,
                   hal::RobotLog::Sink& messages)
      : scenario_(scenario),
        catalog_(catalog),
        stores_(stores),
        group_(group),
        block_(block),
        slab_(slab),
        start_rows_(start_rows),
        run_seed_(run_seed),
        messages_(messages) {}

  void select(std::size_t slot, std::uint32_t entity) {
    slot_ = slot;
    const RobotEntity& e = stores_.robots[entity];
    id_ = stores_.names[e.item].prefix;
    if (e.number >= 0) id_ += std::to_string(e.number);
    set_log(hal::RobotLog(messages_, entity));
  }

  std::string_view id() const noexcept override { return id_; }
  const hal::RobotKind& kind() const noexcept override { return *group_.kind; }
  std::uint64_t run_seed() const noexcept override { return run_seed_; }
  std::vector<hal::ListedDevice> devices() const override {
    return listed_devices(scenario_.controllers[group_.config], catalog_, group_.item->bridge.has_value());
  }
  void* port(const hal::PortType& type) override { return take(type); }

 protected:
  void* take(const hal::PortType& type) override {
    std::size_t i = 0;
    while (i < group_.ports.size() && !(group_.ports[i]->name == type.name && group_.ports[i]->role == type.role)) ++i;
    if (i == group_.ports.size()) {
      check_listed(type);
      // The program's own description, where it has one: limits are not left to a plug-in.
      const auto* const known = catalog_.find<hal::PortType>(hal::port_entry(type.name, type.role));
      group_.ports.push_back(known != nullptr ? known : &type);
    }
    if (group_.ports[i]->layout != type.layout) {
      throw hal::DeviceError("device '" + std::string(type.name) +
                             "' has another layout in the controller's library than in "
                             "this program; rebuild the library");
    }
    add_port_arrays(stores_, group_, block_, slab_, start_rows_);
    return block_.ports[i] + slot_ * type.size;
  }

  void show(hal::PublishedField field, const void* member) override {
    const auto at = reinterpret_cast<std::uintptr_t>(member);
    const auto controller = reinterpret_cast<std::uintptr_t>(block_.controller(slot_));
    if (at < controller || at + hal::size_of(field) > controller + group_.controller->size) {
      throw std::logic_error("publishes '" + field.name +
                             "', which does not lie in the controller itself: publish members that are values");
    }
    field.offset = at - controller;
    for (const hal::PublishedField& known : group_.published) {
      if (known.name != field.name) continue;
      if (known == field) return;
      throw std::logic_error("publishes two members under the name '" + field.name + "'");
    }
    group_.published.push_back(std::move(field));
  }

 private:
  void check_listed(const hal::PortType& type) const {
    const bool sensor = type.role == hal::Role::Sensor;
    const std::string role = sensor ? "sensor" : "actuator";
    const std::string name(type.name);
    const DeviceType* device = find_device(catalog_, type.name, type.role, "default");
    if (device == nullptr) {
      throw hal::DeviceError("asks for the " + role + " '" + name + "', which no simulated robot has");
    }
    if (!device->fits(*group_.kind)) {
      throw hal::DeviceError("asks for the " + role + " '" + name + "', which the robot '" + group_.kind->name +
                             "' does not have");
    }
    const ControllerConfig& config = scenario_.controllers[group_.config];
    for (const DeviceChoice& choice : sensor ? config.sensors : config.actuators) {
      if (choice.device == name) return;
    }
    throw hal::DeviceError("asks for the " + role + " '" + name + "', which its configuration '" + config.id +
                           "' does not list; add <" + name + " implementation=\"default\"/> to its <" + role + "s>");
  }

  const Scenario& scenario_;
  const hal::Catalog& catalog_;
  SpaceStores& stores_;
  RobotGroup& group_;
  RobotBlock& block_;
  Slab* slab_;
  std::size_t start_rows_;
  std::uint64_t run_seed_;
  hal::RobotLog::Sink& messages_;
  std::size_t slot_ = 0;
  std::string id_;
};

}  // namespace tandem::core
