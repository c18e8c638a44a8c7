// Shared by the device files: reading described options, filling in a DeviceType, stamps, and who obeys.
#pragma once
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
