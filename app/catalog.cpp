#include "app/catalog.hpp"

#include <algorithm>

#include "core/device/device.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/robot_factory.hpp"

namespace tandem::app {

const core::KnownNames& known_names() {
  static const core::KnownNames names = [] {
    core::KnownNames n;
    n.robots = core::robot_kinds();
    n.engines = core::known_engines();
    for (const core::DeviceType& type : core::device_types()) {
      auto& list = type.role == hal::Role::Sensor ? n.sensors : n.actuators;
      if (std::find(list.begin(), list.end(), type.device) == list.end()) list.emplace_back(type.device);
    }
    return n;
  }();
  return names;
}

}  // namespace tandem::app
