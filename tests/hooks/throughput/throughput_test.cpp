#include <gmock/gmock.h>

#include "tests/controllers/experiment.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Cylinders, no robots; samples every second over the last two.
struct Counted {
  Scene scene = footbot_scene();
  std::string csv = test::temporary("counted.csv");
  MadeWorld world;

  ~Counted() { std::filesystem::remove(csv); }
  void object(double x_m, double y_m) {
    scene.cylinder(x_m, y_m, 0.06).movable(0.2);
    scene.scenario.objects.back().size[2] = 0.095;
  }
  void begin() {
    HookConfig hook;
    hook.library = "throughput";
    hook.label = "throughput";
    hook.options.name = "loop_functions";
    hook.options.attributes = {{"nest", "-1", 0},    {"source", "1,0,0", 0}, {"spacing", "0.3", 0},
                               {"window", "2 s", 0}, {"every", "1 s", 0},    {"output", csv, 0}};
    scene.scenario.hooks.push_back(hook);
    world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    world->start();
  }
  const Object& at(std::size_t i) const { return world.world->space().objects()[i]; }
  void put(std::size_t i, double x_m, double y_m) {
    Space& space = world->space();
    Object moved = space.objects()[i];
    moved.x_m = x_m;
    moved.y_m = y_m;
    ASSERT_TRUE(space.set_object(space.object(i), moved).ok());
  }
};

TEST(ThroughputHook, PutsWhatReachesTheNestBackToFreePlacesAtTheSource) {
  Counted c;
  c.object(-1.5, 0.0);
  c.object(-1.5, 0.5);
  c.object(0.0, 0.5);
  c.begin();
  steps(c.world, 1);
  EXPECT_NEAR(c.at(0).x_m, 1.0, 1e-9);
  EXPECT_NEAR(c.at(0).y_m, 0.0, 1e-9);
  EXPECT_NEAR(std::hypot(c.at(1).x_m - 1.0, c.at(1).y_m), 0.3, 1e-9);
  EXPECT_NEAR(c.at(2).x_m, 0.0, 1e-3);
}

TEST(ThroughputHook, CountsTheArrivalsOfTheWindow) {
  Counted c;
  c.object(-1.5, 0.0);
  c.begin();
  steps(c.world, 15);  // one in the first second
  c.put(0, -1.5, 0.0);
  steps(c.world, 25);  // one in the second second, none in the third and fourth
  c.world->finish();
  EXPECT_THAT(test::rows_of(c.csv),
              ElementsAre(ElementsAre(1, 1, 1), ElementsAre(2, 2, 2), ElementsAre(3, 1, 2), ElementsAre(4, 0, 2)));
}

TEST(ThroughputHook, WaitsUntilTheRobotLetsGo) {
  Counted c;
  add_footbot(c.scene, "fb", -1.4, 0.0);
  c.object(-1.4 + hal::footbot::kind().body.radius_m + 0.06 + 0.01, 0.0);
  c.begin();
  command<hal::GripperDrive>(c.world, "fb").unlock();
  c.put(0, 0.5, 0.0);
  steps(c.world, 2);
  c.put(0, -1.4 + hal::footbot::kind().body.radius_m + 0.06 + 0.01 + 0.5, 0.0);  // outside still
  Space& space = c.world->space();
  space.set_pose(space.find_robot("fb"), Pose::at(-0.9, 0.0, 0.0));
  command<hal::GripperDrive>(c.world, "fb").lock();
  steps(c.world, 3);
  ASSERT_TRUE(space.holding(space.find_robot("fb")));
  command<hal::WheelSpeeds>(c.world, "fb").set(-0.1, -0.1);  // drags it into the nest
  steps(c.world, 50);
  EXPECT_LT(c.at(0).x_m, -1.1);
  command<hal::WheelSpeeds>(c.world, "fb").set(0.0, 0.0);
  command<hal::GripperDrive>(c.world, "fb").unlock();
  steps(c.world, 3);
  EXPECT_NEAR(c.at(0).x_m, 1.0, 0.01);
}

TEST(ThroughputHook, CountsAnewAfterGoingBack) {
  Counted c;
  c.object(-1.5, 0.0);
  c.begin();
  const auto start = c.world->snapshot();
  ASSERT_TRUE(start.ok());
  steps(c.world, 12);
  ASSERT_TRUE(c.world->restore(start.value()).ok());
  steps(c.world, 10);
  c.world->finish();
  EXPECT_THAT(test::rows_of(c.csv), ElementsAre(ElementsAre(1, 1, 1)));
}

TEST(ThroughputHook, SaysWhenItsFileCannotBeWritten) {
  Counted c;
  c.csv = "/nowhere/there.csv";
  c.begin();
  steps(c.world, 1);
  c.world->finish();
  EXPECT_THAT(c.world->failure(), HasSubstr("/nowhere/there.csv"));
}

}  // namespace
}  // namespace tandem::core
