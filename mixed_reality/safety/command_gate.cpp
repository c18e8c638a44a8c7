#include "mixed_reality/safety/command_gate.hpp"

#include <algorithm>

namespace tandem::mixed_reality {
namespace {

template <class Port>
bool is(const hal::PortType& type) noexcept {
  return type.layout == hal::port_type<Port>().layout;
}

std::size_t units(const hal::PortType& type) noexcept {
  return (type.size + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t);
}

}  // namespace

CommandGate::CommandGate(bridges::RobotBridge& bridge, std::vector<WantedCommand> wanted, bool all_wheels)
    : bridge_(bridge) {
  void* const wheels = all_wheels ? bridge.port(hal::port_type<hal::WheelSpeeds>()) : nullptr;
  task_ = bridge.robot().kind().flies() ? bridge.port(hal::port_type<hal::FlightTask>()) : nullptr;
  std::size_t all = 0;
  bool drives = false;
  for (const WantedCommand& w : wanted) {
    commands_.push_back(
        {w.type, w.port, bridge.port(*w.type), nullptr, is<hal::WheelSpeeds>(*w.type), is<hal::FlightTask>(*w.type)});
    drives = drives || (commands_.back().is_wheels && commands_.back().real != nullptr);
    all += units(*w.type);
  }
  if (!drives) wheels_alone_ = wheels;
  memory_ = std::make_unique<std::max_align_t[]>(all);
  std::max_align_t* next = memory_.get();
  for (Command& c : commands_) {
    c.sent = next;
    c.type->reset(next);
    next += units(*c.type);
  }
}

void CommandGate::stand() noexcept {
  wheels_ = {};
  for (const Command& c : commands_) {
    if (!c.is_task) c.type->reset(c.sent);
  }
}

void CommandGate::hand_over(bool land, hal::TimeNs now_ns) {
  const auto swap = [](const Command& c) {
    auto* const sent = static_cast<std::byte*>(c.sent);
    std::swap_ranges(sent, sent + c.type->size, static_cast<std::byte*>(c.real));
  };
  for (const Command& c : commands_) {
    if (c.real == nullptr) continue;
    c.real == c.wanted ? swap(c) : static_cast<void>(std::memcpy(c.real, c.sent, c.type->size));
  }
  // A controller without wheels leaves them where they are safe.
  if (wheels_alone_ != nullptr) std::memcpy(wheels_alone_, &wheels_, sizeof wheels_);
  hal::FlightTask kept;
  if (task_ != nullptr) std::memcpy(&kept, task_, sizeof kept);
  if (task_ != nullptr && land) {
    hal::FlightTask landing;
    landing.order = hal::FlightOrder::Land;
    std::memcpy(task_, &landing, sizeof landing);
    landing_ = true;
  } else if (landing_) {
    landing_ = false;
    hal::port_type<hal::FlightTask>().reset(task_);  // its controller may not have taken the device
  }
  bridge_.commit(now_ns);
  for (const Command& c : commands_) {
    if (c.real == nullptr || c.real != c.wanted) continue;
    if (c.is_task) std::memcpy(c.real, &kept, sizeof kept);
    swap(c);
  }
}

}  // namespace tandem::mixed_reality
