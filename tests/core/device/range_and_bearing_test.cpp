// Who hears whom among bodies of several heights, against a plain test of every pair with every body.
#include "hal/device/range_and_bearing.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <set>

#include "core/device/shadows.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

constexpr double kPi = std::numbers::pi;

// --- shadows ---

TEST(Shadows, CoverWhatAnyDiscCovers) {
  // Discs at pseudo-random places; every direction is compared with each disc alone.
  std::uint32_t state = 1;
  const auto random = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state >> 8) / 16777216.0;
  };
  for (int round = 0; round < 200; ++round) {
    Shadows shadows;
    struct Disc {
      double angle, half;
    };
    std::vector<Disc> discs;
    for (int i = 0; i < 1 + round % 30; ++i) {
      const double angle = (2.0 * random() - 1.0) * kPi;
      const double distance = 0.2 + 3.0 * random();
      shadows.add(distance * std::cos(angle), distance * std::sin(angle), 0.1);
      discs.push_back({angle, std::asin(0.1 / distance)});
    }
    for (int k = 0; k < 720; ++k) {
      const double angle = -kPi + (k + 0.5) * kPi / 360.0;
      bool covered = false, close = false;
      for (const Disc& d : discs) {
        const double off = std::fabs(std::remainder(angle - d.angle, 2.0 * kPi));
        covered = covered || off <= d.half;
        close = close || std::fabs(off - d.half) < 1e-9;
      }
      if (!close) {
        EXPECT_EQ(shadows.covers(Shadows::direction(std::cos(angle), std::sin(angle))), covered)
            << "round " << round << ", angle " << angle;
      }
    }
  }
}

TEST(Shadows, AreFullOnceTheCircleIsClosed) {
  Shadows shadows;
  for (int i = 0; i < 8; ++i) {
    EXPECT_FALSE(shadows.full());
    shadows.add(0.2 * std::cos(i * kPi / 4.0), 0.2 * std::sin(i * kPi / 4.0), 0.1);  // each covers 60 degrees
  }
  EXPECT_TRUE(shadows.full());
  shadows.clear();
  EXPECT_FALSE(shadows.covers(0.0));
}

// --- whole worlds ---

struct Ends {
  std::array<double, 3> p;  // of the board, in W
  double radius, low, high;
};

/// Whether body `c` is between the boards of `a` and `b`: 0 no, 1 yes, -1 too close to tell. By small steps.
int between(const Ends& a, const Ends& b, const Ends& c) {
  const double length = std::hypot(b.p[0] - a.p[0], b.p[1] - a.p[1]);
  const int steps = 1 + static_cast<int>(length / 2e-3);
  double deepest = -1e9;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const double x = a.p[0] + t * (b.p[0] - a.p[0]) - c.p[0];
    const double y = a.p[1] + t * (b.p[1] - a.p[1]) - c.p[1];
    const double z = a.p[2] + t * (b.p[2] - a.p[2]);
    const double depth = std::min({c.radius - std::hypot(x, y), c.high - z, z - c.low});
    deepest = std::max(deepest, depth);
  }
  return deepest > 2e-3 ? 1 : deepest < -2e-3 ? 0 : -1;
}

Ends ends_of(const Space& space, RobotId id) {
  const hal::RobotKind& kind = space.kind(id);
  const Pose at = space.pose(id);
  return {{at.x_m, at.y_m, at.z_m + kind.part<hal::RangeAndBearingPart>()->height_m},
          kind.body.radius_m,
          at.z_m,
          at.z_m + kind.body.height_m - 0.005};
}

/// Whether robot `i` has robot `j` in sight, by every body between them: 0 yes, 1 no, -1 too close to tell.
int hidden(const Space& space, std::size_t i, std::size_t j) {
  const Ends a = ends_of(space, space.robot(i));
  const Ends b = ends_of(space, space.robot(j));
  int worst = 0;
  for (std::size_t k = 0; k < space.robot_count(); ++k) {
    if (k == i || k == j) continue;
    const int one = between(a, b, ends_of(space, space.robot(k)));
    if (one == 1) return 1;
    if (one != 0) worst = one;
  }
  return worst;
}

void all_send(const MadeWorld& world) {
  Space& space = world.world->space();
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    auto* send = space.port<hal::RangeAndBearingSend>(space.robot(i));
    send->sending = true;
    send->size = 1;
    send->payload[0] = static_cast<std::uint8_t>(i);
  }
}

TEST(RabOcclusion, IsWhatEveryPairWithEveryBodySays) {
  Scene scene = footbot_scene("dynamics2d", 12.0);
  for (int i = 0; i < 60; ++i) {
    const double angle = 2.39996 * i;
    const double radius = 0.3 * std::sqrt(i + 0.5);
    add_footbot(scene, "fb" + std::to_string(i), radius * std::cos(angle), radius * std::sin(angle), i);
  }
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  // A fifth of them send: nobody hears more than it can keep.
  all_send(world);
  Space& space = world->space();
  for (std::size_t i = 0; i < 60; ++i) space.port<hal::RangeAndBearingSend>(space.robot(i))->sending = i % 5 == 0;
  steps(world, 2);
  int blocked = 0, in_sight = 0;
  for (std::size_t i = 0; i < 60; ++i) {
    const Pose at = space.pose(space.robot(i));
    const auto* port = space.port<hal::RangeAndBearing>(space.robot(i));
    EXPECT_EQ(port->dropped, 0U);
    std::set<std::size_t> heard;
    for (std::size_t k = 0; k < port->count; ++k) heard.insert(port->message(k)[0]);
    for (std::size_t j = 0; j < 60; j += 5) {
      if (i == j) continue;
      const Pose other = space.pose(space.robot(j));
      const bool near = std::hypot(at.x_m - other.x_m, at.y_m - other.y_m) <= 3.0;
      const int behind = hidden(space, i, j);
      if (near && behind == -1) continue;
      EXPECT_EQ(heard.count(j), near && behind == 0 ? 1U : 0U) << i << " and " << j;
      blocked += near && behind == 1 ? 1 : 0;
      in_sight += near && behind == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(blocked, 50) << "the scene is no test otherwise";
  EXPECT_GT(in_sight, 50);
}

TEST(RabOcclusion, HeightsCount) {
  // Foot-bots and e-pucks on the ground, eye-bots above them.
  Scene scene = footbot_scene("dynamics2d", 8.0);
  scene.scenario.arena_size[2] = 6.0;
  scene.scenario.arena_center[2] = 3.0;
  scene.engine("particle3d");
  const double ring = 0.5;
  add_footbot(scene, "middle", 0, 0);
  add_footbot(scene, "behind", 1.0, 0);
  add_footbot(scene, "between", 0.5, 0.03);
  scene.pilot("fly").flyer("low", ring + 0.9, 0.0, 0.8).flyer("high", 0.2, 0.2, 2.0);
  ControllerConfig small = scene.scenario.controllers.front();
  small.id = "small";
  small.label = "counting_drive";
  small.sensors = {{"proximity", "default", {}}};
  small.actuators = {{"differential_steering", "default", {}}, {"range_and_bearing", "default", {}}};
  scene.scenario.controllers.push_back(small);
  scene.robot("ep", -0.4, 0).robot("ep_before", -0.2, 0);
  const auto far = std::make_shared<hal::RobotKind>(*test::catalog().find<hal::RobotKind>("e-puck"));
  far->part<hal::RangeAndBearingPart>()->range_m = 3.0;
  for (std::size_t i : {5U, 6U}) {
    scene.scenario.robots[i].controller = scene.scenario.controllers.size() - 1;
    scene.scenario.robots[i].own_kind = far;
  }
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  all_send(world);
  steps(world, 1);
  all_send(world);
  steps(world, 1);
  const auto hears = [&world](const std::string& id, const std::string& who) {
    const Space& space = world->space();
    const Ends a = ends_of(space, space.find_robot(id));
    const Ends b = ends_of(space, space.find_robot(who));
    const double range = std::hypot(a.p[0] - b.p[0], a.p[1] - b.p[1], a.p[2] - b.p[2]);
    const auto* port = space.port<hal::RangeAndBearing>(space.find_robot(id));
    for (std::size_t k = 0; k < port->count; ++k) {
      if (std::fabs(static_cast<double>(port->range_m[k]) - range) < 1e-3) return true;
    }
    return false;
  };
  EXPECT_TRUE(hears("middle", "between"));
  EXPECT_FALSE(hears("middle", "behind")) << "a foot-bot's body is higher than its board";
  EXPECT_FALSE(hears("behind", "middle"));
  EXPECT_TRUE(hears("middle", "ep")) << "an e-puck's board sits on top: the line passes over the other";
  EXPECT_TRUE(hears("middle", "high"));
  EXPECT_TRUE(hears("behind", "high"));
  EXPECT_TRUE(hears("middle", "low")) << "the line rises above the foot-bot in between soon enough";
}

TEST(RabOcclusion, CanBeSwitchedOff) {
  Scene scene = footbot_scene("dynamics2d", 4.0);
  for (int i = 0; i < 3; ++i) add_footbot(scene, "fb" + std::to_string(i), 0.4 * i, 0);
  choose(scene, "range_and_bearing", hal::Role::Sensor, "default", {{"check_occlusions", "false", 11}});
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  all_send(world);
  steps(world, 2);
  EXPECT_EQ(reading<hal::RangeAndBearing>(world, "fb0").count, 2U);
  choose(scene, "range_and_bearing", hal::Role::Sensor, "default");
  auto blocked = make(scene);
  blocked->start();
  all_send(blocked);
  steps(blocked, 2);
  EXPECT_EQ(reading<hal::RangeAndBearing>(blocked, "fb0").count, 1U);
  EXPECT_EQ(reading<hal::RangeAndBearing>(blocked, "fb1").count, 2U);
}

TEST(RabOcclusion, EpucksAloneDoNotHideOneAnother) {
  Scene scene(4.0, "everything");
  for (int i = 0; i < 3; ++i) scene.robot("ep" + std::to_string(i), 0.2 * i, 0);
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  steps(world, 3);
  EXPECT_EQ(reading<hal::RangeAndBearing>(world, "ep0").count, 2U);
}

}  // namespace
}  // namespace tandem::core
