#include "mixed_reality/safety/supervised_robot.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/turret.hpp"

namespace tandem::mixed_reality {
namespace {

/// The clock is always there, messages only come when somebody sends some, and a scanner measures only once it was
/// switched on.
bool must_come(const hal::PortType& type) noexcept {
  return type.role == hal::Role::Sensor && type.name != hal::Clock::kName && type.name != hal::RangeAndBearing::kName &&
         type.name != hal::DistanceScanner::kName;
}

template <class Port>
bool is(const hal::PortType& type) noexcept {
  return type.layout == hal::port_type<Port>().layout;
}

template <class Port>
Port& as(void* port) noexcept {
  return *static_cast<Port*>(port);
}

}  // namespace

SupervisedRobot::SupervisedRobot(std::string id, bridges::RobotBridge& bridge, const SupervisedParams& params,
                                 hal::Log log)
    : id_(std::move(id)),
      bridge_(bridge),
      params_(params),
      log_(std::move(log)),
      supervisor_(params.rearm),
      battery_watch_(bridge.robot().kind()) {
  for (const bridges::PortView& view : bridge.taken()) {
    if (must_come(*view.type)) inputs_.push_back({view.type, static_cast<const hal::Reading*>(view.data)});
    if (view.type->role != hal::Role::Actuator) continue;
    outputs_.push_back({view.type, view.data});
    largest_ = std::max(largest_, view.type->size);
  }
  kept_ = std::make_unique<std::byte[]>(outputs_.size() * largest_);
  // On a slow line only what the controller reads anyway is asked for.
  const hal::RobotKind& kind = bridge.robot().kind();
  const bool taken = std::ranges::any_of(inputs_, [](const Input& i) { return is<hal::Battery>(*i.type); });
  const bool asks = taken || kind.flies() || kind.part<hal::TurretPart>() != nullptr;
  battery_ = asks ? static_cast<const hal::Battery*>(bridge.port(hal::port_type<hal::Battery>())) : nullptr;
  flight_ =
      kind.flies() ? static_cast<const hal::FlightState*>(bridge.port(hal::port_type<hal::FlightState>())) : nullptr;
  position_ = static_cast<const hal::Positioning*>(bridge.port(hal::port_type<hal::Positioning>()));
}

bool SupervisedRobot::latch(hal::Tick tick, hal::TimeNs now) {
  bridge_.set_origin(now - tick * params_.tick_ns);
  bridge_.latch(tick, now);
  for (Input& input : inputs_) input.came = input.came || input.reading->validity == hal::Validity::Fresh;
  const bool steps = supervisor_.judge(conditions(now), now).controller_steps;
  last_ns_ = now;
  note();
  return steps;
}

Conditions SupervisedRobot::conditions(hal::TimeNs now) noexcept {
  Conditions c;
  c.hub_was_frozen = std::exchange(frozen_, false) || (last_ns_ != 0 && now - last_ns_ > params_.frozen_after_ns);
  c.guardian_gone = !guarded_;
  c.robot_stopped_itself = bridge_.stopped_itself();
  c.battery_low = battery_ != nullptr && battery_watch_.low(*battery_, now);
  c.link = bridge_.health();
  c.readings_missing = missing() != nullptr;
  c.pose = hal::Validity::Fresh;  // nobody asks for it
  return c;
}

const SupervisedRobot::Input* SupervisedRobot::missing() const noexcept {
  const auto found = std::ranges::find(inputs_, false, &Input::came);
  return found != inputs_.end() ? &*found : nullptr;
}

void SupervisedRobot::commit(hal::TimeNs now) noexcept {
  const Verdict& verdict = supervisor_.verdict();
  if (verdict.land != landing_) {
    landing_ = verdict.land;
    landing_ ? bridge_.land(now) : bridge_.resume();
  }
  const hal::Pose at =
      position_ == nullptr ? hal::Pose{} : hal::Pose{position_->p_WB[0], position_->p_WB[1], position_->p_WB[2]};
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    std::memcpy(kept(i), outputs_[i].port, outputs_[i].type->size);
    if (is<hal::FlightTask>(*outputs_[i].type)) {
      auto& task = as<hal::FlightTask>(outputs_[i].port);
      task = orders_.pass(task, verdict.may_drive, says_on_ground(flight_));
    } else {
      supervisor_.allow(*outputs_[i].type, outputs_[i].port, position_ == nullptr ? nullptr : &at, now);
    }
  }
  bridge_.commit(now);
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    std::memcpy(outputs_[i].port, kept(i), outputs_[i].type->size);
  }
}

std::string SupervisedRobot::reason() const {
  const Verdict& verdict = supervisor_.verdict();
  std::string text(verdict.reason);
  const Input* input = missing();
  const std::string detail =
      verdict.owner == StopOwner::Readings && input != nullptr ? std::string(input->type->name) : bridge_.trouble();
  if (!verdict.may_drive && !detail.empty()) text += " (" + detail + ")";
  return text;
}

void SupervisedRobot::note() {
  const Verdict& verdict = supervisor_.verdict();
  if (verdict.reason == noted_) return;
  noted_ = verdict.reason;
  const std::string what = "robot '" + id_ + "': " + reason();
  verdict.may_drive || verdict.owner == StopOwner::Run ? log_.info(what) : log_.warning(what);
}

}  // namespace tandem::mixed_reality
