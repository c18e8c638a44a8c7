#include "bridges/thymio_emulator/faults.hpp"

#include <array>

namespace tandem::bridges::thymio_emulator {
namespace {

constexpr std::array<FaultForm, 10> kForms = {{
    {"restart", FaultValue::None, true, 0, "restart@3s",
     "it is switched off and on: deaf for 0.4 s, all its variables are 0, its program is gone"},
    {"program", FaultValue::None, true, 0, "program@3s", "somebody else loads another program into it"},
    {"silent", FaultValue::None, false, kEndless, "silent@5s+2s", "its answers do not get out; it hears and obeys"},
    {"deaf", FaultValue::None, false, kEndless, "deaf@5s+2s", "it hears nothing"},
    {"lie", FaultValue::Word, false, kEndless, "lie=name",
     "describes its first own variable with another size or name, or one variable too many (count)"},
    {"drop", FaultValue::Probability, false, kEndless, "drop=0.01",
     "a message of the robot does not arrive, with this probability"},
    {"lose", FaultValue::Probability, false, kEndless, "lose=0.01",
     "a message of a host does not arrive, with this probability"},
    {"double", FaultValue::Probability, false, kEndless, "double=0.01", "a message of the robot arrives twice"},
    {"delay", FaultValue::Time, false, kEndless, "delay=20ms", "the robot's messages arrive later"},
    {"hangup", FaultValue::None, true, hal::kNsPerSecond, "hangup@6s+1s", "the line disappears and comes back"},
}};

hal::Status read_own(const FaultForm& form, Fault& fault) {
  if (form.value != FaultValue::Word) return {};
  const auto lie = aseba_emulation::lie_named(fault.word);
  if (!lie.ok()) return lie.error();
  fault.lie = lie.value();
  return {};
}

}  // namespace

const FaultTable<Fault> kFaults{kForms, &read_own};

void apply(const FaultPlan::Change& change, Thymio& robot) {
  robot.run_until(change.at);
  switch (change.fault->kind) {
    case FaultKind::Restart:
      return robot.restart(change.at, "fault");
    case FaultKind::Program:
      return robot.load_other_program(change.at);
    case FaultKind::Silent:
      return robot.set_silent(change.begins);
    case FaultKind::Deaf:
      return robot.set_deaf(change.begins);
    case FaultKind::Lie:
      return robot.set_lie(change.begins ? change.fault->lie : Lie::None);
    default:
      return;
  }
}

}  // namespace tandem::bridges::thymio_emulator
