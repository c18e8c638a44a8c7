#include "mixed_reality/barrier/barrier_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/scenario/polygon.hpp"
#include "hal/finite.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr hal::TimeNs kOldest_ns = 5 * hal::kNsPerSecond;  // of poses, as far as bounds look back
constexpr double kSame_m_s = 1e-9;
constexpr double kStill_m = 1e-3;  // who comes no farther when told to stand, stands

using Direction = std::array<double, 3>;

bool finite(const Motion& m) noexcept {
  return hal::all_finite(m.velocity) && std::isfinite(m.turn_rad_s);
}

double dot(const Direction& a, const std::array<double, 3>& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Direction opposite(const Direction& n) noexcept {
  return {-n[0], -n[1], -n[2]};
}

/// What a robot wants to do in a direction: its wheels' forward speed, or that part of its velocity.
double speed_in(const BarrierRobot& robot, const Direction& n) noexcept {
  return robot.flies ? dot(n, robot.wanted.velocity) : robot.wanted.velocity[0];
}

/// Has the robot come at most `gap_m` in the direction that its bound looks at. Where it comes farther even by
/// standing, it is to stand; once it comes no nearer by itself, it may leave.
void hold_back(BarrierRobot& robot, const Direction& n, double gap_m) noexcept {
  const double standing_m = robot.bound.way_m(0.0);
  const bool leaves_only = gap_m < standing_m && standing_m <= kStill_m;
  const auto most_of = [&](double wanted) {
    if (leaves_only) return robot.bound.own_way_m(wanted) <= kStill_m * 1e-6 ? wanted : 0.0;
    return gap_m < standing_m ? 0.0 : robot.bound.most_m_s(wanted, gap_m);
  };
  if (!robot.flies) {
    robot.most_m_s = std::min(robot.most_m_s, std::fabs(most_of(robot.wanted.velocity[0])));
    return;
  }
  // Another bound may turn its velocity this way, so this one counts whatever is wanted.
  const double top_m_s = std::sqrt(dot(robot.wanted.velocity, robot.wanted.velocity));
  const double most = most_of(top_m_s);
  if (gap_m < standing_m && !leaves_only)
    robot.zone_m_s = 0.0;
  else if (n[2] > 0.5)
    robot.up_m_s = std::min(robot.up_m_s, most);
  else if (n[2] < -0.5)
    robot.down_m_s = std::min(robot.down_m_s, most);
  else if (most < top_m_s)
    robot.plane.add(n[0], n[1], most);
}

double low_m(const BarrierRobot& robot) noexcept {
  return robot.pose.z_m - (robot.flies ? robot.error_m : 0.0);
}
double top_m(const BarrierRobot& robot) noexcept {
  return robot.pose.z_m + robot.limits.height_m + (robot.flies ? robot.error_m : 0.0);
}

}  // namespace

BarrierRobot& BarrierFilter::add(const hal::RobotKind& kind) {
  robots_.push_back(std::make_unique<BarrierRobot>(kind));
  robots_.back()->obstacles.reserve(64);
  last_.assign(robots_.size() * robots_.size(), Direction{});
  return *robots_.back();
}

void BarrierFilter::remove(const BarrierRobot& robot) {
  std::erase_if(robots_, [&](const auto& r) { return r.get() == &robot; });
  last_.assign(robots_.size() * robots_.size(), Direction{});
}

void BarrierFilter::solve(hal::TimeNs now_ns) noexcept {
  for (const auto& robot : robots_) begin(*robot, now_ns);
  if (settings_.avoid != core::Avoid::Nobody) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      for (std::size_t k = i + 1; k < robots_.size(); ++k)
        keep_apart(*robots_[i], *robots_[k], last_[i * robots_.size() + k]);
    }
  }
  for (const auto& robot : robots_) {
    if (robot->placed && robot->moves) {
      for (const Obstacle& obstacle : robot->obstacles) keep_from(*robot, obstacle);
      for (const core::SafetyArea& fence : settings_.fences) keep_in(*robot, fence);
      for (const core::SafetyArea& area : settings_.keep_outs) keep_out(*robot, area);
      for (const core::SafetyArea& zone : settings_.zones) keep_slow(*robot, zone);
    }
    decide(*robot);
  }
}

void BarrierFilter::begin(BarrierRobot& robot, hal::TimeNs now_ns) const noexcept {
  robot.trespass = {};
  robot.plane.clear();
  const hal::Pose& pose = robot.pose;
  robot.placed = robot.placed && hal::all_finite({pose.x_m, pose.y_m, pose.z_m, pose.cos_h, pose.sin_h, robot.error_m,
                                                  robot.error_rad});
  if (!robot.placed || !finite(robot.wanted)) robot.wanted = {};
  robot.allowed = robot.wanted;
  robot.most_m_s = robot.up_m_s = robot.down_m_s = robot.zone_m_s = kInfinite;
  if (!robot.placed) return;
  const double reaction_s = robot.latency_s + robot.limits.settle_s;
  const MotionBound::Times times{std::max(robot.pose_ns, now_ns - kOldest_ns), now_ns, tick_ns_ + kLate_ns, reaction_s};
  robot.trail.forget(times.pose_ns - static_cast<hal::TimeNs>(reaction_s * 1e9) - hal::kNsPerSecond);
  robot.bound.begin(robot.trail, times, !robot.flies);
  if (!robot.flies) robot.bound.turn(pose, robot.error_rad, robot.wanted.turn_rad_s);
  const double speed_m_s = std::sqrt(dot(robot.wanted.velocity, robot.wanted.velocity));
  robot.reach_m = robot.bound.farthest_m(speed_m_s);
  robot.up_m = robot.down_m = robot.flies ? robot.reach_m : 0.0;
}

/// Along the line between them, as the last time, or one above the other: whatever leaves most.
void BarrierFilter::keep_apart(BarrierRobot& a, BarrierRobot& b, Direction& last) const noexcept {
  if (!a.placed || !b.placed || (!a.moves && !b.moves)) return;
  const double x = b.pose.x_m - a.pose.x_m, y = b.pose.y_m - a.pose.y_m;
  const double distance_m = std::sqrt(x * x + y * y);
  const double apart_m = a.limits.radius_m + b.limits.radius_m + a.error_m + b.error_m + settings_.apart_m;
  const double above_m = low_m(b) - top_m(a) - settings_.apart_m;  // of b over a
  const double below_m = low_m(a) - top_m(b) - settings_.apart_m;
  if (distance_m - apart_m > a.reach_m + b.reach_m || std::max(above_m, below_m) > a.up_m + b.up_m) {
    last = {};
    return;
  }
  Direction best{1.0, 0.0, 0.0};
  double gap_m = 0.0, left_m = -kInfinite, way_a_m = 0.0, way_b_m = 0.0;
  const auto consider = [&](const Direction& n, double gap) {
    a.bound.look(n);
    b.bound.look(opposite(n));
    const double way_a = a.bound.way_m(0.0), way_b = b.bound.way_m(b.hears ? 0.0 : speed_in(b, opposite(n)));
    if (gap - way_a - way_b <= left_m) return;
    best = n;
    gap_m = gap;
    way_a_m = way_a;
    way_b_m = way_b;
    left_m = gap - way_a - way_b;
  };
  if (distance_m > 0.0) consider({x / distance_m, y / distance_m, 0.0}, distance_m - apart_m);
  if (dot(last, last) > 0.0 && last[2] == 0.0) consider(last, last[0] * x + last[1] * y - apart_m);
  if (a.flies || b.flies) {
    consider({0.0, 0.0, 1.0}, above_m);
    consider({0.0, 0.0, -1.0}, below_m);
  }
  last = best;
  a.bound.look(best);
  b.bound.look(opposite(best));
  way_a_m = a.bound.way_m(a.hears ? 0.0 : speed_in(a, best));
  way_b_m = b.bound.way_m(b.hears ? 0.0 : speed_in(b, opposite(best)));
  left_m = gap_m - way_a_m - way_b_m;
  if (left_m < 0.0) {
    if (way_a_m + way_b_m <= kStill_m) {
      hold_back(a, best, -kInfinite);
      hold_back(b, opposite(best), -kInfinite);
    } else {
      a.most_m_s = a.zone_m_s = b.most_m_s = b.zone_m_s = 0.0;
    }
    return;
  }
  const double more_a = a.hears ? a.bound.way_m(speed_in(a, best)) - way_a_m : 0.0;
  const double more_b = b.hears ? b.bound.way_m(speed_in(b, opposite(best))) - way_b_m : 0.0;
  const double half_m = 0.5 * left_m, spare_m = 0.5 * std::max(0.0, left_m - more_a - more_b);
  // Also where nothing is scarce: other bounds may turn the velocity of what flies this way.
  hold_back(a, best, way_a_m + std::min(more_a, std::max(half_m, left_m - more_b)) + spare_m);
  hold_back(b, opposite(best), way_b_m + std::min(more_b, std::max(half_m, left_m - more_a)) + spare_m);
}

void BarrierFilter::keep_from(BarrierRobot& robot, const Obstacle& obstacle) const noexcept {
  const double x = obstacle.x_m - robot.pose.x_m, y = obstacle.y_m - robot.pose.y_m;
  const double distance_m = std::sqrt(x * x + y * y);
  if (!(distance_m > 0.0)) return;
  const Direction n{x / distance_m, y / distance_m, 0.0};
  const double nearing_m_s = -(n[0] * obstacle.v_m_s[0] + n[1] * obstacle.v_m_s[1]);
  const double horizon_s = hal::to_seconds(tick_ns_ + kLate_ns) + robot.latency_s + robot.limits.settle_s;
  const double gap_m = distance_m - obstacle.beyond_m - body_m(robot) - std::max(0.0, nearing_m_s) * horizon_s;
  if (gap_m > robot.reach_m) return;
  robot.bound.look(n);
  hold_back(robot, n, gap_m);
}

/// All sides of an outline that it may reach. Each is convex: a line parts the robot from it.
void BarrierFilter::keep_from_sides(BarrierRobot& robot, const core::SafetyArea& area) const noexcept {
  const double body = body_m(robot);
  for (std::size_t i = 0, k = area.corners.size() - 1; i < area.corners.size(); k = i++) {
    const core::Point2 p = core::nearest_on_side(area.corners[k], area.corners[i], robot.pose.x_m, robot.pose.y_m);
    const double x = p[0] - robot.pose.x_m, y = p[1] - robot.pose.y_m;
    const double distance_m = std::sqrt(x * x + y * y);
    if (distance_m - body > robot.reach_m || !(distance_m > 0.0)) continue;
    Direction n{x / distance_m, y / distance_m, 0.0};
    double gap_m = distance_m - body;
    robot.bound.look(n);
    double way_m = robot.bound.way_m(0.0);
    // Past the end of a side the line through it may leave more.
    const double along_x = area.corners[i][0] - area.corners[k][0], along_y = area.corners[i][1] - area.corners[k][1];
    const double length_m = std::sqrt(along_x * along_x + along_y * along_y);
    if (gap_m < way_m && length_m > 0.0) {
      Direction across{-along_y / length_m, along_x / length_m, 0.0};
      double across_m = across[0] * x + across[1] * y;
      if (across_m < 0.0) {
        across = opposite(across);
        across_m = -across_m;
      }
      robot.bound.look(across);
      const double across_way_m = robot.bound.way_m(0.0);
      if (across_m - body - across_way_m > gap_m - way_m) {
        n = across;
        gap_m = across_m - body;
        way_m = across_way_m;
      } else {
        robot.bound.look(n);
      }
    }
    hold_back(robot, n, gap_m);
  }
}

namespace {

void note_trespass(BarrierRobot& robot, const core::SafetyArea& area, bool out_of_fence, double depth_m) noexcept {
  if (depth_m > robot.trespass.depth_m) robot.trespass = {&area, out_of_fence, depth_m};
}

}  // namespace

void BarrierFilter::keep_in(BarrierRobot& robot, const core::SafetyArea& fence) const noexcept {
  const double x_m = robot.pose.x_m, y_m = robot.pose.y_m;
  const core::EdgePoint edge = core::nearest_on_edge(fence.corners, x_m, y_m);
  const bool inside = core::contains(fence.corners, x_m, y_m);
  note_trespass(robot, fence, true, robot.limits.radius_m + (inside ? -edge.distance : edge.distance));
  if (robot.flies) {
    note_trespass(robot, fence, true, robot.pose.z_m + robot.limits.height_m - fence.to_m);
    const double gap_m = fence.to_m - top_m(robot) - settings_.apart_m;
    if (gap_m <= robot.up_m) {
      robot.bound.look({0.0, 0.0, 1.0});
      hold_back(robot, {0.0, 0.0, 1.0}, gap_m);
    }
  }
  if (inside) {
    if (edge.distance - body_m(robot) <= robot.reach_m) keep_from_sides(robot, fence);
    return;
  }
  if (!(edge.distance > 0.0)) {
    robot.most_m_s = robot.zone_m_s = 0.0;
    return;
  }
  // Outside: only what leads back.
  const Direction away{(x_m - edge.x) / edge.distance, (y_m - edge.y) / edge.distance, 0.0};
  robot.bound.look(away);
  hold_back(robot, away, -kInfinite);
}

void BarrierFilter::keep_out(BarrierRobot& robot, const core::SafetyArea& area) const noexcept {
  const double x_m = robot.pose.x_m, y_m = robot.pose.y_m;
  const double over_m = low_m(robot) - area.to_m, under_m = area.from_m - top_m(robot);
  if (!robot.flies && (over_m >= 0.0 || under_m >= 0.0)) return;
  const core::EdgePoint edge = core::nearest_on_edge(area.corners, x_m, y_m);
  const bool inside = core::contains(area.corners, x_m, y_m);
  if (!inside && edge.distance - body_m(robot) > robot.reach_m) return;
  const bool at_height = robot.pose.z_m < area.to_m && robot.pose.z_m + robot.limits.height_m > area.from_m;
  const double depth_m = robot.limits.radius_m + (inside ? edge.distance : -edge.distance);
  if (at_height)
    note_trespass(robot, area, false,
                  robot.flies ? std::min({depth_m, area.to_m - robot.pose.z_m,
                                          robot.pose.z_m + robot.limits.height_m - area.from_m})
                              : depth_m);
  if (robot.flies && std::max(over_m, under_m) >= settings_.apart_m) {
    // It may pass over or under it: what it may not is to come to its height here.
    const Direction n{0.0, 0.0, over_m >= under_m ? -1.0 : 1.0};
    robot.bound.look(n);
    hold_back(robot, n, std::max(over_m, under_m) - settings_.apart_m);
    return;
  }
  if (!inside) return keep_from_sides(robot, area);
  if (!(edge.distance > 0.0)) return;
  const Direction deeper{(x_m - edge.x) / edge.distance, (y_m - edge.y) / edge.distance, 0.0};
  robot.bound.look(deeper);
  hold_back(robot, deeper, -kInfinite);
}

/// Fast until it could not be slow any more at the edge.
void BarrierFilter::keep_slow(BarrierRobot& robot, const core::SafetyArea& zone) const noexcept {
  const double lift_m = std::max(low_m(robot) - zone.to_m, zone.from_m - top_m(robot));
  if (lift_m > robot.up_m || (!robot.flies && lift_m >= 0.0)) return;
  const double x_m = robot.pose.x_m, y_m = robot.pose.y_m;
  const double body = body_m(robot);
  const bool inside = core::contains(zone.corners, x_m, y_m);
  const core::EdgePoint edge = core::nearest_on_edge(zone.corners, x_m, y_m);
  const double slow_m_s = zone.max_speed_m_s;
  if (inside || edge.distance <= body) {
    robot.zone_m_s = std::min(robot.zone_m_s, slow_m_s);
    return;
  }
  if (edge.distance - body > robot.reach_m) return;
  for (std::size_t i = 0, k = zone.corners.size() - 1; i < zone.corners.size(); k = i++) {
    const core::Point2 p = core::nearest_on_side(zone.corners[k], zone.corners[i], x_m, y_m);
    const double x = p[0] - x_m, y = p[1] - y_m;
    const double distance_m = std::sqrt(x * x + y * y);
    if (distance_m - body > robot.reach_m || !(distance_m > 0.0)) continue;
    const Direction n{x / distance_m, y / distance_m, 0.0};
    robot.bound.look(n);
    const double wanted = speed_in(robot, n);
    if (robot.bound.way_m(wanted) <= distance_m - body) continue;
    robot.zone_m_s =
        std::min(robot.zone_m_s, std::max(slow_m_s, std::fabs(robot.bound.most_m_s(wanted, distance_m - body))));
  }
}

void BarrierFilter::decide(BarrierRobot& robot) const noexcept {
  const Motion& wanted = robot.wanted;
  Motion& allowed = robot.allowed;
  if (!robot.flies) {
    const double most = std::min(robot.most_m_s, robot.zone_m_s);
    allowed.velocity[0] = std::clamp(wanted.velocity[0], -most, most);
    robot.changed_m_s = std::fabs(allowed.velocity[0] - wanted.velocity[0]);
  } else {
    const std::array<double, 2> level = robot.plane.nearest(wanted.velocity[0], wanted.velocity[1]);
    allowed.velocity = {level[0], level[1], std::clamp(wanted.velocity[2], -robot.down_m_s, robot.up_m_s)};
    const double speed_m_s = std::sqrt(dot(allowed.velocity, allowed.velocity));
    if (speed_m_s > robot.zone_m_s) {
      for (double& c : allowed.velocity) c *= robot.zone_m_s / speed_m_s;
    }
    double off2 = 0.0;
    for (std::size_t c = 0; c < 3; ++c)
      off2 += (allowed.velocity[c] - wanted.velocity[c]) * (allowed.velocity[c] - wanted.velocity[c]);
    robot.changed_m_s = std::sqrt(off2);
  }
  if (robot.changed_m_s < kSame_m_s) robot.changed_m_s = 0.0;
  if (!finite(allowed)) allowed = {};
}

}  // namespace tandem::mixed_reality
