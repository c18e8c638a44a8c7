// A bridge and the emulated firmware that it talks to, joined by a wire in memory: a real robot's whole way from ports
// to ports, in time that the caller turns.
//
//   WiredRobot::robot()     a controller takes its ports here
//   connect()               power on, handshake
//   each tick: readings into body(); sense(tick); controller step; act(); commands out of body()
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/bridged_robot.hpp"
#include "bridges/port_bank.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::bridges {

struct WiredRequest {
  std::string robot;                           ///< its id
  const hal::RobotKind* robot_kind = nullptr;  ///< what is known of it; null: what the bridge knows itself
  std::string what = {};  ///< which firmware, or its file, as the kind takes it; empty: its usual one
  std::string file = {};  ///< the experiment; files that `what` names may lie beside it
  std::uint64_t seed = 1;
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  std::optional<std::vector<std::string>> sensors = {}, actuators = {};  ///< as of BridgeRequest
  hal::Log log = {};
};

/// Deterministic: nothing here reads a clock or waits. A tick of time is as long as that of the run; in its first part
/// the readings travel, in the next the commands.
class WiredRobot {
 public:
  virtual ~WiredRobot() = default;

  virtual BridgedRobot& robot() noexcept = 0;
  /// The firmware's body: its readings are written from outside, its commands taken from there.
  virtual SharedPorts& body() noexcept = 0;
  /// Lets time pass until the robot may be driven. Error: it cannot be, with what is wrong.
  virtual hal::Status connect() = 0;
  /// The readings of the tick pass through firmware, wire and bridge. Ticks may be left out: the time passes all the
  /// same.
  virtual void sense(hal::Tick tick) = 0;
  /// The commands of the controller pass back.
  virtual void act() = 0;
  /// What is wrong, for people; empty: nothing.
  virtual std::string trouble() const = 0;
};

using MadeWiredRobot = hal::Result<std::unique_ptr<WiredRobot>>;

struct WiredType {
  static constexpr std::string_view kCategory = "wired robot";
  using Crosses = hal::Layouts<WiredRequest, WiredRobot, MadeWiredRobot, BridgedRobot, SharedPorts, PortBank,
                               hal::PortType, hal::RobotKind, hal::RobotKind::Crosses, hal::Log>;
  std::string_view name;     ///< the kind of robot whose bridge it has
  std::string_view summary;  ///< what follows "emulated:"
  /// Errors: a firmware or file that there is not, ticks that are too short for the wire.
  MadeWiredRobot (*make)(const WiredRequest& request) = nullptr;
};

/// Splits a tick for robots whose wire takes up to 40 ms each way.
class WiredTime {
 public:
  static constexpr hal::TimeNs kLeastTick_ns = 100 * hal::kNsPerMs;

  explicit WiredTime(hal::TimeNs tick_ns, hal::TimeNs handshake_ns) : tick_ns_(tick_ns), handshake_ns_(handshake_ns) {}
  static hal::Status check(hal::TimeNs tick_ns) {
    if (tick_ns >= kLeastTick_ns) return {};
    return hal::Error{"an emulated wire needs ticks of at least 100 ms; lower ticks_per_second to 10"};
  }
  hal::TimeNs start_of(hal::Tick tick) const noexcept { return handshake_ns_ + tick * tick_ns_; }
  hal::TimeNs part() const noexcept { return tick_ns_ * 2 / 5; }

 private:
  hal::TimeNs tick_ns_, handshake_ns_;
};

}  // namespace tandem::bridges
