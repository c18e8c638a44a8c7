#include "mixed_reality/safety/supervisor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hal/filter.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr Verdict held(std::string_view reason) {
  return {false, false, reason};
}
using C = Conditions;

// First row that applies decides. Everything that is not known to be well stops the robot.
constexpr std::array<SafetyRule, 9> kTable = {{
    {[](const C& c) noexcept { return c.run == RunPhase::Stopping; }, held("the run is stopping")},
    {[](const C& c) noexcept { return c.run == RunPhase::Waiting; }, held("waiting for the start")},
    {[](const C& c) noexcept { return c.controller_failed; }, held("controller stopped")},
    {[](const C& c) noexcept { return c.link == LinkHealth::Connecting; }, held("connecting")},
    {[](const C& c) noexcept { return c.link == LinkHealth::Lost; }, held("link lost")},
    {[](const C& c) noexcept { return c.link == LinkHealth::Suspect; }, held("link suspect")},
    {[](const C& c) noexcept { return c.pose == hal::Validity::Absent; }, held("pose unknown")},
    {[](const C& c) noexcept { return c.pose == hal::Validity::Stale; }, held("pose stale")},
    {[](const C&) noexcept { return true; }, Verdict{true, true, "driving"}},
}};

constexpr Verdict kSettling = held("settling");

}  // namespace

std::span<const SafetyRule> safety_table() noexcept {
  return kTable;
}

Verdict judge(const Conditions& conditions) noexcept {
  for (const SafetyRule& rule : kTable) {
    if (rule.applies(conditions)) return rule.verdict;
  }
  return held("no rule applies");
}

const Verdict& Supervisor::judge(const Conditions& conditions, hal::TimeNs now_ns) noexcept {
  const Verdict said = mixed_reality::judge(conditions);
  if (said.may_drive && !well_) well_since_ns_ = now_ns;
  well_ = said.may_drive;
  const bool was_driving = verdict_.may_drive;
  const bool settled = was_driving || hal::to_seconds(now_ns - well_since_ns_) >= params_.settle_s;
  verdict_ = well_ && !settled ? kSettling : said;
  if (was_driving && !verdict_.may_drive) ++stops_;
  if (!was_driving && verdict_.may_drive) {
    ++rearms_;
    armed_at_ns_ = now_ns;
  }
  return verdict_;
}

hal::WheelSpeeds Supervisor::allowed(const hal::WheelSpeeds& wanted, hal::TimeNs now_ns) const noexcept {
  hal::WheelSpeeds out;
  if (!verdict_.may_drive) return out;
  const double limit_m_s = params_.ramp_m_s2 * hal::to_seconds(now_ns - armed_at_ns_);
  const double fastest_m_s = std::max(std::fabs(wanted.left_m_s), std::fabs(wanted.right_m_s));
  const double scale = fastest_m_s > limit_m_s ? limit_m_s / fastest_m_s : 1.0;
  out.set(wanted.left_m_s * scale, wanted.right_m_s * scale);
  return out;
}

hal::QuadrotorSpeed Supervisor::allowed(const hal::QuadrotorSpeed& wanted, hal::TimeNs now_ns) const noexcept {
  if (!verdict_.may_drive) return {};
  hal::QuadrotorSpeed out = wanted;
  const double limit_m_s = params_.ramp_m_s2 * hal::to_seconds(now_ns - armed_at_ns_);
  hal::filter(out, limit_m_s, std::numeric_limits<double>::max());
  return out;
}

}  // namespace tandem::mixed_reality
