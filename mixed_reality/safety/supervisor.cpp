#include "mixed_reality/safety/supervisor.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr Verdict held(StopOwner owner, std::string_view reason) {
  return {false, false, false, owner, reason};
}
constexpr Verdict landing(StopOwner owner, std::string_view reason) {
  return {false, false, true, owner, reason};
}
using C = Conditions;
using O = StopOwner;

// First row that applies decides. Everything that is not known to be well stops the robot.
// clang-format off
constexpr std::array<SafetyRule, 28> kTable = {{
    {[](const C& c) noexcept { return c.run == RunPhase::Stopping; },     held(O::Run, "the run is stopping")},
    {[](const C& c) noexcept { return c.run == RunPhase::Waiting; },      held(O::Run, "waiting for the start")},
    {[](const C& c) noexcept { return c.emergency_stop; },                landing(O::Operator, "emergency stop; waits to be armed")},
    {[](const C& c) noexcept { return c.being_replaced; },                held(O::Operator, "being replaced")},
    {[](const C& c) noexcept { return c.replaced; },                      held(O::Operator, "waits to be armed")},
    {[](const C& c) noexcept { return c.controller_failed; },             held(O::Controller, "controller failed")},
    {[](const C& c) noexcept { return c.operator_holds; },                held(O::Operator, "held by the operator")},
    {[](const C& c) noexcept { return c.hook_holds; },                    held(O::Hook, "held by a hook")},
    {[](const C& c) noexcept { return c.guardian_gone; },                 landing(O::Guardian, "guardian gone"),
     Recovery::Rearm, "guardian was gone; waits to be re-armed"},
    {[](const C& c) noexcept { return c.run == RunPhase::Paused; },       held(O::Operator, "paused")},
    {[](const C& c) noexcept { return c.hub_was_frozen; },                held(O::Hub, "hub was frozen"),
     Recovery::Rearm, "hub was frozen; waits to be re-armed"},
    {[](const C& c) noexcept { return c.robot_stopped_itself; },          held(O::Robot, "robot stopped by itself"),
     Recovery::Proof, "robot stopped by itself; waits to be re-armed"},
    {[](const C& c) noexcept { return c.doubt == Doubt::Another; },       held(O::Robot, "another robot answers; waits to be re-armed"),
     Recovery::Proof, "another robot answers; waits to be re-armed"},
    {[](const C& c) noexcept { return c.doubt == Doubt::OpenedAnew; },    held(O::Robot, "link was opened anew; waits to be re-armed"),
     Recovery::Proof, "link was opened anew; waits to be re-armed"},
    {[](const C& c) noexcept { return c.doubt == Doubt::Away; },          held(O::Robot, "was away for long; waits to be re-armed"),
     Recovery::Proof, "was away for long; waits to be re-armed"},
    {[](const C& c) noexcept { return c.doubt == Doubt::Late; },          held(O::Robot, "not armed by the start; waits to be re-armed"),
     Recovery::Proof, "not armed by the start; waits to be re-armed"},
    {[](const C& c) noexcept { return c.battery_low; },                   landing(O::Battery, "battery low"),
     Recovery::Operator, "battery was low; waits to be re-armed"},
    {[](const C& c) noexcept { return c.link == LinkHealth::Connecting; },held(O::Link, "connecting"),
     Recovery::Settle, "was not connected; waits to be re-armed"},
    {[](const C& c) noexcept { return c.link == LinkHealth::Lost; },      held(O::Link, "link lost"),
     Recovery::Settle, "link was lost; waits to be re-armed"},
    {[](const C& c) noexcept { return c.link == LinkHealth::Suspect; },   held(O::Link, "link suspect"),
     Recovery::Settle, "link was suspect; waits to be re-armed"},
    {[](const C& c) noexcept { return c.readings_missing; },              held(O::Readings, "a reading never came"),
     Recovery::Settle, "a reading was missing; waits to be re-armed"},
    {[](const C& c) noexcept { return c.pose == hal::Validity::Absent; }, held(O::Pose, "pose unknown"),
     Recovery::Settle, "pose was unknown; waits to be re-armed"},
    {[](const C& c) noexcept { return c.pose == hal::Validity::Stale; },  held(O::Pose, "pose stale"),
     Recovery::Settle, "pose was stale; waits to be re-armed"},
    {[](const C& c) noexcept { return c.pose_disputed; },                 held(O::Pose, "trackers disagree"),
     Recovery::Settle, "trackers disagreed; waits to be re-armed"},
    {[](const C& c) noexcept { return c.links_swapped; },                 held(O::Link, "links seem to be swapped"),
     Recovery::Proof, "links seem to be swapped; waits to be re-armed"},
    {[](const C& c) noexcept { return c.pose_jumped; },                   held(O::Pose, "moved by something else"),
     Recovery::Operator, "moved by something else; waits to be re-armed"},
    {[](const C& c) noexcept { return c.wheels_differ; },                 held(O::Pose, "wheels and pose differ"),
     Recovery::Rearm, "wheels and pose differed; waits to be re-armed"},
    {[](const C&) noexcept { return true; }, Verdict{true, true, false, O::Nobody, "driving"}},
}};
// clang-format on

const SafetyRule& rule_for(const Conditions& conditions) noexcept {
  for (const SafetyRule& rule : kTable) {
    if (rule.applies(conditions)) return rule;
  }
  return kTable.back();
}

/// The row that asks for most, of those that ask for at least `least`, also where another one decides; null: none.
const SafetyRule* asks_for_most(const Conditions& conditions, Recovery least) noexcept {
  const SafetyRule* most = nullptr;
  for (const SafetyRule& rule : kTable) {
    if (rule.recovery < least || !rule.applies(conditions)) continue;
    if (most == nullptr || rule.recovery > most->recovery) most = &rule;
  }
  return most;
}

}  // namespace

std::string_view name_of(StopOwner owner) noexcept {
  constexpr std::array<std::string_view, kStopOwners> kNames = {"nobody",     "run",  "operator", "hook",
                                                                "controller", "hub",  "guardian", "robot",
                                                                "battery",    "link", "readings", "pose"};
  return kNames[static_cast<std::size_t>(owner)];
}

std::span<const SafetyRule> safety_table() noexcept {
  return kTable;
}

Verdict judge(const Conditions& conditions) noexcept {
  return rule_for(conditions).verdict;
}

const Verdict& Supervisor::judge(const Conditions& conditions, hal::TimeNs now_ns) noexcept {
  const Verdict said = mixed_reality::judge(conditions);
  const bool was_driving = verdict_.may_drive;
  latch(conditions);
  if (said.may_drive && !well_) well_since_ns_ = now_ns;
  well_ = said.may_drive;
  if (well_ && rearmed(now_ns)) latched_ = nullptr;
  const bool settled = was_driving || hal::to_seconds(now_ns - well_since_ns_) >= params_.settle_s;
  verdict_ = !well_                ? said
             : latched_ != nullptr ? held(latched_->verdict.owner, latched_->waiting)
             : settled             ? said
                                   : held(StopOwner::Run, "settling");
  if (latched_ != nullptr) verdict_.land = latched_->verdict.land;
  if (was_driving && !verdict_.may_drive) {
    ++stops_;
    ++stops_by_[static_cast<std::size_t>(verdict_.owner)];
  }
  if (!was_driving && verdict_.may_drive) {
    ++rearms_;
    armed_at_ns_ = now_ns;
  }
  has_driven_ = has_driven_ || verdict_.may_drive;
  return verdict_;
}

void Supervisor::latch(const Conditions& conditions) noexcept {
  answers_ = conditions.link == LinkHealth::Active;
  const bool disarmed = conditions.emergency_stop || conditions.replaced;
  // Letting go of a robot is to say that all is well, but not which robot it is.
  const bool lets_go = (disarmed_ && !disarmed) || (operator_held_ && !conditions.operator_holds);
  if (lets_go && !unproved()) rearm();
  disarmed_ = disarmed;
  operator_held_ = conditions.operator_holds;
  if (conditions.run == RunPhase::Waiting || conditions.run == RunPhase::Joining) {
    latched_ = nullptr;
    has_driven_ = false;
    return;
  }
  const bool any_stop = params_.policy.by == RearmBy::Operator && has_driven_;
  const SafetyRule* const rule = asks_for_most(conditions, any_stop ? Recovery::Settle : Recovery::Rearm);
  if (rule == nullptr) return;
  const bool outweighs = latched_ == nullptr || rule->recovery > latched_->recovery;
  const bool as_much = !outweighs && rule->recovery == latched_->recovery;
  const bool newest = as_much && (rule->recovery != Recovery::Operator || rule < latched_);  // or an earlier row's
  if (outweighs || newest) latched_ = rule;
}

/// Whether the stop that needs a re-arm has got it by the time that passed.
bool Supervisor::rearmed(hal::TimeNs now_ns) const noexcept {
  return latched_ != nullptr && latched_->recovery == Recovery::Rearm && params_.policy.by == RearmBy::Time &&
         hal::to_seconds(now_ns - well_since_ns_) >= params_.policy.after_s;
}

void Supervisor::rearm() noexcept {
  if (latched_ == nullptr || params_.policy.by == RearmBy::Never || !answers_) return;
  latched_ = nullptr;
  well_ = false;  // it settles from now on
}

void Supervisor::allow(const hal::PortType& type, void* command, const hal::Pose* at,
                       hal::TimeNs now_ns) const noexcept {
  if (!verdict_.may_drive) return type.reset(command);
  if (type.slow_down == nullptr) return;
  type.slow_down(command, std::max(0.0, hal::to_seconds(now_ns - armed_at_ns_)) * params_.ramp_m_s2, at);
}

}  // namespace tandem::mixed_reality
