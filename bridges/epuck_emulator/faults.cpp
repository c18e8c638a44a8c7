#include "bridges/epuck_emulator/faults.hpp"

#include <algorithm>

namespace tandem::bridges::epuck_emulator {
namespace {

enum class Value : std::uint8_t { None, Probability, Time };

struct Entry {
  FaultKind kind;
  std::string_view name;
  Value value;
  bool needs_start;
  double default_duration_s;  // 0: until the end
  std::string_view example;
  std::string_view doc;
};

constexpr std::array<Entry, 10> kEntries = {{
    {FaultKind::Silent, "silent", Value::None, false, 0.0, "silent@5s+2s",
     "its answers do not arrive; it hears and obeys"},
    {FaultKind::Deaf, "deaf", Value::None, false, 0.0, "deaf@5s+2s", "nothing that is sent arrives at it"},
    {FaultKind::Garbage, "garbage", Value::None, false, 0.0, "garbage@4s+1s",
     "random bytes arrive instead of its answers"},
    {FaultKind::Drop, "drop", Value::Probability, false, 0.0, "drop=0.01", "loses each byte with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, 0.0, "double=0.01",
     "brings each byte twice with this probability"},
    {FaultKind::Corrupt, "corrupt", Value::Probability, false, 0.0, "corrupt=0.001",
     "flips a bit of each byte with this probability"},
    {FaultKind::Delay, "delay", Value::Time, false, 0.0, "delay=20ms", "its bytes arrive later, as over Bluetooth"},
    {FaultKind::Reset, "reset", Value::None, true, 0.0, "reset@3s", "it restarts"},
    {FaultKind::Truncate, "truncate", Value::None, true, 0.0, "truncate@2s",
     "loses the second half of its next answer"},
    {FaultKind::Hangup, "hangup", Value::None, true, 1.0, "hangup@6s+1s", "the device disappears and comes back"},
}};

hal::Error wrong(std::string_view spec, const std::string& why) {
  return hal::Error{"fault '" + std::string(spec) + "': " + why + ". The faults are\n" + fault_manual()};
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
  const std::string name(spec.name);
  const auto entry = std::find_if(kEntries.begin(), kEntries.end(), [&](const Entry& e) { return e.name == name; });
  if (entry == kEntries.end()) return wrong(text, "there is no fault '" + name + "'");
  if (spec.value.has_value() != (entry->value != Value::None)) {
    return wrong(text, "'" + name + (spec.value ? "' takes no value" : "' needs a value"));
  }
  if (!spec.start && entry->needs_start) return wrong(text, "say when, as in " + std::string(entry->example));

  Fault fault;
  fault.kind = entry->kind;
  fault.text = text;
  if (entry->value == Value::Probability) {
    const auto probability = parse_probability(*spec.value);
    if (!probability.ok()) return wrong(text, probability.error().message);
    fault.probability = probability.value();
  } else if (entry->value == Value::Time) {
    const auto delay = parse_time(*spec.value);
    if (!delay.ok()) return wrong(text, delay.error().message);
    fault.delay_ns = delay.value();
  }
  fault.from = spec.from();
  const double lasts_s = entry->default_duration_s;
  fault.until = spec.until(lasts_s > 0.0 ? static_cast<hal::TimeNs>(lasts_s * 1e9) : kEndless);
  return fault;
}

void FaultPlan::begin(hal::TimeNs start) {
  changes_.clear();
  told_ = 0;
  for (Fault& f : faults_) {
    f.from += start;
    const bool ends = f.until < kEndless;
    f.until += start;
    changes_.push_back({f.from, true, &f});
    const bool lasts = f.kind != FaultKind::Reset && f.kind != FaultKind::Truncate;
    if (ends && lasts) changes_.push_back({f.until, false, &f});
  }
  std::stable_sort(changes_.begin(), changes_.end(), [](const Change& a, const Change& b) { return a.at < b.at; });
}

bool FaultPlan::active(FaultKind kind, hal::TimeNs at) const {
  return std::any_of(faults_.begin(), faults_.end(),
                     [&](const Fault& f) { return f.kind == kind && f.from <= at && at < f.until; });
}

std::optional<std::uint8_t> FaultPlan::to_robot(std::uint8_t byte, hal::TimeNs at) {
  if (active(FaultKind::Deaf, at)) return std::nullopt;
  return through_the_air(byte, at);
}

std::optional<std::uint8_t> FaultPlan::to_host(std::uint8_t byte, hal::TimeNs at) {
  if (active(FaultKind::Silent, at)) return std::nullopt;
  if (active(FaultKind::Garbage, at)) return static_cast<std::uint8_t>(chance_.draw() >> 56U);
  return through_the_air(byte, at);
}

std::optional<std::uint8_t> FaultPlan::through_the_air(std::uint8_t byte, hal::TimeNs at) {
  for (const Fault& f : faults_) {
    if (at < f.from || at >= f.until) continue;
    if (f.kind == FaultKind::Drop && chance_.hits(f.probability)) return std::nullopt;
    if (f.kind == FaultKind::Corrupt && chance_.hits(f.probability)) {
      byte = static_cast<std::uint8_t>(byte ^ (1U << (chance_.draw() >> 61U)));
    }
  }
  return byte;
}

bool FaultPlan::doubles(hal::TimeNs at) {
  bool twice = false;
  for (const Fault& f : faults_) {
    if (f.kind == FaultKind::Double && f.from <= at && at < f.until) twice = chance_.hits(f.probability) || twice;
  }
  return twice;
}

hal::TimeNs FaultPlan::delay_ns(hal::TimeNs at) const {
  hal::TimeNs longest = 0;
  for (const Fault& f : faults_) {
    if (f.from <= at && at < f.until) longest = std::max(longest, f.delay_ns);
  }
  return longest;
}

std::uint8_t FaultPlan::garble(std::uint8_t byte) {
  return static_cast<std::uint8_t>(byte + 1 + (chance_.draw() >> 56U) % 255);
}

std::optional<FaultPlan::Change> FaultPlan::next_change(hal::TimeNs now) {
  if (told_ == changes_.size() || changes_[told_].at > now) return std::nullopt;
  return changes_[told_++];
}

std::optional<hal::TimeNs> FaultPlan::next_change_at() const {
  if (told_ == changes_.size()) return std::nullopt;
  return changes_[told_].at;
}

}  // namespace tandem::bridges::epuck_emulator
