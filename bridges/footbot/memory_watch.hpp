// Notices from a module's values that it has lost its memory: it restarted. Modules do not report that.
#pragma once
#include <cstdint>
#include <span>

#include "hal/time.hpp"

namespace tandem::bridges::footbot {

/// Words that a module is told and that are read back: it held others, got no zeros, and holds zeros.
class ToldWords {
 public:
  /// An answer may have been under way for so long when zeros were sent.
  static constexpr hal::TimeNs kOldAnswers_ns = 500 * hal::kNsPerMs;

  void sent(std::span<const std::int16_t> words, hal::TimeNs now) noexcept;
  /// What was read, and when. @returns whether the module has forgotten what it held; once for each time.
  bool forgotten(std::span<const std::int16_t> words, hal::TimeNs taken_ns) noexcept;

 private:
  bool held_ = false;  // other words than zeros
  hal::TimeNs taken_ns_ = 0;
  hal::TimeNs zeros_sent_ns_ = -kOldAnswers_ns;
};

/// A counter that a module counts from 0 since its start: it is 0 again, or near 0 after a silence in which it may have
/// started and begun to count, and cannot have come there by counting.
class ModuleCounter {
 public:
  static constexpr double kLeast = 100.0;      ///< counts: a shorter way it may have gone
  static constexpr double kMostTimes = 3.0;    ///< as fast as before it may count
  static constexpr double kSilentTimes = 1.5;  ///< as long as between the two readings before: one has not come

  /// @returns whether it started again; once for each time.
  bool began_anew(std::int32_t raw, hal::TimeNs taken_ns) noexcept;

 private:
  std::int32_t raw_ = 0;
  hal::TimeNs taken_ns_ = 0;  // 0: never
  double interval_ns_ = 0.0;  // between the last two readings
  double counts_per_ns_ = 0.0;
};

}  // namespace tandem::bridges::footbot
