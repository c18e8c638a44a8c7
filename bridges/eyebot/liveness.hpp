// Liveness of a robot: whether it is alive, has restarted, and is the only one of its name.
#pragma once
#include <array>
#include <cstdint>

#include "hal/time.hpp"

namespace tandem::bridges::eyebot {

/// Whose a message is.
enum class Sender : std::uint8_t {
  Current,    ///< the robot's, as known
  Restarted,  ///< the robot's, which has just been restarted
  Other       ///< of a start before, or of a second robot of that name: not to be used
};

enum class Pulse : std::uint8_t { Never, Beating, Stale, Lost };

/// A robot draws a number at its start, its session. Another one is taken for the robot restarted once the one
/// before has been silent for `kTrial`; when that speaks on, there are two robots of one name, and the one that was
/// there first stays the robot. A session that was replaced does not come back unless the other is lost. Times are
/// CLOCK_MONOTONIC. Not thread-safe.
class Liveness {
 public:
  static constexpr hal::TimeNs kLostAfter = 2 * hal::kNsPerSecond;
  /// In which a second robot of the name would have spoken fifteen times.
  static constexpr hal::TimeNs kTrial = 300 * hal::kNsPerMs;

  /// Of every message that came, in about the order of their coming.
  Sender note(std::int32_t session, hal::TimeNs received_ns) noexcept;
  /// Of the robot's heartbeats, which promise the next after `period_ms`.
  void note_heartbeat(std::int32_t period_ms, hal::TimeNs received_ns) noexcept;

  /// Stale after three periods; lost after two seconds, or three periods when those are longer.
  Pulse pulse(hal::TimeNs now) const noexcept;
  /// When the pulse will change if no heartbeat comes.
  hal::TimeNs next_change(hal::TimeNs now) const noexcept;
  hal::TimeNs heartbeat_ns() const noexcept { return heartbeat_ns_; }
  /// The robot and another of its name spoke in turn three times or more, the last time less than three seconds ago.
  bool namesakes(hal::TimeNs now) const noexcept;
  /// Another start, or another robot of the name, has just spoken: it is not known yet which one it is.
  bool contested(hal::TimeNs now) const noexcept { return rival_ && now - rival_ns_ < kTrial; }
  /// It has been heard for so long that a second robot of its name would have been noticed.
  bool settled(hal::TimeNs now) const noexcept { return known_ && now - begun_ns_ >= kTrial; }

  std::int32_t session() const noexcept { return session_; }
  std::uint64_t restarts() const noexcept { return restarts_; }
  std::uint64_t others() const noexcept { return others_; }  ///< messages of another start

 private:
  void begin(std::int32_t session, hal::TimeNs received_ns) noexcept;
  hal::TimeNs stale_after() const noexcept { return 3 * period_ns_; }
  hal::TimeNs lost_after() const noexcept { return stale_after() > kLostAfter ? stale_after() : kLostAfter; }

  bool known_ = false;
  std::int32_t session_ = 0;
  hal::TimeNs begun_ns_ = 0;
  hal::TimeNs seen_ns_ = 0;
  std::array<std::int32_t, 4> before_{};  // sessions that were replaced, the newest at `newest_`
  std::size_t befores_ = 0, newest_ = 0;
  bool rival_ = false;  // another session spoke, at
  hal::TimeNs rival_ns_ = 0;
  unsigned turns_ = 0;  // the robot spoke after its rival, again and again, at last at
  hal::TimeNs turn_ns_ = 0;
  bool beating_ = false;
  hal::TimeNs heartbeat_ns_ = 0, period_ns_ = 200 * hal::kNsPerMs;
  std::uint64_t restarts_ = 0, others_ = 0;
};

}  // namespace tandem::bridges::eyebot
