#include "mixed_reality/replay/replay.hpp"

#include <cstdlib>

#include "tests/mixed_reality/replay/story.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// A run of one to four real robots among simulated ones, in which something goes wrong every other second.
class Faults {
 public:
  explicit Faults(std::uint64_t seed)
      : dice_(seed), count_(1 + dice_() % 4), story_(scene(), "replay_" + std::to_string(seed)) {
    for (std::size_t i = 0; i < count_; ++i) {
      FakeBody& body = story_.body(id(i));
      body.tells_place = dice_() % 2 == 0;
      body.link_up = i == 0 || dice_() % 8 != 0;  // the others may be missing, and are simulated
    }
    story_.options().freezes = [this] { return freezes_; };
    story_.options().guarded = [this] { return guarded_; };
    story_.options().rearm_asked = &rearm_;
  }

  RecordedStory& story() { return story_; }

  void after_tick(core::World& world) {
    story_.time().oversleep_ns = static_cast<hal::TimeNs>(dice_() % 3'000'000);
    FakeBody& body = story_.body(id(dice_() % count_));
    switch (dice_() % 60) {
      case 0:
      case 1:
        body.link_up = false;
        break;
      case 2:
      case 3:
      case 4:
        body.link_up = true;
        break;
      case 5:
        body.held_fast = !body.held_fast;
        break;
      case 6:  // carried away
        body.pose = core::Pose::at(0.8 * unit() - 0.4, 0.8 * unit() - 0.4, 6.0 * unit() - 3.0);
        break;
      case 7:
        body.stopped_itself = !body.stopped_itself;
        break;
      case 8:
        story_.session().emergency_stop();
        break;
      case 9:
      case 10:
        (void)story_.session().arm("*");
        break;
      case 11:
        ++freezes_;
        break;
      case 12:
        story_.time().pass(700 * hal::kNsPerMs);
        break;
      case 13:
        rearm_ = true;
        break;
      case 14:
        guarded_ = dice_() % 4 != 0;
        break;
      case 15:
      case 16:
        body.real_proximity_m = 0.1 * unit();
        break;
      case 17:
        story_.ask({{"do", dice_() % 2 == 0 ? "halt" : "release"}, {"robot", "*"}});
        break;
      case 18:
        story_.ask({{"do", "release"}, {"robot", "*"}});
        break;
      case 19:
        story_.ask({{"do", "move"}, {"robot", "ep" + std::to_string(dice_() % 6)}, {"x", unit()}, {"y", unit()}});
        break;
      case 20:
        story_.ask({{"do", "add"}, {"robot", {{"controller", "c"}, {"x", -unit()}, {"y", unit()}}}});
        break;
      case 21:
        story_.ask({{"do", "remove"}, {"robot", "ep" + std::to_string(dice_() % 6)}});
        break;
      case 22:
        story_.ask(
            {{"do", "add"},
             {"object",
              {{"shape", "box"}, {"x", unit()}, {"y", -unit()}, {"size_x", 0.1}, {"size_y", 0.1}, {"height", 0.2}}}});
        break;
      case 23:
        if (world.tick() > 60) story_.ask({{"do", "remove"}, {"robot", id(dice_() % count_)}});  // a twin
        break;
      default:
        break;
    }
  }

 private:
  static std::string id(std::uint64_t i) { return "real" + std::to_string(i); }
  double unit() { return static_cast<double>(dice_() % 1000) * 1e-3; }

  core::Scene scene() {
    const std::string kind = dice_() % 3 == 0 ? "dynamics2d" : "kinematics2d";
    const bool everything = dice_() % 2 == 0;
    core::Scene scene(4.0, everything ? "everything" : "obstacle_avoidance",
                      everything ? "test_controllers" : "obstacle_avoidance");
    if (everything) scene.param("left", "0.06").param("right", "0.05").implementations("noisy");
    scene.engine(kind).walls().split("2x2");
    scene.scenario.seed = dice_();
    scene.scenario.escape = core::EscapePolicy::Stop;
    for (std::size_t i = 0; i < count_; ++i) {
      scene.robot(id(i), -0.6 + 0.4 * static_cast<double>(i), 0.3, 0.5);
      made_real(scene, id(i));
      core::RobotItem& item = scene.scenario.robots.back();
      item.bridge->if_missing = core::IfMissing::Simulate;
      item.bridge->connect_s = 1.0;
      if (dice_() % 4 == 0) item.bridge->rearm = "operator";
    }
    scene.robots(6, 1.0);
    if (kind == "dynamics2d") scene.box(1.2, 0.0, 0.1, 0.2, 0.0, 0.06).movable(0.2);
    return scene;
  }

  std::mt19937_64 dice_;
  std::size_t count_;
  std::uint64_t freezes_ = 0;
  bool guarded_ = true;
  std::atomic<bool> rearm_{false};
  RecordedStory story_;
};

TEST(Replay, RunsWithFaultsHaveTheSameBitsAgainInEveryTick) {
  constexpr hal::Tick kTicks = 200;
  const std::uint64_t count = from_environment("TANDEM_REPLAYS", 20);
  const std::uint64_t first = from_environment("TANDEM_REPLAY_SEED", 1);
  std::uint64_t stops = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Faults faults(seed);
    ASSERT_NO_FATAL_FAILURE(faults.story().run(kTicks, [&](core::World& w) { faults.after_tick(w); }));
    for (const RealRobotReport& robot : faults.story().session().report().robots) stops += robot.counts.stops;
    const hal::Tick done = faults.story().session().world().tick();
    const auto again = faults.story().again(seed % 2 == 0 ? 2 : 0);
    EXPECT_EQ(again.failure, "") << "seed " << seed;
    EXPECT_EQ(again.end, "the run ended") << "seed " << seed;
    EXPECT_EQ(again.equal, done) << "seed " << seed << ": " << again.difference;
  }
  EXPECT_GT(stops, count);
}

core::Scene two() {
  core::Scene scene(4.0, "drive");
  scene.param("left", "0.06").param("right", "0.05").robot("ep0", -1.0, 0.0).robot("sim", 0.5, 0.5);
  scene.scenario.controllers[0].actuators.front().implementation = "default";  // turns as the real one
  return std::move(made_real(scene, "ep0"));
}

/// Values of one row of a stream, by tick.
std::map<hal::Tick, std::map<std::string, double>> rows_of(const std::string& path, const std::string& title,
                                                           const std::string& id) {
  std::map<hal::Tick, std::map<std::string, double>> all;
  auto reader = core::RecordReader::open(path);
  EXPECT_TRUE(reader.ok());
  while (const auto entry = reader.value().next()) {
    if (!entry->rows || entry->rows->stream().title() != title) continue;
    const auto& ids = entry->rows->members().ids;
    const auto member = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
    EXPECT_LT(member, ids.size());
    const auto& fields = entry->rows->stream().fields;
    for (std::size_t f = 0; f < fields.size(); ++f) all[entry->tick][fields[f].name] = entry->rows->value(f, member);
  }
  return all;
}

TEST(Record, SaysByTwoClocksWhenEveryTickWasAndWhereRealRobotsWere) {
  core::Scene scene(4.0, "obstacle_avoidance", "obstacle_avoidance");
  scene.walls().robot("ep0", 0.0, 0.0);
  RecordedStory story(made_real(scene, "ep0"), "clocks");
  // A wall clock that is a year off, and goes as the monotonic one does.
  static FakeTime* time = nullptr;
  constexpr hal::TimeNs kApart_ns = 31'536'000 * hal::kNsPerSecond;
  time = &story.time();
  story.options().unix_clock = []() noexcept { return time->now_ns() + kApart_ns; };
  constexpr hal::Tick kStalled = 20;
  ASSERT_NO_FATAL_FAILURE(story.run(60, [&](core::World& world) {
    if (world.tick() == kStalled) story.time().pass(350 * hal::kNsPerMs);
  }));
  const auto clocks = rows_of(story.path(), "run time clock", "run");
  const auto track = rows_of(story.path(), "seen track", "ep0");
  ASSERT_EQ(clocks.count(0), 1U);
  const double began_ns = clocks.at(0).at("monotonic_ns");
  for (hal::Tick t = 0; t < 60; ++t) {
    ASSERT_EQ(clocks.count(t), 1U) << t;
    const auto& now = clocks.at(t);
    // By the schedule, less the slots that a stall of 350 ms leaves out of 100 ms each.
    const double skipped = t < kStalled ? 0.0 : 2.0;
    EXPECT_EQ(now.at("skipped_slots"), skipped) << t;
    EXPECT_EQ(now.at("run_ns"), static_cast<double>(t) * 1e8) << t;
    const double late_ns = now.at("monotonic_ns") - began_ns - (static_cast<double>(t) + skipped) * 1e8;
    EXPECT_GE(late_ns, 0.0) << t;
    EXPECT_LE(late_ns, t == kStalled ? 1e8 : 1e6) << t;
    EXPECT_NEAR(now.at("unix_ns") - now.at("monotonic_ns"), static_cast<double>(kApart_ns), 1e3) << t;
    ASSERT_EQ(track.count(t), 1U) << t;
    EXPECT_GE(track.at(t).at("sent_ns"), now.at("run_ns")) << t;
  }
  EXPECT_EQ(track.at(59).at("known"), 1.0);
  EXPECT_NEAR(track.at(59).at("x"), story.body("ep0").pose.x_m, 0.02);
}

TEST(Replay, NamesTickRobotAndFieldOfTheFirstDifference) {
  RecordedStory story(two(), "differs");
  ASSERT_NO_FATAL_FAILURE(story.run(40));
  const auto moved = story.again(0, [](core::World& world) {
    if (world.tick() != 20) return;
    core::Space& space = world.space();
    core::Pose pose = space.pose(space.find_robot("sim"));
    pose.x_m += 1e-9;
    space.set_pose(space.find_robot("sim"), pose);
  });
  EXPECT_EQ(moved.equal, 20);
  EXPECT_EQ(moved.difference, "robot 'sim' in body: x");
  const auto painted = story.again(0, [](core::World& world) {
    if (world.tick() == 30) world.space().port<hal::WheelSpeeds>(world.space().find_robot("ep0"))->left_m_s = 0.01;
  });
  EXPECT_EQ(painted.equal, 40) << "its controller writes them anew: " << painted.difference;
}

TEST(Replay, AWhatIfIsTheReplayUntilItsTickAndStaysNearTheRealRobotAfterwards) {
  RecordedStory story(two(), "what_if");
  ASSERT_NO_FATAL_FAILURE(story.run(150));
  const auto what_if = story.again(0, {}, 50);
  EXPECT_EQ(what_if.equal, 50);
  ASSERT_EQ(what_if.deviations.size(), 1U);
  const Deviation& of = what_if.deviations[0];
  EXPECT_EQ(of.robot(), "ep0");
  EXPECT_EQ(of.ticks(), 100U);
  // The real robot drives as an ideal one that hears a command at once: the twin is carried on by what it was told.
  EXPECT_LT(of.max_within_m(10), 0.006);
  EXPECT_LT(of.rms_m(), 0.02);
  EXPECT_LT(of.max_m(), 0.04);
  EXPECT_EQ(of.json(10)["every_second_m"].size(), 10U);
}

/// Two simulated robots and a real one, and another configuration.
core::Scene three() {
  core::Scene scene(4.0, "everything");
  scene.param("left", "0.06").param("right", "0.05").robot("ep0", -1.0, 0.0).robot("sim", 0.5, 0.5);
  made_real(scene, "ep0").robot("other", 0.5, -0.5);
  core::ControllerConfig config = scene.scenario.controllers.front();
  config.id = "d";
  config.label = "drive";
  config.params.attributes = {{"left", "-0.03", 0}, {"right", "-0.03", 0}};
  scene.scenario.controllers.push_back(config);
  return scene;
}

/// A what-if from tick 50 on, with the settings of this scene from then on; equal until then.
RecordedStory::Again from_50(RecordedStory& story, const core::Scene* changed, std::int64_t threads = 0,
                             const std::function<void(core::World&)>& look = {}) {
  auto again = story.again(
      threads,
      [&](core::World& world) {
        if (world.tick() == 50 && changed != nullptr) {
          const hal::Status went_on = world.continue_with(changed->scenario);
          EXPECT_TRUE(went_on.ok()) << went_on.error().message;
        }
        if (look) look(world);
      },
      50);
  EXPECT_EQ(again.equal, 50) << again.difference << again.failure;
  EXPECT_EQ(again.hashes.size(), 100U);
  return again;
}

TEST(Replay, WithOtherSettingsIsTheRecordedRunUntilTheTickOfTheWhatIf) {
  RecordedStory story(three(), "what_if_settings");
  ASSERT_NO_FATAL_FAILURE(story.run(100));
  const auto plain = from_50(story, nullptr);
  const core::Scene equal = three();
  EXPECT_EQ(from_50(story, &equal).hashes, plain.hashes);

  core::Scene real = three(), simulated = three(), params = three();
  real.scenario.robots[0].controller = 1;
  simulated.scenario.robots[1].controller = 1;
  params.scenario.controllers[0].params.attributes = {{"left", "0.02", 0}, {"right", "0.05", 0}};
  for (const core::Scene* changed : {&real, &simulated, &params}) {
    const auto what_if = from_50(story, changed);
    EXPECT_NE(what_if.hashes[50], plain.hashes[50]);
    EXPECT_TRUE(std::equal(plain.hashes.begin(), plain.hashes.begin() + 50, what_if.hashes.begin()));
    EXPECT_EQ(from_50(story, changed, 2).hashes, what_if.hashes);
  }
}

TEST(Replay, ARealRobotsOtherControllerDrivesItsSimulatedOneFromTheTickOfTheWhatIf) {
  RecordedStory story(three(), "what_if_controller");
  ASSERT_NO_FATAL_FAILURE(story.run(100));
  core::Scene changed = three();
  changed.scenario.robots[0].controller = 1;
  core::Pose at;
  double left_m = 0.0;
  from_50(story, &changed, 0, [&](core::World& world) {
    const core::Space& space = world.space();
    const core::RobotId robot = space.find_robot("ep0");
    const double rolled_m = space.stores().bodies.left_m[space.stores().row_of(robot)];
    if (world.tick() == 51) {
      at = space.pose(robot);
      left_m = rolled_m;
      EXPECT_GT(left_m, 0.2) << "it goes on with the wheel counts of the real one";
      EXPECT_FALSE(space.halted(robot));
    }
    if (world.tick() < 52) return;
    const double back_m = 0.03 * 0.1 * static_cast<double>(world.tick() - 51);
    EXPECT_NEAR(space.pose(robot).x_m, at.x_m - back_m * at.cos_h, 1e-9);
    EXPECT_NEAR(space.pose(robot).y_m, at.y_m - back_m * at.sin_h, 1e-9);
    EXPECT_NEAR(rolled_m, left_m - back_m, 1e-9);
  });
}

TEST(Replay, WhatPeopleDidIsDoneAgainAndRealRobotsThatWereMissingAreSimulatedAgain) {
  core::Scene scene = two();
  scene.robot("ep1", 0.0, -0.5);
  made_real(scene, "ep1");
  scene.scenario.robots.back().bridge->if_missing = core::IfMissing::Simulate;
  RecordedStory story(scene, "people");
  story.body("ep1").link_up = false;
  ASSERT_NO_FATAL_FAILURE(story.run(60, [&](core::World& world) {
    if (world.tick() == 20) story.ask({{"do", "halt"}, {"robot", "sim"}});
    if (world.tick() == 30) story.ask({{"do", "halt"}, {"robot", "ep0"}});
    if (world.tick() == 40) story.ask({{"do", "release"}, {"robot", "*"}});
  }));
  const auto again = story.again();
  EXPECT_EQ(again.equal, 60) << again.difference << again.failure;
}

}  // namespace
}  // namespace tandem::mixed_reality
