#include "bridges/footbot_emulator/faults.hpp"

#include <cstdio>
#include <numbers>

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr std::array<FaultForm, 13> kForms = {{
    {"missing", FaultValue::Word, false, kEndless, "missing=gripper@0s+3s", "the module is not on the bus"},
    {"restart", FaultValue::MaybeWord, true, 0, "restart=left-motor@3s",
     "it restarts: deaf for 0.2 s, all its variables are 0; restart@3s: all"},
    {"silent", FaultValue::MaybeWord, false, kEndless, "silent=3@5s+2s",
     "its answers do not get out; it hears and obeys; silent@5s: all"},
    {"deaf", FaultValue::MaybeWord, false, kEndless, "deaf=left-motor@5s+2s", "it hears nothing"},
    {"lie", FaultValue::Word, false, kEndless, "lie=left-motor:size",
     "describes its first own variable with another size or name, or one variable too many (count)"},
    {"drop", FaultValue::Probability, false, kEndless, "drop=0.01",
     "a module's frame does not arrive, with this probability"},
    {"lose", FaultValue::Probability, false, kEndless, "lose=0.01",
     "a frame of the host does not arrive, with this probability"},
    {"double", FaultValue::Probability, false, kEndless, "double=0.01", "a module's frame arrives twice"},
    {"swap", FaultValue::Probability, false, kEndless, "swap=0.01",
     "a frame comes after the next one of the same message"},
    {"delay", FaultValue::Time, false, kEndless, "delay=20ms", "frames of modules arrive later"},
    {"hangup", FaultValue::None, true, hal::kNsPerSecond, "hangup@6s+1s",
     "the adapter, or the connection, disappears and comes back"},
    {"carry", FaultValue::Word, true, 0, "carry=0.5:-0.2:90@8s",
     "somebody puts its body elsewhere: metres to the east and the north, degrees counter-clockwise"},
    {"held", FaultValue::None, true, kEndless, "held@5s+2s", "its body is held fast, and its wheels turn on"},
}};

hal::Status read_carried(const FaultForm& form, Fault& fault) {
  std::array<double, 3>& way = fault.carried;
  char rest = 0;
  if (std::sscanf(fault.word.c_str(), "%lf:%lf:%lf%c", &way[0], &way[1], &way[2], &rest) != 3)
    return hal::Error{"say how far and by how many degrees, as in " + std::string(form.example)};
  way[2] *= std::numbers::pi / 180.0;
  return {};
}

hal::Status read_own(const FaultForm& form, Fault& fault) {
  if (form.value != FaultValue::Word && form.value != FaultValue::MaybeWord) return {};
  if (fault.kind == FaultKind::Carry) return read_carried(form, fault);
  const bool lies = fault.kind == FaultKind::Lie;
  const std::size_t colon = lies ? fault.word.find(':') : std::string::npos;
  const std::string name = fault.word.substr(0, colon);
  fault.module = place_of(name);
  if (!fault.module) return hal::Error{"there is no module '" + name + "'; there are " + module_names()};
  if (!lies) return {};
  const auto lie = aseba_emulation::lie_named(colon == std::string::npos ? "" : fault.word.substr(colon + 1));
  if (!lie.ok()) return hal::Error{lie.error().message + ", as in " + std::string(form.example)};
  fault.lie = lie.value();
  return {};
}

std::string about_modules() {
  return " The modules are " + module_names() + ".";
}

}  // namespace

const FaultTable<Fault> kFaults{kForms, &read_own, &about_modules};

void FaultPlan::to_host(const TimedFrame& frame, std::vector<TimedFrame>& out) {
  const auto part = static_cast<Part>(frame.frame.id & 0x700U);
  const bool has_successor = part == Part::First || part == Part::Middle;
  pass(way_, frame, frame.frame.id & 0xFFU, has_successor, out);
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
