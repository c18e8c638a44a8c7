// Shared by the device files: reading described options, filling in a DeviceType, stamps, and who obeys.
#pragma once
#include <memory>
#include <type_traits>
#include <vector>

#include "core/device/device.hpp"
#include "core/random/random.hpp"

namespace tandem::core {

template <class Options>
Options read_options(const Element& element, Problems& problems) {
  return read_settings<Options>(element, problems, {"implementation"});
}

template <class Options>
void describe_options(hal::ParamVisitor& visitor) {
  Options options;
  options.describe(visitor);
}

struct NoOptions {
  static NoOptions noisy() { return {}; }
  void describe(hal::ParamVisitor&) {}
};

/// Whether robots of a kind are built with the part. For DeviceType::fits.
template <class Part>
bool has(const hal::RobotKind& kind) {
  return kind.part<Part>() != nullptr;
}

inline DeviceType sensor_type(std::string_view device, std::string_view implementation, std::string_view summary,
                              bool (*fits)(const hal::RobotKind&),
                              BlockFactory<Sensor> (*make)(const Element&, Problems&, const DeviceSetup&),
                              void (*describe)(hal::ParamVisitor&)) {
  return {device, implementation, summary, hal::Role::Sensor, fits, make, nullptr, describe};
}

inline DeviceType actuator_type(std::string_view device, std::string_view implementation, std::string_view summary,
                                bool (*fits)(const hal::RobotKind&),
                                BlockFactory<Actuator> (*make)(const Element&, Problems&, const DeviceSetup&),
                                void (*describe)(hal::ParamVisitor&)) {
  return {device, implementation, summary, hal::Role::Actuator, fits, nullptr, make, describe};
}

/// A device that works in a medium of that kind.
inline DeviceType in_medium(std::string_view kind, DeviceType type) {
  type.medium = kind;
  return type;
}

/// How exact an implementation of a device is: "default" has the errors that files ask for, "ideal" none, "noisy" some.
enum class Level { Default, Ideal, Noisy };

/// Its options. `Errors` describes them, gives those of a noisy one by `noisy()`, and may have `describe_always` for
/// what all three take, and `written`, the name in the file.
template <class Errors, Level kLevel>
struct LevelOptions : Errors {
  LevelOptions() : Errors(kLevel == Level::Noisy ? Errors::noisy() : Errors{}) {}
  void describe(hal::ParamVisitor& v) {
    if constexpr (requires { Errors::describe_always(v); }) Errors::describe_always(v);
    if constexpr (kLevel != Level::Ideal) Errors::describe(v);
  }
};

/// A device of the class `Device`, a Sensor or an Actuator, which says what it is by its types: `Port`, `Errors`, the
/// `Part` that robots need for it (else all have it), the column `Kept` that it keeps, `kField`, which the world
/// must have, and `kMedium`, the kind of the medium that it works in. It is constructed of (setup, errors, columns of
/// the block); `prepare`, if there is such, completes the factory.
template <class Device, Level kLevel>
DeviceType device_type(std::string_view implementation, std::string_view summary) {
  using Errors = typename Device::Errors;
  using Options = LevelOptions<Errors, kLevel>;
  constexpr bool kSenses = std::is_base_of_v<Sensor, Device>;
  using Factory = BlockFactory<std::conditional_t<kSenses, Sensor, Actuator>>;
  constexpr auto make = [](const Element& element, Problems& problems, const DeviceSetup& setup) {
    Errors errors = read_options<Options>(element, problems);
    if constexpr (requires { errors.written; }) errors.written = element.name;
    if constexpr (requires { Device::kField; }) (void)setup.field(Device::kField, element, problems);
    Factory factory(
        [setup, errors](const BlockColumns& columns) { return std::make_unique<Device>(setup, errors, columns); });
    if constexpr (requires { typename Device::Kept; }) factory.columns = {keeps<typename Device::Kept>()};
    if constexpr (requires { Device::prepare(factory, setup, errors); }) Device::prepare(factory, setup, errors);
    return factory;
  };
  DeviceType type;
  type.device = Device::Port::kName;
  type.implementation = implementation;
  type.summary = summary;
  type.fits = [](const hal::RobotKind& kind) {
    if constexpr (requires { typename Device::Part; }) return has<typename Device::Part>(kind);
    return true;
  };
  type.describe = &describe_options<Options>;
  if constexpr (kSenses)
    type.make_sensor = make;
  else
    type.make_actuator = make;
  if constexpr (!kSenses) type.role = hal::Role::Actuator;
  if constexpr (requires { Device::kMedium; }) type.medium = Device::kMedium;
  return type;
}

/// Its three implementations.
template <class Device>
void add_levels(std::vector<DeviceType>& types, std::string_view usual, std::string_view ideal,
                std::string_view noisy) {
  types.push_back(device_type<Device, Level::Default>("default", usual));
  types.push_back(device_type<Device, Level::Ideal>("ideal", ideal));
  types.push_back(device_type<Device, Level::Noisy>("noisy", noisy));
}

/// Whether robot `i` of the block does what its controller says.
inline bool obeys(const DeviceContext& context, std::size_t i) noexcept {
  const std::uint8_t flags = context.stores.bodies.flags[context.block.first_row + i];
  return (flags & (kAlive | kExternal)) == kAlive && context.block.halted[i] == 0;
}

/// Whether robot `i` is a real robot's twin: what it is and does comes from outside.
inline bool led_from_outside(const DeviceContext& context, std::size_t i) noexcept {
  return (context.stores.bodies.flags[context.block.first_row + i] & kExternal) != 0;
}

inline void stamp(const DeviceContext& context, hal::Reading& port) noexcept {
  port.taken_ns = context.now_ns;
  port.validity = hal::Validity::Fresh;
}

/// In [-1, 1).
inline double to_symmetric(std::uint32_t bits) noexcept {
  return 2.0 * to_unit(bits) - 1.0;
}

}  // namespace tandem::core
