// A robot of some kind with its line, its driver and its stopper, in time that a test turns by hand.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/time.hpp"
#include "tests/golden/golden.hpp"

namespace tandem::faults {

using hal::TimeNs;

inline constexpr TimeNs kMs = hal::kNsPerMs;
inline constexpr TimeNs kSecond = hal::kNsPerSecond;
inline constexpr TimeNs kTick = 100 * kMs;

/// What the light on the robot shows at `now`: time itself, so that a reading tells when it was taken.
inline constexpr TimeNs kLightPeriod = 8 * kSecond;
inline double light_at(TimeNs now) noexcept {
  return static_cast<double>(now % kLightPeriod) / static_cast<double>(kLightPeriod);
}
/// How long before `now` the light was `level`.
inline TimeNs age_of_light(double level, TimeNs now) noexcept {
  const auto taken = static_cast<TimeNs>(level * static_cast<double>(kLightPeriod));
  const TimeNs age = ((now - taken) % kLightPeriod + kLightPeriod) % kLightPeriod;
  return age > kLightPeriod - 200 * kMs ? 0 : age;  // a reading is coarser than the time
}

/// With TANDEM_FAULT_TRACE set, everything is told that passes the line and that the robots do.
inline bool traced() {
  static const bool wanted = std::getenv("TANDEM_FAULT_TRACE") != nullptr;
  return wanted;
}
inline void trace(const std::string& who, TimeNs now, const std::string& what) {
  std::printf("%s %.4f %s\n", who.c_str(), hal::to_seconds(now), what.c_str());
}

/// The robot itself is the kind's emulator without its server; the hub's side is the kind's driver without its thread;
/// the guardian's side is what stops that kind. Faults of line and robot are the emulator's own.
class TestedRobot {
 public:
  virtual ~TestedRobot() = default;

  /// Of all that the emulator logged, in this order.
  const golden::Digest& logged() const noexcept { return logged_; }

  // --- the robot and its line ---
  /// Faults count from `now` on.
  virtual void begin_faults(const std::vector<std::string>& faults, std::uint64_t seed, TimeNs now) = 0;
  /// Robot and line go on to `now`.
  virtual void live(TimeNs now) = 0;
  /// How fast it really drives, in m/s: the least and the greatest of its wheels. A robot that flies: horizontally.
  struct Speed {
    double least = 0.0, greatest = 0.0;
    bool none() const noexcept { return least == 0.0 && greatest == 0.0; }
  };
  virtual Speed speed() const = 0;
  /// For the report of a failure.
  virtual std::string state() const = 0;

  // --- the hub ---
  virtual void open_link(TimeNs now) = 0;
  virtual void close_link(TimeNs now) = 0;
  virtual void latch(hal::Tick tick, TimeNs now) = 0;
  virtual void command(double speed_m_s) = 0;
  virtual void commit(TimeNs now) = 0;
  /// What its I/O thread does.
  virtual void pump(TimeNs now) = 0;
  virtual void stop(TimeNs now) = 0;
  /// The robot has confirmed the last stop, and nothing that moves it was sent since.
  virtual bool at_rest() const = 0;
  /// The hub's clock that shows the date jumps; for those who are told the date.
  virtual void jump_clock(TimeNs) {}
  /// The last that the hub says; then it pumps until `ended`, for a while.
  virtual void end(TimeNs now) = 0;
  virtual bool ended() const = 0;
  virtual bridges::LinkHealth health() const = 0;
  /// Times that the robot stopped by itself or was stopped behind the loop's back.
  virtual std::uint64_t interruptions() const = 0;
  virtual const hal::Light& light() const = 0;

  // --- the guardian ---
  virtual void begin_guarding(TimeNs now, bool hub_is_gone) = 0;
  /// @returns whether the robot has confirmed its stop.
  virtual bool guard(TimeNs now) = 0;
  virtual void end_guarding(TimeNs now) = 0;

 protected:
  /// Takes over an event of the emulator.
  void log(const std::string& who, TimeNs at, const std::string& event) {
    if (traced()) trace(who, at, event);
    logged_.add(who + ' ' + std::to_string(at) + ' ' + event + '\n');
  }

 private:
  golden::Digest logged_;
};

}  // namespace tandem::faults
