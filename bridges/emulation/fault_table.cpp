#include "bridges/emulation/fault_table.hpp"

#include <algorithm>

#include "hal/unit.hpp"

namespace tandem::bridges {
namespace {

/// Puts what was read where it belongs.
template <class To, class From>
hal::Status take(const hal::Result<From>& read, To& to) {
  if (!read.ok()) return read.error();
  to = read.value();
  return {};
}

hal::Status read_value(FaultValue value, std::string_view text, ReadFault& fault) {
  switch (value) {
    case FaultValue::Probability:
      return take(parse_probability(text), fault.number);
    case FaultValue::Charge:
      if (!take(parse_probability(text), fault.number).ok()) return hal::Error{"a charge is from 0 to 1"};
      return {};
    case FaultValue::Number:
      return take(hal::parse_quantity(text, hal::unit::none), fault.number);
    case FaultValue::Length:
      return take(hal::parse_quantity(text, hal::unit::m), fault.number);
    case FaultValue::Time:
      return take(parse_time(text), fault.time_ns);
    case FaultValue::Jump:
      return take(parse_jump(text), fault.time_ns);
    case FaultValue::None:
    case FaultValue::Word:
    case FaultValue::MaybeWord:
      break;
  }
  return {};
}

}  // namespace

hal::Result<std::size_t> read_fault(std::string_view text, std::span<const FaultForm> forms, ReadFault& fault) {
  const auto split = split_fault(text);
  if (!split.ok()) return split.error();
  const FaultSpec& spec = split.value();
  const std::string name(spec.name);
  const auto form = std::find_if(forms.begin(), forms.end(), [&](const FaultForm& f) { return f.name == name; });
  if (form == forms.end()) return hal::Error{"there is no fault '" + name + "'"};
  const std::string example = ", as in " + std::string(form->example);
  if (spec.value && form->value == FaultValue::None) return hal::Error{"'" + name + "' takes no value" + example};
  const bool may_lack = form->value == FaultValue::None || (form->value == FaultValue::MaybeWord && !spec.value);
  if (spec.value.value_or("").empty() && !may_lack) return hal::Error{"'" + name + "' needs a value" + example};
  if (!spec.start && form->needs_start) return hal::Error{"say when" + example};
  fault.text = text;
  fault.word = spec.value.value_or("");
  fault.from = spec.from();
  fault.until = spec.until(form->lasts_ns);
  fault.since_drive = spec.since_drive;
  fault.moment = form->needs_start && form->lasts_ns == 0;
  if (const hal::Status read = read_value(form->value, fault.word, fault); !read.ok()) return read.error();
  return static_cast<std::size_t>(form - forms.begin());
}

hal::Error wrong_fault(std::string_view text, const std::string& why, const std::string& manual) {
  return hal::Error{"fault '" + std::string(text) + "': " + why + ". The faults are\n" + manual};
}

std::string manual_of_faults(std::span<const FaultForm> forms) {
  std::size_t columns = 0;  // wide enough for each
  for (const FaultForm& f : forms) columns = std::max(columns, f.example.size() + 4);
  std::string text;
  for (const FaultForm& f : forms) {
    std::string example = "  " + std::string(f.example);
    example.resize(columns, ' ');
    text += example + std::string(f.doc) + "\n";
  }
  return text;
}

const std::string_view kTimesOfFaults =
    "A fault may be given @START+DURATION; without, it lasts from the start to the end. START counts from the "
    "emulator's start; @drive+START+DURATION counts from when the robot is first told to move (an eye-bot: a "
    "setpoint; a tracker: when a robot that it sees first moves).";

}  // namespace tandem::bridges
