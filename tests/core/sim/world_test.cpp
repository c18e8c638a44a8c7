#include <cmath>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sstream>

#include "core/device/proximity.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

TEST(World, ReachesTheCommandedSpeedExactly) {
  auto world = make(Scene().param("left", "0.05").param("right", "0.05").robot("a", 0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 101);  // the first command acts from the second tick
  const Pose pose = world->space().pose(world->space().robot(0));
  EXPECT_NEAR(pose.x_m, 0.5, 1e-12);
  EXPECT_EQ(pose.y_m, 0.0);
}

TEST(World, DrivesTheCircleThatTheWheelsAsk) {
  // Radius of the arc: base / 2 * (r + l) / (r - l) [Siegwart 2011, ch. 3].
  auto world = make(Scene().param("left", "0.02").param("right", "0.06").robot("a", 0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  const double radius = 0.5 * hal::epuck::kind().drive()->wheel_base_m * 0.08 / 0.04;
  const double turn_rad_s = 0.04 / hal::epuck::kind().drive()->wheel_base_m;
  world->start();
  world->step();
  for (int tick = 1; tick <= 300; ++tick) {
    world->step();
    const Pose pose = world->space().pose(world->space().robot(0));
    const double angle = turn_rad_s * 0.1 * tick;
    ASSERT_NEAR(pose.x_m, radius * std::sin(angle), 1e-10);
    ASSERT_NEAR(pose.y_m, radius * (1 - std::cos(angle)), 1e-10);
    ASSERT_NEAR(std::hypot(pose.cos_h, pose.sin_h), 1.0, 1e-12);
  }
}

TEST(World, ExactAlsoWithCoarseTicks) {
  Scene scene(20.0);
  scene.scenario.ticks_per_second = 1;
  auto world = make(scene.param("left", "-0.1").param("right", "0.1").robot("a", 0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 4);
  const Pose pose = world->space().pose(world->space().robot(0));
  const double angle = 3.0 * 0.2 / hal::epuck::kind().drive()->wheel_base_m;
  EXPECT_NEAR(pose.cos_h, std::cos(angle), 1e-9);
  EXPECT_NEAR(pose.sin_h, std::sin(angle), 1e-9);
}

TEST(World, AWallStopsARobot) {
  auto world = make(Scene().param("left", "0.12").param("right", "0.12").box(1.0, 0, 0.2, 2.0).robot("a", 0, 0.1, 0.2));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  double farthest = 0.0;
  for (int i = 0; i < 200; ++i) {
    world->step();
    farthest = std::max(farthest, world->space().pose(world->space().robot(0)).x_m);
  }
  EXPECT_LE(farthest, 0.9 - hal::epuck::kind().body.radius_m + 1e-12);
  EXPECT_GT(farthest, 0.86);
}

/// Ticks in which a robot rolls farther than a wall is thick, and farther than two robots are wide.
TEST(World, NothingIsJumpedOverInLongTicks) {
  for (const std::int64_t rate : {1, 2, 3}) {
    Scene s;
    s.param("left", "0.128").param("right", "0.128");
    s.scenario.ticks_per_second = rate;
    s.box(0.5, 0, 0.005, 3.0).robot("walled", 0.0, 1.0).robot("a", -0.5, 0.0).robot("b", 0.3, 0.0, M_PI);
    auto world = make(s);
    ASSERT_TRUE(world.world) << world.all_problems();
    const Space& space = world->space();
    world->start();
    for (std::int64_t i = 0; i < 30 * rate; ++i) {
      world->step();
      ASSERT_LT(space.pose(space.find_robot("walled")).x_m, 0.5 - 0.03);
      if (i < 6 * rate) {  // later they roll round one another
        ASSERT_LT(space.pose(space.find_robot("a")).x_m, space.pose(space.find_robot("b")).x_m);
      }
    }
    EXPECT_NEAR(space.pose(space.find_robot("walled")).x_m, 0.4975 - 0.035, 2e-3);
  }
}

TEST(World, RobotsThatMeetHeadOnStopEachOther) {
  auto world = make(Scene().param("left", "0.1").param("right", "0.1").robot("a", -0.3, 0, 0).robot("b", 0.3, 0, M_PI));
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 100);
  const Pose a = world->space().pose(world->space().robot(0));
  const Pose b = world->space().pose(world->space().robot(1));
  EXPECT_NEAR(b.x_m - a.x_m, 2 * hal::epuck::kind().body.radius_m, 1e-9);
  EXPECT_NEAR(a.x_m, -b.x_m, 1e-9);  // neither wins
}

TEST(World, ACrowdIsPushedApartAndStaysInsideItsWalls) {
  auto world = make(Scene(1.6, "epuck_diffusion", "epuck_diffusion").walls().robots(120, 0.6));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 300; ++i) world->step();
  ASSERT_EQ(world->state(), RunState::Running) << world->failure();
  const Space& space = world->space();
  double deepest = 0.0;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const Pose a = space.pose(space.robot(i));
    EXPECT_LE(std::fabs(a.x_m), 0.7 - hal::epuck::kind().body.radius_m + 1e-9);
    for (std::size_t j = 0; j < i; ++j) {
      const Pose b = space.pose(space.robot(j));
      deepest = std::max(deepest, 2 * hal::epuck::kind().body.radius_m - std::hypot(a.x_m - b.x_m, a.y_m - b.y_m));
    }
  }
  EXPECT_LT(deepest, 0.005);
}

std::uint64_t hash_of(const Scene& scene, std::int64_t threads, Assignment assignment, int steps = 15) {
  WorldOptions options;
  options.threads = threads;
  options.assignment = assignment;
  auto world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  run(*world.world, steps);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  return world->state_hash();
}

TEST(World, GivesTheSameBitsForAnyNumberOfThreadsAndEitherAssignment) {
  Scene scene(12.0, "everything");
  scene.implementations("noisy").param("left", "0.04").param("right", "0.05").walls().robots(5000, 5.8);
  const std::uint64_t alone = hash_of(scene, 1, Assignment::Static);
  for (const std::int64_t threads : {0, 2, 3, 8}) {
    EXPECT_EQ(hash_of(scene, threads, Assignment::Static), alone) << threads << " threads, static";
    EXPECT_EQ(hash_of(scene, threads, Assignment::Dynamic), alone) << threads << " threads, dynamic";
  }
}

TEST(World, VectorCodeGivesTheBitsOfTheBaseline) {
  if (!has_avx2()) GTEST_SKIP() << "this processor has no AVX2";
  Scene scene(6.0, "epuck_diffusion", "epuck_diffusion");
  scene.walls().cylinder(1, 1, 0.2).box(-1, 1, 0.3, 0.2, 0.5).robots(1000, 2.8);
  use_vector_code(VectorCode::Baseline);
  const std::uint64_t baseline = hash_of(scene, 1, Assignment::Static);
  use_vector_code(VectorCode::Avx2);
  EXPECT_EQ(hash_of(scene, 1, Assignment::Static), baseline);
}

TEST(World, AnotherSeedGivesAnotherRun) {
  Scene scene(6.0, "epuck_diffusion", "epuck_diffusion");
  scene.walls().robots(100, 2.8);
  const std::uint64_t first = hash_of(scene, 1, Assignment::Static);
  scene.scenario.seed = 8;
  EXPECT_NE(hash_of(scene, 1, Assignment::Static), first);
}

TEST(World, AThrowingControllerStopsItsRobotByNameAndNoOther) {
  Scene scene(4.0, "thrower");
  scene.robot("bad", 0, 0).robot("good", 0, 1);
  scene.scenario.controllers.push_back(scene.scenario.controllers[0]);
  scene.scenario.controllers[1].id = "d";
  scene.scenario.controllers[1].label = "drive";
  scene.param("left", "0.05").param("right", "0.05");
  scene.scenario.robots[1].controller = 1;
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 50);
  EXPECT_EQ(world->state(), RunState::Running);
  const Space& space = world->space();
  EXPECT_TRUE(space.halted(space.find_robot("bad")));
  EXPECT_FALSE(space.halted(space.find_robot("good")));
  EXPECT_NEAR(space.pose(space.find_robot("bad")).x_m, 0.015, 1e-12);  // three ticks of 5 mm, then stopped
  EXPECT_GT(space.pose(space.find_robot("good")).x_m, 0.2);
  ASSERT_EQ(world->incidents().first().size(), 1U);
  EXPECT_NE(world->incidents().first()[0].find("'bad' threw at tick 3: lost my way"), std::string::npos)
      << world->incidents().first()[0];
}

TEST(World, CommandsThatAreNoNumbersStopTheWheelsAndAreCounted) {
  auto world = make(Scene(4.0, "careless").robot("a", 0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 11);
  EXPECT_EQ(world->incidents().commands_not_finite, 9U);
  EXPECT_EQ(world->incidents().commands_clamped, 2U);
  const Space& space = world->space();
  const auto* wheels = space.port<hal::WheelSpeeds>(space.robot(0));
  EXPECT_EQ(wheels->left_m_s, 0.0);
  // Two clamped commands: the faster wheel at its limit, the other in proportion.
  const double way = 2 * 0.1 * 0.75 * hal::epuck::kind().drive()->max_speed_m_s;
  const Pose pose = space.pose(space.robot(0));
  EXPECT_NEAR(std::hypot(pose.x_m, pose.y_m), way, 1e-3);
  ASSERT_FALSE(world->incidents().first().empty());
  EXPECT_NE(world->incidents().first()[0].find("'a'"), std::string::npos);
}

TEST(World, ABodyThatLeavesTheArenaFollowsTheFilesPolicy) {
  Scene scene(1.0);
  scene.param("left", "0.1").param("right", "0.1").robot("a", 0.4, 0).robot("b", -0.4, 0.2);
  {
    auto world = make(scene);
    run(*world.world, 40);
    EXPECT_EQ(world->state(), RunState::Failed);
    EXPECT_NE(world->failure().find("'a' left the arena"), std::string::npos) << world->failure();
  }
  scene.scenario.escape = EscapePolicy::Stop;
  {
    auto world = make(scene);
    run(*world.world, 40);
    EXPECT_EQ(world->state(), RunState::Running);
    EXPECT_EQ(world->space().pose(world->space().find_robot("a")).x_m, 0.5);
    EXPECT_GT(world->incidents().bodies_escaped, 0U);
  }
  scene.scenario.escape = EscapePolicy::Remove;
  {
    auto world = make(scene);
    run(*world.world, 40);
    EXPECT_EQ(world->state(), RunState::Running);
    EXPECT_FALSE(world->space().find_robot("a").valid());
    EXPECT_EQ(world->space().robot_count(), 1U);
    EXPECT_EQ(world->incidents().bodies_escaped, 1U);
  }
}

TEST(World, APositionThatIsNoNumberEndsTheRunByName) {
  auto world = make(Scene().robot("a", 0, 0));
  world->start();
  world->step();
  world->space().set_pose(world->space().robot(0), {std::nan(""), 0, 0, 1, 0});
  world->step();
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_NE(world->failure().find("'a'"), std::string::npos);
  EXPECT_NE(world->failure().find("tick 1"), std::string::npos) << world->failure();
}

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

HookConfig diary(const std::string& path, std::vector<Element::Attribute> more = {}) {
  HookConfig hook;
  hook.library = "test_hooks";
  hook.label = "diary";
  hook.options.name = "loop_functions";
  hook.options.attributes = {{"path", path, 0}};
  hook.options.attributes.insert(hook.options.attributes.end(), more.begin(), more.end());
  return hook;
}

TEST(World, AHeadingThatIsNoNumberEndsTheRunByName) {
  auto world = make(Scene().robot("lost", 0.5, 0.0));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  Space& space = world->space();
  space.set_pose(space.find_robot("lost"), Pose::at(0.1, 0.0, NAN));
  world->step();
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_EQ(world->failure(), "robot 'lost' was put where its heading or height is not a number at tick 1");
}

TEST(World, WheelsThatNoEngineCanFollowEndTheRunByName) {
  auto world = make(Scene().robot("quick", 0.5, 0.0));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  Space& space = world->space();
  space.port<hal::WheelSpeeds>(space.find_robot("quick"))->set(1e9, 0.0);  // a hook's: nobody clamps it
  world->step();
  EXPECT_EQ(world->failure(),
            "robot 'quick' has wheels that are faster than its engine can follow (1e+09 and 0 m/s) at tick 1");
}

TEST(Hooks, AreCalledAtTheirFiveMoments) {
  const std::string path = testing::TempDir() + "tandem_diary.txt";
  Scene scene;
  scene.robot("a", 0, 0);
  scene.scenario.hooks.push_back(diary(path, {{"done_at", "2", 0}}));
  {
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    run(*world.world, 10);
    EXPECT_EQ(world->state(), RunState::Done);
    EXPECT_EQ(world->tick(), 2);
  }
  EXPECT_EQ(text_of(path), "before_run 1\nbefore_step 0\nafter_step 0\nbefore_step 1\nafter_step 1\nafter_run 2\n");
}

TEST(Hooks, OneThatThrowsEndsTheRunByName) {
  Scene scene;
  scene.robot("a", 0, 0);
  scene.scenario.hooks.push_back(diary("/dev/null", {{"throw_at", "4", 0}}));
  auto world = make(scene);
  run(*world.world, 10);
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_NE(world->failure().find("hook 'diary' threw in before_step at tick 4: no more"), std::string::npos)
      << world->failure();
}

/// Three painters, one after the other; `fails` is what the second does.
Scene painted(const std::string& fails = "") {
  Scene s;
  s.field("floor", {{"source", "loop_functions", 5}, {"pixels_per_meter", "10", 5}});
  const auto painter = [&](const char* x, const char* shade, const std::string& flaw) {
    HookConfig hook;
    hook.library = "test_hooks";
    hook.label = "painter";
    hook.line = 20 + static_cast<int>(s.scenario.hooks.size());
    hook.options.name = "loop_functions";
    hook.options.file = "scene";
    hook.options.line = hook.line;
    hook.options.attributes = {{"x", x, 0}, {"shade", shade, 0}, {"fails", flaw, 0}};
    s.scenario.hooks.push_back(hook);
  };
  painter("0", "0", "");
  painter("0.4", "1", fails);
  painter("-0.4", "0.2", "");
  return s;
}

TEST(Hooks, PaintTheFloorEachOverThoseBeforeIt) {
  auto world = make(painted());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 1);
  const Space& space = world->space();
  EXPECT_NEAR(space.floor(0.0, 0.45), 0.0, 0.01);  // the first alone
  EXPECT_NEAR(space.floor(0.3, 0.0), 1.0, 0.01);   // the second over it
  EXPECT_NEAR(space.floor(0.0, 0.0), 0.2, 0.01);   // the third over both
  EXPECT_NEAR(space.floor(-0.8, 0.0), 0.2, 0.01);  // the third alone
  EXPECT_NEAR(space.floor(1.5, 1.5), 0.5, 0.01);   // nobody
}

TEST(World, APaintedFloorHasAShadeEverywhere) {
  auto world = make(painted());
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 1);
  for (const double x_m : {-1e300, -3.0, 3.0, 1e300, std::nan("")}) {
    const double shade = world->space().floor(x_m, -x_m);
    EXPECT_TRUE(shade >= 0.0 && shade <= 1.0) << x_m;
  }
}

TEST(Hooks, ThatThrowWhileTheyAreMadeOrPaintAreNamed) {
  for (const char* where : {"params", "constructor"}) {
    auto world = make(painted(where));
    EXPECT_EQ(world.world, nullptr);
    EXPECT_THAT(
        world.all_problems(),
        testing::HasSubstr("scene:21: error: hook 'painter' (library 'test_hooks') threw while it was made: no "));
  }
  auto world = make(painted("floor"));
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 3);
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_EQ(world->failure(), "hook 'painter' threw in floor at tick 0: spilt");
}

TEST(Hooks, MayMoveRobots) {
  Scene scene;
  scene.robot("a", 0, 0);
  scene.scenario.hooks.push_back(diary("/dev/null", {{"shift", "true", 0}}));
  auto world = make(scene);
  run(*world.world, 5);
  EXPECT_EQ(world->space().pose(world->space().robot(0)).y_m, 1.0);
}

TEST(World, SaysWhichElementsNobodyAskedFor) {
  Scene s = painted();
  const auto child = [](Element& parent, const std::string& name, int line) {
    Element& e = parent.children.emplace_back();
    e.name = name;
    e.file = "scene";
    e.line = line;
  };
  ControllerConfig& config = s.scenario.controllers.back();
  config.params.name = "params";
  config.sensors[0].options.name = "proximity";
  child(config.params, "gains", 31);
  child(config.sensors[0].options, "filter", 32);
  child(s.scenario.hooks[0].options, "brush", 33);
  s.robot("a", 1.0, 1.0);
  const std::string all = make(s).all_problems();
  EXPECT_THAT(all, testing::HasSubstr("scene:31: error: <params> cannot hold <gains>; it may hold: none"));
  EXPECT_THAT(all, testing::HasSubstr("scene:32: error: <proximity> cannot hold <filter>"));
  EXPECT_THAT(all, testing::HasSubstr("scene:33: error: <loop_functions> cannot hold <brush>"));
}

TEST(World, SaysWhichObjectsEnginesCannotMove) {
  const auto problems_with = [](const std::string& engine, double width_m, double mass_kg) {
    Scene s;
    s.engine(engine).box(0, 0, width_m, width_m).movable(mass_kg);
    s.scenario.objects.back().line = 17;
    return make(s).all_problems();
  };
  for (const char* engine : {"dynamics2d", "dynamics3d"}) {
    EXPECT_EQ(problems_with(engine, 0.1, 0.5), "");
    EXPECT_THAT(problems_with(engine, 1e-5, 0.5),
                testing::HasSubstr("scene:17: error: movable box 'box0' at (0, 0) measures 1e-05 m"));
    EXPECT_THAT(problems_with(engine, 1e-5, 0.5), testing::HasSubstr(std::string("the engine ") + engine));
    EXPECT_THAT(problems_with(engine, 0.1, 1e-12), testing::HasSubstr("weighs 1e-12 kg"));
  }
  auto world = make(Scene().engine("dynamics2d").box(0, 0, 0.1, 0.1).movable(0.5));
  Object chip = world->space().objects()[0];
  chip.id = "chip";
  chip.x_m = 1.0;
  chip.half_x_m = 1e-5;
  EXPECT_THAT(world->space().add_object(chip).error().message, testing::HasSubstr("box 'chip' measures 2e-05 m"));
}

TEST(World, WarnsOfPlacesThatAnEngineOfThePlaneDoesNotKnow) {
  Scene scene(4.0);
  scene.robot("high", 0, 0).robot("tilted", 1, 0).robot("good", -1, 0);
  scene.scenario.robots[0].placement.p_W[2] = 0.5;
  scene.scenario.robots[1].placement.pitch_rad = 0.1;
  const auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  ASSERT_EQ(world.problems.size(), 2U) << world.all_problems();
  EXPECT_NE(world.all_problems().find("warning: robot 'high' is 0.5 m above the ground, but its engine"),
            std::string::npos)
      << world.all_problems();
  EXPECT_NE(world.all_problems().find("warning: robot 'tilted' is tilted"), std::string::npos) << world.all_problems();
  scene.engine("dynamics3d");
  EXPECT_EQ(make(scene).all_problems(), "");

  Scene pushed(4.0);
  pushed.robot("good", -1, 0).box(1, 0, 0.3, 0.3).movable(1.0).engine("dynamics2d");
  EXPECT_EQ(make(pushed).all_problems(), "");
  pushed.scenario.objects[0].placement.p_W[2] = 0.5;
  EXPECT_NE(make(pushed).all_problems().find("warning: 'box0' is 0.5 m above the ground"), std::string::npos);
}

TEST(World, SaysWhichFloorIsTooFine) {
  Scene s = painted();
  s.scenario.arena_size = {1e4, 1e4, 1.0};
  EXPECT_THAT(make(s).all_problems(),
              testing::HasSubstr("scene:5: error: the floor would have 100000 x 100000 pixels, at most 100 million can "
                                 "be painted: choose pixels_per_meter=\"1\" or less"));
}

TEST(World, SaysWhichControllerOrDeviceIsWrong) {
  const auto problems_of = [](const Scene& scene) {
    auto world = make(scene);
    EXPECT_EQ(world.world, nullptr);
    return world.all_problems();
  };
  {
    Scene scene(4.0, "everything");
    scene.robot("a", 0, 0);
    scene.scenario.controllers[0].sensors.clear();
    EXPECT_NE(problems_of(scene).find("does not list; add <range_and_bearing"), std::string::npos)
        << problems_of(scene);
  }
  {
    Scene scene(4.0, "drvie");
    EXPECT_NE(problems_of(scene.robot("a", 0, 0)).find("has no controller 'drvie'; it has: drive"), std::string::npos);
  }
  {
    Scene scene(4.0, "drive", "no_such_library");
    EXPECT_NE(problems_of(scene.robot("a", 0, 0)).find("'no_such_library' is not there; looked for"),
              std::string::npos);
  }
  {
    Scene scene(4.0, "stillborn");
    EXPECT_NE(problems_of(scene.robot("a", 0, 0)).find("robot 'a' refuses to be made"), std::string::npos);
  }
  {
    Scene scene;
    scene.scenario.controllers[0].sensors[0].implementation = "nosiy";
    EXPECT_NE(problems_of(scene.robot("a", 0, 0))
                  .find("'proximity' has no implementation 'nosiy'; it has: default, ideal, noisy"),
              std::string::npos);
  }
  {
    Scene scene;
    EXPECT_NE(problems_of(scene.param("lfet", "1").robot("a", 0, 0)).find("no attribute 'lfet'. Did you mean 'left'?"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace tandem::core
