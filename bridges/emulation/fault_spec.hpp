// Faults of emulated robots as they are written: NAME[=VALUE][@[drive+]START[+DURATION]].
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
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
  bool since_drive = false;

  /// From the start of the emulator, or as `since_drive` of FaultTimes; `otherwise` where no duration was given.
  hal::TimeNs from() const noexcept { return start.value_or(0); }
  hal::TimeNs until(hal::TimeNs otherwise = kEndless) const noexcept;
};

/// When a fault is active: in [from, until).
struct FaultTimes {
  hal::TimeNs from = 0;
  hal::TimeNs until = kEndless;
  /// They count from when the robot is first ordered to move: wheels a speed that is not 0, an eye-bot a setpoint. A
  /// tracker's from when a robot that it sees first moves. Else from the start of the emulator.
  bool since_drive = false;
};

/// "silent@5s+2s", "silent@drive+5s+2s"; "silent@drive" is "silent@drive+0s". A bare number is in seconds. Errors: a
/// time that cannot be read, or is before the start.
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
