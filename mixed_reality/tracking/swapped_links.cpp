#include "mixed_reality/tracking/swapped_links.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kPointEvery_ns = 50 * hal::kNsPerMs;
constexpr hal::TimeNs kStep_ns = 20 * hal::kNsPerMs;    // of delays that are tried
constexpr double kGap_m = 0.5;                          // encoders that jump so far began anew
constexpr double kPointsDiffer_m = 0.03;                // where a turn fits more
constexpr double kDiffers_m = 0.010, kSigmas = 1.5;     // a robot's wheels and its own tag
constexpr double kAlike_m = 0.005, kAlikeSigmas = 1.5;  // another one's tag: this, its noise, …
constexpr double kAlikePart = 0.02;                     // … and a part of the way (slip, scale)
constexpr double kClearly = 0.3;                        // … and by so much better than its own
constexpr double kOnly = 1.5;                           // … and the next best is worse by this factor

bool is_due(const MotionTrail& trail, hal::TimeNs at_ns) noexcept {
  return trail.size() == 0 || at_ns - trail.newest().at_ns >= kPointEvery_ns;
}

}  // namespace

void SwappedLinks::resize(std::size_t robots) {
  if (robots == robots_.size()) return;
  robots_.assign(robots, {});
  found_.reserve(robots);
  since_ns_ = -1;
}

void SwappedLinks::note(std::size_t index, const hal::WheelEncoders& encoders, double wheel_base_m,
                        const PoseMeasurement* seen, const Moment& now) noexcept {
  Robot& robot = robots_[index];
  if (seen != nullptr && is_due(robot.seen, seen->taken_ns)) {
    robot.seen.add({seen->taken_ns, seen->x_m, seen->y_m, seen->heading_rad, 0.0});
    robot.sd_m = seen->sd_m;
  }
  if (encoders.validity != hal::Validity::Fresh) {
    robot.known = false;
    return robot.wheels.clear();
  }
  const hal::TimeNs at_ns = now.to_monotonic(encoders.taken_ns);
  if (robot.known && !is_due(robot.wheels.trail(), at_ns)) return;
  const double left_m = robot.known ? encoders.left_m - robot.left_m : 0.0;
  const double right_m = robot.known ? encoders.right_m - robot.right_m : 0.0;
  if (!(std::fabs(left_m) + std::fabs(right_m) < kGap_m)) {
    robot.known = false;
    return robot.wheels.clear();
  }
  robot.wheels.roll(at_ns, left_m, right_m, wheel_base_m);
  robot.left_m = encoders.left_m;
  robot.right_m = encoders.right_m;
  robot.known = true;
}

std::span<const SwappedLinks::Found> SwappedLinks::judge(hal::TimeNs now_ns) noexcept {
  found_.clear();
  if (since_ns_ < 0) since_ns_ = judged_ns_ = now_ns;
  if (farthest_m({judged_ns_, now_ns}) < kEvery_m) return {};
  judged_ns_ = now_ns;
  double rolled_m = farthest_m({since_ns_, now_ns});
  for (; rolled_m > kLast_m && since_ns_ < now_ns; rolled_m = farthest_m({since_ns_, now_ns}))
    since_ns_ += kPointEvery_ns;
  if (rolled_m < kFirst_m) return {};
  compare({since_ns_, now_ns});
  return found_;
}

double SwappedLinks::farthest_m(const MotionSpan& span) noexcept {
  double farthest = 0.0;
  for (Robot& robot : robots_) {
    const MotionTrail& wheels = robot.wheels.trail();
    robot.rolled_m = 0.0;
    if (wheels.size() == 0) continue;
    robot.rolled_m = wheels.newest().way_m - wheels.at(span.from_ns).value_or(wheels[0]).way_m;
    farthest = std::max(farthest, robot.rolled_m);
  }
  return farthest;
}

void SwappedLinks::compare(const MotionSpan& span) noexcept {
  for (Robot& robot : robots_) {
    const auto own = best_delay(robot.wheels.trail(), robot.seen, span, kEarly_ns, kLate_ns, kStep_ns);
    robot.own_m = own ? own->apart_m : 0.0;
    robot.points = robot.seen.size() > 0 && !robot.seen.newest().heading_rad;
    robot.differs = robot.own_m > (robot.points ? kPointsDiffer_m : kDiffers_m) + kSigmas * robot.sd_m;
  }
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    const bool enough = robot.rolled_m >= (robot.points ? kFirstPoints_m : kFirst_m);
    std::size_t as = robot.differs && enough && robot.found_ns < span.from_ns ? who_moves_as(i, span) : kNobody;
    if (as != kNobody && robot.rolled_m < kAlone_m && !somebody_moves_as(i, span)) as = kNobody;
    if (as != kNobody && as == robot.moves_as) {
      found_.push_back({i, as});
      robot.found_ns = span.to_ns;
    }
    robot.moves_as = as;
  }
}

std::size_t SwappedLinks::who_moves_as(std::size_t index, const MotionSpan& span) const noexcept {
  const Robot& robot = robots_[index];
  std::size_t best = kNobody;
  double best_m = 0.0, second_m = 1e9;
  for (std::size_t k = 0; k < robots_.size(); ++k) {
    const Robot& other = robots_[k];
    if (k == index || !other.differs) continue;
    const auto apart = best_delay(robot.wheels.trail(), other.seen, span, kEarly_ns, kLate_ns, kStep_ns);
    if (!apart) continue;
    if (best == kNobody || apart->apart_m < best_m) {
      if (best != kNobody) second_m = best_m;
      best_m = apart->apart_m;
      best = k;
    } else {
      second_m = std::min(second_m, apart->apart_m);
    }
  }
  if (best == kNobody) return kNobody;
  return alike(robot, robots_[best], best_m) && second_m > kOnly * best_m ? best : kNobody;
}

bool SwappedLinks::alike(const Robot& rolls, const Robot& seen, double apart_m) noexcept {
  return apart_m < kAlike_m + kAlikeSigmas * seen.sd_m + kAlikePart * rolls.rolled_m &&
         apart_m < kClearly * std::min(rolls.own_m, seen.own_m);
}

/// Whoever is swapped has left its own tag to another one.
bool SwappedLinks::somebody_moves_as(std::size_t index, const MotionSpan& span) const noexcept {
  const Robot& robot = robots_[index];
  return std::ranges::any_of(robots_, [&](const Robot& other) {
    if (&other == &robot || !other.differs) return false;
    const auto apart = best_delay(other.wheels.trail(), robot.seen, span, kEarly_ns, kLate_ns, kStep_ns);
    return apart && alike(other, robot, apart->apart_m);
  });
}

}  // namespace tandem::mixed_reality
