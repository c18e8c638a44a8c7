// The Thymio as its controller sees it: ports that the wiring fills and drains.
#pragma once
#include <vector>

#include "bridges/bridged_robot.hpp"
#include "bridges/reckoning.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio {

/// Every port class that a Thymio has: sensors first.
const std::vector<const hal::PortType*>& port_types();

/// Ports of one Thymio. Its motors tell speeds, not ways: what its wheels have rolled is added up from them.
class ThymioRobot final : public BridgedRobot {
 public:
  explicit ThymioRobot(RobotSettings settings);

  /// Whether somebody reads or writes the port, be it only the odometry. `type` is one of `port_types()`.
  bool uses(const hal::PortType& type) const noexcept;
  template <class T>
  bool uses() const noexcept {
    return uses(hal::port_type<T>());
  }

  /// What follows from the readings that were just filled: clock and odometry.
  void complete(hal::Tick tick) noexcept;

 private:
  Reckoning reckoning_;
};

}  // namespace tandem::bridges::thymio
