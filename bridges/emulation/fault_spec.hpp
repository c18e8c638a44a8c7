// Faults of emulated robots as they are written: NAME[=VALUE][@[drive+]START[+DURATION]].
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  /// They count from when the robot is first told to move: wheels a speed that is not 0, an eye-bot a setpoint. A
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

/// Manual of an emulator's faults: one line each, how it is written (`example`, in so many columns) and what it does
/// (`doc`), and how faults are given a time.
template <class Entries>
std::string manual_of_faults(const Entries& entries, std::size_t columns) {
  std::string text;
  for (const auto& e : entries) {
    std::string example = "  " + std::string(e.example);
    example.resize(std::max(columns, example.size() + 1), ' ');
    text += example + std::string(e.doc) + "\n";
  }
  return text +
         "A fault may be given @START+DURATION; without, it lasts from the start to the end. START counts from the "
         "emulator's start; @drive+START+DURATION counts from when the robot is first told to move (an eye-bot: a "
         "setpoint; a tracker: when a robot that it sees first moves).";
}

/// What is wrong with a fault as it was written, and the faults that there are.
hal::Error fault_error(std::string_view text, const std::string& why, const std::string& manual);

/// A line of an emulator's manual of faults, and how the fault is read. `Value` has an enumerator None.
template <class Kind, class Value>
struct FaultEntry {
  Kind kind;
  std::string_view name;
  Value value;           ///< None: it takes none
  bool needs_start;      ///< it happens at a moment, which must be said
  hal::TimeNs lasts_ns;  ///< where no duration is given
  std::string_view example;
  std::string_view doc;
};

/// Reads a fault (FaultTimes with `kind` and `text`) that one of the entries allows; `read_value(entry, text, fault)`,
/// a hal::Status, reads its value. Values of the kind `may_lack` may be left out. Errors name what is wrong, and end
/// with `manual`.
template <class Fault, class Kind, class Value, std::size_t kCount, class ReadValue>
hal::Result<Fault> read_fault(std::string_view text, const std::array<FaultEntry<Kind, Value>, kCount>& entries,
                              const std::string& manual, const ReadValue& read_value, Value may_lack = Value::None) {
  const auto wrong = [&](const std::string& why) { return fault_error(text, why, manual); };
  const auto split = split_fault(text);
  if (!split.ok()) return wrong(split.error().message);
  const FaultSpec& spec = split.value();
  const std::string name(spec.name);
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.name == name; });
  if (entry == entries.end()) return wrong("there is no fault '" + name + "'");
  const std::string example = ", as in " + std::string(entry->example);
  if (spec.value && entry->value == Value::None) return wrong("'" + name + "' takes no value" + example);
  if (!spec.value && entry->value != Value::None && entry->value != may_lack)
    return wrong("'" + name + "' needs a value" + example);
  if (!spec.start && entry->needs_start) return wrong("say when" + example);
  Fault fault;
  fault.kind = entry->kind;
  fault.text = text;
  fault.from = spec.from();
  fault.until = spec.until(entry->lasts_ns);
  fault.since_drive = spec.since_drive;
  if (spec.value) {
    if (const hal::Status read = read_value(*entry, *spec.value, fault); !read.ok()) return wrong(read.error().message);
  }
  return fault;
}

/// All of them, or what is wrong with the first that is.
template <class Fault>
hal::Result<std::vector<Fault>> read_faults(const std::vector<std::string>& texts,
                                            hal::Result<Fault> (*parse)(std::string_view)) {
  std::vector<Fault> faults;
  for (const std::string& text : texts) {
    auto fault = parse(text);
    if (!fault.ok()) return fault.error();
    faults.push_back(std::move(fault).value());
  }
  return faults;
}

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
