#include "core/sim/robot_factory.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>

#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/settings.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device_list.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::uint32_t kNobody = 0xFFFFFFFFU;

/// Position along Morton's space-filling curve over a grid of 2^16 x 2^16 cells.
std::uint32_t curve_position(double x01, double y01) noexcept {
  const auto spread = [](double v01) {
    auto v = static_cast<std::uint32_t>(std::clamp(v01, 0.0, 1.0) * 65535.0);
    v = (v | (v << 8)) & 0x00FF00FFU;
    v = (v | (v << 4)) & 0x0F0F0F0FU;
    v = (v | (v << 2)) & 0x33333333U;
    return (v | (v << 1)) & 0x55555555U;
  };
  return spread(x01) | (spread(y01) << 1);
}

/// Zeroed memory for a block: of the slab at the start, of its own (`slab` null) while the run goes on, because a
/// snapshot may be the last that needs it.
std::byte* make_array(RobotBlock& block, Slab* slab, std::size_t size, std::size_t type_align) {
  const std::size_t align = std::max(type_align, kCacheLine);
  if (slab != nullptr) return slab->take(size, align);
  auto* const array = static_cast<std::byte*>(allocate_large(size, align));
  block.own_arrays.emplace_back(array, [size, align](std::byte* p) { free_large(p, size, align); });
  std::memset(array, 0, size);
  return array;
}

void reset_ports(const hal::PortType& type, RobotBlock& block, std::size_t port) {
  for (std::size_t i = 0; i < block.capacity; ++i) type.reset(block.ports[port] + i * type.size);
}

/// Gives the block an array for each port of its group that it has none for yet. At the start (`slab` given) the arrays
/// of a group's blocks are parts of one, of `start_rows` rows: who looks at the whole group finds its robots in a row.
void add_port_arrays(SpaceStores& stores, const RobotGroup& group, RobotBlock& block, Slab* slab,
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
    std::vector<hal::ListedDevice> listed;
    const ControllerConfig& config = scenario_.controllers[group_.config];
    const auto add = [&](const std::vector<DeviceChoice>& choices, hal::Role role) {
      for (const DeviceChoice& choice : choices) {
        const auto* const port = catalog_.find<hal::PortType>(hal::port_entry(choice.device, role));
        if (port != nullptr) listed.push_back({port, choice.options.name});
      }
    };
    add(config.sensors, hal::Role::Sensor);
    add(config.actuators, hal::Role::Actuator);
    return listed;
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

bool same_battery(const BatteryConfig& a, const BatteryConfig& b) {
  return a.model == b.model && a.start_charge == b.start_charge && a.full_charge == b.full_charge &&
         a.delta == b.delta && a.pos_delta == b.pos_delta && a.orient_delta == b.orient_delta;
}

bool same_kit(const RobotItem& a, const RobotItem& b) {
  return a.kind == b.kind && a.own_kind == b.own_kind && a.controller == b.controller &&
         same_battery(a.battery, b.battery);
}

/// Robots that share a block must share everything that is not per robot.
bool same_group(const RobotItem& a, const RobotItem& b) {
  return same_kit(a, b) && !a.params && !b.params;
}

bool same_params(const std::optional<Element>& a, const std::optional<Element>& b) {
  return a && b ? same_settings(*a, *b) : !a && !b;
}

}  // namespace

void RobotFactory::make(const std::vector<RobotRequest>& requests, Problems& problems) {
  stores_.bodies.reserve(requests.size());
  slab_ = &stores_.slab;
  const std::vector<std::vector<std::uint32_t>> unsorted = group(requests);
  for (std::size_t g = 0; g < unsorted.size(); ++g) {
    std::vector<std::uint32_t> members = unsorted[g];
    sort_by_place(requests, members);
    const bool prepared = stores_.groups[g].controller != nullptr;
    if ((prepared || prepare_group(g, problems)) && make_blocks(g, requests, members, problems)) complete(g);
  }
  media_.fit(stores_);
  slab_ = nullptr;
  new_params_.clear();
  end_kept();
  if (!start_groups_.empty()) return;
  start_groups_ = stores_.groups;
  start_blocks_ = stores_.blocks;
  start_robots_ = stores_.robots.size();
  for (const auto& column : stores_.columns.all()) start_columns_.emplace_back(column.get(), column->of_block);
}

/// Those that were not filled anew, because something went wrong.
void RobotFactory::end_kept() noexcept {
  for (; filled_ < kept_.size(); ++filled_) destroy_controllers(stores_, kept_[filled_]);
  kept_.clear();
  filled_ = 0;
}

RobotFactory::~RobotFactory() {
  end_kept();
}

void RobotFactory::begin_anew(std::uint64_t seed) noexcept {
  end_kept();
  seed_ = seed;
  kept_ = start_blocks_;
  for (RobotBlock& block : kept_) block.constructed.fill(0);
  for (std::size_t b = 0; b < stores_.blocks.size(); ++b) {
    RobotBlock& block = stores_.blocks[b];
    if (b >= kept_.size()) {
      destroy_controllers(stores_, block);
      continue;
    }
    for (std::size_t slot = 0; slot < block.used; ++slot) {
      if (block.constructed[slot] != 0 && stores_.bodies.entity[block.first_row + slot] >= start_robots_) {
        const hal::PluginCall call(&name_constructor, this, b, slot);
        stores_.groups[block.group].controller->destroy(block.controller(slot));
        block.constructed[slot] = 0;
      }
    }
    kept_[b].constructed = block.constructed;
  }
  stores_.groups = start_groups_;
  for (RobotGroup& group : stores_.groups) group.blocks.clear();
  for (const auto& column : stores_.columns.all()) column->of_block.clear();  // also those that came since
  for (const auto& [column, of_block] : start_columns_) column->of_block = of_block;
}

bool RobotFactory::change_params(const Scenario& changed, Problems& problems) {
  std::vector<std::pair<std::shared_ptr<RobotItem>, std::shared_ptr<const void>>> wanted;
  for (std::size_t g = 0; g < start_groups_.size(); ++g) {
    auto item = std::make_shared<RobotItem>(*start_groups_[g].item);
    const auto first = std::find(group_of_item_.begin(), group_of_item_.end(), g);
    item->params = changed.robots[static_cast<std::size_t>(first - group_of_item_.begin())].params;
    auto params = read_params(start_groups_[g], *item, changed, problems);
    wanted.emplace_back(std::move(item), std::move(params));
  }
  if (has_errors(problems)) return false;
  for (std::size_t g = 0; g < start_groups_.size(); ++g) {
    start_groups_[g].item = wanted[g].first;
    start_groups_[g].params = wanted[g].second;
  }
  new_params_.assign(start_groups_.size(), 1);
  return true;
}

std::vector<std::vector<std::uint32_t>> RobotFactory::group(const std::vector<RobotRequest>& requests) {
  if (group_of_item_.empty()) {
    for (const RobotItem& item : scenario_.robots) {
      std::size_t g = 0;
      while (g < stores_.groups.size() && !same_group(*stores_.groups[g].item, item)) ++g;
      if (g == stores_.groups.size()) stores_.groups.emplace_back().item = std::make_shared<RobotItem>(item);
      group_of_item_.push_back(g);
    }
  }
  std::vector<std::vector<std::uint32_t>> members(stores_.groups.size());
  for (std::size_t r = 0; r < requests.size(); ++r)
    members[group_of_item_[requests[r].item]].push_back(static_cast<std::uint32_t>(r));
  return members;
}

void RobotFactory::sort_by_place(const std::vector<RobotRequest>& requests, std::vector<std::uint32_t>& members) const {
  const double width = stores_.max_x_m - stores_.min_x_m;
  const double depth = stores_.max_y_m - stores_.min_y_m;
  std::vector<std::uint64_t> keys;
  keys.reserve(members.size());
  for (const std::uint32_t r : members) {
    const std::uint32_t place =
        curve_position((requests[r].x_m - stores_.min_x_m) / width, (requests[r].y_m - stores_.min_y_m) / depth);
    keys.push_back((static_cast<std::uint64_t>(place) << 32) | r);
  }
  std::sort(keys.begin(), keys.end());
  for (std::size_t i = 0; i < keys.size(); ++i) members[i] = static_cast<std::uint32_t>(keys[i]);
}

bool RobotFactory::prepare_group(std::size_t g, Problems& problems) {
  const RobotItem& item = *stores_.groups[g].item;
  const ControllerConfig& config = scenario_.controllers[item.controller];
  const auto problem = [&](int line, std::string message) {
    problems.push_back({scenario_.file, line, std::move(message), false});
  };
  RobotGroup& group = stores_.groups[g];
  group.config = item.controller;
  group.kind = item.own_kind != nullptr ? item.own_kind.get() : find_kind(scenario_, loader_.catalog(), item.kind);
  if (group.kind == nullptr) {
    problem(item.line, "unknown kind of robot '" + item.kind + "'");
    return false;
  }
  if (const auto* board = group.kind->part<hal::RangeAndBearingPart>(); board != nullptr) {
    group.rab_range_m = board->range_m;
    group.rab_payload = static_cast<unsigned>(board->payload);
    group.rab_height_m = board->height_m;
  }
  const auto type = loader_.controller(config.library, config.label);
  if (!type.ok()) {
    problem(config.line, "controller '" + config.id + "': " + type.error().message);
    return false;
  }
  group.controller = type.value();
  Problems found;
  group.params = read_params(group, item, scenario_, found);
  // Listed devices must exist even when the controller does not take them.
  auto factories = std::make_shared<GroupFactories>();
  bool good = read_devices(group, hal::Role::Sensor, *factories, found);
  good = read_devices(group, hal::Role::Actuator, *factories, found) && good && !has_errors(found);
  group.factories = std::move(factories);
  for (Problem& one : found) {  // what groups share is wrong once
    const auto same = [&](const Problem& other) {
      return other.file == one.file && other.line == one.line && other.message == one.message;
    };
    if (std::none_of(problems.begin(), problems.end(), same)) problems.push_back(std::move(one));
  }
  return good;
}

/// The parameters of a robot's controller; null, with a problem, where the controller's own description of them throws.
std::shared_ptr<const void> RobotFactory::read_params(const RobotGroup& group, const RobotItem& item,
                                                      const Scenario& scenario, Problems& problems) const {
  const ControllerConfig& config = scenario.controllers[group.config];
  const Element& params = item.params ? *item.params : config.params;
  std::string why = "controller '" + config.id + "' threw while it read its parameters";
  try {
    const hal::PluginCall call(&name_params, this, group.config);
    ElementReader reader(params, problems);
    auto read = group.controller->read_params(reader);
    reader.finish();
    return read;
  } catch (const std::exception& e) {
    why += std::string(": ") + e.what();
  } catch (...) {
  }
  problems.push_back({scenario_.file, config.line, std::move(why), false});
  return nullptr;
}

bool RobotFactory::read_devices(const RobotGroup& group, hal::Role role, GroupFactories& factories,
                                Problems& problems) {
  const ControllerConfig& config = scenario_.controllers[group.config];
  DeviceSetup setup{*group.kind, group.item, 1.0 / static_cast<double>(scenario_.ticks_per_second), &stores_.fields};
  bool good = true;
  for (const DeviceChoice& choice : role == hal::Role::Sensor ? config.sensors : config.actuators) {
    const DeviceType* type = find_device(loader_.catalog(), choice.device, role, choice.implementation);
    const int line = choice.options.line != 0 ? choice.options.line : config.line;
    const auto problem = [&](std::string message) {
      problems.push_back({scenario_.file, line, std::move(message), false});
      good = false;
    };
    if (type == nullptr) {
      std::string known;
      for (const DeviceType* t : loader_.catalog().all<DeviceType>()) {
        if (t->device == choice.device && t->role == role)
          known += (known.empty() ? "" : ", ") + std::string(t->implementation);
      }
      problem(known.empty() ? "no simulated device '" + choice.device + "'"
                            : "device '" + choice.device + "' has no implementation '" + choice.implementation +
                                  "'; it has: " + known);
    } else if (!type->fits(*group.kind)) {
      problem("the robot '" + group.kind->name + "' has no device '" + choice.device +
              "'; take it out of the controller configuration '" + config.id + "', or make one of its own for '" +
              group.kind->name + "'");
    } else {
      setup.channel = choice.medium;
      if (!type->medium.empty()) {
        const auto medium = media_.of(loader_.catalog(), type->medium);
        if (!medium.ok()) {
          problem("device '" + choice.device + "': " + medium.error().message);
          continue;
        }
        setup.medium = medium.value();
      }
      GroupFactories::Listed listed{type, {}, {}};
      if (type->make_sensor != nullptr) listed.sensor = type->make_sensor(choice.options, problems, setup);
      if (type->make_actuator != nullptr) listed.actuator = type->make_actuator(choice.options, problems, setup);
      listed.with_factory([&](const auto& factory) {
        for (const KeptColumn& column : factory.columns) {
          const auto known = stores_.columns.of(*column.type);
          if (!known.ok()) problem("device '" + choice.device + "': " + known.error().message);
        }
      });
      factories.listed.push_back(std::move(listed));
    }
  }
  return good;
}

std::uint32_t RobotFactory::add_block(std::size_t g, std::size_t capacity) {
  RobotBlock block;
  if (filled_ < kept_.size()) {
    block = kept_[filled_++];
    block.halted.fill(0);
    for (std::size_t p = 0; p < block.ports.size(); ++p) reset_ports(*stores_.groups[g].ports[p], block, p);
  } else {
    block.capacity = capacity;
    const hal::ControllerType& type = *stores_.groups[g].controller;
    block.controller_stride = (type.size + type.align - 1) / type.align * type.align;
    block.controllers = make_array(block, slab_, block.controller_stride * capacity, type.align);
  }
  block.group = g;
  block.first_row = stores_.bodies.size();
  stores_.bodies.resize(block.first_row + capacity);
  const std::size_t index = stores_.blocks.size();
  for (const KeptColumn& column : stores_.groups[g].columns) {  // a block that was kept has its rows
    if (column.arrays->array(index) == nullptr) continue;
    for (std::size_t slot = 0; slot < block.capacity; ++slot) column.start(index, slot);
  }
  stores_.blocks.push_back(std::move(block));
  stores_.groups[g].blocks.push_back(index);
  return static_cast<std::uint32_t>(stores_.blocks.size() - 1);
}

bool RobotFactory::make_blocks(std::size_t g, const std::vector<RobotRequest>& requests,
                               const std::vector<std::uint32_t>& members, Problems& problems) {
  start_rows_ = members.size();
  for (std::size_t begin = 0; begin < members.size(); begin += kBlockRows) {
    const std::size_t count = std::min(kBlockRows, members.size() - begin);
    const std::uint32_t block = add_block(g, count);
    stores_.blocks[block].used = count;
    for (std::uint32_t slot = 0; slot < count; ++slot) place(requests[members[begin + slot]], {block, slot});
    for (std::uint32_t slot = 0; slot < count; ++slot) {
      const std::string why = construct({block, slot}, stores_.groups[g].params);
      if (why.empty()) continue;
      problems.push_back({scenario_.file, scenario_.controllers[stores_.groups[g].config].line, why, false});
      return false;
    }
  }
  return true;
}

void RobotFactory::place(const RobotRequest& request, Slot at) {
  RobotEntity& e = stores_.robots[request.entity];
  e.block = at.block;
  e.slot = at.slot;
  e.alive = true;
  Bodies& b = stores_.bodies;
  const std::size_t row = stores_.blocks[at.block].first_row + at.slot;
  b.x_m[row] = request.x_m;
  b.y_m[row] = request.y_m;
  b.cos_h[row] = std::cos(request.yaw_rad);
  b.sin_h[row] = std::sin(request.yaw_rad);
  b.radius_m[row] = static_cast<float>(stores_.groups[stores_.blocks[at.block].group].kind->body.radius_m);
  if (b.has_motion) {
    b.motion[row].z_m = request.z_m;
    b.motion[row].q_WB = {std::cos(0.5 * request.yaw_rad), 0.0, 0.0, std::sin(0.5 * request.yaw_rad)};
  }
  b.flags[row] = kAlive;
  b.entity[row] = request.entity;
}

void RobotFactory::name_controller(std::size_t block, std::size_t slot, hal::FixedText& out) const noexcept {
  const RobotBlock& b = stores_.blocks[block];
  const ControllerConfig& config = scenario_.controllers[stores_.groups[b.group].config];
  out << "controller '" << config.id << "' (library '" << config.library << "') of robot '";
  const RobotEntity& robot = stores_.robots[stores_.bodies.entity[b.first_row + slot]];
  if (robot.item < stores_.names.size()) out << stores_.names[robot.item].prefix;
  if (robot.number >= 0) out << std::int64_t{robot.number};
  out << "'";
}

void RobotFactory::name_constructor(const void* factory, std::size_t block, std::size_t slot,
                                    hal::FixedText& out) noexcept {
  static_cast<const RobotFactory*>(factory)->name_controller(block, slot, out);
  out << ", while it was made,";
}

void RobotFactory::name_params(const void* factory, std::size_t config, std::size_t /*index*/,
                               hal::FixedText& out) noexcept {
  const ControllerConfig& c = static_cast<const RobotFactory*>(factory)->scenario_.controllers[config];
  out << "controller '" << c.id << "' (library '" << c.library << "'), while it read its parameters,";
}

/// Makes or resets the controller of the robot that is placed there. Says what went wrong, or nothing.
std::string RobotFactory::construct(Slot at, const std::shared_ptr<const void>& params) {
  RobotBlock& block = stores_.blocks[at.block];
  RobotGroup& group = stores_.groups[block.group];
  const hal::ControllerType& type = *group.controller;
  ConstructedRobot robot(scenario_, loader_.catalog(), stores_, group, block, slab_, start_rows_, seed_, messages_);
  robot.select(at.slot, stores_.bodies.entity[block.first_row + at.slot]);
  std::string why;
  const hal::PluginCall call(&name_constructor, this, at.block, at.slot);
  try {
    if (block.constructed[at.slot] != 0) {  // of the run before
      const bool same_params = new_params_.empty() || new_params_[block.group] == 0;
      if (same_params && type.reset(block.controller(at.slot), robot)) return {};
      block.constructed[at.slot] = 0;
      type.destroy(block.controller(at.slot));
    }
    type.construct(block.controller(at.slot), robot, params.get());
    block.constructed[at.slot] = 1;
    return {};
  } catch (const std::exception& e) {
    why = e.what();
  } catch (...) {
    why = "threw an exception of unknown type";
  }
  return "controller '" + scenario_.controllers[group.config].id + "' (" + std::string(type.name) + ") of robot '" +
         std::string(robot.id()) + "' " + why;
}

/// What the devices of the group's ports need: columns, with those of robots that fly, and media.
void RobotFactory::note_needs(RobotGroup& group) {
  const auto add = [&](const KeptColumn& wanted) {
    ColumnArrays* const arrays = stores_.columns.of(*wanted.type).value();
    const auto same = [arrays](const KeptColumn& other) { return other.arrays == arrays; };
    if (std::any_of(group.columns.begin(), group.columns.end(), same)) return;
    group.columns.push_back(wanted);
    group.columns.back().arrays = arrays;
  };
  if (group.kind->flies()) {
    add(keeps<FlightCommand>());
    add(keeps<RotorState>());
  }
  for (const hal::PortType* port : group.ports) {
    const GroupFactories::Listed& made = *group.factories->find(port->name, port->role);
    made.with_factory([&](const auto& factory) {
      for (const KeptColumn& column : factory.columns) add(column);
      if (!factory.publishes && !factory.listens) return;
      const Medium* const medium = media_.of(loader_.catalog(), made.type->medium).value();
      const auto same = [medium](const MediumUse& other) { return other.medium == medium; };
      auto use = std::find_if(group.media.begin(), group.media.end(), same);
      if (use == group.media.end()) use = group.media.insert(use, MediumUse{medium});
      use->publishes = use->publishes || factory.publishes;
      use->listens = use->listens || factory.listens;
      use->reach_m = std::max(use->reach_m, factory.reach_m);
    });
  }
}

/// Gives a block the rows of its group's columns that it lacks.
void RobotFactory::add_rows(std::size_t block_index) {
  RobotBlock& block = stores_.blocks[block_index];
  for (const KeptColumn& column : stores_.groups[block.group].columns) {
    std::vector<std::byte*>& arrays = column.arrays->of_block;
    if (arrays.size() <= block_index) arrays.resize(block_index + 1, nullptr);
    if (arrays[block_index] != nullptr) continue;
    arrays[block_index] = make_array(block, slab_, column.type->size * block.capacity, column.type->align);
    for (std::size_t slot = 0; slot < block.capacity; ++slot) column.start(block_index, slot);
  }
}

/// Gives every block of the group arrays, rows and devices for all ports that its controllers have taken by now.
void RobotFactory::complete(std::size_t g) {
  RobotGroup& group = stores_.groups[g];
  devices_.blocks.resize(stores_.blocks.size());
  note_needs(group);
  for (const std::size_t b : group.blocks) {
    add_port_arrays(stores_, group, stores_.blocks[b], slab_, start_rows_);
    add_rows(b);
    BlockDevices& devices = devices_.blocks[b];
    if (devices.sensors.size() == group.ports.size()) continue;
    devices = {};  // those that are there may find more columns now
    const BlockColumns columns(stores_.columns, b);
    for (const hal::PortType* port : group.ports) {
      const GroupFactories::Listed& made = *group.factories->find(port->name, port->role);
      const bool is_sensor = port->role == hal::Role::Sensor;
      devices.sensors.push_back(is_sensor ? made.sensor.make(columns) : nullptr);
      devices.actuators.push_back(is_sensor ? nullptr : made.actuator.make(columns));
    }
  }
}

// --- while the run goes on ---

hal::Error RobotFactory::cannot_be_made(const RobotItem& item, const Problems& problems) {
  std::string message = "robot '" + item.id + "' cannot be made:";
  for (const Problem& problem : problems) message += " " + problem.message + ";";
  message.pop_back();
  return hal::Error{message};
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
