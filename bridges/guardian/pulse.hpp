// Judges fairly on a busy machine whether another process still sends its heartbeat, and whether this one was frozen.
#pragma once
#include <cstdint>

#include "hal/time.hpp"

namespace tandem::bridges::guardian {

struct PulseLimits {
  hal::TimeNs beat_ns = 20 * hal::kNsPerMs;      ///< between two beats, and between two looks at them
  hal::TimeNs stopped_ns = 100 * hal::kNsPerMs;  ///< of silence, where the system says that the hub was stopped
  hal::TimeNs silent_ns = 350 * hal::kNsPerMs;   ///< of silence, whatever the system says
  hal::TimeNs asleep_ns = 400 * hal::kNsPerMs;   ///< a beat of one's own that is later than this was a freeze
};

/// One process' judgement of the other's heartbeat. Counts the silence since the last beat in the time in which the
/// judge itself was awake: one that was not scheduled for a while saw nothing, and blames none for it.
class Pulse {
 public:
  explicit Pulse(const PulseLimits& limits = {}) noexcept : limits_(limits) {}

  /// One look at the number of beats. `stopped` is asked only where its answer matters.
  /// @returns whether the other one is frozen.
  template <class Stopped>
  bool frozen(std::uint32_t beats, hal::TimeNs now, const Stopped& stopped) {
    const hal::TimeNs awake = started_ ? now - looked_ns_ : 0;
    looked_ns_ = now;
    if (!started_ || beats != beats_) {
      started_ = started_ || beats != 0;  // before the first beat there is no heart
      beats_ = beats;
      silence_ns_ = 0;
      return false;
    }
    silence_ns_ += awake < 2 * limits_.beat_ns ? awake : 2 * limits_.beat_ns;
    if (silence_ns_ >= limits_.silent_ns) return true;
    return silence_ns_ >= limits_.stopped_ns && stopped();
  }
  /// Starts again, such as after a freeze.
  void forget() noexcept { *this = Pulse(limits_); }

 private:
  PulseLimits limits_;
  bool started_ = false;
  std::uint32_t beats_ = 0;
  hal::TimeNs looked_ns_ = 0;
  hal::TimeNs silence_ns_ = 0;
};

/// A process' judgement of itself, by the clock that goes on while the machine sleeps: whatever made a beat so late, a
/// signal, a paused container, a suspended laptop, may have held up the other process as well, and then neither can
/// tell it of the other.
class OwnPulse {
 public:
  explicit OwnPulse(const PulseLimits& limits = {}) noexcept : limits_(limits) {}

  /// One beat at `boot_ns` (CLOCK_BOOTTIME). @returns for how long this process was frozen; 0: it was not.
  hal::TimeNs slept(hal::TimeNs boot_ns) noexcept {
    const hal::TimeNs gap = beat_ns_ != 0 ? boot_ns - beat_ns_ : 0;
    beat_ns_ = boot_ns;
    return gap > limits_.beat_ns + limits_.asleep_ns ? gap : 0;
  }

 private:
  PulseLimits limits_;
  hal::TimeNs beat_ns_ = 0;  // 0: none yet
};

}  // namespace tandem::bridges::guardian
