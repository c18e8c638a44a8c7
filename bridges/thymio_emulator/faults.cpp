#include "bridges/thymio_emulator/faults.hpp"

#include <algorithm>
#include <array>

namespace tandem::bridges::thymio_emulator {
namespace {

enum class Value : std::uint8_t { None, Lie, Probability, Time };

struct Entry {
  FaultKind kind;
  std::string_view name;
  Value value;
  bool needs_start;
  hal::TimeNs lasts_ns;  // where no duration is given
  std::string_view example;
  std::string_view doc;
};

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

hal::Error wrong(std::string_view text, const std::string& why) {
  return hal::Error{"fault '" + std::string(text) + "': " + why + ". The faults are\n" + fault_manual()};
}

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
  std::string text;
  for (const Entry& e : kEntries) {
    std::string example = "  " + std::string(e.example);
    example.resize(std::max<std::size_t>(18, example.size() + 1), ' ');
    text += example + std::string(e.doc) + "\n";
  }
  return text + "A fault may be given @START+DURATION; without, it lasts from the start to the end.";
}

hal::Result<Fault> parse_fault(std::string_view text) {
  const auto split = split_fault(text);
  if (!split.ok()) return wrong(text, split.error().message);
  const FaultSpec& spec = split.value();
  const auto entry = std::ranges::find(kEntries, spec.name, &Entry::name);
  if (entry == kEntries.end()) return wrong(text, "there is no fault '" + std::string(spec.name) + "'");
  if (spec.value && entry->value == Value::None) return wrong(text, "it takes no value");
  if (!spec.value && entry->value != Value::None)
    return wrong(text, "it needs a value, as in " + std::string(entry->example));
  if (!spec.start && entry->needs_start) return wrong(text, "say when, as in " + std::string(entry->example));
  Fault fault;
  fault.kind = entry->kind;
  fault.text = text;
  fault.from = spec.from();
  fault.until = spec.until(entry->lasts_ns);
  if (spec.value) {
    if (const hal::Status read = read_value(*entry, *spec.value, fault); !read.ok())
      return wrong(text, read.error().message);
  }
  return fault;
}

void FaultPlan::begin(hal::TimeNs start) {
  changes_.clear();
  told_ = 0;
  for (Fault& f : faults_) {
    const bool ends = f.until < kEndless && f.until > f.from;
    f.from += start;
    f.until += start;
    changes_.push_back({f.from, true, &f});
    if (ends) changes_.push_back({f.until, false, &f});
  }
  std::ranges::stable_sort(changes_, {}, &Change::at);
}

std::optional<FaultPlan::Change> FaultPlan::next_change(hal::TimeNs now) {
  if (told_ == changes_.size() || changes_[told_].at > now) return std::nullopt;
  return changes_[told_++];
}

std::optional<hal::TimeNs> FaultPlan::next_change_at() const {
  if (told_ == changes_.size()) return std::nullopt;
  return changes_[told_].at;
}

bool FaultPlan::happens(FaultKind kind, hal::TimeNs at) {
  bool any = false;
  for (const Fault& f : faults_) {
    if (f.kind == kind && f.from <= at && at < f.until) any = chance_.hits(f.probability) || any;
  }
  return any;
}

void FaultPlan::to_host(const TimedMessage& message, std::vector<TimedMessage>& out) {
  if (happens(FaultKind::Drop, message.at)) return;
  hal::TimeNs delay_ns = 0;
  for (const Fault& f : faults_) {
    if (f.from <= message.at && message.at < f.until) delay_ns = std::max(delay_ns, f.delay_ns);
  }
  last_out_ = std::max(last_out_, message.at + delay_ns);
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
