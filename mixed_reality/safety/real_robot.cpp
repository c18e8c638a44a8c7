#include "mixed_reality/safety/real_robot.hpp"

#include <algorithm>
#include <utility>

#include "hal/device/flight.hpp"
#include "hal/device/turret.hpp"

namespace tandem::mixed_reality {
RealRobot::RealRobot(std::unique_ptr<bridges::RobotBridge> bridge, std::vector<WantedCommand> wanted,
                     const RealRobotParams& params)
    : bridge_(std::move(bridge)),
      params_(params),
      supervisor_(params.rearm),
      gate_(*bridge_, std::move(wanted), params.all_wheels),
      battery_watch_(bridge_->robot().kind()) {
  const hal::RobotKind& kind = bridge_->robot().kind();
  const auto reads_battery = [](const bridges::PortView& v) {
    return v.type->layout == hal::port_type<hal::Battery>().layout;
  };
  // On a slow line only what its controller reads anyway is asked for.
  const std::vector<bridges::PortView> taken = bridge_->taken();
  const bool asks = params.ask_battery || kind.flies() || kind.part<hal::TurretPart>() != nullptr ||
                    std::ranges::any_of(taken, reads_battery);
  if (kind.flies()) flight_ = static_cast<const hal::FlightState*>(bridge_->port(hal::port_type<hal::FlightState>()));
  if (asks) battery_ = static_cast<const hal::Battery*>(bridge_->port(hal::port_type<hal::Battery>()));
}

void RealRobot::rearm() {
  proof_.arm();
  supervisor_.rearm();
}

void RealRobot::rearm_if_proved() {
  if (!supervisor_.unproved()) supervisor_.rearm();
}

void RealRobot::emergency_stop(hal::TimeNs monotonic_ns) noexcept {
  if (emergency_stop_) return;
  emergency_stop_ = true;
  bridge_->land(monotonic_ns);
}

void RealRobot::arm(bool named) {
  if (named && awaits_arming()) rearm();
  if (named) replaced_ = false;
  if (!emergency_stop_) return;
  emergency_stop_ = false;
  if (!being_replaced_) bridge_->resume();
}

void RealRobot::retire(hal::TimeNs monotonic_ns) noexcept {
  being_replaced_ = true;
  bridge_->land(monotonic_ns);
}

void RealRobot::stay() noexcept {
  being_replaced_ = false;
  replaced_ = true;
  if (!emergency_stop_) bridge_->resume();
}

void RealRobot::join_late() noexcept {
  proof_.join_late();
  replaced_ = true;
}

void RealRobot::read(hal::Tick tick, hal::TimeNs origin_ns, hal::TimeNs now_ns) noexcept {
  bridge_->set_origin(origin_ns);
  bridge_->latch(tick, now_ns);
}

const Verdict& RealRobot::judge(Conditions c, const Moment& now) {
  phase_ = c.run;
  begun_ = c.run == RunPhase::Running || c.run == RunPhase::Paused;
  const bool slept =
      c.run == RunPhase::Running && judged_ns_ != 0 && now.monotonic_ns - judged_ns_ > params_.frozen_after_ns;
  c.hub_was_frozen = std::exchange(hub_was_frozen_, false) || slept;
  c.guardian_gone = !guarded_;
  c.emergency_stop = emergency_stop_;
  c.being_replaced = being_replaced_;
  c.replaced = replaced_;
  c.robot_stopped_itself = bridge_->stopped_itself();
  c.doubt = proof_.look(c.run, *bridge_, now.monotonic_ns);
  c.battery_low = battery_ != nullptr && battery_watch_.low(*battery_, now.monotonic_ns);
  c.link = bridge_->health();
  judged_ns_ = now.monotonic_ns;
  return supervisor_.judge(c, now.run_ns);
}

/// The verdict and the command are of the latch: a loop that was kept from running since must not send them.
bool RealRobot::may_move(hal::TimeNs monotonic_ns, hal::TimeNs verdict_lasts_ns) const noexcept {
  return supervisor_.verdict().may_drive && !emergency_stop_ && monotonic_ns - judged_ns_ <= verdict_lasts_ns;
}

RobotState RealRobot::state() const noexcept {
  if (being_replaced_) return RobotState::Retired;
  if (supervisor_.verdict().may_drive) return RobotState::Driving;
  return begun_ && !replaced_ ? RobotState::Held : RobotState::Joining;
}

std::string RealRobot::reason(std::string_view detail) const {
  const Verdict& verdict = supervisor_.verdict();
  std::string text(verdict.reason);
  if (verdict.may_drive) return text;
  std::string more(detail);
  const auto add = [&more](const std::string& part) { more += (more.empty() || part.empty() ? "" : "; ") + part; };
  if (supervisor_.unproved()) add(proof_.detail());
  add(bridge_->trouble());
  if (!more.empty()) text += " (" + more + ")";
  return text;
}

}  // namespace tandem::mixed_reality
