#include "core/device/device.hpp"

#include "core/device/coupling.hpp"
#include "core/device/types.hpp"

namespace tandem::core {

void register_devices(hal::Registrar& registrar) {
  static const std::vector<DeviceType> all = [] {
    std::vector<DeviceType> types;
    for (auto& part : {wheel_types(), flight_types(), flight_sensor_types(), pan_tilt_types(), proximity_types(),
                       ring_level_types(), accelerometer_types(), body_device_types(), lamp_types(),
                       time_of_flight_types(), selector_types(), button_types(), range_and_bearing_types(),
                       turret_types(), gripper_types(), scanner_types(), camera_types()}) {
      types.insert(types.end(), part.begin(), part.end());
    }
    return types;
  }();
  for (const DeviceType& type : all) registrar.add(type);
  static const std::vector<CouplingType> couplings = {piloting_type(), gripping_type()};
  for (const CouplingType& type : couplings) registrar.add(type);
}

const Field* DeviceSetup::field(std::string_view name, const Element& element, Problems& problems) const {
  const Field* const found = fields->find(name);
  if (found != nullptr) return found;
  std::vector<std::string> names;
  for (const Fields::Entry& entry : fields->all()) names.push_back(entry.name);
  problems.push_back(problem_at(element, "<" + element.name + "> senses the field '" + std::string(name) +
                                             "', which is not there; there are: " + listed(names)));
  return nullptr;
}

const GroupFactories::Listed* GroupFactories::find(std::string_view device, hal::Role role) const noexcept {
  for (const Listed& one : listed) {
    if (one.type->device == device && one.type->role == role) return &one;
  }
  return nullptr;
}

const DeviceType* device_without_joints(const RobotGroup& group, JointKinds there) noexcept {
  for (const hal::PortType* port : group.ports) {
    const GroupFactories::Listed* made = group.factories->find(port->name, port->role);
    if (made != nullptr && (made->type->joints & ~there) != 0) return made->type;
  }
  return nullptr;
}

std::string DeviceType::device_entry(std::string_view device, hal::Role role, std::string_view implementation) {
  return hal::port_entry(device, role) + " " + std::string(implementation);
}

const DeviceType* find_device(const hal::Catalog& catalog, std::string_view device, hal::Role role,
                              std::string_view implementation) {
  return catalog.find<DeviceType>(DeviceType::device_entry(device, role, implementation));
}

}  // namespace tandem::core
