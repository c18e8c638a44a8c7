// A robot as its controller sees it while being constructed: who it is, and the devices it has.
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "hal/port.hpp"
#include "hal/spec/data_sheet.hpp"

namespace tandem::hal {

/// A device that the robot does not have, or that its configuration does not list. Thrown from a controller's
/// constructor.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Handed to a controller's constructor and valid only during it; the ports it gives live as long as the robot.
class Robot {
 public:
  virtual ~Robot() = default;

  virtual std::string_view id() const noexcept = 0;
  virtual const DataSheet& data_sheet() const noexcept = 0;
  /// A number of this robot's own, from the run's seed and the robot's id: for controllers that need chance.
  virtual std::uint64_t seed() const noexcept = 0;

  /// The reading of device class `T`; filled before every step.
  /// @throws DeviceError when the robot has no such device or its configuration does not list it.
  template <SensorPort T>
  const T& sensor() {
    return *static_cast<const T*>(take(port_type<T>()));
  }

  /// The command of device class `T`; taken over after every step. Keeps its value until written again.
  /// @throws DeviceError as above.
  template <ActuatorPort T>
  T& actuator() {
    return *static_cast<T*>(take(port_type<T>()));
  }

 protected:
  /// Memory of a port with `type`'s layout. Never null; throws DeviceError.
  virtual void* take(const PortType& type) = 0;
};

}  // namespace tandem::hal
