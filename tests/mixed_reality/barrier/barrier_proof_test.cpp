// Whatever robots are told, they touch neither one another nor the edge of what they may not leave or enter: bodies
// that obey late, at any moment within their links' latency, that follow with limited deceleration, and whose poses are
// old and wrong within their bounds. A check by chance: TANDEM_BARRIER_PAIRS of pairs, in virtual time.
#include <cmath>
#include <cstdlib>
#include <deque>
#include <gtest/gtest.h>
#include <vector>

#include "core/scenario/polygon.hpp"
#include "hal/device/brakes.hpp"
#include "hal/random.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "hal/robot/thymio.hpp"
#include "mixed_reality/barrier/barrier_filter.hpp"

namespace tandem::mixed_reality {
namespace {

using core::Point2;
constexpr hal::TimeNs kTick_ns = 100 * hal::kNsPerMs;
constexpr hal::TimeNs kStep_ns = 10 * hal::kNsPerMs;
constexpr double kStep_s = 0.01;
constexpr std::size_t kOldest = 12;  // steps that a pose may be old

std::uint32_t how_many(std::uint32_t usual) {
  const char* const asked = std::getenv("TANDEM_BARRIER_PAIRS");
  return asked != nullptr ? static_cast<std::uint32_t>(std::strtoul(asked, nullptr, 10)) : usual;
}

const hal::RobotKind& kind_of(hal::Random& random) {
  const hal::RobotKind* const kinds[] = {&hal::epuck::kind(), &hal::footbot::kind(), &hal::thymio::kind()};
  return *kinds[random.integer(0, 2)];
}

/// The body itself.
class Body {
 public:
  Body(const hal::RobotKind& kind, const hal::Pose& start, hal::Random& random) : kind_(kind), pose_(start) {
    heading_rad_ = start.heading_rad();
    latency_s_ = random.uniform(0.0, 0.15);
    rate_ = random.uniform(1.0, 5.0);
    if (kind.drive() != nullptr) rate_ *= kind.part<hal::BrakesPart>()->deceleration_m_s2;
    if (kind.flies()) rate_ *= kind.flight()->max_acceleration_m_s2;
    poses_.assign(kOldest + 1, pose_);
  }
  double latency_s() const { return latency_s_; }
  const hal::Pose& pose() const { return pose_; }
  const hal::Pose& pose_of(std::size_t steps_ago) const { return poses_[poses_.size() - 1 - steps_ago]; }

  void tell(hal::TimeNs now_ns, const Motion& motion, hal::Random& random) {
    hal::TimeNs at_ns = now_ns + static_cast<hal::TimeNs>(random.uniform(0.0, latency_s_) * 1e9);
    if (!pending_.empty()) at_ns = std::max(at_ns, pending_.back().first);
    pending_.emplace_back(at_ns, motion);
  }
  void move(hal::TimeNs now_ns) {
    while (!pending_.empty() && pending_.front().first <= now_ns) {
      target_ = pending_.front().second;
      pending_.pop_front();
    }
    kind_.flies() ? fly() : roll();
    poses_.push_back(pose_);
    poses_.pop_front();
  }

 private:
  void roll() {
    const double half_m = 0.5 * kind_.drive()->wheel_base_m, most = rate_ * kStep_s;
    const auto approach = [&](double& speed, double wanted) { speed += std::clamp(wanted - speed, -most, most); };
    approach(left_, target_.velocity[0] - half_m * target_.turn_rad_s);
    approach(right_, target_.velocity[0] + half_m * target_.turn_rad_s);
    const double turn_rad = (right_ - left_) / (2.0 * half_m) * kStep_s;
    const double way_m = 0.5 * (left_ + right_) * kStep_s;
    pose_.x_m += way_m * std::cos(heading_rad_ + 0.5 * turn_rad);
    pose_.y_m += way_m * std::sin(heading_rad_ + 0.5 * turn_rad);
    heading_rad_ += turn_rad;
    pose_.cos_h = std::cos(heading_rad_);
    pose_.sin_h = std::sin(heading_rad_);
  }
  void fly() {
    std::array<double, 3> off{};
    double off2 = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      off[c] = target_.velocity[c] - velocity_[c];
      off2 += off[c] * off[c];
    }
    const double part = off2 > 0.0 ? std::min(1.0, rate_ * kStep_s / std::sqrt(off2)) : 0.0;
    for (std::size_t c = 0; c < 3; ++c) velocity_[c] += part * off[c];
    pose_.x_m += velocity_[0] * kStep_s;
    pose_.y_m += velocity_[1] * kStep_s;
    pose_.z_m += velocity_[2] * kStep_s;
  }

  const hal::RobotKind& kind_;
  hal::Pose pose_;
  double heading_rad_ = 0.0;
  double latency_s_, rate_;
  double left_ = 0.0, right_ = 0.0;
  std::array<double, 3> velocity_{};
  Motion target_;
  std::deque<std::pair<hal::TimeNs, Motion>> pending_;
  std::deque<hal::Pose> poses_;
};

/// Bodies with a filter between them and their commands.
class Scene {
 public:
  Scene(const core::SafetyConfig& settings, std::uint32_t seed) : filter_(settings, kTick_ns), random_(7, seed) {}

  hal::Random& random() { return random_; }
  void add(const hal::RobotKind& kind, const hal::Pose& start) {
    robots_.push_back({&kind,
                       Body(kind, start, random_),
                       &filter_.add(kind),
                       {},
                       random_.uniform(0.0, 0.01),
                       random_.uniform(0.0, 0.05)});
  }
  const hal::Pose& pose(std::size_t i) const { return robots_[i].body.pose(); }
  BarrierRobot& robot(std::size_t i) { return *robots_[i].barrier; }

  /// One tick: `wish(i)` says what robot i wants; `look` after every step.
  template <class Wish, class Look>
  void tick(const Wish& wish, const Look& look) {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      One& one = robots_[i];
      BarrierRobot& robot = *one.barrier;
      const auto ago = static_cast<std::size_t>(random_.integer(0, kOldest - 1));
      robot.placed = true;
      robot.pose = one.body.pose_of(ago);
      robot.pose_ns = now_ns_ - static_cast<hal::TimeNs>(ago) * kStep_ns;
      robot.error_m = one.error_m;
      robot.error_rad = one.error_rad;
      robot.latency_s = blind ? 0.0 : one.body.latency_s();
      if (blind) robot.limits.settle_s = 0.0;
      const double angle = random_.uniform(-3.15, 3.15), off_m = random_.uniform(0.0, one.error_m);
      robot.pose.x_m += off_m * std::cos(angle);
      robot.pose.y_m += off_m * std::sin(angle);
      const double heading = robot.pose.heading_rad() + random_.uniform(-one.error_rad, one.error_rad);
      robot.pose.cos_h = std::cos(heading);
      robot.pose.sin_h = std::sin(heading);
      robot.wanted = wish(i);
    }
    filter_.solve(now_ns_);
    for (One& one : robots_) {
      one.barrier->note_sent(now_ns_, one.barrier->allowed);
      one.body.tell(now_ns_, one.barrier->allowed, random_);
      wanted_m_s += std::fabs(one.barrier->wanted.velocity[0]);
      allowed_m_s += std::fabs(one.barrier->allowed.velocity[0]);
    }
    const hal::TimeNs next_ns = now_ns_ + kTick_ns + (random_.chance(0.2) ? BarrierFilter::kLate_ns : 0);
    for (; now_ns_ < next_ns; now_ns_ += kStep_ns) {
      for (One& one : robots_) one.body.move(now_ns_);
      look();
    }
  }

  bool blind = false;
  double wanted_m_s = 0.0, allowed_m_s = 0.0;

 private:
  struct One {
    const hal::RobotKind* kind;
    Body body;
    BarrierRobot* barrier;
    Motion wanted;
    double error_m, error_rad;
  };
  BarrierFilter filter_;
  hal::Random random_;
  hal::TimeNs now_ns_ = hal::kNsPerSecond;
  std::vector<One> robots_;
};

/// Wheels at random; or straight on, or as before.
Motion any_wheels(const hal::RobotKind& kind, const Motion& before, hal::Random& random) {
  const double most = kind.drive()->max_speed_m_s;
  const double draw = random.uniform();
  if (draw < 0.3) return before;
  if (draw < 0.5) return {{random.chance(0.8) ? most : -most, 0.0, 0.0}, 0.0};
  const double left = random.uniform(-most, most), right = random.uniform(-most, most);
  return {{0.5 * (left + right), 0.0, 0.0}, (right - left) / kind.drive()->wheel_base_m};
}

/// Straight at the other, as fast as it can.
Motion towards(const hal::Pose& at, const hal::Pose& other, const hal::RobotKind& kind) {
  const double off_rad =
      std::remainder(std::atan2(other.y_m - at.y_m, other.x_m - at.x_m) - at.heading_rad(), 6.283185);
  const double most = kind.drive()->max_speed_m_s, turn_m_s = std::clamp(off_rad * 0.1, -0.5 * most, 0.5 * most);
  return {{most - std::fabs(turn_m_s), 0.0, 0.0}, 2.0 * turn_m_s / kind.drive()->wheel_base_m};
}

struct Outcome {
  double nearest_m = 1.0;  // between the bodies
  double wanted_m_s = 0.0, allowed_m_s = 0.0;
};

/// A pair that begins apart, most of them facing one another, some of them after one another. `blind`: the filter knows
/// nothing of delays.
Outcome run_pair(std::uint32_t pair, bool blind = false) {
  core::SafetyConfig settings;
  settings.apart_m = pair % 2 == 0 ? 0.0 : 0.01;
  Scene scene(settings, pair);
  scene.blind = blind;
  hal::Random& random = scene.random();
  const hal::RobotKind* const kinds[] = {&kind_of(random), &kind_of(random)};
  const double touch_m = kinds[0]->body.radius_m + kinds[1]->body.radius_m;
  const double angle = random.uniform(-3.15, 3.15), distance_m = touch_m + 0.03 + random.uniform(0.0, 0.25);
  const bool facing = random.chance(0.7);
  const double off_a = random.uniform(-0.6, 0.6), off_b = random.uniform(-0.6, 0.6);
  scene.add(*kinds[0], hal::Pose::at(0.0, 0.0, facing ? angle + off_a : random.uniform(-3.15, 3.15)));
  scene.add(*kinds[1], hal::Pose::at(distance_m * std::cos(angle), distance_m * std::sin(angle),
                                     facing ? angle + 3.14159 + off_b : random.uniform(-3.15, 3.15)));
  const bool hunts[2] = {random.chance(0.4), random.chance(0.4)};
  Motion wish[2];
  Outcome outcome;
  for (int tick = 0; tick < 25; ++tick) {
    scene.tick(
        [&](std::size_t i) {
          return wish[i] = hunts[i] ? towards(scene.pose(i), scene.pose(1 - i), *kinds[i])
                                    : any_wheels(*kinds[i], wish[i], random);
        },
        [&] {
          const double x = scene.pose(1).x_m - scene.pose(0).x_m, y = scene.pose(1).y_m - scene.pose(0).y_m;
          outcome.nearest_m = std::min(outcome.nearest_m, std::sqrt(x * x + y * y) - touch_m);
        });
  }
  outcome.wanted_m_s = scene.wanted_m_s;
  outcome.allowed_m_s = scene.allowed_m_s;
  return outcome;
}

TEST(BarrierProof, PairsOfRobotsOnWheelsNeverTouchWhateverTheyAreTold) {
  const std::uint32_t pairs = how_many(8000);
  double wanted = 0.0, allowed = 0.0, least_m = 1.0;
  std::uint32_t near = 0;
  for (std::uint32_t pair = 0; pair < pairs; ++pair) {
    const Outcome outcome = run_pair(pair);
    ASSERT_GE(outcome.nearest_m, 0.0) << "pair " << pair;
    least_m = std::min(least_m, outcome.nearest_m);
    near += outcome.nearest_m < 0.02 ? 1 : 0;
    wanted += outcome.wanted_m_s;
    allowed += outcome.allowed_m_s;
  }
  std::printf("%u pairs: nearest %.2f mm, %.0f %% came within 2 cm, %.0f %% of the speed wanted was allowed\n", pairs,
              least_m * 1e3, 100.0 * near / pairs, 100.0 * allowed / wanted);
  EXPECT_GT(near, pairs / 5) << "they are not kept apart by more than is needed";
  EXPECT_GT(allowed, 0.3 * wanted);
}

TEST(BarrierProof, FindsTheTouchesOfAFilterThatKnowsNothingOfDelays) {
  std::uint32_t touched = 0;
  for (std::uint32_t pair = 0; pair < 1000; ++pair) touched += run_pair(pair, true).nearest_m < 0.0 ? 1 : 0;
  EXPECT_GT(touched, 100U);
}

TEST(BarrierProof, ACrowdOfRobotsNeverTouches) {
  const std::uint32_t crowds = how_many(8000) / 1000;
  for (std::uint32_t crowd = 0; crowd < crowds; ++crowd) {
    core::SafetyConfig settings;
    settings.fences.push_back({"pen", {{-0.6, -0.6}, {0.6, -0.6}, {0.6, 0.6}, {-0.6, 0.6}}, 0.0, 1.0, 0.0, 0});
    Scene scene(settings, crowd);
    const hal::RobotKind& kind = hal::epuck::kind();
    std::vector<Motion> wish(16);
    for (std::size_t i = 0; i < 16; ++i)
      scene.add(kind, hal::Pose::at(-0.36 + 0.24 * static_cast<double>(i % 4),
                                    -0.36 + 0.24 * static_cast<double>(i / 4), scene.random().uniform(-3.15, 3.15)));
    for (int tick = 0; tick < 100; ++tick) {
      scene.tick([&](std::size_t i) { return wish[i] = any_wheels(kind, wish[i], scene.random()); },
                 [&] {
                   for (std::size_t i = 0; i < 16; ++i) {
                     ASSERT_LE(std::fabs(scene.pose(i).x_m), 0.6 - kind.body.radius_m);
                     ASSERT_LE(std::fabs(scene.pose(i).y_m), 0.6 - kind.body.radius_m);
                     for (std::size_t k = 0; k < i; ++k)
                       ASSERT_GE(
                           std::hypot(scene.pose(i).x_m - scene.pose(k).x_m, scene.pose(i).y_m - scene.pose(k).y_m),
                           2.0 * kind.body.radius_m)
                           << crowd;
                   }
                 });
      if (HasFatalFailure()) return;
    }
  }
}

TEST(BarrierProof, AConcaveFenceAndAKeepOutHoldTheWholeBody) {
  core::SafetyConfig settings;
  settings.fences.push_back(
      {"bay", {{-1, -1}, {1, -1}, {1, 1}, {0.3, 1}, {0.3, 0}, {-0.3, 0}, {-0.3, 1}, {-1, 1}}, 0.0, 1.0, 0.0, 0});
  settings.keep_outs.push_back({"star", {{0.3, -0.6}, {0.6, -0.4}, {0.45, -0.3}, {0.4, -0.45}}, 0.0, 1.0, 0.0, 0});
  const std::uint32_t robots = how_many(8000) / 50;
  for (std::uint32_t n = 0; n < robots; ++n) {
    Scene scene(settings, n);
    const hal::RobotKind& kind = kind_of(scene.random());
    hal::Pose start;
    do {
      start = hal::Pose::at(scene.random().uniform(-1.0, 1.0), scene.random().uniform(-1.0, 1.0),
                            scene.random().uniform(-3.15, 3.15));
    } while (!core::contains(settings.fences[0].corners, start.x_m, start.y_m) ||
             core::nearest_on_edge(settings.fences[0].corners, start.x_m, start.y_m).distance <
                 kind.body.radius_m + 0.03 ||
             core::contains(settings.keep_outs[0].corners, start.x_m, start.y_m) ||
             core::nearest_on_edge(settings.keep_outs[0].corners, start.x_m, start.y_m).distance <
                 kind.body.radius_m + 0.03);
    scene.add(kind, start);
    Motion wish;
    for (int tick = 0; tick < 60; ++tick) {
      scene.tick(
          [&](std::size_t) { return wish = any_wheels(kind, wish, scene.random()); },
          [&] {
            const hal::Pose& at = scene.pose(0);
            ASSERT_TRUE(core::contains(settings.fences[0].corners, at.x_m, at.y_m)) << n;
            ASSERT_GE(core::nearest_on_edge(settings.fences[0].corners, at.x_m, at.y_m).distance, kind.body.radius_m);
            ASSERT_FALSE(core::contains(settings.keep_outs[0].corners, at.x_m, at.y_m)) << n;
            ASSERT_GE(core::nearest_on_edge(settings.keep_outs[0].corners, at.x_m, at.y_m).distance, kind.body.radius_m)
                << n;
          });
      if (HasFatalFailure()) return;
    }
  }
}

TEST(BarrierProof, VirtualThingsThatStandAreNotDrivenInto) {
  const core::SafetyConfig settings;
  const std::uint32_t robots = how_many(8000) / 50;
  for (std::uint32_t n = 0; n < robots; ++n) {
    Scene scene(settings, n);
    const hal::RobotKind& kind = kind_of(scene.random());
    scene.add(kind, hal::Pose::at(0.0, 0.0, scene.random().uniform(-3.15, 3.15)));
    for (int i = 0; i < 6; ++i) {
      const double angle = 1.0472 * i, radius_m = scene.random().uniform(0.0, 0.2);
      const double away_m = radius_m + kind.body.radius_m + scene.random().uniform(0.03, 0.2);
      scene.robot(0).obstacles.push_back({away_m * std::cos(angle), away_m * std::sin(angle), radius_m, {}});
    }
    Motion wish;
    for (int tick = 0; tick < 40; ++tick) {
      scene.tick([&](std::size_t) { return wish = any_wheels(kind, wish, scene.random()); },
                 [&] {
                   for (const Obstacle& o : scene.robot(0).obstacles)
                     ASSERT_GE(std::hypot(scene.pose(0).x_m - o.x_m, scene.pose(0).y_m - o.y_m),
                               o.beyond_m + kind.body.radius_m);
                 });
      if (HasFatalFailure()) return;
    }
  }
}

TEST(BarrierProof, FlightsKeepApartUnderTheCeilingAndOutOfATablesHeight) {
  core::SafetyConfig settings;
  settings.fences.push_back({"hall", {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}}, 0.0, 3.0, 0.0, 0});
  settings.keep_outs.push_back({"table", {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}, 0.6, 1.0, 0.0, 0});
  const hal::RobotKind& kind = hal::eyebot::kind();
  const std::uint32_t pairs = how_many(8000) / 50;
  double wanted = 0.0, allowed = 0.0;
  for (std::uint32_t n = 0; n < pairs; ++n) {
    Scene scene(settings, n);
    scene.add(kind, hal::Pose::at(-2.0, scene.random().uniform(-0.5, 0.5), 0.0, 1.3));
    scene.add(kind, hal::Pose::at(2.0, scene.random().uniform(-0.5, 0.5), 0.0, 1.3));
    Motion wish[2];
    for (int tick = 0; tick < 80; ++tick) {
      scene.tick(
          [&](std::size_t i) {
            if (scene.random().chance(0.7)) return wish[i];
            for (double& c : wish[i].velocity) c = scene.random().uniform(-0.7, 0.7);
            if (tick < 30) wish[i].velocity[0] = i == 0 ? 0.7 : -0.7;
            return wish[i];
          },
          [&] {
            for (std::size_t i = 0; i < 2; ++i) {
              const hal::Pose& at = scene.pose(i);
              ASSERT_LE(std::fabs(at.x_m), 4.0 - kind.body.radius_m);
              ASSERT_LE(std::fabs(at.y_m), 4.0 - kind.body.radius_m);
              ASSERT_LE(at.z_m + kind.body.height_m, 3.0);
              const bool beside =
                  !core::contains(settings.keep_outs[0].corners, at.x_m, at.y_m) &&
                  core::nearest_on_edge(settings.keep_outs[0].corners, at.x_m, at.y_m).distance >= kind.body.radius_m;
              ASSERT_TRUE(beside || at.z_m >= 1.0 || at.z_m + kind.body.height_m <= 0.6) << n << " at " << at.z_m;
            }
            const double apart_m =
                std::hypot(scene.pose(1).x_m - scene.pose(0).x_m, scene.pose(1).y_m - scene.pose(0).y_m);
            ASSERT_TRUE(apart_m >= 2.0 * kind.body.radius_m ||
                        std::fabs(scene.pose(1).z_m - scene.pose(0).z_m) >= kind.body.height_m)
                << n;
          });
      if (HasFatalFailure()) return;
    }
    wanted += scene.wanted_m_s;
    allowed += scene.allowed_m_s;
  }
  EXPECT_GT(allowed, 0.2 * wanted);
}

}  // namespace
}  // namespace tandem::mixed_reality
