// Regions with walls and gates, splits of one arena, and engines of several kinds side by side: nobody notices a
// border.
#include <map>

#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

constexpr double kSpeed_m_s = 0.1;

/// Name of the region that owns a robot.
std::string region_of(const MadeWorld& world, const std::string& id) {
  const SpaceStores& s = world.world->space().stores();
  const std::uint16_t region = s.bodies.region[s.row_of(world.world->space().find_robot(id))];
  return region == kNoRegion ? "none" : s.regions[region].name;
}

/// Every living robot belongs to exactly one region, which contains it; no two regions have a body in their lists. The
/// lists are as of the start of the tick, so a body that came from an engine without lists may not be in one yet.
void expect_one_region_each(const MadeWorld& world, double slack_m = 1e-9) {
  const SpaceStores& s = world.world->space().stores();
  const bool all_listed = std::all_of(s.regions.begin(), s.regions.end(), [](const Region& r) { return r.listed; });
  std::map<std::uint32_t, int> lists;
  for (const Region& region : s.regions) {
    ASSERT_TRUE(std::is_sorted(region.owned.begin(), region.owned.end()));
    ASSERT_TRUE(std::is_sorted(region.mirrored.begin(), region.mirrored.end()));
    for (const BodyKey body : region.owned) {
      ++lists[body.value];
      ASSERT_FALSE(std::binary_search(region.mirrored.begin(), region.mirrored.end(), body)) << region.name;
    }
  }
  for (const std::uint32_t entity : s.living) {
    const RobotEntity& e = s.robots[entity];
    const std::size_t row = s.blocks[e.block].first_row + e.slot;
    ASSERT_NE(s.bodies.region[row], kNoRegion);
    const Region& region = s.regions[s.bodies.region[row]];
    ASSERT_LE(region.distance(s.bodies.x_m[row], s.bodies.y_m[row]), slack_m) << region.name;
    const int listed = lists[static_cast<std::uint32_t>(row)];
    ASSERT_LE(listed, 1) << "row " << row;
    if (all_listed) {
      ASSERT_EQ(listed, 1) << "row " << row;
    }
  }
}

/// Steps, and returns how far robot `id` moved in this tick.
double step_and_measure(const MadeWorld& world, const std::string& id) {
  const Pose before = pose_of(world, id);
  world.world->step();
  const Pose after = pose_of(world, id);
  return std::hypot(after.x_m - before.x_m, after.y_m - before.y_m);
}

using Regions = EveryEngine;

/// Two rooms of 1.5 m x 2 m and the corridor between them, 1 m long and 40 cm wide; walls all around.
Scene rooms(const std::string& west, const std::string& corridor, const std::string& east,
            const std::string& controller = "drive") {
  Scene s(4.0, controller);
  s.scenario.arena_size = {4.0, 2.0, 1.0};
  s.engine(west, "west").side(-2, -1).side(-0.5, -1).side(-0.5, -0.2, "corridor").side(-0.5, 0.2).side(-0.5, 1);
  s.side(-2, 1);
  s.engine(corridor, "corridor").side(-0.5, -0.2).side(0.5, -0.2, "east").side(0.5, 0.2).side(-0.5, 0.2, "west");
  s.engine(east, "east").side(0.5, -1).side(2, -1).side(2, 1).side(0.5, 1).side(0.5, 0.2, "corridor").side(0.5, -0.2);
  return s;
}

/// Drives through both gates; speed, heading and the controller's memory must come through.
void expect_smooth_passage(Scene s, double bend_m_s) {
  s.robot("a", -1, 0).wheels(kSpeed_m_s, kSpeed_m_s + bend_m_s);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  const RobotId id = world->space().find_robot("a");
  steps(world, 10);
  EXPECT_EQ(region_of(world, "a"), "west");
  double last_rad = pose_of(world, "a").heading_rad();
  std::vector<std::string> seen;
  for (int i = 0; i < 190; ++i) {
    const double way_m = step_and_measure(world, "a");
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    const Pose pose = pose_of(world, "a");
    EXPECT_NEAR(way_m, 0.1 * (kSpeed_m_s + 0.5 * bend_m_s), 0.02 * 0.1 * kSpeed_m_s)
        << "at x " << pose.x_m << " in " << region_of(world, "a");
    EXPECT_NEAR(turned_rad(last_rad, pose.heading_rad()), 0.1 * bend_m_s / kWheelBase_m, 1e-3) << "at x " << pose.x_m;
    last_rad = pose.heading_rad();
    const std::string region = region_of(world, "a");
    if (seen.empty() || seen.back() != region) seen.push_back(region);
    expect_one_region_each(world);
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"west", "corridor", "east"}));
  EXPECT_EQ(world->space().find_robot("a"), id);
  EXPECT_EQ(world->space().robot_count(), 1U);
  const auto* said = world->space().port<hal::RangeAndBearingSend>(id);
  ASSERT_NE(said, nullptr);
  EXPECT_EQ(said->payload[0], 200) << "the controller has not stepped once a tick";
}

TEST_P(Regions, ARobotPassesGatesWithItsSpeedHeadingAndMemory) {
  const std::string kind = GetParam();
  expect_smooth_passage(rooms(kind, kind, kind, "counting_drive"), 0.0);
  expect_smooth_passage(rooms(kind, kind, kind, "counting_drive"), 1e-4);
}

TEST_P(Regions, AWallSideHoldsRobots) {
  const std::string kind = GetParam();
  Scene s = rooms(kind, kind, kind);
  s.robot("side", -1, 0.6).wheels(0.1288, 0.1288);                  // against the wall beside the gate
  s.robot("back", 1.5, -0.5, 0.2).wheels(0.1, 0.1);                 // against the outer wall
  s.robot("aisle", 0, 0, 0.5 * std::numbers::pi).wheels(0.1, 0.1);  // against the corridor's side
  s.robot("corner", 1.5, 0.5, 0.25 * std::numbers::pi).wheels(0.1288, 0.1288);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  double side_m = -2, back_m = -2, aisle_m = -2, corner_m = -2;
  for (int i = 0; i < 200; ++i) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    if (i < 100) continue;
    side_m = std::max(side_m, pose_of(world, "side").x_m);
    back_m = std::max(back_m, pose_of(world, "back").x_m);
    aisle_m = std::max(aisle_m, pose_of(world, "aisle").y_m);
    corner_m = std::max({corner_m, pose_of(world, "corner").x_m - 1.0, pose_of(world, "corner").y_m});
    expect_one_region_each(world);
  }
  EXPECT_NEAR(side_m, -0.5 - kRobotRadius_m, depth_m());
  EXPECT_NEAR(back_m, 2.0 - kRobotRadius_m, depth_m());
  EXPECT_NEAR(aisle_m, 0.2 - kRobotRadius_m, depth_m());
  EXPECT_NEAR(corner_m, 1.0 - kRobotRadius_m, depth_m());
  EXPECT_EQ(world->incidents().bodies_escaped, 0U);
}

TEST_P(Regions, AWallsEndStopsARobotThatAimsBesideTheGate) {
  // The gate is open for y in [-0.2, 0.2]; this robot's rim catches on its upper end.
  const std::string kind = GetParam();
  auto world = make(rooms(kind, kind, kind).robot("a", -0.8, 0.19).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 150; ++i) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    const Pose pose = pose_of(world, "a");
    if (i < 60) continue;
    // Deeper than its slack in the corner (-0.5, 0.2) of the two walls it never is, whichever way it slides.
    ASSERT_GT(std::hypot(pose.x_m + 0.5, pose.y_m - 0.2), kRobotRadius_m - 2 * depth_m()) << i;
    if (pose.x_m > -0.5) {
      ASSERT_LT(pose.y_m, 0.2 - kRobotRadius_m + 2 * depth_m()) << i;
    }
  }
}

TEST_P(Regions, ARobotInNoRegionIsALoadErrorWithItsLine) {
  const std::string kind = GetParam();
  Scene s = rooms(kind, kind, kind);
  s.robot("lost", 0, 0.6);
  s.scenario.robots.back().line = 42;
  auto world = make(s);
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("scene:42: error: robot 'lost' at (0, 0.6)"), std::string::npos)
      << world.all_problems();
}

TEST_P(Regions, ARobotThatFitsNowhereIsALoadErrorWithItsLine) {
  Scene s(4.0);
  s.engine(GetParam(), "cell");
  for (const auto& [x, y] : {std::pair{-0.03, -0.03}, {0.03, -0.03}, {0.03, 0.03}, {-0.03, 0.03}}) s.side(x, y);
  s.robot("stuck", 0, 0);
  s.scenario.robots.back().line = 42;
  auto world = make(s);
  EXPECT_EQ(world.world, nullptr);
  EXPECT_NE(world.all_problems().find("scene:42: error: robot 'stuck' at (0, 0) does not fit into the region 'cell'"),
            std::string::npos)
      << world.all_problems();
}

TEST_P(Regions, RegionsThatOverlapAreALoadErrorThatNamesBothAndThePlace) {
  const auto problems_of = [&](const std::vector<std::pair<double, double>>& outline) {
    Scene s;
    s.engine(GetParam(), "one").side(-2, -2).side(0, -2).side(0, 2).side(-2, 2);
    s.engine(GetParam(), "two");
    for (const auto& [x_m, y_m] : outline) s.side(x_m, y_m);
    auto world = make(s.robot("a", -1.9, 1.9));
    EXPECT_EQ(world.world == nullptr, !world.problems.empty());
    return world.all_problems();
  };
  const std::vector<std::vector<std::pair<double, double>>> bad = {
      {{-0.1, -2}, {2, -2}, {2, 2}, {-0.1, 2}},                // shifted along common lines
      {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},                    // corners within
      {{-1.5, -1}, {-0.5, -1}, {-0.5, 1}, {-1.5, 1}},          // wholly within
      {{-3, -3}, {1, -3}, {1, 3}, {-3, 3}},                    // wholly around
      {{-3, -0.1}, {3, -0.1}, {3, 0.1}, {-3, 0.1}},            // across, no corner in the other
      {{-2, -2}, {0, -2}, {0, 2}, {-2, 2}},                    // the same
      {{-2, 2}, {0, 2}, {0, -2}, {-2, -2}},                    // the same, the other way round
      {{0, -2}, {1, 0}, {0, 2}, {-2, 0}},                      // corners on the other's sides
      {{0.5, -3}, {0.5, 3}, {0, 2.5}, {-0.2, 0}, {0, -2.5}}};  // only a tip within
  for (const auto& outline : bad) {
    const std::string text = problems_of(outline);
    EXPECT_NE(text.find("scene:101: error:"), std::string::npos)
        << text << outline[0].first << "," << outline[0].second;
    EXPECT_NE(text.find("'two' overlaps that of engine 'one' (line 100)"), std::string::npos) << text;
  }
  const std::vector<std::vector<std::pair<double, double>>> good = {{{0, -2}, {2, -2}, {2, 2}, {0, 2}},
                                                                    {{0, -0.5}, {1, -0.5}, {1, 0.5}, {0, 0.5}},
                                                                    {{0, -3}, {1, -3}, {1, 3}, {0, 3}},
                                                                    {{0, 2}, {2, 2}, {2, 3}, {0, 3}},
                                                                    {{0.3, -1}, {2, -1}, {2, 1}, {0, 0.2}}};
  for (const auto& outline : good) EXPECT_EQ(problems_of(outline), "") << outline[0].first << "," << outline[0].second;
}

/// Four quarters of an arena of 4 m, open to one another.
Scene quarters(const std::string& kind) {
  Scene s(4.0);
  s.engine(kind, "sw").side(-2, -2).side(0, -2, "se").side(0, 0, "nw").side(-2, 0);
  s.engine(kind, "se").side(0, -2).side(2, -2).side(2, 0, "ne").side(0, 0, "sw");
  s.engine(kind, "ne").side(0, 0, "se").side(2, 0).side(2, 2).side(0, 2, "nw");
  s.engine(kind, "nw").side(-2, 0, "sw").side(0, 0, "ne").side(0, 2).side(-2, 2);
  return s;
}

TEST_P(Regions, RobotsPassWhereFourRegionsMeetAndAlongBorders) {
  Scene s = quarters(GetParam());
  const double pi = std::numbers::pi;
  s.robot("diagonal", -1, -1, 0.25 * pi).wheels(0.1, 0.1);
  s.robot("along_x", -1.9, 0, 0).wheels(0.1, 0.1);  // exactly on the border
  s.robot("along_y", 0, 1.9, -0.5 * pi).wheels(0.09, 0.09);
  s.robot("spin", 0, 1.0, 0).wheels(-0.05, 0.05);
  s.robot("weave", 0.01, -1.5, 0.5 * pi).wheels(0.04, 0.1);  // in circles over the border
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 120; ++i) {
    const double way_m = step_and_measure(world, "diagonal");
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    expect_one_region_each(world);
    if (i > 5 && i < 100) {
      EXPECT_NEAR(way_m, 0.01, 0.02 * 0.01) << i;
    }
  }
  EXPECT_EQ(world->incidents().bodies_escaped, 0U);
}

TEST_P(Regions, ATJunctionLetsRobotsThrough) {
  Scene s(4.0);
  s.engine(GetParam(), "west").side(-2, -2).side(0, -2, "south").side(0, 0, "north").side(0, 2).side(-2, 2);
  s.engine(GetParam(), "south").side(0, -2).side(2, -2).side(2, 0, "north").side(0, 0, "west");
  s.engine(GetParam(), "north").side(0, 0, "south").side(2, 0).side(2, 2).side(0, 2, "west");
  for (int i = 0; i < 9; ++i) s.robot("r" + std::to_string(i), -0.6, 0.08 * (i - 4)).wheels(0.1, 0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 121; ++i) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    expect_one_region_each(world);
  }
  for (int i = 0; i < 9; ++i) {
    const Pose pose = pose_of(world, "r" + std::to_string(i));
    EXPECT_NEAR(pose.x_m, 0.6, 0.02 * 1.2) << i;
    EXPECT_NEAR(pose.y_m, 0.08 * (i - 4), 1e-3) << i;
    EXPECT_EQ(region_of(world, "r" + std::to_string(i)), pose.y_m < 0.0 ? "south" : "north") << pose.y_m;
  }
}

TEST_P(Regions, AnOutlineMayBeConcaveAndGivenEitherWayRound) {
  for (const bool clockwise : {false, true}) {
    Scene s(4.0);
    // An L, and the square that completes it. A side belongs to the vertex that it starts from.
    if (clockwise) {
      s.engine(GetParam(), "ell")
          .side(-2, -2)
          .side(-2, 2)
          .side(0, 2, "square")
          .side(0, 0, "square")
          .side(2, 0)
          .side(2, -2);
      s.engine(GetParam(), "square").side(0, 0, "ell").side(0, 2).side(2, 2).side(2, 0, "ell");
    } else {
      s.engine(GetParam(), "ell")
          .side(-2, -2)
          .side(2, -2)
          .side(2, 0, "square")
          .side(0, 0, "square")
          .side(0, 2)
          .side(-2, 2);
      s.engine(GetParam(), "square").side(0, 0, "ell").side(2, 0).side(2, 2).side(0, 2, "ell");
    }
    s.robot("a", -0.4, 1.0, -0.2).wheels(0.1, 0.1).robot("b", 1.0, -0.4, 1.8).wheels(0.1, 0.1);
    s.robot("c", 0.1, 0.15, -2.1).wheels(0.1, 0.1).robot("wall", 0.5, 1.7, 0.5 * std::numbers::pi).wheels(0.1, 0.1);
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    for (int i = 0; i < 61; ++i) {
      world->step();
      ASSERT_EQ(world->state(), RunState::Running) << world->failure();
      expect_one_region_each(world);
    }
    EXPECT_NEAR(pose_of(world, "a").x_m, -0.4 + 0.6 * std::cos(0.2), 0.02);
    EXPECT_EQ(region_of(world, "a"), "square");
    EXPECT_NEAR(pose_of(world, "b").y_m, -0.4 + 0.6 * std::sin(1.8), 0.02);
    EXPECT_EQ(region_of(world, "b"), "square");
    EXPECT_EQ(region_of(world, "c"), "ell");
    EXPECT_NEAR(pose_of(world, "wall").y_m, 2.0 - kRobotRadius_m, depth_m());
  }
}

TEST_P(Regions, InAFileWithoutGatesSidesAreOpenWhereAnotherRegionLiesBehind) {
  // ARGoS 3 files name no gates for borders that engines share.
  Scene s(4.0);
  s.engine(GetParam(), "west").side(-2, -1).side(0, -1).side(0, 1).side(-2, 1);
  s.engine(GetParam(), "east").side(0, -1).side(2, -1).side(2, 1).side(0, 1);
  s.robot("through", -0.3, 0).wheels(0.1, 0.1).robot("up", -1, 0.5, 0.5 * std::numbers::pi).wheels(0.1, 0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 81);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_NEAR(pose_of(world, "through").x_m, 0.5, 0.02);
  EXPECT_EQ(region_of(world, "through"), "east");
  EXPECT_NEAR(pose_of(world, "up").y_m, 1.0 - kRobotRadius_m, depth_m());
}

/// A region whose gate leads to an engine that is not behind it.
Scene trap_door(const std::string& kind) {
  Scene s(6.0);
  s.engine(kind, "here").side(-1, -1).side(1, -1, "there").side(1, 1).side(-1, 1);
  s.engine(kind, "there").side(2, -1).side(3, -1).side(3, 1).side(2, 1);
  return s.robot("lost", 0.8, 0).wheels(0.1, 0.1).robot("other", -0.5, 0).wheels(0, 0);
}

TEST_P(Regions, ABodyThatLeavesAllRegionsIsTreatedAsOneThatLeavesTheArena) {
  {
    auto world = make(trap_door(GetParam()));
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 40);
    EXPECT_EQ(world->state(), RunState::Failed);
    EXPECT_NE(world->failure().find("'lost' left the region of engine 'here'"), std::string::npos) << world->failure();
  }
  {
    Scene s = trap_door(GetParam());
    s.scenario.escape = EscapePolicy::Stop;
    auto world = make(s);
    steps(world, 40);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    EXPECT_NEAR(pose_of(world, "lost").x_m, 1.0, 1e-3);
    EXPECT_EQ(region_of(world, "lost"), "here");
    EXPECT_GT(world->incidents().bodies_escaped, 0U);
    expect_one_region_each(world);
  }
  {
    Scene s = trap_door(GetParam());
    s.scenario.escape = EscapePolicy::Remove;
    auto world = make(s);
    steps(world, 40);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    EXPECT_EQ(world->incidents().bodies_escaped, 1U);
    EXPECT_FALSE(world->space().find_robot("lost").valid());
    EXPECT_EQ(world->space().robot_count(), 1U);
    expect_one_region_each(world);
  }
}

TEST_P(Regions, AHookMayPutARobotIntoAnotherRegionButNotNowhere) {
  const std::string kind = GetParam();
  auto world = make(rooms(kind, kind, kind).robot("a", -1, 0).wheels(0.1, 0.1));
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 10);
  Space& space = world->space();
  space.set_pose(space.find_robot("a"), {1.0, 0.5, 0.0, 0.0, 1.0});
  world->step();
  EXPECT_EQ(region_of(world, "a"), "east");
  expect_one_region_each(world);
  steps(world, 19);
  EXPECT_NEAR(pose_of(world, "a").x_m, 1.0, 0.01);
  EXPECT_NEAR(pose_of(world, "a").y_m, 0.7, 0.01);
  space.set_pose(space.find_robot("a"), {0.0, 0.7, 0.0, 0.0, 1.0});  // beside the corridor
  world->step();
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_NE(world->failure().find("'a' was put where no engine has its region"), std::string::npos) << world->failure();
}

TEST_P(Regions, ARobotThatIsRemovedAtABorderIsGoneOnBothSides) {
  Scene s = scene(4.0);
  s.split("2x1").robot("a", -0.3, 0).wheels(0.1, 0.1).robot("b", 0.01, 0).wheels(0, 0);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 15);
  world->space().remove_robot(world->space().find_robot("b"));
  steps(world, 46);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_NEAR(pose_of(world, "a").x_m, 0.3, 0.02);
  expect_one_region_each(world);
}

TEST_P(Regions, RealRobotsAreInTheWayOnBothSidesOfABorder) {
  Scene s = scene(4.0);
  s.split("2x1").robot("w", -0.3, 0).wheels(0.1, 0.1).robot("e", 0.3, 0.0, std::numbers::pi).wheels(0.1, 0.1);
  auto world = make(s.robot("real", 0.0, 0.0));
  ASSERT_TRUE(world.world) << world.all_problems();
  Space& space = world->space();
  const RobotId real = space.find_robot("real");
  space.set_external(real, true);
  for (int i = 0; i < 60; ++i) {
    const double x_m = 0.02 * std::sin(0.2 * i);  // to and fro over the border
    space.set_pose(real, {x_m, 0.0, 0.0, 1.0, 0.0});
    world->step();
    ASSERT_EQ(space.pose(real).x_m, x_m);
    for (const char* id : {"w", "e"})
      ASSERT_LE(overlap_m(pose_of(world, id), space.pose(real)), 0.004 + 2 * depth_m()) << i;
    expect_one_region_each(world);
  }
}

// --- splits of one arena ---

TEST_P(Regions, ALoneRobotDrivesAcrossAllBordersAsIfThereWereNone) {
  const double pi = std::numbers::pi;
  for (const double heading_rad : {0.0, 0.3, 0.25 * pi, 0.5 * pi, -2.0}) {
    for (const double bend_m_s : {0.0, 0.002}) {
      const auto start = [&](const std::string& split) {
        Scene s = scene(2.0);
        if (!split.empty()) s.split(split);
        const double x_m = -0.85 * std::cos(heading_rad);
        const double y_m = -0.85 * std::sin(heading_rad);
        return make(s.robot("a", x_m, y_m, heading_rad).wheels(kSpeed_m_s, kSpeed_m_s + bend_m_s));
      };
      auto whole = start("1x1");
      auto parts = start("4x4");
      ASSERT_TRUE(whole.world && parts.world) << parts.all_problems();
      double largest_m = 0.0;
      std::map<std::string, int> visited;
      for (int i = 0; i < 170; ++i) {
        whole->step();
        parts->step();
        const Pose a = pose_of(whole, "a");
        const Pose b = pose_of(parts, "a");
        largest_m = std::max(largest_m, std::hypot(a.x_m - b.x_m, a.y_m - b.y_m));
        largest_m = std::max(largest_m, std::fabs(turned_rad(a.heading_rad(), b.heading_rad())));
        expect_one_region_each(parts);
        ASSERT_EQ(parts->state(), RunState::Running) << parts->failure();
        ++visited[region_of(parts, "a")];
      }
      EXPECT_LE(largest_m, GetParam() == "kinematics2d" ? 0.0 : 1e-9) << heading_rad << " " << bend_m_s;
      if (GetParam() != "kinematics2d") {
        EXPECT_GE(visited.size(), 4U) << heading_rad;  // kinematics2d works on all parts as one
      }
    }
  }
}

TEST_P(Regions, AutoSplitsNothingThatIsSmall) {
  auto world = make(scene(3.0).split("auto").robots(50, 1.3));
  ASSERT_TRUE(world.world) << world.all_problems();
  EXPECT_EQ(world->space().stores().regions.size(), 1U);
  steps(world, 5);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

/// How two robots met: the deepest overlap at any time, and at the end.
struct Meeting {
  double deepest_m = -1.0;
  double last_m = -1.0;
  double fastest_m_s = 0.0;
};

Meeting meet(const Scene& s, int ticks) {
  Meeting meeting;
  auto world = make(s);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (!world.world) return meeting;
  for (int i = 0; i < ticks; ++i) {
    meeting.fastest_m_s = std::max(meeting.fastest_m_s, 10.0 * step_and_measure(world, "a"));
    meeting.last_m = overlap_m(pose_of(world, "a"), pose_of(world, "b"));
    meeting.deepest_m = std::max(meeting.deepest_m, meeting.last_m);
    expect_one_region_each(world);
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  return meeting;
}

TEST_P(Regions, RobotsThatMeetAcrossABorderOverlapNoMoreThanWithinOneRegion) {
  const double pi = std::numbers::pi;
  constexpr double kMore_m = 1e-4;
  struct Way {
    double angle_rad, offset_m;  // of the way of one robot against the x axis; of its way from the other's
  };
  // The arena is split in 2 x 2: borders along both axes. Meeting points: on one border, where four regions
  // meet, and a little beside.
  for (const auto& at : {std::pair{0.0, 0.5}, {0.0, 0.0}, {0.5, 0.0}, {0.01, -0.4}, {-0.02, 0.03}}) {
    const double px = at.first, py = at.second;
    for (const Way& way : {Way{0.0, 0.0}, Way{0.5 * pi, 0.0}, Way{0.3, 0.02}, Way{0.25 * pi, 0.0}, Way{-1.2, -0.03}}) {
      for (const double speed_m_s : {0.03, 0.1288}) {
        const auto start = [&](const char* split) {
          const double c = std::cos(way.angle_rad);
          const double n = std::sin(way.angle_rad);
          Scene s = scene(4.0);
          s.split(split);
          const double from_m = 0.2;
          s.robot("a", px - from_m * c, py - from_m * n, way.angle_rad).wheels(speed_m_s, speed_m_s);
          s.robot("b", px + from_m * c - way.offset_m * n, py + from_m * n + way.offset_m * c, way.angle_rad + pi);
          s.wheels(speed_m_s, speed_m_s);
          return s;
        };
        const Meeting whole = meet(start("1x1"), 80);
        const Meeting parts = meet(start("2x2"), 80);
        const std::string what = "at (" + std::to_string(px) + ", " + std::to_string(py) + "), angle " +
                                 std::to_string(way.angle_rad) + ", offset " + std::to_string(way.offset_m) +
                                 ", speed " + std::to_string(speed_m_s);
        EXPECT_LE(parts.deepest_m, std::max(whole.deepest_m, 0.0) + kMore_m) << what;
        EXPECT_LE(parts.last_m, std::max(whole.last_m, 0.0) + kMore_m) << what;
        EXPECT_LE(parts.fastest_m_s, std::max(whole.fastest_m_s, speed_m_s) * 1.05 + 0.005) << what;
      }
    }
  }
}

TEST_P(Regions, AThingOnABorderHoldsRobotsOfBothSides) {
  Scene s = scene(2.0);
  s.split("2x2").box(0, 0, 0.2, 0.2, 0.3).cylinder(0.0, 0.6, 0.1);
  const double pi = std::numbers::pi;
  s.robot("w", -0.4, 0.0, 0.0).robot("e", 0.4, 0.0, pi).robot("s", 0.0, -0.4, 0.5 * pi);
  s.robot("cw", -0.4, 0.6, 0.0).robot("ce", 0.4, 0.6, pi);
  s.param("left", "0.1").param("right", "0.1");
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 100; ++i) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    if (i < 40) continue;
    for (const char* id : {"cw", "ce"}) {
      const Pose pose = pose_of(world, id);
      ASSERT_GT(std::hypot(pose.x_m, pose.y_m - 0.6), 0.1 + kRobotRadius_m - depth_m()) << id << " in tick " << i;
    }
    for (const char* id : {"w", "e", "s"}) {  // in the frame of the box
      const Pose pose = pose_of(world, id);
      const double u = pose.x_m * std::cos(0.3) + pose.y_m * std::sin(0.3);
      const double v = pose.y_m * std::cos(0.3) - pose.x_m * std::sin(0.3);
      const double dx = std::max(0.0, std::fabs(u) - 0.1);
      const double dy = std::max(0.0, std::fabs(v) - 0.1);
      ASSERT_GT(std::hypot(dx, dy), kRobotRadius_m - depth_m()) << id << " in tick " << i;
    }
  }
}

/// Contacts of a crowd, averaged over time.
struct Contacts {
  double pairs = 0.0;      ///< that touch, mean over ticks
  double overlap_m = 0.0;  ///< mean over pairs and ticks
  double deepest_m = 0.0;  ///< mean over ticks of the deepest pair: the maximum of all would be one event
};

Contacts contacts_of(const std::string& kind, const std::string& split, std::uint64_t seed) {
  Scene s(2.0, "epuck_diffusion", "epuck_diffusion");
  s.engine(kind).split(split).walls().robots(300, 0.86);
  s.scenario.seed = seed;
  auto world = make(s);
  EXPECT_TRUE(world.world) << world.all_problems();
  Contacts contacts;
  if (!world.world) return contacts;
  constexpr int kTicks = 200;
  for (int i = 0; i < kTicks; ++i) {
    world->step();
    const Crowd crowd = crowd_of(world->space(), 1e-3);
    contacts.pairs += static_cast<double>(crowd.pairs) / kTicks;
    contacts.overlap_m += crowd.sum_m / static_cast<double>(std::max<std::size_t>(1, crowd.pairs)) / kTicks;
    contacts.deepest_m += std::max(0.0, crowd.deepest_m) / kTicks;
    if (i % 20 == 0) expect_one_region_each(world);
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  EXPECT_EQ(world->space().robot_count(), 300U);
  return contacts;
}

TEST_P(Regions, ACrowdTouchesAsOftenAndAsDeepAcrossBordersAsWithinOneRegion) {
  Contacts whole;
  Contacts parts;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Contacts w = contacts_of(GetParam(), "1x1", seed);
    const Contacts p = contacts_of(GetParam(), "4x4", seed);
    whole = {whole.pairs + w.pairs, whole.overlap_m + w.overlap_m, whole.deepest_m + w.deepest_m};
    parts = {parts.pairs + p.pairs, parts.overlap_m + p.overlap_m, parts.deepest_m + p.deepest_m};
  }
  RecordProperty("pairs", std::to_string(whole.pairs / 3) + " whole, " + std::to_string(parts.pairs / 3) + " split");
  EXPECT_GT(whole.pairs / 3, 20.0);  // it is a crowd
  EXPECT_NEAR(parts.pairs, whole.pairs, 0.05 * whole.pairs);
  EXPECT_NEAR(parts.overlap_m, whole.overlap_m, 0.25 * whole.overlap_m + 3 * 2e-5);
  // The solver of dynamics3d stops at errors of 1 cm/s: 0.2 mm in a sub-step of 20 ms.
  EXPECT_LE(parts.deepest_m, 1.25 * whole.deepest_m + 3 * (GetParam() == "dynamics3d" ? 2e-4 : 5e-5));
}

INSTANTIATE_TEST_SUITE_P(Physics, Regions, testing::ValuesIn(test::engine_kinds()), name_of_kind);

/// Movable objects, for engines with forces.
using MovableAcrossBorders = EveryEngine;

TEST_P(MovableAcrossBorders, ABoxThatIsPushedOverABorderKeepsMoving) {
  for (const double offset_m : {0.0, 0.5}) {  // in the middle of a side, and where four regions meet
    Scene s = scene(2.0);
    s.split("2x2").box(-0.4, offset_m, 0.1, 0.2, 0.0, 0.06).movable(0.1);
    s.robot("a", -0.5, offset_m).wheels(kSpeed_m_s, kSpeed_m_s);
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    steps(world, 20);
    const SpaceStores& stores = world->space().stores();
    const std::uint16_t before = stores.object_region[0];
    for (int i = 0; i < 70; ++i) {
      const double last_m = stores.objects[0].x_m;
      world->step();
      ASSERT_EQ(world->state(), RunState::Running) << world->failure();
      EXPECT_NEAR(stores.objects[0].x_m - last_m, 0.01, 5e-4) << "box at " << last_m;
      ASSERT_LE(stores.regions[stores.object_region[0]].distance(stores.objects[0].x_m, stores.objects[0].y_m), 1e-9);
    }
    EXPECT_NE(stores.object_region[0], before);
    EXPECT_GT(stores.objects[0].x_m, 0.3);
  }
}

TEST_P(MovableAcrossBorders, AnObjectGlidesOverABorderAsIfThereWereNone) {
  const auto start = [&](const char* split) {
    return make(scene(2.0).split(split).cylinder(-0.1, 0.3, 0.06).movable(0.3).robot("a", -0.8, -0.8).wheels(0, 0));
  };
  auto whole = start("1x1");
  auto parts = start("2x2");
  ASSERT_TRUE(whole.world && parts.world) << parts.all_problems();
  for (const MadeWorld* world : {&whole, &parts}) {
    steps(*world, 5);
    (*world)->space().stores().object_motion[0].v_m_s = {0.9, -0.5, 0.0};
  }
  for (int i = 0; i < 20; ++i) {
    whole->step();
    parts->step();
    EXPECT_NEAR(whole->space().objects()[0].x_m, parts->space().objects()[0].x_m, 1e-6) << i;
    EXPECT_NEAR(whole->space().objects()[0].y_m, parts->space().objects()[0].y_m, 1e-6) << i;
  }
  EXPECT_GT(parts->space().objects()[0].x_m, 0.05);
}

TEST_P(MovableAcrossBorders, RobotsOfBothSidesPushOneBox) {
  // Two robots push a box that lies on the border at y = 0, one from each region; it goes straight on.
  Scene s = scene(2.0);
  s.split("1x2").box(-0.2, 0, 0.1, 0.3, 0.0, 0.06).movable(0.2);
  s.robot("n", -0.3, 0.08).wheels(kSpeed_m_s, kSpeed_m_s).robot("s", -0.3, -0.08).wheels(kSpeed_m_s, kSpeed_m_s);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 71);
  const Object& box = world->space().objects()[0];
  EXPECT_NEAR(box.x_m, -0.3 + 0.7 + kRobotRadius_m + 0.05, 0.02);
  EXPECT_NEAR(box.y_m, 0.0, 0.02);
  EXPECT_NEAR(std::atan2(box.sin_h, box.cos_h), 0.0, 0.1);
  for (const char* id : {"n", "s"}) EXPECT_LE(pose_of(world, id).x_m, box.x_m - 0.05 - kRobotRadius_m + 5e-3) << id;
}

/// An engine with forces in the west, kinematics2d in the east, and a gate each way.
Scene west_of_kinematics(const std::string& kind) {
  Scene s(4.0);
  s.engine(kind, "west").side(-2, -2).side(0, -2, "east").side(0, 2).side(-2, 2);
  s.engine("kinematics2d", "east").side(0, -2).side(2, -2).side(2, 2).side(0, 2, "west");
  return s;
}

TEST_P(MovableAcrossBorders, AnObjectStopsAtAGateBehindWhichNobodyCouldMoveIt) {
  Scene s = west_of_kinematics(GetParam());
  s.box(-0.3, 0, 0.1, 0.2, 0.0, 0.06).movable(0.1).robot("a", -0.45, 0).wheels(kSpeed_m_s, kSpeed_m_s);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 120; ++i) {
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    ASSERT_LE(world->space().objects()[0].x_m, 1e-9) << i;
  }
  EXPECT_GT(world->space().objects()[0].x_m, -0.05);
  EXPECT_EQ(world->incidents().bodies_escaped, 0U);
}

TEST_P(MovableAcrossBorders, AnEngineWithoutForcesTakesAnObjectOnTheBorderAsItStands) {
  Scene s = west_of_kinematics(GetParam());
  s.box(-0.03, 0, 0.1, 0.2, 0.0, 0.5).movable(2.0).robot("a", 0.3, 0, std::numbers::pi).wheels(0.1, 0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 80);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  const double rim_m = pose_of(world, "a").x_m - kRobotRadius_m;
  EXPECT_GE(rim_m, world->space().objects()[0].x_m + 0.05 - depth_m() - 0.01);
  EXPECT_LT(rim_m, 0.05);
}

TEST_P(MovableAcrossBorders, AThingThatFitsNowhereIsALoadErrorWithItsLine) {
  const auto problems_of = [&](double half_region_m, double size_x_m, double size_y_m) {
    Scene s(4.0);
    s.engine(GetParam(), "hall");
    for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
      s.side(half_region_m * x, half_region_m * y);
    s.box(0, 0, size_x_m, size_y_m).movable(1.0);
    s.scenario.objects[0].line = 42;
    return make(s).all_problems();
  };
  EXPECT_EQ(problems_of(2.0, 4.5, 0.5), "");  // a long one may lie askew
  EXPECT_EQ(problems_of(2.0, 3.9, 3.9), "");
  EXPECT_NE(problems_of(2.0, 4.5, 4.1).find("scene:42: error: movable box 'box0' at (0, 0) is larger than the arena"),
            std::string::npos);
  EXPECT_NE(problems_of(0.5, 1.5, 1.1)
                .find("scene:42: error: movable box 'box0' at (0, 0) does not fit into the region 'hall' (1 m x 1 m)"),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Physics, MovableAcrossBorders, testing::ValuesIn(kinds_with_forces()), name_of_kind);

// --- one engine over several regions is the same engine ---

TEST(KinematicRegions, OpenBordersChangeNotASingleBit) {
  const auto hash_of = [](Scene s) {
    s.scenario.controllers[0].label = s.scenario.controllers[0].library = "epuck_diffusion";
    auto world = make(s.walls().robots(200, 1.8));
    EXPECT_TRUE(world.world) << world.all_problems();
    if (!world.world) return std::uint64_t{0};
    run(*world.world, 100);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    return world->state_hash();
  };
  const std::uint64_t whole = hash_of(Scene(4.0));
  EXPECT_EQ(hash_of(Scene(4.0).engine("kinematics2d")), whole);
  EXPECT_EQ(hash_of(Scene(4.0).engine("kinematics2d").split("4x4")), whole);
  EXPECT_EQ(hash_of(Scene(4.0).engine("kinematics2d").split("auto")), whole);
  Scene open(4.0);  // quarters without walls between them; the arena's own edge is out of reach behind its boxes
  open.engine("kinematics2d", "sw").side(-3, -3).side(0, -3, "se").side(0, 0, "nw").side(-3, 0);
  open.engine("kinematics2d", "se").side(0, -3).side(3, -3).side(3, 0, "ne").side(0, 0, "sw");
  open.engine("kinematics2d", "ne").side(0, 0, "se").side(3, 0).side(3, 3).side(0, 3, "nw");
  open.engine("kinematics2d", "nw").side(-3, 0, "sw").side(0, 0, "ne").side(0, 3).side(-3, 3);
  EXPECT_EQ(hash_of(open), whole);
}

// --- engines of several kinds in one experiment ---

using KindPair = std::pair<std::string, std::string>;

/// All pairs of different kinds.
std::vector<KindPair> kind_pairs() {
  std::vector<KindPair> pairs;
  for (const std::string& one : test::engine_kinds()) {
    for (const std::string& other : test::engine_kinds()) {
      if (one != other) pairs.emplace_back(one, other);
    }
  }
  return pairs;
}

class TwoKinds : public testing::TestWithParam<KindPair> {
 protected:
  /// Two halves of an arena, with a gate each way all along x = 0.
  Scene halves(const std::string& controller = "drive") const {
    Scene s(4.0, controller);
    s.engine(GetParam().first, "west").side(-2, -2).side(0, -2, "east").side(0, 2).side(-2, 2);
    s.engine(GetParam().second, "east").side(0, -2).side(2, -2).side(2, 2).side(0, 2, "west");
    return s;
  }
  double depth_m() const { return std::max(depth_bar_m(GetParam().first), depth_bar_m(GetParam().second)); }
};

TEST_P(TwoKinds, ARobotPassesFromOneEngineToTheOtherAndBack) {
  Scene s = halves("counting_drive");
  s.robot("go", -0.5, 0.5).wheels(0.1, 0.1);
  s.robot("come", 0.5, -0.5, std::numbers::pi).wheels(0.1, 0.1);
  s.robot("loop", -0.02, -1.2, 0.3).wheels(0.06, 0.1);  // a circle of 10.6 cm radius over the border, several times
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  int changes = 0;
  std::string last = region_of(world, "loop");
  steps(world, 5);
  for (int i = 0; i < 250; ++i) {
    const Pose go = pose_of(world, "go");
    const Pose loop = pose_of(world, "loop");
    const double way_m = step_and_measure(world, "come");
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    expect_one_region_each(world);
    if (i < 100) {
      EXPECT_NEAR(way_m, 0.01, 0.02 * 0.01) << i;
      EXPECT_NEAR(pose_of(world, "go").x_m - go.x_m, 0.01, 0.02 * 0.01) << i;
    }
    const Pose now = pose_of(world, "loop");
    EXPECT_NEAR(turned_rad(loop.heading_rad(), now.heading_rad()), 0.1 * 0.04 / kWheelBase_m, 0.02 * 0.075) << i;
    if (region_of(world, "loop") != last) ++changes;
    last = region_of(world, "loop");
    if (i == 120) {  // both stop well inside the other half
      EXPECT_EQ(region_of(world, "go"), "east");
      EXPECT_EQ(region_of(world, "come"), "west");
      set_halted(world, "go");
      set_halted(world, "come");
    }
  }
  EXPECT_GE(changes, 4);
  const auto* said = world->space().port<hal::RangeAndBearingSend>(world->space().find_robot("loop"));
  ASSERT_NE(said, nullptr);
  EXPECT_EQ(said->payload[0], 255);
  EXPECT_EQ(world->space().robot_count(), 3U);
}

TEST_P(TwoKinds, RobotsOfBothEnginesCollideAtTheBorder) {
  for (const double y_m : {0.0, 0.3}) {
    Scene s = halves();
    s.robot("a", -0.3, y_m).wheels(0.1, 0.1).robot("b", 0.3, y_m, std::numbers::pi).wheels(0.1, 0.1);
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    for (int i = 0; i < 120; ++i) {
      world->step();
      ASSERT_EQ(world->state(), RunState::Running) << world->failure();
      // Each takes the other for something that does not give way: a tick's way of each at most.
      ASSERT_LE(overlap_m(pose_of(world, "a"), pose_of(world, "b")), 0.02 + depth_m()) << i;
    }
    EXPECT_LE(overlap_m(pose_of(world, "a"), pose_of(world, "b")), 0.01 + depth_m());
    EXPECT_GT(pose_of(world, "b").x_m, pose_of(world, "a").x_m);  // neither passed through the other
  }
}

TEST_P(TwoKinds, RobotsSeeAndHearThoseOfTheOtherEngine) {
  Scene s = halves("everything");
  s.robot("a", -0.05, 0).wheels(0, 0).robot("b", 0.05, 0, std::numbers::pi).wheels(0, 0);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 5);
  ASSERT_EQ(region_of(world, "a"), "west");
  ASSERT_EQ(region_of(world, "b"), "east");
  const Space& space = world->space();
  for (const char* id : {"a", "b"}) {
    const auto* proximity = space.port<hal::Proximity>(space.find_robot(id));
    ASSERT_NE(proximity, nullptr);
    // The two front sensors look 17 degrees aside, from the rim to the other's rim.
    const double aside_rad = 17.0 * std::numbers::pi / 180.0;
    const double half_chord_m = std::sqrt(kRobotRadius_m * kRobotRadius_m - std::pow(0.1 * std::sin(aside_rad), 2));
    const double seen_m = 0.1 * std::cos(aside_rad) - half_chord_m - kRobotRadius_m;
    for (const std::size_t front : {0U, 7U}) EXPECT_NEAR(proximity->distance_m[front], seen_m, 2e-3) << id;
    EXPECT_EQ(proximity->distance_m[3], proximity->range_m) << id;
    const auto* heard = space.port<hal::RangeAndBearing>(space.find_robot(id));
    ASSERT_NE(heard, nullptr);
    ASSERT_EQ(heard->count, 1U) << id;
    EXPECT_NEAR(heard->range_m[0], 0.1, 2e-3) << id;
    EXPECT_NEAR(heard->bearing_rad[0], 0.0, 0.02) << id;
  }
}

TEST_P(TwoKinds, TheSameBitsForAnyNumberOfThreads) {
  const auto hash_of = [&](std::int64_t threads, Assignment assignment) {
    Scene s = halves();
    s.scenario.controllers[0].label = s.scenario.controllers[0].library = "epuck_diffusion";
    WorldOptions options;
    options.threads = threads;
    options.assignment = assignment;
    auto world = make(s.robots(150, 1.2), options);
    EXPECT_TRUE(world.world) << world.all_problems();
    if (!world.world) return std::uint64_t{0};
    run(*world.world, 60);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    return world->state_hash();
  };
  const std::uint64_t alone = hash_of(1, Assignment::Static);
  for (const std::int64_t threads : {2, 3, 8}) {
    EXPECT_EQ(hash_of(threads, Assignment::Static), alone) << threads;
    EXPECT_EQ(hash_of(threads, Assignment::Dynamic), alone) << threads;
  }
}

std::string name_of_pair(const testing::TestParamInfo<KindPair>& info) {
  return info.param.first + "_" + info.param.second;
}
INSTANTIATE_TEST_SUITE_P(Physics, TwoKinds, testing::ValuesIn(kind_pairs()), name_of_pair);

using TwoKindsWithForces = TwoKinds;

TEST_P(TwoKindsWithForces, AThingThatIsPushedPassesFromOneEngineToTheOther) {
  Scene s = halves();
  s.box(-0.3, 0.2, 0.1, 0.2, 0.0, 0.06).movable(0.1).robot("a", -0.45, 0.2).wheels(0.1, 0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  steps(world, 20);
  for (int i = 0; i < 60; ++i) {
    const double last_m = world->space().objects()[0].x_m;
    world->step();
    ASSERT_EQ(world->state(), RunState::Running) << world->failure();
    EXPECT_NEAR(world->space().objects()[0].x_m - last_m, 0.01, 2e-3) << "box at " << last_m;
  }
  EXPECT_GT(world->space().objects()[0].x_m, 0.2);
}

/// All pairs of kinds with forces, those of one kind among them.
std::vector<KindPair> pairs_with_forces() {
  std::vector<KindPair> pairs;
  for (const std::string& one : kinds_with_forces()) {
    for (const std::string& other : kinds_with_forces()) pairs.emplace_back(one, other);
  }
  return pairs;
}
INSTANTIATE_TEST_SUITE_P(Physics, TwoKindsWithForces, testing::ValuesIn(pairs_with_forces()), name_of_pair);

}  // namespace
}  // namespace tandem::core
