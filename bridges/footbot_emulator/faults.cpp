#include "bridges/footbot_emulator/faults.hpp"

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <utility>

namespace tandem::bridges::footbot_emulator {
namespace {

enum class Value : std::uint8_t { None, Module, AnyModule, Lie, Probability, Time, Way };

using Entry = FaultEntry<FaultKind, Value>;

constexpr std::array<Entry, 13> kEntries = {{
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
    {FaultKind::Carry, "carry", Value::Way, true, 0, "carry=0.5:-0.2:90@8s",
     "somebody puts its body elsewhere: metres to the east and the north, degrees counter-clockwise"},
    {FaultKind::Held, "held", Value::None, true, kEndless, "held@5s+2s",
     "its body is held fast, and its wheels turn on"},
}};

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
  if (entry.value == Value::Way) {
    std::array<double, 3>& way = fault.carried;
    char rest = 0;
    if (std::sscanf(std::string(value).c_str(), "%lf:%lf:%lf%c", &way[0], &way[1], &way[2], &rest) != 3)
      return hal::Error{"say how far and by how many degrees, as in " + std::string(entry.example)};
    way[2] *= std::numbers::pi / 180.0;
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
  return manual_of_faults(kEntries, 26) + " The modules are " + module_names() + ".";
}

hal::Result<Fault> parse_fault(std::string_view text) {
  return read_fault<Fault>(text, kEntries, fault_manual(), &read_value, Value::AnyModule);
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
  if (fault.kind == FaultKind::Carry || fault.kind == FaultKind::Held) return;  // of the body
  if (fault.module) return to(*fault.module);
  for (std::size_t i = 0; i < kModules; ++i) to(Place{i});
}

}  // namespace tandem::bridges::footbot_emulator
