// A wired robot whose bridge is a driver: its life tick by tick, whatever its wire.
#pragma once
#include <algorithm>
#include <string>

#include "bridges/wired/wired_robot.hpp"

namespace tandem::bridges::wired {

/// Powers the firmware on, lets the driver find it, and turns the time of both. What kind of wire joins them is the
/// derived class's, which also owns firmware and driver.
///
/// `Driver` has robot(), latch(tick, now), commit(now) and state(); `kActive` is the state in which it may be driven.
template <class Driver, auto kActive>
class WiredLine : public WiredRobot {
 public:
  BridgedRobot& robot() noexcept final { return driver().robot(); }

  hal::Status connect() final {
    power_on();
    while (now_ < handshake_ns_) {
      driver().latch(0, now_);
      driver().commit(now_);
      elapse(tick_ns_);
    }
    if (driver().state() == kActive) return {};
    return hal::Error{"the emulated firmware was not found: " + trouble()};
  }

  void sense(hal::Tick tick) final {
    while (now_ + step_ns_ <= time_.start_of(tick)) elapse(std::min(time_.start_of(tick) - now_, tick_ns_));
    driver().commit(now_);  // asks for the readings of this instant; the commands are those of the last tick
    elapse(time_.part());
    driver().latch(tick, now_);
  }

  void act() final {
    driver().commit(now_);
    elapse(time_.part());
  }

 protected:
  /// `handshake_ns`: how long the bridge may take to find its robot. `step_ns`: how often both ends of the wire are
  /// turned.
  WiredLine(const WiredRequest& request, hal::TimeNs handshake_ns, hal::TimeNs step_ns)
      : time_(request.tick_ns, handshake_ns),
        handshake_ns_(handshake_ns),
        tick_ns_(request.tick_ns),
        step_ns_(step_ns) {}

  virtual Driver& driver() noexcept = 0;
  /// At the instant 0.
  virtual void power_on() = 0;
  /// Both ends of the wire live at this instant.
  virtual void turn(hal::TimeNs now) = 0;

  hal::TimeNs now_ns() const noexcept { return now_; }

  /// The input of every driver.
  template <class Settings>
  static void set_robot(Settings& settings, const WiredRequest& request, hal::TimeNs handshake_ns) {
    settings.robot.id = request.robot;
    settings.robot.kind = request.robot_kind;
    settings.robot.seed = request.seed;
    settings.robot.tick_ns = request.tick_ns;
    settings.robot.origin_ns = handshake_ns;
    settings.robot.sensors = request.sensors;
    settings.robot.actuators = request.actuators;
    settings.command_timeout_ns = std::max(settings.command_timeout_ns, 2 * request.tick_ns);
  }

 private:
  void elapse(hal::TimeNs duration_ns) {
    const hal::TimeNs end = now_ + duration_ns;
    for (; now_ < end; now_ += step_ns_) turn(now_);
  }

  WiredTime time_;
  hal::TimeNs handshake_ns_, tick_ns_, step_ns_, now_ = 0;
};

MadeWiredRobot make_wired_epuck(const WiredRequest& request);
MadeWiredRobot make_wired_footbot(const WiredRequest& request);

}  // namespace tandem::bridges::wired
