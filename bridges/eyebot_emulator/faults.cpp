#include "bridges/eyebot_emulator/faults.hpp"

#include <algorithm>
#include <array>

#include "hal/unit.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hal::TimeNs;

enum class Value : std::uint8_t { None, Channel, Probability, Time, SignedTime, Charge, Rate, Length };

/// One line of the manual, and how the fault is read.
struct Entry {
  FaultKind kind;
  std::string_view name;
  Value value;
  bool needs_start;  ///< it happens at a moment
  std::string_view example;
  std::string_view doc;
};

constexpr std::array<Entry, 23> kEntries = {{
    {FaultKind::Silent, "silent", Value::Channel, false, "silent=state@5s+2s",
     "a channel of the robot is not sent; silent@5s: all"},
    {FaultKind::Deaf, "deaf", Value::Channel, false, "deaf=cmd/velocity@5s+2s",
     "a channel does not reach the robot (heartbeat: those of hubs); deaf@5s: all"},
    {FaultKind::Drop, "drop", Value::Probability, false, "drop=0.01", "a report is lost, with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, "double=0.01", "a report arrives twice"},
    {FaultKind::Swap, "swap", Value::Probability, false, "swap=0.01", "a report comes after the next of its channel"},
    {FaultKind::Delay, "delay", Value::Time, false, "delay=50ms", "reports arrive later"},
    {FaultKind::Lose, "lose", Value::Probability, false, "lose=0.01", "a command is lost, with this probability"},
    {FaultKind::Repeat, "repeat", Value::Probability, false, "repeat=0.01", "a command arrives twice"},
    {FaultKind::Overtake, "overtake", Value::Probability, false, "overtake=0.01",
     "a command comes after the next of its channel"},
    {FaultKind::Lag, "lag", Value::Time, false, "lag=300ms", "commands arrive later"},
    {FaultKind::Fingerprint, "fingerprint", Value::Probability, false, "fingerprint=0.05",
     "a report has the fingerprint of no type"},
    {FaultKind::Truncate, "truncate", Value::Probability, false, "truncate=0.05", "a report lacks its end"},
    {FaultKind::Restart, "restart", Value::None, true, "restart@3s", "the robot loses its power and starts anew"},
    {FaultKind::Clock, "clock", Value::SignedTime, true, "clock=1h@3s", "the robot's clock jumps, by -1h backwards"},
    {FaultKind::Battery, "battery", Value::Charge, true, "battery=0.05@10s", "so much charge is left, from 0 to 1"},
    {FaultKind::NoPosition, "no-position", Value::None, false, "no-position@5s+3s",
     "the robot does not know where it is"},
    {FaultKind::Hardware, "hardware", Value::None, false, "hardware@5s+1s", "the robot finds a fault in itself"},
    {FaultKind::Namesake, "namesake", Value::None, false, "namesake@5s+5s", "there is a second robot of that name"},
    {FaultKind::Flood, "flood", Value::Rate, false, "flood=2000@5s+2s", "so many reports of its state a second"},
    {FaultKind::Damage, "damage", Value::Channel, false, "damage=state",
     "every report on a channel is damaged, from the start or for a while"},
    {FaultKind::Future, "future", Value::Probability, false, "future=0.01", "a report is stamped an hour ahead"},
    {FaultKind::Place, "place", Value::Length, false, "place=3m@5s+2s",
     "the robot believes itself so far east of where it is"},
    {FaultKind::SecondHub, "second-hub", Value::None, false, "second-hub@5s+5s",
     "another hub, 'second', beats its heart and commands the robot's lights"},
}};

constexpr std::size_t kStampAt = 8;  // in a message, behind the fingerprint

hal::Error wrong(std::string_view text, const std::string& why) {
  return hal::Error{"fault '" + std::string(text) + "': " + why + ". The faults are\n" + fault_manual()};
}

hal::Status read_value(const Entry& entry, std::string_view value, Fault& fault) {
  switch (entry.value) {
    case Value::None:
      break;
    case Value::Channel:
      fault.channel = value;
      break;
    case Value::Probability: {
      const auto probability = parse_probability(value);
      if (!probability.ok()) return probability.error();
      fault.probability = probability.value();
      break;
    }
    case Value::Charge: {
      const auto charge = parse_probability(value);
      if (!charge.ok()) return hal::Error{"a charge is from 0 to 1"};
      fault.charge = charge.value();
      break;
    }
    case Value::Time:
    case Value::SignedTime: {
      const auto time = entry.value == Value::Time ? parse_time(value) : parse_jump(value);
      if (!time.ok()) return time.error();
      fault.time_ns = time.value();
      break;
    }
    case Value::Length: {
      const auto length = hal::parse_quantity(value, hal::unit::m);
      if (!length.ok()) return length.error();
      fault.length_m = length.value();
      break;
    }
    case Value::Rate: {
      const auto rate = hal::parse_quantity(value, hal::unit::none);
      if (!rate.ok()) return rate.error();
      if (!(rate.value() > Eyebot::kStateRate_Hz && rate.value() <= 100000.0)) {
        return hal::Error{"a flood is of more than 50 and at most 100000 reports a second"};
      }
      fault.rate_Hz = static_cast<int>(rate.value());
      break;
    }
  }
  return {};
}

bool ends_with_topic(const std::string& channel, const std::string& topic) {
  return topic.empty() || channel.ends_with("/" + topic);
}

}  // namespace

std::string fault_manual() {
  std::string text;
  for (const Entry& e : kEntries) {
    std::string example = "  " + std::string(e.example);
    example.resize(std::max<std::size_t>(28, example.size() + 1), ' ');
    text += example + std::string(e.doc) + "\n";
  }
  return text + "A fault may be given @START+DURATION; without, it lasts from the start to the end.";
}

hal::Result<Fault> parse_fault(std::string_view text) {
  const auto split = split_fault(text);
  if (!split.ok()) return wrong(text, split.error().message);
  const FaultSpec& spec = split.value();
  const auto* entry = std::ranges::find(kEntries, spec.name, &Entry::name);
  if (entry == kEntries.end()) return wrong(text, "there is no fault '" + std::string(spec.name) + "'");
  if (spec.value && entry->value == Value::None) return wrong(text, "it takes no value");
  if (!spec.value && entry->value != Value::None && entry->value != Value::Channel) {
    return wrong(text, "it needs a value, as in " + std::string(entry->example));
  }
  if (!spec.start && entry->needs_start) return wrong(text, "say when, as in " + std::string(entry->example));
  Fault fault;
  fault.kind = entry->kind;
  fault.text = text;
  fault.from = spec.from();
  fault.until = spec.until();
  if (spec.value) {
    if (const hal::Status read = read_value(*entry, *spec.value, fault); !read.ok()) {
      return wrong(text, read.error().message);
    }
  }
  return fault;
}

void FaultPlan::begin(TimeNs start) {
  changes_.clear();
  told_ = 0;
  for (Fault& f : faults_) {
    const bool moment = f.kind == FaultKind::Restart || f.kind == FaultKind::Clock || f.kind == FaultKind::Battery;
    const bool ends = f.until < kEndless && !moment;
    f.from += start;
    f.until += start;
    changes_.push_back({f.from, true, &f});
    if (ends) changes_.push_back({f.until, false, &f});
  }
  std::ranges::stable_sort(changes_, {}, &Change::at);
}

std::optional<FaultPlan::Change> FaultPlan::next_change(TimeNs now) {
  if (told_ == changes_.size() || changes_[told_].at > now) return std::nullopt;
  return changes_[told_++];
}

std::optional<TimeNs> FaultPlan::next_change_at() const {
  if (told_ == changes_.size()) return std::nullopt;
  return changes_[told_].at;
}

bool FaultPlan::happens(FaultKind kind, TimeNs at) {
  bool any = false;
  for (const Fault& f : faults_) {
    if (f.kind == kind && f.from <= at && at < f.until) any = chance_.hits(f.probability) || any;
  }
  return any;
}

bool FaultPlan::is_mute(FaultKind kind, const std::string& channel, TimeNs at) const {
  return std::ranges::any_of(faults_, [&](const Fault& f) {
    return f.kind == kind && f.from <= at && at < f.until && ends_with_topic(channel, f.channel);
  });
}

TimeNs FaultPlan::longest_ns(FaultKind kind, TimeNs at) const {
  TimeNs longest = 0;
  for (const Fault& f : faults_) {
    if (f.kind == kind && f.from <= at && at < f.until) longest = std::max(longest, f.time_ns);
  }
  return longest;
}

void FaultPlan::damage(const std::string& channel, Bytes& data, TimeNs at) {
  const bool other = happens(FaultKind::Fingerprint, at) || is_mute(FaultKind::Damage, channel, at);
  if (other && data.size() >= 8) {
    for (std::size_t i = 0; i < 8; ++i) data[i] ^= std::byte{0xFF};
  }
  if (happens(FaultKind::Future, at) && data.size() >= kStampAt + 8) {
    std::uint64_t stamp_us = 0;
    for (std::size_t i = 0; i < 8; ++i) stamp_us = stamp_us << 8U | std::to_integer<std::uint64_t>(data[kStampAt + i]);
    stamp_us += 3'600'000'000;
    for (std::size_t i = 8; i-- > 0; stamp_us >>= 8U) data[kStampAt + i] = static_cast<std::byte>(stamp_us & 0xFFU);
  }
  if (happens(FaultKind::Truncate, at)) data.resize(static_cast<std::size_t>(chance_.draw() % data.size()));
}

void FaultPlan::pass(Way& way, Datagram message, std::vector<Datagram>& out) {
  const TimeNs sent_at = message.at;
  const auto deliver = [&](Datagram d) {
    d.at = way.last_at = std::max(way.last_at, sent_at + longest_ns(way.late, sent_at));
    out.push_back(std::move(d));
  };
  if (is_mute(way.mute, message.channel, sent_at) || happens(way.lose, sent_at)) return;
  const auto held = way.held.find(message.channel);
  if (held == way.held.end() && happens(way.swap, sent_at)) {
    way.held.emplace(message.channel, std::move(message));
    return;
  }
  deliver(message);
  if (happens(way.twice, sent_at)) deliver(message);
  if (held == way.held.end()) return;
  deliver(std::move(held->second));
  way.held.erase(held);
}

void FaultPlan::to_hub(const Datagram& message, std::vector<Datagram>& out) {
  Datagram damaged = message;
  damage(message.channel, damaged.data, message.at);
  pass(out_, std::move(damaged), out);
}

void FaultPlan::to_robot(const Datagram& message, std::vector<Datagram>& out) {
  pass(in_, message, out);
}

void apply(const FaultPlan::Change& change, Eyebot& robot, std::int32_t new_session) {
  const Fault& fault = *change.fault;
  robot.run_until(change.at);
  switch (fault.kind) {
    case FaultKind::Restart:
      return robot.restart(new_session, change.at);
    case FaultKind::Clock:
      return robot.jump_clock(fault.time_ns / 1000);
    case FaultKind::Battery:
      return robot.set_charge(fault.charge);
    case FaultKind::NoPosition:
      return robot.set_position_lost(change.begins);
    case FaultKind::Hardware:
      return robot.set_hardware_fault(change.begins);
    case FaultKind::Place:
      return robot.set_place_error(change.begins ? fault.length_m : 0.0);
    case FaultKind::Flood:
      return robot.set_state_rate_Hz(change.begins ? fault.rate_Hz : Eyebot::kStateRate_Hz);
    default:
      return;
  }
}

}  // namespace tandem::bridges::eyebot_emulator
