// Knows of one real robot whether it rests, for the list of robots that may move.
#pragma once
#include <cmath>

#include "hal/device/wheels.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// A robot that was told to move is not known to rest until it answers again, is told to stand, and its encoders have
/// stood for kStood (where it has none: until it was told so for that long), or until it has confirmed its stop. One
/// that got no command is taken to rest.
class RestWatch {
 public:
  static constexpr hal::TimeNs kStood_ns = 300 * hal::kNsPerMs;
  static constexpr double kStill_m = 0.001;

  /// Once a tick. `encoders` null: it has none. `confirmed`: it says itself that it stands.
  void note(hal::TimeNs now_ns, bool answers, bool told_to_move, bool confirmed,
            const hal::WheelEncoders* encoders) noexcept {
    if (confirmed) rests_ = true;
    if (told_to_move) rests_ = false;
    if (rests_) return;
    const double left_m = encoders != nullptr ? encoders->left_m : 0.0;
    const double right_m = encoders != nullptr ? encoders->right_m : 0.0;
    const bool stands = std::fabs(left_m - left_m_) < kStill_m && std::fabs(right_m - right_m_) < kStill_m;
    if (!answers || told_to_move || !stands) {
      since_ns_ = now_ns;
      left_m_ = left_m;
      right_m_ = right_m;
    }
    rests_ = now_ns - since_ns_ >= kStood_ns;
  }
  bool rests() const noexcept { return rests_; }

 private:
  bool rests_ = true;
  hal::TimeNs since_ns_ = 0;
  double left_m_ = 0.0, right_m_ = 0.0;
};

}  // namespace tandem::mixed_reality
