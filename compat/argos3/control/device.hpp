// Devices of a robot as ARGoS' controllers have them, each on one port of ours.
#pragma once
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/control_interface/ci_sensor.h>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hal/device_list.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::compat::argos3 {

/// The robot that devices are made for.
struct Fitting {
  hal::DeviceList& list;
  const hal::RobotKind& kind;
  std::string written;  ///< name of the device in the file

  /// A port that the configuration lists, too; null: it does not.
  template <class Port>
  Port* find() const {
    for (const hal::ListedDevice& device : list.devices()) {
      if (device.port->name == Port::kName && device.port->role == hal::port_type<Port>().role)
        return static_cast<Port*>(list.port(*device.port));
    }
    return nullptr;
  }
};

/// A device as our side uses it.
class Device {
 public:
  virtual ~Device() = default;
  /// Of this port it reads, or writes it. Again when the experiment begins again.
  virtual void attach(void* port, const Fitting& fitting) = 0;
  /// Before each step of the controller: takes over the port's reading.
  virtual void sense() {}
  /// The controller asks for it, in the middle of a step perhaps.
  void first_use() {
    if (const argos::CCI_Sensor* const sensor = as_sensor(); sensor != nullptr && sensor->IsEnabled()) sense();
  }
  /// As at the start: once, before Init.
  virtual void begin() {}
  /// The experiment begins again. A device that Init switched on stays on.
  virtual void reset() { begin(); }
  virtual argos::CCI_Sensor* as_sensor() noexcept { return nullptr; }
  virtual argos::CCI_Actuator* as_actuator() noexcept { return nullptr; }

  bool used = false;  ///< the controller has asked for it
};

/// A sensor of ARGoS' class `Cci` on a port.
template <class Cci, class Port>
class SensorOn : public Cci, public Device {
 public:
  using PortClass = Port;
  void attach(void* port, const Fitting& fitting) override {
    port_ = static_cast<const Port*>(port);
    fit(fitting);
  }
  argos::CCI_Sensor* as_sensor() noexcept final { return this; }

 protected:
  virtual void fit(const Fitting&) {}
  const Port& port() const noexcept { return *port_; }

 private:
  const Port* port_ = nullptr;
};

/// An actuator of ARGoS' class `Cci` on a port; commands go there at once.
template <class Cci, class Port>
class ActuatorOn : public Cci, public Device {
 public:
  using PortClass = Port;
  void attach(void* port, const Fitting& fitting) override {
    port_ = static_cast<Port*>(port);
    fit(fitting);
  }
  argos::CCI_Actuator* as_actuator() noexcept final { return this; }

 protected:
  virtual void fit(const Fitting&) {}
  Port& port() noexcept { return *port_; }

 private:
  Port* port_ = nullptr;
};

/// A device that ARGoS' controllers may ask for.
struct DeviceClass {
  std::string_view written;  ///< as files name it
  hal::Role role = hal::Role::Sensor;
  std::string_view port;     ///< of ours
  std::uint64_t layout = 0;  ///< of the port as this library knows it
  std::unique_ptr<Device> (*make)() = nullptr;
};

template <class Made>
DeviceClass device_class(std::string_view written) {
  const hal::PortType& type = hal::port_type<typename Made::PortClass>();
  return {written, type.role, type.name, type.layout, [] { return std::unique_ptr<Device>(std::make_unique<Made>()); }};
}

// By group.
std::span<const DeviceClass> ring_classes();
std::span<const DeviceClass> motion_classes();
std::span<const DeviceClass> signal_classes();

/// The class of a device that a configuration lists, or null: ARGoS has none for it.
const DeviceClass* find_class(const hal::ListedDevice& device);

}  // namespace tandem::compat::argos3
