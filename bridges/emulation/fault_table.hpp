// Table of an emulator's faults: each row says how a fault is written, read and explained.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/emulation/fault_spec.hpp"
#include "hal/result.hpp"

namespace tandem::bridges {

/// What stands behind NAME= in a fault. MaybeWord may be left out.
enum class FaultValue : std::uint8_t { None, Probability, Charge, Number, Length, Time, Jump, Word, MaybeWord };

/// What was read of any emulator's fault.
struct ReadFault : FaultTimes {
  bool moment = false;      ///< it happens at `from`, and has no end
  double number = 0.0;      ///< Probability and Charge: 0 to 1; Number; Length: metres
  hal::TimeNs time_ns = 0;  ///< Time, Jump
  std::string word{};       ///< the value as written; empty: there is none
  std::string text{};       ///< as written
};

template <class FaultKind>
struct FaultOf : ReadFault {
  using Kind = FaultKind;
  Kind kind{};
};

/// A fault's row but for its kind.
struct FaultForm {
  std::string_view name;
  FaultValue value;
  bool needs_start;      ///< it begins at a time that must be said
  hal::TimeNs lasts_ns;  ///< where no duration is given; 0 and needs_start: it happens at a moment
  std::string_view example;
  std::string_view doc;
};

/// Reads `text` by the form of that name. @returns its row. Errors: what is wrong, for `wrong_fault` to complete.
hal::Result<std::size_t> read_fault(std::string_view text, std::span<const FaultForm> forms, ReadFault& fault);
/// What is wrong with a fault as it was written, and the faults that there are.
hal::Error wrong_fault(std::string_view text, const std::string& why, const std::string& manual);
/// One line a fault: how it is written and what it does.
std::string manual_of_faults(std::span<const FaultForm> forms);
/// How faults of emulators are given a time.
extern const std::string_view kTimesOfFaults;

/// All that an emulator can show. `Fault` is FaultOf its kinds, perhaps with more that `read_own` reads.
template <class Fault>
struct FaultTable {
  /// In the order of the kinds' enumerators.
  std::span<const FaultForm> forms;
  /// Reads or checks what is the emulator's own in a fault with a value; null: nothing is.
  hal::Status (*read_own)(const FaultForm& form, Fault& fault) = nullptr;
  /// What the manual says at its end; null: nothing.
  std::string (*more)() = nullptr;

  std::string manual() const {
    return manual_of_faults(forms) + std::string(kTimesOfFaults) + (more != nullptr ? more() : std::string());
  }

  /// Reads NAME[=VALUE][@[drive+]START[+DURATION]]: "silent@5s+2s", "drop=0.01". A bare number is in seconds. Errors
  /// name what is wrong and list the faults that there are.
  hal::Result<Fault> parse(std::string_view text) const {
    Fault fault;
    const auto row = read_fault(text, forms, fault);
    if (!row.ok()) return wrong_fault(text, row.error().message, manual());
    fault.kind = static_cast<typename Fault::Kind>(row.value());
    if (read_own == nullptr || fault.word.empty()) return fault;
    const hal::Status own = read_own(forms[row.value()], fault);
    if (!own.ok()) return wrong_fault(text, own.error().message, manual());
    return fault;
  }
  /// All of them, or what is wrong with the first that is.
  hal::Result<std::vector<Fault>> parse(const std::vector<std::string>& texts) const {
    std::vector<Fault> faults;
    for (const std::string& text : texts) {
      auto fault = parse(std::string_view(text));
      if (!fault.ok()) return fault.error();
      faults.push_back(std::move(fault).value());
    }
    return faults;
  }
};

}  // namespace tandem::bridges
