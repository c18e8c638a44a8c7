// A real robot while its controller is constructed, with the devices that its configuration lists.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/bridged_robot.hpp"
#include "bridges/peer/peer_robot.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/device_list.hpp"
#include "hal/robot.hpp"

namespace tandem::app {

/// Gives what `robot` gives. Both, and the configuration, outlive it.
class ListedRobot final : public hal::Robot, public hal::DeviceList {
 public:
  ListedRobot(hal::Robot& robot, const core::ControllerConfig& config, const hal::Catalog& catalog)
      : robot_(robot), config_(config), catalog_(catalog) {}

  std::string_view id() const noexcept override { return robot_.id(); }
  const hal::RobotKind& kind() const noexcept override { return robot_.kind(); }
  std::uint64_t run_seed() const noexcept override { return robot_.run_seed(); }
  std::vector<hal::ListedDevice> devices() const override { return core::listed_devices(config_, catalog_, true); }
  void* port(const hal::PortType& type) override { return take(type); }

  /// Told what the controller publishes, which is unused otherwise.
  void on_show(std::function<void(hal::PublishedField, const void* member)> told) { on_show_ = std::move(told); }

 protected:
  void* take(const hal::PortType& type) override {
    if (auto* const bridged = dynamic_cast<bridges::BridgedRobot*>(&robot_)) return bridged->require(type);
    if (auto* const peer = dynamic_cast<bridges::peer::PeerRobot*>(&robot_)) return peer->require(type);
    throw hal::DeviceError("robot '" + std::string(id()) + "' has ports of a form that is not known here");
  }
  void show(hal::PublishedField field, const void* member) override {
    if (auto* const peer = dynamic_cast<bridges::peer::PeerRobot*>(&robot_))
      return peer->published(std::move(field), member);
    if (on_show_) on_show_(std::move(field), member);
  }

 private:
  hal::Robot& robot_;
  const core::ControllerConfig& config_;
  const hal::Catalog& catalog_;
  std::function<void(hal::PublishedField, const void*)> on_show_;
};

}  // namespace tandem::app
