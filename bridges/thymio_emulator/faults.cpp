#include "bridges/thymio_emulator/faults.hpp"

#include <algorithm>
#include <array>

namespace tandem::bridges::thymio_emulator {
namespace {

enum class Value : std::uint8_t { None, Lie, Probability, Time };

using Entry = FaultEntry<FaultKind, Value>;

constexpr std::array<Entry, 10> kEntries = {{
    {FaultKind::Restart, "restart", Value::None, true, 0, "restart@3s",
     "it is switched off and on: deaf for 0.4 s, all its variables are 0, its program is gone"},
    {FaultKind::Program, "program", Value::None, true, 0, "program@3s", "somebody else loads another program into it"},
    {FaultKind::Silent, "silent", Value::None, false, kEndless, "silent@5s+2s",
     "its answers do not get out; it hears and obeys"},
    {FaultKind::Deaf, "deaf", Value::None, false, kEndless, "deaf@5s+2s", "it hears nothing"},
    {FaultKind::Lie, "lie", Value::Lie, false, kEndless, "lie=name",
     "describes its first own variable with another size or name, or one variable too many (count)"},
    {FaultKind::Drop, "drop", Value::Probability, false, kEndless, "drop=0.01",
     "a message of the robot does not arrive, with this probability"},
    {FaultKind::Lose, "lose", Value::Probability, false, kEndless, "lose=0.01",
     "a message of a host does not arrive, with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, kEndless, "double=0.01",
     "a message of the robot arrives twice"},
    {FaultKind::Delay, "delay", Value::Time, false, kEndless, "delay=20ms", "the robot's messages arrive later"},
    {FaultKind::Hangup, "hangup", Value::None, true, hal::kNsPerSecond, "hangup@6s+1s",
     "the line disappears and comes back"},
}};

hal::Status read_value(const Entry& entry, std::string_view value, Fault& fault) {
  switch (entry.value) {
    case Value::Probability: {
      const auto probability = parse_probability(value);
      if (!probability.ok()) return probability.error();
      fault.probability = probability.value();
      return {};
    }
    case Value::Time: {
      const auto delay = parse_time(value);
      if (!delay.ok()) return delay.error();
      fault.delay_ns = delay.value();
      return {};
    }
    case Value::Lie:
      fault.lie = value == "size" ? Lie::Size : value == "count" ? Lie::Count : value == "name" ? Lie::Name : Lie::None;
      if (fault.lie == Lie::None)
        return hal::Error{"a lie is about size, count or name, as in " + std::string(entry.example)};
      return {};
    case Value::None:
      break;
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

void FaultPlan::to_host(const TimedMessage& message, std::vector<TimedMessage>& out) {
  if (happens(FaultKind::Drop, message.at)) return;
  last_out_ = std::max(last_out_, message.at + delay_ns(message.at));
  out.push_back({message.message, last_out_});
  if (happens(FaultKind::Double, message.at)) out.push_back({message.message, last_out_});
}

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
