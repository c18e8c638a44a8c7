// A robot whose readings are made up: the same on every machine, and none of any world.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/device_list.hpp"
#include "hal/robot.hpp"

namespace tandem::decisions {

/// Has every device that is asked for. What its sensors read is a function of (device, field, element, tick) alone,
/// made from the device's own description: within what its unit, or the robot's kind, allows. Each value stays
/// for a few ticks; a few readings in a hundred are stale or absent.
class MadeUpRobot final : public hal::Robot, public hal::DeviceList {
 public:
  /// `listed`: what its configuration lists, for controllers that take all of that.
  explicit MadeUpRobot(const hal::RobotKind& kind, std::vector<hal::ListedDevice> listed = {})
      : kind_(kind), listed_(std::move(listed)) {}

  std::string_view id() const noexcept override { return "robot"; }
  const hal::RobotKind& kind() const noexcept override { return kind_; }
  std::uint64_t run_seed() const noexcept override { return 1; }

  std::vector<hal::ListedDevice> devices() const override { return listed_; }
  void* port(const hal::PortType& type) override { return take(type); }

  /// Fills every sensor that was taken.
  void sense(std::int64_t tick);

  /// Mixes every value of every actuator that was taken into `hash`, in the order of their names.
  std::uint64_t mix_commands(std::uint64_t hash) const noexcept;

 private:
  struct Device {
    const hal::PortType* type = nullptr;
    std::vector<std::max_align_t> memory;
    std::uint64_t key = 0;  // of its stream of made-up values

    void* port() { return memory.data(); }
    const void* port() const { return memory.data(); }
  };

  void* take(const hal::PortType& type) override;
  void fill(Device& device, std::int64_t tick);
  void fill_clock(Device& device, std::int64_t tick);
  double made_up(const hal::PortType& type, const hal::Field& field, std::size_t index, std::uint64_t bits) const;
  double entries(const hal::PortType& type, const hal::Field& field, std::uint64_t bits) const;

  const hal::RobotKind& kind_;
  std::vector<hal::ListedDevice> listed_;
  std::map<std::string, Device> sensors_, actuators_;  // nodes stay where they are
};

}  // namespace tandem::decisions
