// A controller that is not one of a simulated row.
#pragma once
#include <cstddef>
#include <new>
#include <string>
#include <utility>

#include "hal/controller.hpp"
#include "hal/plugin_call.hpp"
#include "hal/robot_log.hpp"
#include "hal/time.hpp"

namespace tandem::app {

/// One controller made for a real robot, in memory of its own. What it says goes to `log`.
class BridgedController final : hal::RobotLog::Sink {
 public:
  /// `who` names it where it crashes or does not return: "controller 'walk' (library 'walk') of robot 'ep0'"; empty: by
  /// its label.
  BridgedController(const hal::ControllerType& type, hal::Robot& robot, const void* params,
                    std::int64_t ticks_per_second, const hal::Log& log, std::string who = {})
      : type_(type),
        who_(who.empty() ? "controller '" + std::string(type.name) + "'" : std::move(who)),
        memory_(::operator new (type.size, std::align_val_t{type.align})),
        log_(log),
        id_(robot.id()),
        ticks_per_second_(ticks_per_second) {
    robot.set_log(hal::RobotLog(*this, 0));
    const hal::PluginCall call(&name, this, kMade);
    try {
      type.construct(memory_, robot, params);
    } catch (...) {
      ::operator delete (memory_, std::align_val_t{type.align});
      throw;
    }
  }
  ~BridgedController() override {
    const hal::PluginCall call(&name, this, kDestroyed);
    type_.destroy(memory_);
    ::operator delete (memory_, std::align_val_t{type_.align});
  }
  BridgedController(const BridgedController&) = delete;
  BridgedController& operator=(const BridgedController&) = delete;

  void* memory() noexcept { return memory_; }
  /// Shows what people may change. @throws whatever the controller throws
  void controls(hal::Controls& controls) {
    if (type_.controls != nullptr) type_.controls(memory_, controls);
  }
  /// False when it threw; `why` then says what.
  bool step(std::string& why, hal::Tick tick = 0) {
    tick_ = tick;
    const std::uint8_t running = 0;
    hal::PluginCall call(&name, this, kSteps + static_cast<std::size_t>(tick));
    if (type_.step_row(static_cast<std::byte*>(memory_), type_.size, 0, 1, &running, call.fault()) == 1) return true;
    why = call.fault().message;
    return false;
  }

 private:
  hal::TimeNs now_ns() const noexcept override { return hal::time_of_tick(tick_, ticks_per_second_); }
  void write(std::uint32_t, hal::Severity severity, std::string_view text, std::uint32_t left_out) noexcept override {
    log_.write(severity, hal::message_of(id_, tick_, text, left_out));
  }
  // Parts of the calls: from kSteps on they are ticks.
  static constexpr std::size_t kMade = 0, kDestroyed = 1, kSteps = 2;

  static void name(const void* self, std::size_t part, std::size_t /*index*/, hal::FixedText& out) noexcept {
    out << static_cast<const BridgedController*>(self)->who_;
    if (part == kMade) {
      out << ", while it was made,";
    } else if (part == kDestroyed) {
      out << ", while it was destroyed,";
    } else {
      out << " at tick " << static_cast<std::int64_t>(part - kSteps);
    }
  }

  const hal::ControllerType& type_;
  std::string who_;
  void* memory_;
  hal::Log log_;
  std::string id_;
  std::int64_t ticks_per_second_;
  hal::Tick tick_ = 0;
};

}  // namespace tandem::app
