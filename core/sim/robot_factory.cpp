#include "core/sim/robot_factory.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kCacheLine = 64;

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

/// A controller constructor's view of the robot that it is to drive.
class ConstructedRobot final : public hal::Robot {
 public:
  ConstructedRobot(const Scenario& scenario, SpaceStores& stores, RobotGroup& group, RobotBlock& block,
                   std::uint64_t run_seed)
      : scenario_(scenario), stores_(stores), group_(group), block_(block), run_seed_(run_seed) {}

  void select(std::size_t slot, std::uint32_t entity) {
    slot_ = slot;
    entity_ = entity;
    const RobotEntity& e = stores_.robots[entity];
    id_ = stores_.names[e.item].prefix;
    if (e.number >= 0) id_ += std::to_string(e.number);
  }

  std::string_view id() const noexcept override { return id_; }
  const hal::DataSheet& data_sheet() const noexcept override { return *group_.sheet; }
  std::uint64_t seed() const noexcept override {
    const auto bits = draw(run_seed_, entity_, Stream::ControllerSeed, 0);
    return (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
  }

 protected:
  void* take(const hal::PortType& type) override {
    std::size_t i = 0;
    while (i < group_.ports.size() && !(group_.ports[i]->name == type.name && group_.ports[i]->role == type.role)) ++i;
    if (i == group_.ports.size()) {
      check_listed(type);
      group_.ports.push_back(&type);
      if (type.role == hal::Role::Actuator) {
        if (type.name == hal::WheelSpeeds::kName) group_.wheels = static_cast<int>(i);
        if (type.name == hal::QuadrotorPosition::kName) group_.flight_position = static_cast<int>(i);
        if (type.name == hal::QuadrotorSpeed::kName) group_.flight_speed = static_cast<int>(i);
        if (type.name == hal::TurretDrive::kName) group_.turret = static_cast<int>(i);
        if (type.name == hal::GripperDrive::kName) group_.gripper = static_cast<int>(i);
        if (type.name == hal::ScannerDrive::kName) group_.scanner = static_cast<int>(i);
      }
    }
    if (group_.ports[i]->layout != type.layout) {
      throw hal::DeviceError("device '" + std::string(type.name) +
                             "' has another layout in the controller's library than in "
                             "this program; rebuild the library");
    }
    for (std::size_t b = block_.ports.size(); b < group_.ports.size(); ++b) add_array(*group_.ports[b]);
    return block_.ports[i] + slot_ * type.size;
  }

 private:
  void check_listed(const hal::PortType& type) const {
    const bool sensor = type.role == hal::Role::Sensor;
    const std::string role = sensor ? "sensor" : "actuator";
    const std::string name(type.name);
    if (find_device(type.name, type.role, "default") == nullptr) {
      throw hal::DeviceError("asks for the " + role + " '" + name + "', which no simulated robot has");
    }
    if (!find_device(type.name, type.role, "default")->fits(*group_.sheet)) {
      throw hal::DeviceError("asks for the " + role + " '" + name + "', which the robot '" +
                             std::string(group_.sheet->kind) + "' does not have");
    }
    const ControllerConfig& config = scenario_.controllers[group_.config];
    for (const DeviceChoice& choice : sensor ? config.sensors : config.actuators) {
      if (choice.device == name) return;
    }
    throw hal::DeviceError("asks for the " + role + " '" + name + "', which its configuration '" + config.id +
                           "' does not list; add <" + name + " implementation=\"default\"/> to its <" + role + "s>");
  }

  void add_array(const hal::PortType& type) {
    std::byte* const array = stores_.slab.take(type.size * block_.capacity, std::max(type.align, kCacheLine));
    for (std::size_t i = 0; i < block_.capacity; ++i) type.reset(array + i * type.size);
    block_.ports.push_back(array);
  }

  const Scenario& scenario_;
  SpaceStores& stores_;
  RobotGroup& group_;
  RobotBlock& block_;
  std::uint64_t run_seed_;
  std::size_t slot_ = 0;
  std::uint32_t entity_ = 0;
  std::string id_;
};

/// Robots that share a block must share everything that is not per robot.
bool same_group(const RobotItem& a, const RobotItem& b) {
  return a.kind == b.kind && a.controller == b.controller && !a.params && !b.params && a.rab_range_m == b.rab_range_m &&
         a.rab_payload == b.rab_payload && a.battery.model == b.battery.model &&
         a.battery.start_charge == b.battery.start_charge && a.battery.full_charge == b.battery.full_charge &&
         a.battery.delta == b.battery.delta && a.battery.pos_delta == b.battery.pos_delta &&
         a.battery.orient_delta == b.battery.orient_delta;
}

class Factory {
 public:
  Factory(const Scenario& scenario, std::uint64_t seed, hal::PluginLoader& loader, SpaceStores& stores,
          Problems& problems)
      : scenario_(scenario), seed_(seed), loader_(loader), stores_(stores), problems_(problems) {}

  RobotDevices make(const std::vector<RobotRequest>& requests) {
    std::vector<std::vector<std::uint32_t>> members = group(requests);
    RobotDevices devices;
    stores_.bodies.reserve(requests.size());
    for (std::size_t g = 0; g < members.size(); ++g) {
      sort_by_place(requests, members[g]);
      if (prepare_group(g)) make_blocks(g, requests, members[g], devices);
    }
    for (const RobotGroup& made : stores_.groups) {
      if (made.sheet != nullptr && made.sheet->flies) stores_.bodies.flight.resize(stores_.bodies.size());
    }
    add_mechanisms();
    if (sends_) stores_.broadcasts.resize(stores_.bodies.size());
    return devices;
  }

 private:
  /// Rows for what turns and holds, where a controller takes any port of it.
  void add_mechanisms() {
    Bodies& b = stores_.bodies;
    const auto taken = [this](std::initializer_list<std::string_view> names) {
      for (const RobotGroup& made : stores_.groups) {
        for (const hal::PortType* port : made.ports) {
          if (std::find(names.begin(), names.end(), port->name) != names.end()) return true;
        }
      }
      return false;
    };
    if (taken({hal::TurretDrive::kName, hal::TurretEncoder::kName})) b.turrets.resize(b.size());
    if (taken({hal::GripperDrive::kName})) b.grips.resize(b.size());
    if (taken({hal::ScannerDrive::kName})) b.scanners.resize(b.size());
    if (slants_) b.hidden_rolls.resize(b.size());
  }

  void problem(int line, std::string message) {
    problems_.push_back({scenario_.file, line, std::move(message), false});
  }

  std::vector<std::vector<std::uint32_t>> group(const std::vector<RobotRequest>& requests) {
    std::vector<std::vector<std::uint32_t>> members;
    std::vector<std::size_t> group_of_item(scenario_.robots.size(), 0);
    for (std::size_t i = 0; i < scenario_.robots.size(); ++i) {
      std::size_t g = 0;
      while (g < first_item_.size() && !same_group(scenario_.robots[first_item_[g]], scenario_.robots[i])) ++g;
      if (g == first_item_.size()) {
        first_item_.push_back(i);
        members.emplace_back();
        stores_.groups.emplace_back();
      }
      group_of_item[i] = g;
    }
    for (std::size_t r = 0; r < requests.size(); ++r)
      members[group_of_item[requests[r].item]].push_back(static_cast<std::uint32_t>(r));
    return members;
  }

  void sort_by_place(const std::vector<RobotRequest>& requests, std::vector<std::uint32_t>& members) const {
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

  bool prepare_group(std::size_t g) {
    const RobotItem& item = scenario_.robots[first_item_[g]];
    const ControllerConfig& config = scenario_.controllers[item.controller];
    RobotGroup& group = stores_.groups[g];
    group.config = item.controller;
    group.sheet = data_sheet_of(item.kind);
    if (group.sheet == nullptr) {
      problem(item.line, "unknown kind of robot '" + item.kind + "'");
      return false;
    }
    group.rab_range_m = item.rab_range_m >= 0.0 ? item.rab_range_m : group.sheet->rab_range_m;
    group.rab_payload = item.rab_payload >= 0 ? static_cast<unsigned>(item.rab_payload) : group.sheet->rab_payload;
    const auto type = loader_.controller(config.library, config.label);
    if (!type.ok()) {
      problem(config.line, "controller '" + config.id + "': " + type.error().message);
      return false;
    }
    group.controller = type.value();
    const Element& params = item.params ? *item.params : config.params;
    const std::size_t before = problems_.size();
    ElementReader reader(params, problems_);
    group.params = group.controller->read_params(reader);
    reader.finish();
    // Listed devices must exist even when the controller does not take them.
    bool good = !has_errors(problems_, before);
    good = check_devices(config, config.sensors, hal::Role::Sensor, *group.sheet) && good;
    good = check_devices(config, config.actuators, hal::Role::Actuator, *group.sheet) && good;
    return good;
  }

  bool check_devices(const ControllerConfig& config, const std::vector<DeviceChoice>& choices, hal::Role role,
                     const hal::DataSheet& sheet) {
    bool good = true;
    for (const DeviceChoice& choice : choices) {
      const DeviceType* type = find_device(choice.device, role, choice.implementation);
      const int line = choice.options.line != 0 ? choice.options.line : config.line;
      if (type == nullptr) {
        std::string known;
        for (const DeviceType& t : device_types()) {
          if (t.device == choice.device && t.role == role)
            known += (known.empty() ? "" : ", ") + std::string(t.implementation);
        }
        problem(line, known.empty() ? "no simulated device '" + choice.device + "'"
                                    : "device '" + choice.device + "' has no implementation '" + choice.implementation +
                                          "'; it has: " + known);
        good = false;
      } else if (!type->fits(sheet)) {
        problem(line, "the robot '" + std::string(sheet.kind) + "' has no device '" + choice.device + "'");
        good = false;
      } else {
        Problems found;
        const RobotItem none;
        const DeviceSetup setup{sheet, none};
        if (type->make_sensor != nullptr) (void)type->make_sensor(choice.options, found, setup);
        if (type->make_actuator != nullptr) (void)type->make_actuator(choice.options, found, setup);
        if (checked_.insert(&choice).second) problems_.insert(problems_.end(), found.begin(), found.end());
        good = good && !has_errors(found);
      }
    }
    return good;
  }

  void make_blocks(std::size_t g, const std::vector<RobotRequest>& requests, const std::vector<std::uint32_t>& members,
                   RobotDevices& devices) {
    const std::size_t first_block = stores_.blocks.size();
    for (std::size_t begin = 0; begin < members.size(); begin += kBlockRows) {
      const std::size_t count = std::min(kBlockRows, members.size() - begin);
      RobotBlock block;
      block.group = g;
      block.first_row = stores_.bodies.size();
      block.capacity = count;
      block.used = count;
      stores_.bodies.resize(block.first_row + count);
      stores_.blocks.push_back(std::move(block));
      stores_.groups[g].blocks.push_back(stores_.blocks.size() - 1);
      for (std::size_t i = 0; i < count; ++i) {
        place(requests[members[begin + i]], static_cast<std::uint32_t>(stores_.blocks.size() - 1),
              static_cast<std::uint32_t>(i));
      }
      if (!construct(stores_.blocks.back())) {
        devices.blocks.resize(stores_.blocks.size());
        return;
      }
    }
    add_devices(g, first_block, devices);
  }

  void place(const RobotRequest& request, std::uint32_t block, std::uint32_t slot) {
    RobotEntity& e = stores_.robots[request.entity];
    e.block = block;
    e.slot = slot;
    e.alive = true;
    Bodies& b = stores_.bodies;
    const std::size_t row = stores_.blocks[block].first_row + slot;
    b.x_m[row] = request.x_m;
    b.y_m[row] = request.y_m;
    b.cos_h[row] = std::cos(request.yaw_rad);
    b.sin_h[row] = std::sin(request.yaw_rad);
    b.radius_m[row] = static_cast<float>(stores_.groups[stores_.blocks[block].group].sheet->body_radius_m);
    if (b.has_motion) {
      b.motion[row].z_m = request.z_m;
      b.motion[row].q_WB = {std::cos(0.5 * request.yaw_rad), 0.0, 0.0, std::sin(0.5 * request.yaw_rad)};
    }
    b.flags[row] = kAlive;
    b.entity[row] = request.entity;
  }

  bool construct(RobotBlock& block) {
    RobotGroup& group = stores_.groups[block.group];
    const hal::ControllerType& type = *group.controller;
    block.controller_stride = (type.size + type.align - 1) / type.align * type.align;
    block.controllers = stores_.slab.take(block.controller_stride * block.capacity, std::max(type.align, kCacheLine));
    ConstructedRobot robot(scenario_, stores_, group, block, seed_);
    block.used = 0;
    for (std::size_t slot = 0; slot < block.capacity; ++slot) {
      const std::uint32_t entity = stores_.bodies.entity[block.first_row + slot];
      robot.select(slot, entity);
      std::string why;
      try {
        type.construct(block.controllers + slot * block.controller_stride, robot, group.params.get());
        ++block.used;
        continue;
      } catch (const std::exception& e) {
        why = e.what();
      } catch (...) {
        why = "threw an exception of unknown type";
      }
      const ControllerConfig& config = scenario_.controllers[group.config];
      problem(config.line, "controller '" + config.id + "' (" + std::string(type.name) + ") of robot '" +
                               std::string(robot.id()) + "' " + why);
      return false;
    }
    return true;
  }

  void add_devices(std::size_t g, std::size_t first_block, RobotDevices& devices) {
    RobotGroup& group = stores_.groups[g];
    const ControllerConfig& config = scenario_.controllers[group.config];
    const DeviceSetup setup{*group.sheet, scenario_.robots[first_item_[g]],
                            1.0 / static_cast<double>(scenario_.ticks_per_second)};
    devices.blocks.resize(stores_.blocks.size());
    for (const hal::PortType* port : group.ports) {
      const bool is_sensor = port->role == hal::Role::Sensor;
      const DeviceChoice* choice = nullptr;
      for (const DeviceChoice& c : is_sensor ? config.sensors : config.actuators) {
        if (c.device == port->name) choice = &c;
      }
      const DeviceType* type = find_device(port->name, port->role, choice->implementation);
      Problems already_reported;
      const Recipe<Sensor> sensor = is_sensor ? type->make_sensor(choice->options, already_reported, setup) : nullptr;
      const Recipe<Actuator> actuator =
          is_sensor ? nullptr : type->make_actuator(choice->options, already_reported, setup);
      for (std::size_t b = first_block; b < stores_.blocks.size(); ++b) {
        const std::size_t capacity = stores_.blocks[b].capacity;
        devices.blocks[b].sensors.push_back(is_sensor ? sensor(capacity) : nullptr);
        devices.blocks[b].actuators.push_back(is_sensor ? nullptr : actuator(capacity));
      }
      if (port->name == hal::RangeAndBearingSend::kName && !is_sensor) sends_ = true;
      if (!is_sensor && type->implementation == kSlanted) slants_ = true;
    }
  }

  const Scenario& scenario_;
  std::uint64_t seed_;
  hal::PluginLoader& loader_;
  SpaceStores& stores_;
  Problems& problems_;
  std::vector<std::size_t> first_item_;  // of each group
  std::set<const DeviceChoice*> checked_;
  bool sends_ = false;
  bool slants_ = false;
};

}  // namespace

const hal::DataSheet* data_sheet_of(std::string_view kind) {
  for (const hal::DataSheet* sheet : {&hal::epuck::kDataSheet, &hal::eyebot::kDataSheet, &hal::footbot::kDataSheet}) {
    if (sheet->kind == kind) return sheet;
  }
  return nullptr;
}

std::vector<std::string> robot_kinds() {
  return {std::string(hal::epuck::kDataSheet.kind), std::string(hal::eyebot::kDataSheet.kind),
          std::string(hal::footbot::kDataSheet.kind)};
}

RobotDevices make_robots(const Scenario& scenario, const std::vector<RobotRequest>& requests, std::uint64_t seed,
                         hal::PluginLoader& loader, SpaceStores& stores, Problems& problems) {
  return Factory(scenario, seed, loader, stores, problems).make(requests);
}

void destroy_controllers(SpaceStores& stores) noexcept {
  for (RobotBlock& block : stores.blocks) {
    const RobotGroup& group = stores.groups[block.group];
    if (group.controller == nullptr) continue;
    for (std::size_t i = 0; i < block.used; ++i)
      group.controller->destroy(block.controllers + i * block.controller_stride);
    block.used = 0;
  }
}

}  // namespace tandem::core
