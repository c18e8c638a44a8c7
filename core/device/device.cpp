#include "core/device/device.hpp"

#include "core/device/coupling.hpp"
#include "core/device/types.hpp"

namespace tandem::core {

const std::vector<DeviceType>& device_types() {
  static const std::vector<DeviceType> all = [] {
    std::vector<DeviceType> types;
    for (auto& part : {wheel_types(), flight_types(), flight_sensor_types(), pan_tilt_types(), proximity_types(),
                       ring_level_types(), body_device_types(), lamp_types(), range_and_bearing_types(), turret_types(),
                       gripper_types(), scanner_types(), camera_types()}) {
      types.insert(types.end(), part.begin(), part.end());
    }
    return types;
  }();
  return all;
}

const std::vector<CouplingType>& coupling_types() {
  static const std::vector<CouplingType> all = {piloting_type(), gripping_type()};
  return all;
}

const GroupRecipes::Listed* GroupRecipes::find(std::string_view device, hal::Role role) const noexcept {
  for (const Listed& one : listed) {
    if (one.type->device == device && one.type->role == role) return &one;
  }
  return nullptr;
}

const DeviceType* device_without_joints(const RobotGroup& group, JointKinds there) noexcept {
  for (const hal::PortType* port : group.ports) {
    const GroupRecipes::Listed* made = group.recipes->find(port->name, port->role);
    if (made != nullptr && (made->type->joints & ~there) != 0) return made->type;
  }
  return nullptr;
}

const DeviceType* find_device(std::string_view device, hal::Role role, std::string_view implementation) {
  for (const DeviceType& type : device_types()) {
    if (type.device == device && type.role == role && type.implementation == implementation) return &type;
  }
  return nullptr;
}

}  // namespace tandem::core
