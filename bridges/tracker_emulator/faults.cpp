#include "bridges/tracker_emulator/faults.hpp"

#include <array>

namespace tandem::bridges::tracker_emulator {
namespace {

constexpr std::array<FaultForm, 9> kForms = {{
    {"gap", FaultValue::None, false, kEndless, "gap@5s+2s", "it sees nothing; a camera: it stalls"},
    {"lose", FaultValue::Probability, false, kEndless, "lose=0.05",
     "a thing is not seen in an exposure, with this probability"},
    {"double", FaultValue::Probability, false, kEndless, "double=0.02", "a message or frame is sent twice"},
    {"swap", FaultValue::Probability, false, kEndless, "swap=0.01",
     "two things are taken for one another; swap=1@8s: from then on"},
    {"late", FaultValue::Probability, false, kEndless, "late=0.1",
     "a message or frame is sent half a second later, after others"},
    {"mirror", FaultValue::None, false, kEndless, "mirror@8s",
     "y and headings have the wrong sign; frames are mirrored"},
    {"shift", FaultValue::Length, false, kEndless, "shift=0.3@8s",
     "it sees everything so far to the east of where it is"},
    {"clock", FaultValue::Jump, false, kEndless, "clock=1h@8s", "its clock is set, forwards or back"},
    {"garbage", FaultValue::Probability, false, kEndless, "garbage=0.01", "a message or frame is cut short"},
}};

}  // namespace

const FaultTable<Fault> kFaults{kForms};

double FaultPlan::shift_m(hal::TimeNs at) const {
  double last_m = 0.0;
  for (const Fault& fault : faults()) {
    if (fault.kind == FaultKind::Shift && is_at_work(fault, at)) last_m = fault.number;
  }
  return last_m;
}

hal::TimeNs FaultPlan::jump_ns(hal::TimeNs at) const {
  hal::TimeNs sum_ns = 0;
  for (const Fault& fault : faults()) {
    if (fault.kind == FaultKind::Clock && is_at_work(fault, at)) sum_ns += fault.time_ns;
  }
  return sum_ns;
}

}  // namespace tandem::bridges::tracker_emulator
