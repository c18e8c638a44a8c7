#include "bridges/eyebot_emulator/faults.hpp"

#include <algorithm>
#include <array>

#include "hal/unit.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using hal::TimeNs;

enum class Value : std::uint8_t { None, Channel, Probability, Time, SignedTime, Charge, Rate, Length };

using Entry = FaultEntry<FaultKind, Value>;

constexpr std::array<Entry, 23> kEntries = {{
    {FaultKind::Silent, "silent", Value::Channel, false, kEndless, "silent=state@5s+2s",
     "a channel of the robot is not sent; silent@5s: all"},
    {FaultKind::Deaf, "deaf", Value::Channel, false, kEndless, "deaf=cmd/velocity@5s+2s",
     "a channel does not reach the robot (heartbeat: those of hubs); deaf@5s: all"},
    {FaultKind::Drop, "drop", Value::Probability, false, kEndless, "drop=0.01",
     "a report is lost, with this probability"},
    {FaultKind::Double, "double", Value::Probability, false, kEndless, "double=0.01", "a report arrives twice"},
    {FaultKind::Swap, "swap", Value::Probability, false, kEndless, "swap=0.01",
     "a report comes after the next of its channel"},
    {FaultKind::Delay, "delay", Value::Time, false, kEndless, "delay=50ms", "reports arrive later"},
    {FaultKind::Lose, "lose", Value::Probability, false, kEndless, "lose=0.01",
     "a command is lost, with this probability"},
    {FaultKind::Repeat, "repeat", Value::Probability, false, kEndless, "repeat=0.01", "a command arrives twice"},
    {FaultKind::Overtake, "overtake", Value::Probability, false, kEndless, "overtake=0.01",
     "a command comes after the next of its channel"},
    {FaultKind::Lag, "lag", Value::Time, false, kEndless, "lag=300ms", "commands arrive later"},
    {FaultKind::Fingerprint, "fingerprint", Value::Probability, false, kEndless, "fingerprint=0.05",
     "a report has the fingerprint of no type"},
    {FaultKind::Truncate, "truncate", Value::Probability, false, kEndless, "truncate=0.05", "a report lacks its end"},
    {FaultKind::Restart, "restart", Value::None, true, kEndless, "restart@3s",
     "the robot loses its power and starts anew"},
    {FaultKind::Clock, "clock", Value::SignedTime, true, kEndless, "clock=1h@3s",
     "the robot's clock jumps, by -1h backwards"},
    {FaultKind::Battery, "battery", Value::Charge, true, kEndless, "battery=0.05@10s",
     "so much charge is left, from 0 to 1"},
    {FaultKind::NoPosition, "no-position", Value::None, false, kEndless, "no-position@5s+3s",
     "the robot does not know where it is"},
    {FaultKind::Hardware, "hardware", Value::None, false, kEndless, "hardware@5s+1s",
     "the robot finds a fault in itself"},
    {FaultKind::Namesake, "namesake", Value::None, false, kEndless, "namesake@5s+5s",
     "there is a second robot of that name"},
    {FaultKind::Flood, "flood", Value::Rate, false, kEndless, "flood=2000@5s+2s",
     "so many reports of its state a second"},
    {FaultKind::Damage, "damage", Value::Channel, false, kEndless, "damage=state",
     "every report on a channel is damaged, from the start or for a while"},
    {FaultKind::Future, "future", Value::Probability, false, kEndless, "future=0.01",
     "a report is stamped an hour ahead"},
    {FaultKind::Place, "place", Value::Length, false, kEndless, "place=3m@5s+2s",
     "the robot believes itself so far east of where it is"},
    {FaultKind::SecondHub, "second-hub", Value::None, false, kEndless, "second-hub@5s+5s",
     "another hub, 'second', beats its heart and commands the robot's lights"},
}};

constexpr std::size_t kStampAt = 8;  // in a message, behind the fingerprint

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
  return manual_of_faults(kEntries, 28);
}

hal::Result<Fault> parse_fault(std::string_view text) {
  return read_fault<Fault>(text, kEntries, fault_manual(), &read_value, Value::Channel);
}

bool FaultPlan::is_mute(FaultKind kind, const std::string& channel, TimeNs at) const {
  return std::ranges::any_of(faults(), [&](const Fault& f) {
    return f.kind == kind && is_at_work(f, at) && ends_with_topic(channel, f.channel);
  });
}

TimeNs FaultPlan::longest_ns(FaultKind kind, TimeNs at) const {
  TimeNs longest = 0;
  for (const Fault& f : faults()) {
    if (f.kind == kind && is_at_work(f, at)) longest = std::max(longest, f.time_ns);
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
  if (happens(FaultKind::Truncate, at)) data.resize(static_cast<std::size_t>(chance().draw() % data.size()));
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
