// A real robot as its controller sees it: ports that a driver fills and drains.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/port_bank.hpp"
#include "bridges/robot_bridge.hpp"
#include "hal/robot.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

struct RobotSettings {
  std::string id = "robot";
  const hal::RobotKind* kind = nullptr;  ///< what is known of it, for as long as it lives; null: what the bridge knows
  std::uint64_t seed = 0;
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  hal::TimeNs origin_ns = 0;  ///< start of the run on the link's clock; readings are stamped from there
  /// Readings that are older by this than their period are stale; 0: two ticks, at least 150 ms.
  hal::TimeNs fresh_ns = 0;
  /// Names of the devices that the configuration lists; empty optional: all that the robot has.
  std::optional<std::vector<std::string>> sensors = {};
  std::optional<std::vector<std::string>> actuators = {};
};

/// Ports of one robot. Those that were taken, by a controller, with `require` or with `find`, are what the robot is
/// asked for and told. Not thread-safe: one thread constructs, latches, steps and commits.
class BridgedRobot : public hal::Robot {
 public:
  /// `noun`: what such a robot is called in messages, "foot-bot". `kind`: unless the settings have one.
  BridgedRobot(std::string_view noun, const hal::RobotKind& kind, RobotSettings settings,
               std::span<const hal::PortType* const> types);
  BridgedRobot(const BridgedRobot&) = delete;
  BridgedRobot& operator=(const BridgedRobot&) = delete;

  std::string_view id() const noexcept override { return settings_.id; }
  const hal::RobotKind& kind() const noexcept override { return kind_; }
  std::uint64_t run_seed() const noexcept override { return settings_.seed; }

  /// Takes a port by its description, for those who fuse, record or inspect. The memory lives as long as the robot.
  /// @throws hal::DeviceError
  void* require(const hal::PortType& type) { return take(type); }
  /// Takes a port whatever the configuration lists; null when there is none of that name, role and layout that can be
  /// reached.
  void* find(const hal::PortType& type) noexcept;
  /// Ports that were taken, in this order.
  std::vector<PortView> taken() const;
  /// Ports that can be reached.
  std::vector<const hal::PortType*> present() const;

  /// Whether the port is read or written. `type` is one of those that the robot was made with.
  bool uses(const hal::PortType& type) const noexcept { return state_[bank_.row_of(type)].taken; }
  template <class T>
  bool uses() const noexcept {
    return uses(hal::port_type<T>());
  }
  void* memory(const hal::PortType& type) const noexcept { return bank_.rows()[bank_.row_of(type)].data(); }
  template <class T>
  T& port() const noexcept {
    return *static_cast<T*>(memory(hal::port_type<T>()));
  }

  const RobotSettings& settings() const noexcept { return settings_; }
  void set_origin(hal::TimeNs origin_ns) noexcept { settings_.origin_ns = origin_ns; }
  /// Stamps a reading taken at `taken` (link's clock) that comes every `period_ns`; 0: it never came, and stays absent.
  void stamp(hal::Reading& reading, hal::TimeNs taken, hal::TimeNs period_ns, hal::TimeNs now) const noexcept;
  /// Fills the clock.
  void tell_time(hal::Tick tick) noexcept;
  /// Makes every command safe against the robot's kind; calls `count` for each that was changed.
  template <class Count>
  void limit_commands(Count&& count) noexcept {
    for (const PortBank::Row& row : bank_.rows()) {
      hal::Limited what;
      if (row.type->limit != nullptr && row.type->limit(row.data(), 0, 1, kind_, what) == 0) count(what);
    }
  }
  /// Keeps every command as it is now; `restore_commands` brings it back: what a controller wrote stays, it may write
  /// once and never again.
  void keep_commands() noexcept;
  void restore_commands() noexcept;

 protected:
  void* take(const hal::PortType& type) override;
  /// The port cannot be reached, and `find` does not give it. `why` follows "has no sensor 'gripper'" for a controller;
  /// without a reason a controller gets it all the same: others may fill it.
  void leave_out(const hal::PortType& type, std::string_view why = {});
  /// What follows "has no sensor 'x'" where no robot of the kind has one.
  std::string_view never_had = {};

 private:
  struct State {
    bool present = true;
    bool taken = false;
    std::string_view why = {};  // it is not present
  };
  bool listed(const hal::PortType& type) const;
  void* take(std::size_t row);

  std::string noun_;
  const hal::RobotKind& kind_;
  RobotSettings settings_;
  PortBank bank_;
  std::vector<State> state_;  // parallel to the bank's rows
  std::vector<std::size_t> order_;
  std::vector<std::byte> kept_;  // the commands, one after the other
};

}  // namespace tandem::bridges
