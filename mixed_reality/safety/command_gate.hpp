// Gate between a controller's commands and a real robot: each command passes it once a tick.
//
//   prepare(…)   what the safety table, the ramp and the caller's fence leave of what the controller wants
//   send(…)      what others leave of that (a barrier between robots); handed to the bridge, which then commits
#pragma once
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "mixed_reality/safety/flight_order_gate.hpp"
#include "mixed_reality/safety/supervisor.hpp"

namespace tandem::mixed_reality {

/// Where a controller writes a command. It may be the bridge's own port: that then keeps what the controller wrote.
struct WantedCommand {
  const hal::PortType* type;
  const void* port;
};

/// Allocates nothing after its construction. Not thread-safe.
class CommandGate {
 public:
  /// `all_wheels`: a robot with wheels whose controller takes none is told to stand. `bridge`, and what `wanted` points
  /// to, must outlive this.
  CommandGate(bridges::RobotBridge& bridge, std::vector<WantedCommand> wanted, bool all_wheels);

  /// From now on it drives so, whatever its controller says; nothing: as its controller says.
  void steer(const std::optional<hal::WheelSpeeds>& wheels) noexcept { steered_ = wheels; }

  /// `alive`: it may move. `confine(type, command)` changes a command that moves it, and returns whether it did. `at`:
  /// where the robot is; null: unknown.
  template <class Confine>
  void prepare(const Supervisor& supervisor, bool alive, const hal::Pose* at, hal::TimeNs run_ns, Confine&& confine) {
    alive_ = alive;
    confined_ = 0;
    const auto allow = [&](const hal::PortType& type, void* command) {
      supervisor.allow(type, command, at, run_ns);
      confined_ += confine(type, command) ? 1 : 0;
    };
    for (const Command& c : commands_) {
      std::memcpy(c.sent, c.wanted, c.type->size);
      if (c.is_task) continue;
      if (!alive) {
        c.type->reset(c.sent);
        continue;
      }
      if (c.is_wheels && steered_) std::memcpy(c.sent, &*steered_, sizeof *steered_);
      allow(*c.type, c.sent);
    }
    wheels_ = {};
    if (wheels_alone_ != nullptr && steered_ && alive) {
      wheels_ = *steered_;
      allow(hal::port_type<hal::WheelSpeeds>(), &wheels_);
    }
  }
  /// The commands of this kind as they are prepared.
  template <class Port, class Use>
  void each(Use&& use) const {
    for (const Command& c : commands_) {
      if (c.type->layout == hal::port_type<Port>().layout) use(*static_cast<const Port*>(c.sent));
    }
    if constexpr (std::is_same_v<Port, hal::WheelSpeeds>) {
      if (wheels_alone_ != nullptr && steered_) use(wheels_);
    }
  }

  /// `alive`: it still may move, as it might when they were prepared. `hold_back(type, command)` may change each.
  template <class HoldBack>
  void send(bool alive, bool on_ground, bool land, hal::TimeNs now_ns, HoldBack&& hold_back) {
    if (!alive || !alive_) stand();
    for (const Command& c : commands_) {
      if (c.is_task) {
        auto& task = *static_cast<hal::FlightTask*>(c.sent);
        task = orders_.pass(task, alive && alive_, on_ground);
      }
      if (c.is_task || (alive && alive_)) hold_back(*c.type, c.sent);
      if (c.is_wheels) wheels_ = *static_cast<const hal::WheelSpeeds*>(c.sent);
    }
    if (wheels_alone_ != nullptr && steered_ && alive && alive_)
      hold_back(hal::port_type<hal::WheelSpeeds>(), &wheels_);
    hand_over(land, now_ns);
  }

  /// The wheel speeds that were last handed over.
  const hal::WheelSpeeds& wheels() const noexcept { return wheels_; }
  /// How many of the prepared commands `confine` changed.
  std::uint64_t confined() const noexcept { return confined_; }
  /// A command as it was last sent; stays where it is.
  template <class Visit>
  void for_each_sent(Visit&& visit) const {
    for (const Command& c : commands_) visit(*c.type, static_cast<const void*>(c.sent));
  }

 private:
  struct Command {
    const hal::PortType* type;
    const void* wanted;
    void* real;  // the bridge's port; null: the robot has none such
    void* sent;
    bool is_wheels, is_task;
  };
  void stand() noexcept;
  void hand_over(bool land, hal::TimeNs now_ns);

  bridges::RobotBridge& bridge_;
  std::vector<Command> commands_;
  std::unique_ptr<std::max_align_t[]> memory_;  // of what is sent
  void* wheels_alone_ = nullptr;                // the bridge's, where the controller takes none
  void* task_ = nullptr;                        // of flight; null: it does not fly
  std::optional<hal::WheelSpeeds> steered_;
  FlightOrderGate orders_;
  hal::WheelSpeeds wheels_;
  std::uint64_t confined_ = 0;
  bool alive_ = false;
  bool landing_ = false;  // it was told to, by us
};

}  // namespace tandem::mixed_reality
