#include "bridges/footbot_emulator/faults.hpp"

#include <algorithm>
#include <utility>

namespace tandem::bridges::footbot_emulator {
namespace {

enum class Value : std::uint8_t { None, Module, AnyModule, Lie, Probability, Time };

struct Entry {
  FaultKind kind;
  std::string_view name;
  Value value;
  bool needs_start;
  hal::TimeNs lasts_ns;  // where no duration is given
  std::string_view example;
  std::string_view doc;
};

constexpr std::array<Entry, 11> kEntries = {{
    {FaultKind::Missing, "missing", Value::Module, false, kEndless, "missing=gripper@0s+3s",
     "the module is not on the bus"},
    {FaultKind::Restart, "restart", Value::AnyModule, true, 0, "restart=left-motor@3s",
     "it restarts: deaf for 0.2 s, all its variables are 0; restart@3s: all"},
    {FaultKind::Silent, "silent", Value::AnyModule, false, kEndless, "silent=3@5s+2s",
     "its answers do not get out; it hears and obeys; silent@5s: all"},
    {FaultKind::Deaf, "deaf", Value::AnyModule, false, kEndless, "deaf=left-motor@5s+2s", "it hears nothing"},
    {FaultKind::Lie, "lie", Value::Lie, false, kEndless, "lie=left-motor:size",
     "describes its first own variable with another size or name, or one variable too many (count)"},
    {FaultKind::Drop, "drop", Value::Probability, false, kEndless, "drop=0.01",
     "a module's frame does not arrive, with this probability"},
    {FaultKind::Lose, "lose", Value::Probability, false, kEndless, "lose=0.01",
     "a frame of the host does not arrive, with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, kEndless, "double=0.01", "a module's frame arrives twice"},
    {FaultKind::Swap, "swap", Value::Probability, false, kEndless, "swap=0.01",
     "a frame comes after the next one of the same message"},
    {FaultKind::Delay, "delay", Value::Time, false, kEndless, "delay=20ms", "frames of modules arrive later"},
    {FaultKind::Hangup, "hangup", Value::None, true, hal::kNsPerSecond, "hangup@6s+1s",
     "the adapter, or the connection, disappears and comes back"},
}};

hal::Error wrong(std::string_view text, const std::string& why) {
  return hal::Error{"fault '" + std::string(text) + "': " + why + ". The faults are\n" + fault_manual()};
}

hal::Result<Place> parse_module(std::string_view text) {
  const auto place = place_of(text);
  if (!place) return hal::Error{"there is no module '" + std::string(text) + "'; there are " + module_names()};
  return *place;
}

hal::Status read_value(const Entry& entry, std::string_view value, Fault& fault) {
  if (entry.value == Value::Probability) {
    const auto probability = parse_probability(value);
    if (!probability.ok()) return probability.error();
    fault.probability = probability.value();
    return {};
  }
  if (entry.value == Value::Time) {
    const auto delay = parse_time(value);
    if (!delay.ok()) return delay.error();
    fault.delay_ns = delay.value();
    return {};
  }
  const std::size_t colon = entry.value == Value::Lie ? value.find(':') : std::string_view::npos;
  const auto module = parse_module(value.substr(0, colon));
  if (!module.ok()) return module.error();
  fault.module = module.value();
  if (entry.value != Value::Lie) return {};
  const std::string_view lie = colon == std::string_view::npos ? "" : value.substr(colon + 1);
  fault.lie = lie == "size" ? Lie::Size : lie == "count" ? Lie::Count : lie == "name" ? Lie::Name : Lie::None;
  if (fault.lie == Lie::None)
    return hal::Error{"a lie is about size, count or name, as in " + std::string(entry.example)};
  return {};
}

}  // namespace

std::string fault_manual() {
  std::string text;
  for (const Entry& e : kEntries) {
    std::string example = "  " + std::string(e.example);
    example.resize(std::max<std::size_t>(26, example.size() + 1), ' ');
    text += example + std::string(e.doc) + "\n";
  }
  return text + "A fault may be given @START+DURATION; without, it lasts from the start to the end. The modules are " +
         module_names() + ".";
}

hal::Result<Fault> parse_fault(std::string_view text) {
  const auto split = split_fault(text);
  if (!split.ok()) return wrong(text, split.error().message);
  const FaultSpec& spec = split.value();
  const auto entry = std::ranges::find(kEntries, spec.name, &Entry::name);
  if (entry == kEntries.end()) return wrong(text, "there is no fault '" + std::string(spec.name) + "'");
  if (spec.value && entry->value == Value::None) return wrong(text, "it takes no value");
  if (!spec.value && entry->value != Value::None && entry->value != Value::AnyModule) {
    return wrong(text, "it needs a value, as in " + std::string(entry->example));
  }
  if (!spec.start && entry->needs_start) return wrong(text, "say when, as in " + std::string(entry->example));
  Fault fault;
  fault.kind = entry->kind;
  fault.text = text;
  fault.from = spec.from();
  fault.until = spec.until(entry->lasts_ns);
  if (spec.value) {
    if (const hal::Status read = read_value(*entry, *spec.value, fault); !read.ok()) {
      return wrong(text, read.error().message);
    }
  }
  return fault;
}

void FaultPlan::begin(hal::TimeNs start) {
  changes_.clear();
  told_ = 0;
  for (Fault& f : faults_) {
    const bool ends = f.until < kEndless && f.kind != FaultKind::Restart;
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

hal::TimeNs FaultPlan::delay_ns(hal::TimeNs at) const {
  hal::TimeNs longest = 0;
  for (const Fault& f : faults_) {
    if (f.from <= at && at < f.until) longest = std::max(longest, f.delay_ns);
  }
  return longest;
}

bool FaultPlan::reaches_robot(hal::TimeNs at) {
  return !happens(FaultKind::Lose, at);
}

void FaultPlan::to_host(const TimedFrame& frame, std::vector<TimedFrame>& out) {
  const auto deliver = [&](TimedFrame f) {
    f.at = last_out_ = std::max(last_out_, frame.at + delay_ns(frame.at));
    out.push_back(f);
  };
  const auto part = static_cast<Part>(frame.frame.id & 0x700U);
  auto& held = held_back_[frame.frame.id & 0xFFU];
  if (happens(FaultKind::Drop, frame.at)) return;
  const bool has_successor = part == Part::First || part == Part::Middle;
  if (!held && has_successor && happens(FaultKind::Swap, frame.at)) {
    held = frame;
    return;
  }
  deliver(frame);
  if (happens(FaultKind::Double, frame.at)) deliver(frame);
  if (held) deliver(*std::exchange(held, std::nullopt));
}

void apply(const FaultPlan::Change& change, Footbot& robot) {
  const Fault& fault = *change.fault;
  const auto to = [&](Place place) {
    switch (fault.kind) {
      case FaultKind::Missing:
        return robot.set_missing(place, change.begins, change.at);
      case FaultKind::Restart:
        return robot.restart(place, change.at, "fault");
      case FaultKind::Silent:
        return robot.set_silent(place, change.begins);
      case FaultKind::Deaf:
        return robot.set_deaf(place, change.begins);
      case FaultKind::Lie:
        return robot.set_lie(place, change.begins ? fault.lie : Lie::None);
      default:
        return;
    }
  };
  robot.run_until(change.at);
  if (fault.module) return to(*fault.module);
  for (std::size_t i = 0; i < kModules; ++i) to(Place{i});
}

}  // namespace tandem::bridges::footbot_emulator
