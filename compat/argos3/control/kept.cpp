#include "compat/argos3/control/kept.hpp"

#include <cstdlib>
#include <cxxabi.h>
#include <stdexcept>

#include "hal/element.hpp"

namespace tandem::compat::argos3 {

namespace {

hal::DeviceList& list_of(hal::Robot& robot) {
  auto* const list = dynamic_cast<hal::DeviceList*>(&robot);
  if (list == nullptr)
    throw std::runtime_error("a controller of ARGoS' runs in worlds that tell which devices a configuration lists");
  return *list;
}

}  // namespace

const DeviceClass* find_class(const hal::ListedDevice& device) {
  const DeviceClass* same_port = nullptr;
  for (const std::span<const DeviceClass> group : {ring_classes(), motion_classes(), signal_classes()}) {
    for (const DeviceClass& one : group) {
      if (one.role != device.port->role || one.port != device.port->name || one.layout != device.port->layout) continue;
      if (one.written == device.written) return &one;
      if (same_port == nullptr) same_port = &one;
    }
  }
  return same_port;
}

Kept::Kept(hal::Robot& robot, const argos::tandem_detail::SRegistration& registration, ticpp::Element& params) {
  take(robot);
  const ContextScope scope(*this);
  controller_.reset(static_cast<argos::CCI_Controller*>(registration.Create()));
  controller_->SetId(std::string(robot.id()));
  std::size_t next = 0;
  for (const hal::ListedDevice& listed : list_of(robot).devices()) {
    if (find_class(listed) == nullptr) continue;
    Device& device = *devices_[next++];
    if (argos::CCI_Sensor* const sensor = device.as_sensor(); sensor != nullptr) {
      sensors_.emplace_back(sensor, &device);
      controller_->AddSensor(listed.written, sensor);
    } else {
      controller_->AddActuator(listed.written, device.as_actuator());
    }
  }
  controller_->Init(params);
}

/// All devices that the configuration lists and ARGoS has a class for, as at the start.
void Kept::take(hal::Robot& robot) {
  hal::DeviceList& list = list_of(robot);
  std::size_t next = 0;
  unclassed_.clear();
  for (const hal::ListedDevice& listed : list.devices()) {
    const DeviceClass* const found = find_class(listed);
    if (found == nullptr) {
      unclassed_.push_back(listed);
      continue;
    }
    const bool is_new = next == devices_.size();
    if (is_new) devices_.push_back(found->make());
    Device& device = *devices_[next++];
    device.attach(list.port(*listed.port), {list, robot.kind(), listed.written});
    is_new ? device.begin() : device.reset();
  }
  log_ = robot.log();
  set_run_seed(robot.run_seed());
  set_seed(hal::seed_of(robot.run_seed(), robot.id()), robot.id());
}

Kept::~Kept() {
  const ContextScope scope(*this);
  controller_.reset();
}

void Kept::end() {
  if (std::exchange(ended_, true)) return;
  const ContextScope scope(*this);
  try {
    controller_->Destroy();
  } catch (const std::exception& e) {
    log_.error(std::string("in Destroy(): ") + e.what());
  } catch (...) {
    log_.error("in Destroy(): an exception of unknown type");
  }
}

const hal::PortType* Kept::unclassed(std::string_view written, hal::Role role) const {
  for (const hal::ListedDevice& one : unclassed_) {
    if (one.written == written && one.port->role == role) return one.port;
  }
  return nullptr;
}

void Kept::step() {
  const ContextScope scope(*this);
  for (const auto& [sensor, device] : sensors_) {
    if (device->used && sensor->IsEnabled()) device->sense();
  }
  controller_->ControlStep();
}

void Kept::reset(hal::Robot& robot) {
  take(robot);
  const ContextScope scope(*this);
  controller_->SetId(std::string(robot.id()));
  controller_->Reset();
}

void Kept::tell(bool error, std::string_view text) {
  if (!error)
    log_.info(text);
  else if (ended_)
    log_.warning(text);  // an error at its end would be a failure of the run
  else
    log_.error(text);
}

}  // namespace tandem::compat::argos3

namespace argos {

namespace {

template <class Map>
auto* found(const Map& devices, tandem::hal::Role as, const std::string& name, const std::string& id) {
  const auto at = devices.find(name);
  if (at == devices.end()) {
    const char* const role = as == tandem::hal::Role::Sensor ? "sensor" : "actuator";
    const auto* const kept =
        dynamic_cast<const tandem::compat::argos3::Kept*>(tandem::compat::argos3::current_context());
    const auto* const port = kept == nullptr ? nullptr : kept->unclassed(name, as);
    if (port != nullptr)
      THROW_ARGOSEXCEPTION("robot '" << id << "': the configuration lists the " << role << " '" << name
                                     << "', but Tandem's ARGoS layer has no class for it (port " << port->name << ")")
    std::vector<std::string> known;
    for (const auto& [listed, device] : devices) known.push_back(listed);
    THROW_ARGOSEXCEPTION("robot '" << id << "': the controller asks for the " << role << " '" << name
                                   << "', which its configuration does not list; it lists: "
                                   << (known.empty() ? "none" : tandem::hal::listed(known))
                                   << tandem::hal::did_you_mean(name, known))
  }
  auto* const device = dynamic_cast<tandem::compat::argos3::Device*>(at->second);
  if (device != nullptr && !std::exchange(device->used, true)) device->first_use();
  return at->second;
}

std::string plain_name(const std::type_info& type) {
  int status = -1;
  const std::unique_ptr<char, void (*)(void*)> name(abi::__cxa_demangle(type.name(), nullptr, nullptr, &status),
                                                    &std::free);
  return status == 0 ? name.get() : type.name();
}

}  // namespace

CCI_Sensor::CCI_Sensor() : m_bEnabled(true) {}
CCI_Sensor::~CCI_Sensor() = default;
void CCI_Sensor::Enable() {
  m_bEnabled = true;
}
void CCI_Sensor::Disable() {
  m_bEnabled = false;
}
CCI_Actuator::CCI_Actuator() = default;
CCI_Actuator::~CCI_Actuator() = default;

CCI_Controller::CCI_Controller() = default;
CCI_Controller::~CCI_Controller() = default;

CCI_Actuator* CCI_Controller::FindActuator(const std::string& name) const {
  return found(m_mapActuators, tandem::hal::Role::Actuator, name, m_strId);
}
CCI_Sensor* CCI_Controller::FindSensor(const std::string& name) const {
  return found(m_mapSensors, tandem::hal::Role::Sensor, name, m_strId);
}

CCI_Sensor::TMap& CCI_Controller::GetAllSensors() {
  for (const auto& [name, sensor] : m_mapSensors) FindSensor(name);
  return m_mapSensors;
}

void CCI_Controller::WrongDevice(const char* role, const std::string& name, const std::type_info& asked) const {
  std::string is;
  if (role[0] == 's') {
    const CCI_Sensor& sensor = *m_mapSensors.at(name);
    is = plain_name(typeid(sensor));
  } else {
    const CCI_Actuator& actuator = *m_mapActuators.at(name);
    is = plain_name(typeid(actuator));
  }
  THROW_ARGOSEXCEPTION("robot '" << m_strId << "': the " << role << " '" << name << "' is no " << plain_name(asked)
                                 << "; the device's name in the file chooses the class (here " << is << ")")
}

}  // namespace argos
