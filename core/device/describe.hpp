// Shared by the device files: reading described options, and filling in a DeviceType.
#pragma once
#include "core/device/device.hpp"

namespace tandem::core {

template <class Options>
Options read_options(const Element& element, Problems& problems) {
  Options options;
  ElementReader reader(element, problems, {"implementation"});
  options.describe(reader);
  reader.finish();
  return options;
}

template <class Options>
void describe_options(hal::ParamVisitor& visitor) {
  Options options;
  options.describe(visitor);
}

inline DeviceType sensor_type(std::string_view device, std::string_view implementation, std::string_view summary,
                              bool (*fits)(const hal::DataSheet&),
                              Recipe<Sensor> (*make)(const Element&, Problems&, const DeviceSetup&),
                              void (*describe)(hal::ParamVisitor&)) {
  return {device, implementation, summary, hal::Role::Sensor, fits, make, nullptr, describe};
}

inline DeviceType actuator_type(std::string_view device, std::string_view implementation, std::string_view summary,
                                bool (*fits)(const hal::DataSheet&),
                                Recipe<Actuator> (*make)(const Element&, Problems&, const DeviceSetup&),
                                void (*describe)(hal::ParamVisitor&)) {
  return {device, implementation, summary, hal::Role::Actuator, fits, nullptr, make, describe};
}

}  // namespace tandem::core
