// Going back: a restored world goes on as it went on from the snapshot, to the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <random>
#include <rapidcheck.h>
#include <set>

#include "core/sim/engine_factory.hpp"
#include "core/space/stores.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/footbots.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

std::vector<std::uint64_t> hashes(World& world, int steps) {
  std::vector<std::uint64_t> all;
  for (int i = 0; i < steps; ++i) {
    world.step();
    all.push_back(world.state_hash());
  }
  return all;
}

/// Robots that sense and talk with noise, and drive into one another, in four regions; crates where they can be pushed.
Scene crowd(const std::string& kind, const std::string& controller = "everything") {
  Scene s(4.0, controller);
  s.engine(kind).param("left", "0.06").param("right", "0.05").implementations("noisy").walls().robots(60, 0.6);
  if (kind != "particle3d") s.split("2x2");
  s.scenario.escape = EscapePolicy::Stop;
  s.scenario.robots[0].battery.delta = 0.001;
  if (test::engine_traits(kind).forces) {
    s.box(1.0, 0, 0.1, 0.2, 0.0, 0.06).movable(0.2).cylinder(-1.0, 0.0, 0.06).movable(0.1);
    s.box(0.0, 1.0, 0.1, 0.1, 0.3, 0.06).movable(0.1);
  }
  return s;
}

NewRobot at(const std::string& id, double x_m, double y_m) {
  return {.id = id, .controller = "c", .pose = Pose::at(x_m, y_m, 0.3)};
}

class Going : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engines, Going, testing::ValuesIn(test::engine_kinds()),
                         [](const auto& kind) { return kind.param; });

TEST_P(Going, BackGoesOnAsBefore) {
  auto world = make(crowd(GetParam()));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 30; ++i) world->step();
  const std::uint64_t before = world->state_hash();
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
  EXPECT_EQ(snapshot.value().tick(), 30);
  EXPECT_EQ(world->state_hash(), before);
  const std::vector<std::uint64_t> first = hashes(*world.world, 100);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(world->restore(snapshot.value()).ok());
    EXPECT_EQ(world->tick(), 30);
    EXPECT_EQ(world->state_hash(), before);
    EXPECT_EQ(hashes(*world.world, 100), first);
  }
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Going, BackUndoesWhatHooksDid) {
  auto world = make(crowd(GetParam()));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 10; ++i) world->step();
  Space& space = world->space();
  const RobotId gone = space.find_robot("ep3");
  const RobotId moved = space.find_robot("ep4");
  auto* port = space.port<hal::WheelSpeeds>(gone);
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
  const std::vector<std::uint64_t> first = hashes(*world.world, 20);
  const std::size_t rows = space.stores().bodies.size();

  space.remove_robot(gone);
  space.set_pose(moved, Pose::at(1.7, 1.7, 0));
  std::vector<RobotId> newcomers;
  for (int i = 0; i < 40; ++i) {
    const auto added = space.add_robot(at("new" + std::to_string(i), -1.8 + 0.09 * i, -1.7));
    ASSERT_TRUE(added.ok()) << added.error().message;
    newcomers.push_back(added.value());
  }
  NewRobot other = at("other", 1.5, 0.8);
  other.params = {{"left", "0.01"}};
  ASSERT_TRUE(space.add_robot(other).ok());
  Object box;
  box.id = "box";
  box.x_m = -1.5;
  box.half_x_m = box.half_y_m = 0.1;
  box.z_high_m = 0.3;
  const auto added_box = space.add_object(box);
  ASSERT_TRUE(added_box.ok()) << added_box.error().message;
  ASSERT_TRUE(space.add_light({"lamp", 0, 0, 0.3, 2.0}).ok());
  space.remove_object(space.find_object("box0"));
  const std::vector<std::uint64_t> altered = hashes(*world.world, 20);
  EXPECT_NE(altered.back(), first.back());

  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_EQ(space.robot_count(), 60U);
  EXPECT_TRUE(space.contains(gone));
  EXPECT_EQ(space.port<hal::WheelSpeeds>(gone), port);
  EXPECT_EQ(space.stores().bodies.size(), rows);
  for (const RobotId id : newcomers) EXPECT_FALSE(space.contains(id));
  EXPECT_FALSE(space.find_robot("new7").valid());
  EXPECT_FALSE(space.contains(added_box.value()));
  EXPECT_TRUE(space.find_object("box0").valid());
  EXPECT_TRUE(space.lights().empty());
  EXPECT_EQ(hashes(*world.world, 20), first);

  // What vanished may come again under the same id; what its first id named stays gone.
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  const auto again = space.add_robot(at("new0", -1.8, -1.7));
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_FALSE(space.contains(newcomers[0]));
  EXPECT_TRUE(space.contains(again.value()));
  EXPECT_TRUE(space.add_object(box).ok());
  EXPECT_FALSE(space.contains(added_box.value()));
  world->step();
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST_P(Going, BackToAMomentWithThoseWhoCame) {
  auto world = make(crowd(GetParam()));
  world->start();
  world->step();
  Space& space = world->space();
  for (int i = 0; i < 10; ++i) {
    space.remove_robot(space.find_robot("ep" + std::to_string(i)));
    ASSERT_TRUE(space.add_robot(at("new" + std::to_string(i), -1.8 + 0.1 * i, -1.7)).ok());
  }
  const RobotId kept = space.find_robot("new4");
  if (test::engine_traits(GetParam()).forces) {
    ASSERT_TRUE(space.join(kept, space.find_robot("new5"), {-1.35, -1.7, 0.02}).ok());
  }
  world->step();
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
  const std::vector<std::uint64_t> first = hashes(*world.world, 30);
  for (int i = 0; i < 10; ++i) space.remove_robot(space.find_robot("new" + std::to_string(i)));
  (void)hashes(*world.world, 5);
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_TRUE(space.contains(kept));
  EXPECT_EQ(hashes(*world.world, 30), first);
}

TEST_P(Going, BackAndThenOnToAMomentOfAnotherBranch) {
  Scene scene(4.0, "picky");
  auto world = make(scene.engine(GetParam()).robot("a", 0, 0));
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  Space& space = world->space();
  ASSERT_TRUE(space.add_light({"lamp", 0.5, 0, 0.2, 1.0}).ok());
  const hal::Result<Snapshot> early = world->snapshot();
  ASSERT_TRUE(early.ok()) << early.error().message;
  // Its block, its devices and its port of every block came after the early moment.
  const auto with_light = space.add_robot(at("light", 1, 1));
  ASSERT_TRUE(with_light.ok()) << with_light.error().message;
  (void)hashes(*world.world, 5);
  const auto* port = space.port<hal::Light>(with_light.value());
  const hal::Result<Snapshot> late = world->snapshot();
  ASSERT_TRUE(late.ok()) << late.error().message;
  const std::vector<std::uint64_t> first = hashes(*world.world, 20);

  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(world->restore(early.value()).ok());
    EXPECT_EQ(space.robot_count(), 1U);
    const auto other = space.add_robot(at("other", -1, -1));
    ASSERT_TRUE(other.ok()) << other.error().message;
    (void)hashes(*world.world, 5);
    ASSERT_TRUE(world->restore(late.value()).ok());
    EXPECT_FALSE(space.contains(other.value()));
    EXPECT_TRUE(space.contains(with_light.value()));
    EXPECT_EQ(space.port<hal::Light>(with_light.value()), port);
    EXPECT_EQ(hashes(*world.world, 20), first);
  }
}

TEST_P(Going, BackWithAFootBotThatSwingsItsLoad) {
  if (!test::engine_traits(GetParam()).forces) GTEST_SKIP() << "an engine without masses";
  Scene scene = footbot_scene(GetParam());
  scene.cylinder(hal::footbot::kind().body.radius_m + 0.11, 0, 0.1).movable(0.2);
  choose(scene, "differential_steering", hal::Role::Actuator, "slanted");
  choose(scene, "odometry", hal::Role::Sensor, "noisy");
  add_footbot(scene, "a", 0, 0);
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  world->step();
  command<hal::GripperDrive>(world, "a").lock();
  command<hal::TurretDrive>(world, "a").turn(0.5);
  command<hal::ScannerDrive>(world, "a").turn(3.0);
  command<hal::WheelSpeeds>(world, "a").set(0.05, 0.04);
  steps(world, 10);
  ASSERT_TRUE(reading<hal::Gripper>(world, "a").holding);
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
  const std::vector<std::uint64_t> first = hashes(*world.world, 50);
  command<hal::GripperDrive>(world, "a").unlock();
  steps(world, 10);
  world->space().remove_robot(world->space().find_robot("a"));
  steps(world, 2);
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_TRUE(reading<hal::Gripper>(world, "a").holding);
  EXPECT_EQ(hashes(*world.world, 50), first);
}

TEST(Snapshots, OfAFinishedRunBringItBack) {
  Scene scene(1.0, "drive");
  auto world = make(scene.param("left", "0.1").param("right", "0.1").robot("a", 0.3, 0));
  world->start();
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok());
  for (int i = 0; i < 100; ++i) world->step();
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_EQ(world->incidents().bodies_escaped, 1U);
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_EQ(world->state(), RunState::Running);
  EXPECT_EQ(world->failure(), "");
  EXPECT_EQ(world->incidents().bodies_escaped, 0U);
  EXPECT_EQ(world->tick(), 0);
}

TEST(Snapshots, CountersOfMisbehaviourGoBackToo) {
  auto world = make(Scene(4.0, "careless").robot("a", 0, 0));
  world->start();
  for (int i = 0; i < 7; ++i) world->step();
  const Incidents before = world->incidents();
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_TRUE(snapshot.ok());
  const std::vector<std::uint64_t> first = hashes(*world.world, 13);
  EXPECT_GT(world->incidents().commands_clamped, before.commands_clamped);
  ASSERT_TRUE(world->restore(snapshot.value()).ok());
  EXPECT_EQ(world->incidents().commands_clamped, before.commands_clamped);
  EXPECT_EQ(world->incidents().commands_not_finite, before.commands_not_finite);
  EXPECT_EQ(world->incidents().first(), before.first());
  EXPECT_EQ(hashes(*world.world, 13), first);
}

TEST(Snapshots, SayWhichControllerCannotBeCopied) {
  auto world = make(Scene(4.0, "owner").robot("a", 0, 0).robot("b", 1, 0));
  world->start();
  const hal::Result<Snapshot> snapshot = world->snapshot();
  ASSERT_FALSE(snapshot.ok());
  EXPECT_THAT(snapshot.error().message,
              HasSubstr("controller 'owner' of robot 'a' cannot be copied. Give its class a copy"));
  for (int i = 0; i < 3; ++i) world->step();  // and the run is none the worse
  EXPECT_EQ(world->state(), RunState::Running);
}

TEST(Snapshots, ACopyThatThrowsIsAnError) {
  auto world = make(Scene(4.0, "reluctant").robot("a", 0, 0));
  world->start();
  EXPECT_TRUE(world->snapshot().ok());
  for (int i = 0; i < 3; ++i) world->step();
  const hal::Result<Snapshot> late = world->snapshot();
  ASSERT_FALSE(late.ok());
  EXPECT_THAT(late.error().message, HasSubstr("of robot 'a' threw: I am unique"));
  world->step();
  EXPECT_EQ(world->state(), RunState::Running);
}

TEST(Snapshots, OfAnotherWorldAreRefused) {
  auto one = make(Scene(4.0, "drive").robot("a", 0, 0));
  auto other = make(Scene(4.0, "drive").robot("a", 0, 0));
  const hal::Result<Snapshot> snapshot = one->snapshot();
  ASSERT_TRUE(snapshot.ok());
  const hal::Status restored = other->restore(snapshot.value());
  EXPECT_THAT(restored.error().message, HasSubstr("another world"));
}

Scene with_shepherd(std::vector<Element::Attribute> more) {
  Scene s(4.0, "everything");
  s.param("left", "0.05").param("right", "0.045").walls().robots(20, 1.0);
  return with_hook(s, "shepherd", std::move(more));
}

TEST(Checkpoints, AHookGoesBackAndItsMemoryWithIt) {
  auto straight = make(with_shepherd({}));
  run(*straight.world, 60);
  // Twice back from tick 41 to 21: forty steps more until the same moment.
  auto looping = make(with_shepherd({{"save_at", "20", 0}, {"back_at", "40", 0}, {"times", "2", 0}}));
  looping->start();
  for (int i = 0; i < 41; ++i) looping->step();
  EXPECT_EQ(looping->tick(), 21);
  for (int i = 0; i < 20; ++i) looping->step();
  EXPECT_EQ(looping->tick(), 21);
  for (int i = 0; i < 39; ++i) looping->step();
  EXPECT_EQ(looping->tick(), 60);
  EXPECT_EQ(looping->state_hash(), straight->state_hash());
  EXPECT_EQ(looping->state(), RunState::Running) << looping->failure();
}

TEST(Checkpoints, OneThatWasNeverSavedIsAnError) {
  auto world = make(with_shepherd({{"back_at", "5", 0}}));
  run(*world.world, 10);
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_THAT(world->failure(), HasSubstr("there is no checkpoint 'fold'"));
}

TEST(Checkpoints, AControllerWithoutACopyEndsTheRunByName) {
  Scene s = with_shepherd({{"save_at", "5", 0}});
  s.scenario.controllers[0].label = "owner";
  s.scenario.controllers[0].params.attributes.clear();
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 10);
  EXPECT_EQ(world->state(), RunState::Failed);
  EXPECT_THAT(world->failure(), HasSubstr("checkpoint 'fold': no snapshot: the controller 'owner'"));
}

// --- anything, in any order ---

/// Does the same to its world as any other Fuzzer with the same seed, and knows what must then be true.
class Fuzzer {
 public:
  Fuzzer(const std::string& kind, std::int64_t threads, std::uint64_t seed) : random_(seed) {
    Scene s(4.0, "everything");
    s.engine(kind).param("left", "0.06").param("right", "0.05").implementations("noisy").walls().robots(kRobots, 1.5);
    s.scenario.escape = EscapePolicy::Stop;
    forces_ = test::engine_traits(kind).forces;
    WorldOptions options;
    options.threads = threads;
    made_ = make(s, options);
    RC_ASSERT(made_.world != nullptr);
    made_->start();
    for (int i = 0; i < kRobots; ++i) names_.insert("ep" + std::to_string(i));
  }

  void act() {
    Space& space = made_->space();
    switch (random_() % 12) {
      case 0:
      case 1:
      case 2:
        add();
        break;
      case 3:
        if (const RobotId robot = any(); robot.valid()) {
          names_.erase(space.robot_name(robot));
          space.remove_robot(robot);
        }
        break;
      case 4:
        if (const RobotId robot = any(); robot.valid()) space.set_pose(robot, pose());
        break;
      case 5:
        if (const RobotId robot = any(); robot.valid()) {
          (void)space.set_battery(robot, 0.5);
          (void)space.set_velocity(robot, {{0.1, 0.0, 0.0}, {}});
          space.set_halted(robot, random_() % 2 == 0);
        }
        break;
      case 6:
        add_object();
        break;
      case 7:
        space.remove_object(space.object(kWalls + random_() % (space.objects().size() - kWalls + 1)));
        break;
      case 8:
        if (const RobotId a = any(), b = any(); forces_ && a.valid())
          (void)space.join(a, b, {space.pose(a).x_m, space.pose(a).y_m, 0.02});
        break;
      case 9:
        keep();
        break;
      case 10:
        go_back();
        break;
      default:
        break;
    }
    check();
    made_->step();
    check();
  }

  std::uint64_t hash() const { return made_.world->state_hash(); }
  const std::string& failure() const { return made_.world->failure(); }

 private:
  static constexpr int kRobots = 12;
  static constexpr std::size_t kWalls = 4;  // the first objects: they stay
  struct Kept {
    Snapshot snapshot;
    std::set<std::string> names;
    std::uint64_t hash;
  };

  double coordinate() { return -1.8 + 3.6 * static_cast<double>(random_() % 1000) / 1000.0; }
  Pose pose() {
    const double x_m = coordinate();
    return Pose::at(x_m, coordinate(), 0.001 * static_cast<double>(random_() % 6000));
  }
  RobotId any() {
    const Space& space = made_->space();
    return space.robot_count() == 0 ? RobotId{} : space.robot(random_() % space.robot_count());
  }

  void add() {
    NewRobot wanted{.id = "n" + std::to_string(random_() % 200), .controller = "c", .pose = pose()};
    if (random_() % 3 == 0) wanted.params = {{"left", random_() % 2 == 0 ? "0.01" : "0.08"}};
    const auto added = made_->space().add_robot(wanted);
    if (!added.ok()) return;
    RC_ASSERT(names_.insert(wanted.id).second);
    RC_ASSERT(made_->space().find_robot(wanted.id) == added.value());
  }

  void add_object() {
    Object box;
    box.id = "o" + std::to_string(random_() % 100);
    box.x_m = coordinate();
    box.y_m = coordinate();
    box.half_x_m = box.half_y_m = 0.05;
    box.z_high_m = 0.06;
    box.mass_kg = 0.1;
    box.movable = random_() % 2 == 0;
    (void)made_->space().add_object(box);
  }

  void keep() {
    const auto snapshot = made_->snapshot();
    RC_ASSERT(snapshot.ok());
    kept_.push_back({snapshot.value(), names_, hash()});
  }

  void go_back() {
    if (kept_.empty()) return;
    const Kept& kept = kept_[random_() % kept_.size()];
    RC_ASSERT(made_->restore(kept.snapshot).ok());
    RC_ASSERT(hash() == kept.hash);
    names_ = kept.names;
  }

  void check() {
    const Space& space = made_->space();
    const SpaceStores& s = space.stores();
    RC_ASSERT(space.robot_count() == names_.size());
    std::set<std::size_t> rows;
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const RobotId robot = space.robot(i);
      RC_ASSERT(space.contains(robot));
      RC_ASSERT(names_.contains(space.robot_name(robot)));
      RC_ASSERT(space.find_robot(space.robot_name(robot)) == robot);
      const std::size_t row = s.row_of(robot);
      RC_ASSERT(rows.insert(row).second);
      RC_ASSERT((s.bodies.flags[row] & kAlive) != 0);
      RC_ASSERT(s.bodies.entity[row] == robot.index);
      RC_ASSERT(s.blocks[s.robots[robot.index].block].constructed[s.robots[robot.index].slot] == 1);
    }
    for (std::size_t row = 0; row < s.bodies.size(); ++row)
      RC_ASSERT(rows.contains(row) == ((s.bodies.flags[row] & kAlive) != 0));
    for (const Joint& joint : s.joints) {
      if (!joint.alive) continue;
      for (const BodyKey body : {joint.a, joint.b}) RC_ASSERT(body.is_object() || rows.contains(body.index()));
    }
    RC_ASSERT(made_->state() == RunState::Running);
  }

  std::mt19937_64 random_;
  bool forces_ = false;
  MadeWorld made_;
  std::set<std::string> names_;
  std::vector<Kept> kept_;
};

TEST_P(Going, OnWhateverHooksDoAndAlikeForAnyThreads) {
  EXPECT_TRUE(rc::check("random sequences of changes", [&](std::uint64_t seed) {
    Fuzzer one(GetParam(), 1, seed);
    Fuzzer three(GetParam(), 3, seed);
    for (int i = 0; i < 15; ++i) {
      one.act();
      three.act();
      RC_ASSERT(one.hash() == three.hash());
    }
  }));
}

}  // namespace
}  // namespace tandem::core
