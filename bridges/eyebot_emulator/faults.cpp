#include "bridges/eyebot_emulator/faults.hpp"

#include <algorithm>
#include <array>

namespace tandem::bridges::eyebot_emulator {
namespace {

using hal::TimeNs;

constexpr std::array<FaultForm, 23> kForms = {{
    {"silent", FaultValue::MaybeWord, false, kEndless, "silent=state@5s+2s",
     "a channel of the robot is not sent; silent@5s: all"},
    {"deaf", FaultValue::MaybeWord, false, kEndless, "deaf=cmd/velocity@5s+2s",
     "a channel does not reach the robot (heartbeat: those of hubs); deaf@5s: all"},
    {"drop", FaultValue::Probability, false, kEndless, "drop=0.01", "a report is lost, with this probability"},
    {"double", FaultValue::Probability, false, kEndless, "double=0.01", "a report arrives twice"},
    {"swap", FaultValue::Probability, false, kEndless, "swap=0.01", "a report comes after the next of its channel"},
    {"delay", FaultValue::Time, false, kEndless, "delay=50ms", "reports arrive later"},
    {"lose", FaultValue::Probability, false, kEndless, "lose=0.01", "a command is lost, with this probability"},
    {"repeat", FaultValue::Probability, false, kEndless, "repeat=0.01", "a command arrives twice"},
    {"overtake", FaultValue::Probability, false, kEndless, "overtake=0.01",
     "a command comes after the next of its channel"},
    {"lag", FaultValue::Time, false, kEndless, "lag=300ms", "commands arrive later"},
    {"fingerprint", FaultValue::Probability, false, kEndless, "fingerprint=0.05",
     "a report has the fingerprint of no type"},
    {"truncate", FaultValue::Probability, false, kEndless, "truncate=0.05", "a report lacks its end"},
    {"restart", FaultValue::None, true, 0, "restart@3s", "the robot loses its power and starts anew"},
    {"clock", FaultValue::Jump, true, 0, "clock=1h@3s", "the robot's clock jumps, by -1h backwards"},
    {"battery", FaultValue::Charge, true, 0, "battery=0.05@10s", "so much charge is left, from 0 to 1"},
    {"no-position", FaultValue::None, false, kEndless, "no-position@5s+3s", "the robot does not know where it is"},
    {"hardware", FaultValue::None, false, kEndless, "hardware@5s+1s", "the robot finds a fault in itself"},
    {"namesake", FaultValue::None, false, kEndless, "namesake@5s+5s", "there is a second robot of that name"},
    {"flood", FaultValue::Number, false, kEndless, "flood=2000@5s+2s", "so many reports of its state a second"},
    {"damage", FaultValue::MaybeWord, false, kEndless, "damage=state",
     "every report on a channel is damaged, from the start or for a while"},
    {"future", FaultValue::Probability, false, kEndless, "future=0.01", "a report is stamped an hour ahead"},
    {"place", FaultValue::Length, false, kEndless, "place=3m@5s+2s",
     "the robot believes itself so far east of where it is"},
    {"second-hub", FaultValue::None, false, kEndless, "second-hub@5s+5s",
     "another hub, 'second', beats its heart and commands the robot's lights"},
}};

constexpr std::size_t kStampAt = 8;  // in a message, behind the fingerprint

hal::Status check(const FaultForm& form, Fault& fault) {
  const bool good = form.value != FaultValue::Number || (fault.number > Eyebot::kStateRate_Hz && fault.number <= 1e5);
  if (good) return {};
  return hal::Error{"a flood is of more than 50 and at most 100000 reports a second"};
}

bool ends_with_topic(const std::string& channel, const std::string& topic) {
  return topic.empty() || channel.ends_with("/" + topic);
}

}  // namespace

const FaultTable<Fault> kFaults{kForms, &check};

bool FaultPlan::is_mute(FaultKind kind, const std::string& channel, TimeNs at) const {
  return std::ranges::any_of(faults(), [&](const Fault& f) {
    return f.kind == kind && is_at_work(f, at) && ends_with_topic(channel, f.word);
  });
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

void FaultPlan::to_hub(const Datagram& message, std::vector<Datagram>& out) {
  Datagram damaged = message;
  damage(message.channel, damaged.data, message.at);
  if (!is_mute(FaultKind::Silent, message.channel, message.at)) pass(out_, damaged, message.channel, true, out);
}

void FaultPlan::to_robot(const Datagram& message, std::vector<Datagram>& out) {
  if (!is_mute(FaultKind::Deaf, message.channel, message.at)) pass(in_, message, message.channel, true, out);
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
      return robot.set_charge(fault.number);
    case FaultKind::NoPosition:
      return robot.set_position_lost(change.begins);
    case FaultKind::Hardware:
      return robot.set_hardware_fault(change.begins);
    case FaultKind::Place:
      return robot.set_place_error(change.begins ? fault.number : 0.0);
    case FaultKind::Flood:
      return robot.set_state_rate_Hz(change.begins ? static_cast<int>(fault.number) : Eyebot::kStateRate_Hz);
    default:
      return;
  }
}

}  // namespace tandem::bridges::eyebot_emulator
