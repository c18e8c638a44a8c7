#include "core/sim/robot_factory.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/sim/constructed_robot.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/robot_kit.hpp"
#include "core/sim/settings.hpp"
#include "core/sim/thrown.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::core {
namespace {

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

}  // namespace

void RobotFactory::make(const std::vector<RobotRequest>& requests, Problems& problems) {
  stores_.bodies.reserve(requests.size());
  slab_ = &stores_.slab;
  const std::vector<std::vector<std::uint32_t>> unsorted = group(requests);
  for (std::size_t g = 0; g < unsorted.size(); ++g) {
    std::vector<std::uint32_t> members = unsorted[g];
    sort_by_place(requests, members);
    const bool prepared = stores_.groups[g].controller != nullptr && !new_settings_;
    if ((prepared || prepare_group(g, problems)) && make_blocks(g, requests, members, problems))
      complete(g);
    else if (!kept_.empty())
      break;  // the blocks that are left are of this group
  }
  media_.fit(stores_);
  slab_ = nullptr;
  end_kept();
  const bool anew = std::exchange(new_settings_, false) || start_groups_.empty();
  if (!anew || has_errors(problems)) return;
  start_columns_.clear();
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

void RobotFactory::begin_anew(std::uint64_t seed, bool changed) {
  end_kept();
  new_settings_ = changed;
  any_reset_ = false;
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
  for (std::size_t i = group_of_item_.size(); changed && i-- > 0;) {  // that of the first stands for its group
    RobotGroup& group = stores_.groups[group_of_item_[i]];
    group.item = std::make_shared<RobotItem>(scenario_.robots[i]);
    group.media.clear();
  }
  for (const auto& column : stores_.columns.all()) column->of_block.clear();  // also those that came since
  for (const auto& [column, of_block] : start_columns_) column->of_block = of_block;
}

void RobotFactory::check_params(const Scenario& changed, Problems& problems) const {
  for (std::size_t i = 0; i < group_of_item_.size(); ++i)
    (void)read_params(stores_.groups[group_of_item_[i]], changed.robots[i], changed, problems);
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
  for (const hal::PortType* port : group.ports) {  // that they took before the settings changed
    if (factories->find(port->name, port->role) != nullptr) continue;
    found.push_back({scenario_.file, config.line,
                     "the controller '" + config.id + "' has taken the device '" + std::string(port->name) +
                         "', which its configuration no longer lists",
                     false});
    good = false;
  }
  group.factories = std::move(factories);
  for (Problem& one : found) {  // what groups share is wrong once
    const auto same = [&](const Problem& other) {
      return other.file == one.file && (other.line == one.line || one.ignored) && other.message == one.message;
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
  const hal::PluginCall call(&name_params, this, group.config);
  std::shared_ptr<const void> read;
  const auto what = thrown([&] {
    ElementReader reader(params, problems);
    read = group.controller->read_params(reader);
    reader.finish();
  });
  if (!what) return read;
  problems.push_back({scenario_.file, config.line,
                      "controller '" + config.id + "' threw while it read its parameters" + *what, false});
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
      if (!new_settings_ && type.reset(block.controller(at.slot), robot)) {
        any_reset_ = true;
        return {};
      }
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

}  // namespace tandem::core
