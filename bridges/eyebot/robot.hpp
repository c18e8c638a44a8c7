// The eye-bot as its controller sees it: ports that the driver fills and drains.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/robot.hpp"
#include "hal/spec/eyebot.hpp"

namespace tandem::bridges::eyebot {

/// Every port class that an eye-bot has: sensors first. Range-and-bearing and distance scanner are in both halves.
const std::vector<const hal::PortType*>& port_types();

struct RobotSettings {
  std::string id = "eyebot";
  std::uint64_t seed = 0;
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  hal::TimeNs origin_ns = 0;  ///< start of the run on CLOCK_MONOTONIC; readings are stamped from there
  /// Readings that are older by this than their messages may lie apart are stale; 0: two ticks, at least 150 ms.
  hal::TimeNs fresh_ns = 0;
  /// Names of the devices that the configuration lists; empty optional: all that the robot has.
  std::optional<std::vector<std::string>> sensors = {};
  std::optional<std::vector<std::string>> actuators = {};
};

/// Not thread-safe: one thread constructs, latches, steps and commits.
class EyebotRobot final : public hal::Robot {
 public:
  explicit EyebotRobot(RobotSettings settings);
  EyebotRobot(const EyebotRobot&) = delete;
  EyebotRobot& operator=(const EyebotRobot&) = delete;

  std::string_view id() const noexcept override { return settings_.id; }
  const hal::DataSheet& data_sheet() const noexcept override { return hal::eyebot::kDataSheet; }
  std::uint64_t run_seed() const noexcept override { return settings_.seed; }

  /// Takes a port by its description, for those who fuse, record or inspect. The memory lives as long as the robot.
  /// @throws hal::DeviceError
  void* require(const hal::PortType& type) { return take(type); }
  /// Takes a port whatever the configuration lists; null when there is none of that name, role and layout.
  void* find(const hal::PortType& type) noexcept;

  struct PortView {
    const hal::PortType* type;
    void* data;
  };
  /// Ports that were taken, in this order.
  std::vector<PortView> taken() const;
  /// Whether somebody reads or writes the port. `type` is one of `port_types()`.
  bool uses(const hal::PortType& type) const noexcept { return row(type).taken; }
  template <class T>
  bool uses() const noexcept {
    return uses(hal::port_type<T>());
  }
  template <class T>
  T& port() const noexcept {
    return *static_cast<T*>(static_cast<void*>(row(hal::port_type<T>()).data.get()));
  }

  const RobotSettings& settings() const noexcept { return settings_; }
  void set_origin(hal::TimeNs origin_ns) noexcept { settings_.origin_ns = origin_ns; }
  /// Stamps a reading that was taken at `taken` (CLOCK_MONOTONIC) and comes every `period_ns`.
  void stamp(hal::Reading& reading, hal::TimeNs taken, hal::TimeNs period_ns, hal::TimeNs now) const noexcept;
  /// Fills the clock.
  void tell_time(hal::Tick tick) noexcept;

 protected:
  void* take(const hal::PortType& type) override;

 private:
  struct Row {
    const hal::PortType* type;
    std::unique_ptr<std::max_align_t[]> data;
    bool taken = false;
  };
  const Row& row(const hal::PortType& type) const noexcept;
  bool listed(const hal::PortType& type) const;
  void* take(Row& row);

  RobotSettings settings_;
  std::vector<Row> rows_;  // parallel to `port_types()`
  std::vector<std::size_t> order_;
};

}  // namespace tandem::bridges::eyebot
