#include "mixed_reality/safety/lone_robot.hpp"

#include <algorithm>
#include <utility>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::mixed_reality {
namespace {

/// The clock is always there, messages only come when somebody sends some, and a scanner measures only once it was
/// switched on.
bool must_come(const hal::PortType& type) noexcept {
  return type.role == hal::Role::Sensor && type.name != hal::Clock::kName && type.name != hal::RangeAndBearing::kName &&
         type.name != hal::DistanceScanner::kName;
}

std::vector<WantedCommand> commands_of(const bridges::RobotBridge& bridge) {
  std::vector<WantedCommand> all;
  for (const bridges::PortView& view : bridge.taken()) {
    if (view.type->role == hal::Role::Actuator) all.push_back({view.type, view.data});
  }
  return all;
}

RealRobotParams without_wheels(RealRobotParams params) {
  params.all_wheels = false;
  return params;
}

}  // namespace

LoneRobot::LoneRobot(std::string id, std::unique_ptr<bridges::RobotBridge> bridge, RealRobotParams params,
                     hal::TimeNs tick_ns, hal::Log log)
    : id_(std::move(id)),
      commands_(commands_of(*bridge)),
      inputs_([&bridge] {
        std::vector<Input> all;
        for (const bridges::PortView& view : bridge->taken()) {
          if (must_come(*view.type)) all.push_back({view.type, static_cast<const hal::Reading*>(view.data)});
        }
        return all;
      }()),
      real_(std::move(bridge), std::move(commands_), without_wheels(params)),
      position_(static_cast<const hal::Positioning*>(real_.bridge().port(hal::port_type<hal::Positioning>()))),
      tick_ns_(tick_ns),
      log_(std::move(log)) {}

bool LoneRobot::latch(hal::Tick tick, hal::TimeNs now, RunPhase phase) {
  real_.read(tick, now - tick * tick_ns_, now);
  for (Input& input : inputs_) input.came = input.came || input.reading->validity == hal::Validity::Fresh;
  Conditions outside;
  outside.run = phase;
  outside.pose = hal::Validity::Fresh;  // nobody asks for it
  outside.readings_missing = missing() != nullptr;
  const bool steps = real_.judge(outside, {now, now}).controller_steps;
  note();
  return steps;
}

void LoneRobot::commit(hal::TimeNs now) {
  const bool alive = real_.verdict().may_drive && !real_.emergency_stopped();
  const hal::Pose at =
      position_ == nullptr ? hal::Pose{} : hal::Pose{position_->p_WB[0], position_->p_WB[1], position_->p_WB[2]};
  real_.gate().prepare(real_.supervisor(), alive, position_ == nullptr ? nullptr : &at, now,
                       [](const hal::PortType&, void*) { return false; });
  real_.send(alive, now, [](const hal::PortType&, void*) {});
}

const hal::PortType* LoneRobot::missing() const noexcept {
  const auto found = std::ranges::find(inputs_, false, &Input::came);
  return found != inputs_.end() ? found->type : nullptr;
}

std::string LoneRobot::reason() const {
  const bool reads = real_.verdict().owner == StopOwner::Readings && missing() != nullptr;
  return real_.reason(reads ? missing()->name : std::string_view());
}

void LoneRobot::note() {
  const Verdict& verdict = real_.verdict();
  if (verdict.reason == noted_) return;
  noted_ = verdict.reason;
  const std::string what = "robot '" + id_ + "': " + reason();
  verdict.may_drive || verdict.owner == StopOwner::Run ? log_.info(what) : log_.warning(what);
}

}  // namespace tandem::mixed_reality
