// Devices that a configuration lists: for controllers that take whatever there is, such as scripts.
#pragma once
#include <string>
#include <vector>

#include "hal/port.hpp"

namespace tandem::hal {

/// A device that a configuration lists.
struct ListedDevice {
  const PortType* port = nullptr;  ///< the program's description; lives as long as the robot
  std::string written;             ///< as the file names it: "footbot_proximity", say, for the port "proximity"
};

/// What a hal::Robot also is where it knows its configuration; asked for by dynamic_cast.
class DeviceList {
 public:
  virtual ~DeviceList() = default;
  /// Sensors first.
  virtual std::vector<ListedDevice> devices() const = 0;
  /// Memory of the port that is so described. Never null. @throws DeviceError
  virtual void* port(const PortType& type) = 0;
};

}  // namespace tandem::hal
