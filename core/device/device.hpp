// Simulated devices: what fills a sensor port and what drains an actuator port, one call a block of robots.
#pragma once
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"
#include "hal/port.hpp"

namespace tandem::core {

/// What a device needs to know of the tick. The stores are those of the tick's end: bodies have moved.
struct DeviceContext {
  const SpaceStores& stores;
  const RobotGroup& group;
  const RobotBlock& block;
  hal::Tick tick;
  hal::TimeNs now_ns;
  double tick_s;
  std::uint64_t seed;
};

/// What a device keeps from tick to tick: `per_slot` numbers for every slot of its block.
struct DeviceMemory {
  std::size_t per_slot = 1;
  double at_first = 0.0;  ///< what a new robot starts with
  std::vector<double> values;

  DeviceMemory(std::size_t capacity, std::size_t numbers_per_slot, double first)
      : per_slot(numbers_per_slot), at_first(first), values(capacity * numbers_per_slot, first) {}
  void renew(std::size_t slot) noexcept {
    for (std::size_t i = slot * per_slot; i < (slot + 1) * per_slot; ++i) values[i] = at_first;
  }
};

/// Fills the ports of one block. One object a block, so that state (a battery's charge) needs no locks. Reads the
/// space, never other robots' ports.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// `ports` is the block's array of this port class; rows [0, block.used) are filled.
  virtual void sense(const DeviceContext& context, void* ports) noexcept = 0;
  /// All that it keeps from tick to tick, or null. Snapshots copy it, and a slot's part is renewed for a new robot.
  virtual DeviceMemory* memory() noexcept { return nullptr; }
};

/// Carries the commands of one block into the space, at the start of a tick. Keeps nothing from tick to tick.
class Actuator {
 public:
  virtual ~Actuator() = default;
  /// Writes only rows of its own block in `stores`.
  virtual void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept = 0;
};

/// What a device is made for.
struct DeviceSetup {
  const hal::DataSheet& sheet;
  const RobotItem& item;
  double tick_s = 0.1;
  const std::vector<MediumConfig>* media = nullptr;  ///< of the file; null: none

  /// The number of an LED medium, as in ObjectLed::medium.
  std::uint16_t led_medium(const std::string& id) const noexcept {
    return media == nullptr ? std::uint16_t{0} : led_medium_number(*media, id);
  }
};

template <class Device>
using Recipe = std::function<std::unique_ptr<Device>(std::size_t capacity)>;

/// One implementation of one device class.
struct DeviceType {
  std::string_view device;  ///< the port's name
  std::string_view implementation;
  std::string_view summary;
  hal::Role role = hal::Role::Sensor;
  /// Whether robots with this data sheet have the device at all.
  bool (*fits)(const hal::DataSheet& sheet) = nullptr;
  /// Reads the options (problems with lines); the recipe then makes one object a block. One of the two is set.
  Recipe<Sensor> (*make_sensor)(const Element& options, Problems& problems, const DeviceSetup& setup) = nullptr;
  Recipe<Actuator> (*make_actuator)(const Element& options, Problems& problems, const DeviceSetup& setup) = nullptr;
  /// Shows its options, for the manual.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
};

/// The devices that a configuration lists, read for the robots of one group.
struct GroupRecipes {
  struct Listed {
    std::string_view device;  ///< the port's name
    hal::Role role;
    Recipe<Sensor> sensor;  ///< one of the two is set
    Recipe<Actuator> actuator;
  };
  std::vector<Listed> listed;

  const Listed* find(std::string_view device, hal::Role role) const noexcept;
};

/// All implementations of all devices; the first of a device is its default.
const std::vector<DeviceType>& device_types();

/// The implementation that an experiment file names, or null. "default" is always the first.
const DeviceType* find_device(std::string_view device, hal::Role role, std::string_view implementation);

}  // namespace tandem::core
