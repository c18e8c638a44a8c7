#include "bridges/tracker_emulator/faults.hpp"

#include <algorithm>
#include <array>

#include "hal/unit.hpp"

namespace tandem::bridges::tracker_emulator {
namespace {

enum class Value : std::uint8_t { None, Probability, Length, Jump };

using Entry = FaultEntry<FaultKind, Value>;

constexpr std::array<Entry, 9> kEntries = {{
    {FaultKind::Gap, "gap", Value::None, false, kEndless, "gap@5s+2s", "it sees nothing; a camera: it stalls"},
    {FaultKind::Lose, "lose", Value::Probability, false, kEndless, "lose=0.05",
     "a thing is not seen in an exposure, with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, kEndless, "double=0.02",
     "a message or frame is sent twice"},
    {FaultKind::Swap, "swap", Value::Probability, false, kEndless, "swap=0.01",
     "two things are taken for one another; swap=1@8s: from then on"},
    {FaultKind::Late, "late", Value::Probability, false, kEndless, "late=0.1",
     "a message or frame is sent half a second later, after others"},
    {FaultKind::Mirror, "mirror", Value::None, false, kEndless, "mirror@8s",
     "y and headings have the wrong sign; frames are mirrored"},
    {FaultKind::Shift, "shift", Value::Length, false, kEndless, "shift=0.3@8s",
     "it sees everything so far to the east of where it is"},
    {FaultKind::Clock, "clock", Value::Jump, false, kEndless, "clock=1h@8s", "its clock is set, forwards or back"},
    {FaultKind::Garbage, "garbage", Value::Probability, false, kEndless, "garbage=0.01",
     "a message or frame is cut short"},
}};

hal::Status read_value(const Entry& entry, std::string_view text, Fault& fault) {
  if (entry.value == Value::Probability) {
    const auto probability = parse_probability(text);
    if (!probability.ok()) return probability.error();
    fault.probability = probability.value();
  } else if (entry.value == Value::Jump) {
    const auto jump = parse_jump(text);
    if (!jump.ok()) return jump.error();
    fault.jump_ns = jump.value();
  } else {
    const auto length = hal::parse_quantity(text, hal::unit::m);
    if (!length.ok()) return length.error();
    fault.shift_m = length.value();
  }
  return {};
}

}  // namespace

std::string fault_manual() {
  return manual_of_faults(kEntries, 18);
}

hal::Result<Fault> parse_fault(std::string_view text) {
  return read_fault<Fault>(text, kEntries, fault_manual(), &read_value);
}

double FaultPlan::shift_m(hal::TimeNs at) const {
  double last_m = 0.0;
  for (const Fault& fault : faults()) {
    if (fault.kind == FaultKind::Shift && is_at_work(fault, at)) last_m = fault.shift_m;
  }
  return last_m;
}

hal::TimeNs FaultPlan::jump_ns(hal::TimeNs at) const {
  hal::TimeNs sum_ns = 0;
  for (const Fault& fault : faults()) {
    if (fault.kind == FaultKind::Clock && is_at_work(fault, at)) sum_ns += fault.jump_ns;
  }
  return sum_ns;
}

}  // namespace tandem::bridges::tracker_emulator
