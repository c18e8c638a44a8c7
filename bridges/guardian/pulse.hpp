// Judges fairly on a busy machine whether the hub still sends its heartbeat.
#pragma once
#include <cstdint>

#include "hal/time.hpp"

namespace tandem::bridges::guardian {

struct PulseLimits {
  hal::TimeNs beat_ns = 20 * hal::kNsPerMs;      ///< between two beats, and between two looks at them
  hal::TimeNs stopped_ns = 100 * hal::kNsPerMs;  ///< of silence, where the system says that the hub was stopped
  hal::TimeNs silent_ns = 350 * hal::kNsPerMs;   ///< of silence, whatever the system says
};

/// Counts the silence since the last beat in the time in which the guardian itself was awake: a guardian that was not
/// scheduled for a while saw nothing, and blames nobody for it.
class Pulse {
 public:
  explicit Pulse(const PulseLimits& limits = {}) noexcept : limits_(limits) {}

  /// One look at the number of beats. `stopped` is asked only where its answer matters.
  /// @returns whether the hub is frozen.
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
  /// Begins anew, such as after a freeze.
  void forget() noexcept { *this = Pulse(limits_); }

 private:
  PulseLimits limits_;
  bool started_ = false;
  std::uint32_t beats_ = 0;
  hal::TimeNs looked_ns_ = 0;
  hal::TimeNs silence_ns_ = 0;
};

}  // namespace tandem::bridges::guardian
