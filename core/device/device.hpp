// Simulated devices: what fills a sensor port and what drains an actuator port, one call a block of robots.
#pragma once
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/medium/medium.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"
#include "hal/catalog.hpp"
#include "hal/port.hpp"

namespace tandem::core {

/// Context of a device in a tick. The stores are those of the tick's end: bodies have moved.
struct DeviceContext {
  const SpaceStores& stores;
  const RobotGroup& group;
  const RobotBlock& block;
  hal::Tick tick;
  hal::TimeNs now_ns;
  double tick_s;
  std::uint64_t seed;
};

/// The columns of one block, for the devices that are made for it and keep what they find.
class BlockColumns {
 public:
  BlockColumns(Columns& columns, std::size_t block) : columns_(columns), block_(block) {}

  /// The rows of the block's robots; null where no device of theirs keeps such.
  template <class T>
  T* find() const {
    return columns_.of<T>().of_block(block_);
  }
  /// The column of all robots.
  template <class T>
  Column<T> of_all() const {
    return columns_.of<T>();
  }

 private:
  Columns& columns_;
  std::size_t block_;
};

/// Fills the ports of one block; one object a block. Keeps nothing from tick to tick but in columns: it may be made
/// again at any time. Reads the space, never other robots' ports; writes no columns but rows of its own block.
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// `ports` is the block's array of this port class; rows [0, block.used) are filled.
  virtual void sense(const DeviceContext& context, void* ports) noexcept = 0;
};

/// Carries the commands of one block into the space, at the start of a tick. Keeps nothing from tick to tick but in
/// columns.
class Actuator {
 public:
  virtual ~Actuator() = default;
  /// Writes only rows of its own block in `stores`.
  virtual void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept = 0;
};

/// Input of a device's factory.
struct DeviceSetup {
  const hal::RobotKind& kind;
  std::shared_ptr<const RobotItem> item;  ///< a changed setting gives the group another one
  double tick_s = 0.1;
  const Fields* fields = nullptr;  ///< of the world; they live as long
  Medium* medium = nullptr;        ///< that the device works in, if any; lives as long as the world
  std::uint8_t channel = 0;        ///< number of the one that the file names, as `medium_number` gives it

  /// The field of that name; null, and a problem at `element`, where the world has none.
  const Field* field(std::string_view name, const Element& element, Problems& problems) const;
  /// The medium by its class; `DeviceType::medium` is of that kind.
  template <class M>
  M& medium_as() const noexcept {
    return static_cast<M&>(*medium);
  }
};

/// Makes a device for one block.
template <class Device>
struct BlockFactory {
  std::function<std::unique_ptr<Device>(const BlockColumns& columns)> make;
  std::vector<KeptColumn> columns;          ///< that its robots need for it
  bool publishes = false, listens = false;  ///< in the device's medium
  double reach_m = 0.0;                     ///< as MediumUse has it

  BlockFactory() = default;
  template <class Make>
  requires std::is_invocable_v<Make, const BlockColumns&> BlockFactory(Make how, std::vector<KeptColumn> kept = {})
      : make(std::move(how)), columns(std::move(kept)) {}
};

/// One implementation of one device class.
struct DeviceType {
  static constexpr std::string_view kCategory = "device";
  static constexpr std::uint32_t kNumber = 2;
  using Crosses = hal::Layouts<StoreLayouts, DeviceContext, BlockColumns, DeviceSetup, BlockFactory<Sensor>,
                               BlockFactory<Actuator>, Sensor, Actuator, Element, Problem, hal::ParamVisitor>;
  std::string_view device;  ///< the port's name
  std::string_view implementation;
  std::string_view summary;
  hal::Role role = hal::Role::Sensor;
  /// Whether robots of this kind are built with what the device at all.
  bool (*fits)(const hal::RobotKind& kind) = nullptr;
  /// Reads the options (problems with lines); the factory then makes one object a block. One of the two is set.
  BlockFactory<Sensor> (*make_sensor)(const Element& options, Problems& problems, const DeviceSetup& setup) = nullptr;
  BlockFactory<Actuator> (*make_actuator)(const Element& options, Problems& problems,
                                          const DeviceSetup& setup) = nullptr;
  /// Shows its options, for the manual.
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  JointKinds joints = 0;         ///< that it works by: only where the robot's engine has them
  std::string_view medium = {};  ///< kind of the medium that it works in; it then has an option `medium`, an id

  std::string catalog_name() const { return device_entry(device, role, implementation); }
  /// As the catalog names it: "sensor proximity noisy".
  static std::string device_entry(std::string_view device, hal::Role role, std::string_view implementation);
};

/// The devices that a configuration lists, read for the robots of one group.
struct GroupFactories {
  struct Listed {
    const DeviceType* type = nullptr;
    BlockFactory<Sensor> sensor;  ///< one of the two is set
    BlockFactory<Actuator> actuator;

    /// Calls `visit` with the factory that is set.
    template <class Visit>
    void with_factory(Visit&& visit) const {
      if (type->role == hal::Role::Sensor)
        visit(sensor);
      else
        visit(actuator);
    }
  };
  std::vector<Listed> listed;

  const Listed* find(std::string_view device, hal::Role role) const noexcept;
};

/// The first device that the group's controllers took and that works by joints other than `there`; null: none.
const DeviceType* device_without_joints(const RobotGroup& group, JointKinds there) noexcept;

/// Adds every simulated device and every coupling of this folder.
void register_devices(hal::Registrar& registrar);

/// The implementation that an experiment file names, or null. "default" is one of every device.
const DeviceType* find_device(const hal::Catalog& catalog, std::string_view device, hal::Role role,
                              std::string_view implementation);

}  // namespace tandem::core
