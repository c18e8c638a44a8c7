// Syntax of faults of emulated robots: NAME[=VALUE][@START[+DURATION]].
#pragma once
#include <limits>
#include <optional>
#include <string_view>

#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// Later than the end of every run, and still far from overflow when a start is added.
inline constexpr hal::TimeNs kEndless = std::numeric_limits<hal::TimeNs>::max() / 4;

/// The parts of what was written; they point into it.
struct FaultSpec {
  std::string_view name;
  std::optional<std::string_view> value{};
  std::optional<hal::TimeNs> start{};
  std::optional<hal::TimeNs> duration{};

  /// From the start of the emulator; `otherwise` where no duration was given.
  hal::TimeNs from() const noexcept { return start.value_or(0); }
  hal::TimeNs until(hal::TimeNs otherwise = kEndless) const noexcept;
};

/// "silent@5s+2s". A bare number is in seconds. Errors: a time that cannot be read, or is before the start.
hal::Result<FaultSpec> split_fault(std::string_view text);

/// Any time that is not negative; at most `kEndless`.
hal::Result<hal::TimeNs> parse_time(std::string_view text);
/// A jump of a clock: seconds, minutes ("5 min") or hours ("1h"), forwards or backwards ("-1h").
hal::Result<hal::TimeNs> parse_jump(std::string_view text);
/// From 0 to 1.
hal::Result<double> parse_probability(std::string_view text);

/// Chance from a seed: SplitMix64 [Steele, Lea, Flood 2014].
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  std::uint64_t draw() noexcept;
  bool hits(double probability) noexcept { return static_cast<double>(draw() >> 11U) * 0x1p-53 < probability; }

 private:
  std::uint64_t state_;
};

}  // namespace tandem::bridges
