// Cameras in a whole world: closed forms, who hides whom against a plain test of every line with every body, noise, and
// what is refused.
#include "hal/device/cameras.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/watchers.hpp"

namespace tandem::core {
namespace {

namespace fb = hal::footbot;

const double kLedRing_m = fb::kind().body.radius_m + 0.005;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;
const double kReach_m =
    fb::kind().part<hal::OmniCameraPart>()->height_m * std::tan(fb::kind().part<hal::OmniCameraPart>()->aperture_rad);

MadeWorld made(const Scene& scene, const WorldOptions& options = {}) {
  auto world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (world.world) world->start();
  return world;
}

const hal::OmnidirectionalCamera& omni(const MadeWorld& world, const std::string& id) {
  return reading<hal::OmnidirectionalCamera>(world, id);
}
const hal::PerspectiveCamera& lens(const MadeWorld& world, const std::string& id) {
  return reading<hal::PerspectiveCamera>(world, id);
}

void look_ahead(hal::RobotKind& kind) {
  kind.part<hal::CameraPart>()->in_front = true;
}

Scene two(double x_m, double y_m, double heading_rad = 0.0) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0, heading_rad);
  add_footbot(scene, "lamp", x_m, y_m);
  return scene;
}

void beacon(const MadeWorld& world, const std::string& id, hal::Rgb color) {
  command<hal::RingLeds>(world, id).set(fb::kind().part<hal::LedsPart>()->beacon_led(), color);
}

// --- all around ---

TEST(OmnidirectionalCamera, TellsColourDistanceAndBearing) {
  auto world = made(two(-0.3, 0.4, 0.7));
  beacon(world, "lamp", {10, 20, 30});
  world->step();
  const auto& port = omni(world, "eye");
  ASSERT_EQ(port.count, 1U);
  EXPECT_EQ(port.color(0), (hal::Rgb{10, 20, 30}));
  EXPECT_NEAR(port.distance_m[0], 0.5, 1e-6);
  EXPECT_NEAR(port.bearing_rad[0], std::atan2(0.4, -0.3) - 0.7, 1e-6);
  EXPECT_EQ(port.validity, hal::Validity::Fresh);
  EXPECT_EQ(port.dropped, 0U);
}

TEST(OmnidirectionalCamera, SeesNothingThatIsOffAndNothingOfItself) {
  auto world = made(two(0.3, 0.0));
  shine(world, "eye", hal::kRed);
  world->step();
  EXPECT_EQ(omni(world, "eye").count, 0U);
  EXPECT_GT(omni(world, "lamp").count, 0U);
  shine(world, "eye", hal::kBlack);
  world->step();
  EXPECT_EQ(omni(world, "lamp").count, 0U);
}

TEST(OmnidirectionalCamera, SeesTheDiscThatItsApertureCovers) {
  for (const auto& [told_rad, reach_m] : {std::pair{-1.0, kReach_m}, std::pair{kPi / 3, 0.2887 * std::sqrt(3.0)}}) {
    const double aperture_rad = told_rad;  // a lambda takes no structured binding
    for (const double beyond_m : {-1e-3, 1e-3}) {
      Scene scene = two(reach_m + beyond_m, 0.0);
      if (aperture_rad > 0.0)
        scene.parts([&](hal::RobotKind& kind) { kind.part<hal::OmniCameraPart>()->aperture_rad = aperture_rad; });
      auto world = made(scene);
      beacon(world, "lamp", hal::kBlue);
      world->step();
      EXPECT_EQ(omni(world, "eye").count, beyond_m < 0.0 ? 1U : 0U) << aperture_rad;
    }
  }
}

TEST(OmnidirectionalCamera, SeesTheNearSideOfARing) {
  auto world = made(two(0.5, 0.0));
  shine(world, "lamp", hal::kGreen);
  world->step();
  // From 0.29 m up, the line to an LED falls into the robot's own body unless the LED is on this side of it.
  const auto& port = omni(world, "eye");
  ASSERT_EQ(port.count, 7U) << "six of twelve, and the beacon";
  for (std::size_t i = 1; i < port.count; ++i) EXPECT_GE(port.distance_m[i], port.distance_m[i - 1]);
  EXPECT_NEAR(port.distance_m[0], std::hypot(0.5 - kLedRing_m * std::cos(kPi / 12), 0.0233), 1e-3);
}

TEST(OmnidirectionalCamera, SeesTheRingTurnWithTheTurret) {
  auto world = made(two(0.5, 0.0));
  command<hal::RingLeds>(world, "lamp").set(0, hal::kRed);  // 15 degrees from ahead: hidden behind its own body
  world->step();
  EXPECT_EQ(omni(world, "eye").count, 0U);
  command<hal::TurretDrive>(world, "lamp").go_to(165.0 * kPi / 180.0);
  steps(world, 30);
  ASSERT_EQ(omni(world, "eye").count, 1U);
  EXPECT_NEAR(omni(world, "eye").distance_m[0], 0.5 - kLedRing_m, 1e-6);
  EXPECT_NEAR(omni(world, "eye").bearing_rad[0], 0.0, 1e-6);
}

TEST(OmnidirectionalCamera, KeepsTheNearestOfMany) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0);
  for (int i = 0; i < 16; ++i) {
    const double radius = i < 8 ? 0.3 : 0.6;
    const double angle = i * kPi / 4 + (i < 8 ? 0.0 : kPi / 8);
    add_footbot(scene, "r" + std::to_string(i), radius * std::cos(angle), radius * std::sin(angle), 0.1 * i);
  }
  auto world = made(scene);
  for (int i = 0; i < 16; ++i) shine(world, "r" + std::to_string(i), hal::kWhite);
  world->step();
  const auto& port = omni(world, "eye");
  EXPECT_EQ(port.count, hal::OmnidirectionalCamera::kCapacity);
  EXPECT_GT(port.dropped, 0U);
  for (std::size_t i = 1; i < port.count; ++i) EXPECT_GE(port.distance_m[i], port.distance_m[i - 1]);
  EXPECT_NEAR(port.distance_m[0], 0.3 - kLedRing_m, 0.01);
}

// --- who hides whom ---

struct Disc {
  double x, y, radius, low, high;
};

/// Whether a line passes through a body: 0 no, 1 yes, -1 too close to tell. By small steps.
int through(const Vec3& a, const Vec3& b, const Disc& c) {
  const int count = 1 + static_cast<int>(std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]) / 1e-3);
  double deepest = -1e9;
  for (int i = 0; i <= count; ++i) {
    const double t = static_cast<double>(i) / count;
    const double z = a[2] + t * (b[2] - a[2]);
    const double off = std::hypot(a[0] + t * (b[0] - a[0]) - c.x, a[1] + t * (b[1] - a[1]) - c.y);
    deepest = std::max(deepest, std::min({c.radius - off, c.high - z, z - c.low}));
  }
  return deepest > 2.5e-3 ? 1 : deepest < -1.5e-3 ? 0 : -1;
}

TEST(OmnidirectionalCamera, SeesWhatEveryLineWithEveryBodySays) {
  Scene scene = camera_scene(8.0);
  constexpr int kRobots = 70;
  for (int i = 0; i < kRobots; ++i) {
    const double angle = 2.39996 * i;
    const double radius = 0.14 * std::sqrt(i + 0.5);
    add_footbot(scene, "fb" + std::to_string(i), radius * std::cos(angle), radius * std::sin(angle), i);
  }
  auto world = made(scene);
  // Each shines with one LED of its ring, in a colour of its own.
  for (int i = 0; i < kRobots; ++i)
    command<hal::RingLeds>(world, "fb" + std::to_string(i))
        .set(static_cast<std::size_t>(i % 12), {static_cast<std::uint8_t>(i + 1), 0, 0});
  world->step();
  const Space& space = world->space();
  std::vector<Disc> bodies;
  std::vector<Vec3> leds;
  for (int i = 0; i < kRobots; ++i) {
    const Pose at = space.pose(space.robot(static_cast<std::size_t>(i)));
    const double bearing = at.heading_rad() + (15.0 + 30.0 * (i % 12)) * kPi / 180.0;
    bodies.push_back({at.x_m, at.y_m, fb::kind().body.radius_m, 0.0, fb::kind().body.height_m});
    leds.push_back({at.x_m + kLedRing_m * std::cos(bearing), at.y_m + kLedRing_m * std::sin(bearing), 0.085});
  }
  int seen = 0, hidden = 0;
  for (std::size_t i = 0; i < kRobots; ++i) {
    const Vec3 eye{bodies[i].x, bodies[i].y, fb::kind().part<hal::OmniCameraPart>()->height_m};
    const auto& port = omni(world, "fb" + std::to_string(i));
    ASSERT_EQ(port.dropped, 0U);
    for (std::size_t j = 0; j < kRobots; ++j) {
      const double range = std::hypot(leds[j][0] - eye[0], leds[j][1] - eye[1]);
      if (i == j || std::fabs(range - kReach_m) < 1e-3) continue;
      int behind = 0;
      for (std::size_t k = 0; k < kRobots && behind != 1; ++k) {
        const int one = k == i ? 0 : through(eye, leds[j], bodies[k]);
        if (one != 0) behind = one;
      }
      if (range < kReach_m && behind == -1) continue;
      const bool expected = range < kReach_m && behind == 0;
      bool found = false;
      for (std::size_t k = 0; k < port.count; ++k) found = found || port.color(k).r == j + 1;
      EXPECT_EQ(found, expected) << i << " and " << j;
      seen += expected ? 1 : 0;
      hidden += range < kReach_m && behind == 1 ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 100) << "the scene is no test otherwise";
  EXPECT_GT(hidden, 100);
}

TEST(OmnidirectionalCamera, IsBlockedByWhatIsHighEnough) {
  for (const double height_m : {0.1, 0.5}) {
    Scene scene = two(0.6, 0.0);
    scene.box(0.3, 0.0, 0.05, 0.3, 0.0, height_m);
    auto world = made(scene);
    beacon(world, "lamp", hal::kRed);
    world->step();
    EXPECT_EQ(omni(world, "eye").count, height_m < 0.2 ? 1U : 0U) << height_m;
  }
}

TEST(OmnidirectionalCamera, SeesTheLampsOfAnEpuck) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0);
  scene.robot("ep", 0.3, 0.0, kPi);
  scene.scenario.robots.back().controller = 1;
  auto world = made(scene);
  command<hal::BodyLed>(world, "ep").on = true;
  command<hal::FrontLed>(world, "ep").on = true;
  world->step();
  const auto& port = omni(world, "eye");
  ASSERT_EQ(port.count, 2U);
  EXPECT_EQ(port.color(0), hal::kRed);
  EXPECT_NEAR(port.distance_m[0], 0.3 - hal::epuck::kind().body.radius_m, 1e-6);
  EXPECT_EQ(port.color(1), hal::kGreen);
  EXPECT_NEAR(port.distance_m[1], 0.3, 1e-6);
}

TEST(OmnidirectionalCamera, ForgetsARobotThatIsRemoved) {
  auto world = made(two(0.4, 0.0));
  beacon(world, "lamp", hal::kRed);
  steps(world, 2);
  EXPECT_EQ(omni(world, "eye").count, 1U);
  world->space().remove_robot(world->space().find_robot("lamp"));
  world->step();
  EXPECT_EQ(omni(world, "eye").count, 0U);
}

// --- objects and lamps ---

TEST(Cameras, SeeTheLedsOfObjects) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0);
  scene.box(0.5, 0.2, 0.2, 0.1, kPi / 2, 0.15);
  add_led(scene, {0.1, 0.0, 0.15}, {1, 2, 3});   // turned with the box: 10 cm to the north
  add_led(scene, {-0.1, 0.0, 0.15}, {0, 0, 0});  // off
  scene.cylinder(-3.0, -3.0, 0.1);
  add_led(scene, {0.0, 0.0, 0.5}, {9, 9, 9});  // out of reach
  auto world = made(scene);
  world->step();
  const auto& port = omni(world, "eye");
  ASSERT_EQ(port.count, 1U);
  EXPECT_EQ(port.color(0), (hal::Rgb{1, 2, 3}));
  EXPECT_NEAR(port.distance_m[0], std::hypot(0.5, 0.3), 1e-6);
  EXPECT_NEAR(port.bearing_rad[0], std::atan2(0.3, 0.5), 1e-6);
}

TEST(Cameras, DoNotSeeThroughTheObjectThatBearsTheLed) {
  for (const double x_m : {-0.1, 0.1}) {
    Scene scene = camera_scene();
    add_footbot(scene, "eye", 0, 0);
    scene.cylinder(0.5, 0.0, 0.1);
    add_led(scene, {x_m, 0.0, 0.1}, {255, 0, 0});  // on its side
    auto world = made(scene);
    world->step();
    EXPECT_EQ(omni(world, "eye").count, x_m < 0.0 ? 1U : 0U);
  }
}

TEST(Cameras, SeeWhatHooksMakeOfLeds) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0);
  scene.box(0.5, 0.0, 0.1, 0.1, 0.0, 0.1);
  add_led(scene, {0.0, 0.0, 0.1}, {0, 0, 0});
  auto world = made(scene);
  world->step();
  EXPECT_EQ(omni(world, "eye").count, 0U);
  const std::uint64_t before = world->state_hash();
  Space& space = world->space();
  const ObjectId box = space.find_object("box0");
  ASSERT_TRUE(space.set_object_led(box, 0, hal::kBlue).ok());
  EXPECT_NE(world->state_hash(), before);
  world->step();
  ASSERT_EQ(omni(world, "eye").count, 1U);
  EXPECT_EQ(omni(world, "eye").color(0), hal::kBlue);
  Object moved = space.objects()[box.index];
  moved.x_m = 0.0;
  moved.y_m = -0.4;
  ASSERT_TRUE(space.set_object(box, moved).ok());
  world->step();
  ASSERT_EQ(omni(world, "eye").count, 1U);
  EXPECT_NEAR(omni(world, "eye").bearing_rad[0], -kPi / 2, 1e-6);
  EXPECT_THAT(space.set_object_led(box, 1, hal::kBlue).error().message, HasSubstr("has 1 LEDs"));
  space.remove_object(box);
  EXPECT_THAT(space.set_object_led(box, 0, hal::kBlue).error().message, HasSubstr("no such object"));
  world->step();
  EXPECT_EQ(omni(world, "eye").count, 0U);
}

TEST(Cameras, SeeMovableObjectsWhereTheyAre) {
  Scene scene = camera_scene();
  scene.scenario.engines.clear();
  scene.engine("dynamics2d");
  add_footbot(scene, "eye", 0, 0);
  scene.cylinder(0.5, 0.0, 0.05).movable(0.1);
  scene.scenario.objects.back().size[2] = 0.1;
  add_led(scene, {0.0, 0.0, 0.1}, {255, 0, 0});
  auto world = made(scene);
  Space& space = world->space();
  ASSERT_TRUE(space.set_object_velocity(space.object(0), {{0.0, 0.5, 0.0}, {}}).ok());
  world->step();
  world->step();
  ASSERT_EQ(omni(world, "eye").count, 1U);
  const Object& now = space.objects()[0];
  EXPECT_GT(now.y_m, 0.02);
  EXPECT_NEAR(omni(world, "eye").bearing_rad[0], std::atan2(now.y_m, now.x_m), 1e-6);
}

TEST(Cameras, SeeLampsBelowOrInTheImage) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0);
  LightItem low;
  low.id = "low";
  low.p_W = {0.3, 0.0, 0.2};
  low.rgb = {255, 0, 0};
  LightItem high = low;
  high.id = "high";
  high.p_W = {0.2, -0.1, 1.2887};
  high.rgb = {0, 255, 0};
  scene.scenario.lights = {low, high};
  auto world = made(scene);
  world->step();
  ASSERT_EQ(omni(world, "eye").count, 1U);
  EXPECT_EQ(omni(world, "eye").color(0), hal::kRed);
  // The other looks up: one metre above it, 0.2 m ahead is towards the image's bottom, 0.1 m to the right is right.
  const auto& port = lens(world, "eye");
  ASSERT_EQ(port.count, 1U);
  EXPECT_EQ(port.color(0), hal::kGreen);
  const double px_per_tangent = 400.0 / std::tan(kPi / 6);
  EXPECT_NEAR(port.x_px[0], 320.0 + 0.1 * px_per_tangent, 1e-3);
  EXPECT_NEAR(port.y_px[0], 240.0 + 0.2 * px_per_tangent, 1e-3);
  EXPECT_EQ(port.width_px, 640U);
  EXPECT_EQ(port.height_px, 480U);
}

TEST(Cameras, SeeOnlyTheirOwnMedium) {
  Scene scene = two(0.4, 0.0);
  scene.scenario.media = {{"range_and_bearing", "rab", {}, 0}, {"led", "a", {}, 0}, {"led", "b", {}, 0}};
  scene.box(0.0, 0.4, 0.1, 0.1, 0.0, 0.1);
  add_led(scene, {0.0, 0.0, 0.1}, {0, 0, 255}, "b");
  choose_everywhere(scene, "leds", "default", {{"medium", "a", 0}});
  for (const auto& [medium, expected] : {std::pair<std::string, unsigned>{"a", 1U}, {"b", 1U}, {"", 2U}}) {
    choose_everywhere(scene, "omnidirectional_camera", "default", {{"medium", medium, 0}});
    auto world = made(scene);
    beacon(world, "lamp", hal::kRed);
    world->step();
    const auto& port = omni(world, "eye");
    ASSERT_EQ(port.count, expected) << medium;
    if (expected == 1U) {
      EXPECT_EQ(port.color(0), medium == "a" ? hal::kRed : hal::kBlue);
    }
  }
}

// --- through a lens ---

TEST(PerspectiveCamera, LooksAheadAsAPinholeDoes) {
  Scene scene = two(1.0, 0.2);
  scene.parts(&look_ahead);
  auto world = made(scene);
  beacon(world, "lamp", hal::kRed);
  world->step();
  const auto& port = lens(world, "eye");
  ASSERT_EQ(port.count, 1U);
  const double depth = 1.0 - fb::kind().body.radius_m;
  const double px_per_tangent = 400.0 / std::tan(kPi / 6);  // half the image's diagonal is what the aperture spans
  EXPECT_NEAR(port.x_px[0], 320.0 - 0.2 / depth * px_per_tangent, 1e-3) << "left of the middle";
  EXPECT_NEAR(port.y_px[0], 240.0, 1e-3) << "as high as the lens";
  EXPECT_EQ(lens(world, "lamp").count, 0U) << "it looks away";
}

TEST(PerspectiveCamera, SeesAsFarAndAsWideAsItIsTold) {
  const auto count = [](double x_m, double y_m, double range_m, double aperture_rad) {
    Scene scene = two(x_m, y_m);
    scene.parts([&](hal::RobotKind& kind) {
      look_ahead(kind);
      auto& camera = *kind.part<hal::CameraPart>();
      camera.aperture_rad = aperture_rad;
      camera.focal_length_m = 0.05;
      camera.range_m = range_m;
    });
    auto world = made(scene);
    beacon(world, "lamp", hal::kRed);
    world->step();
    return lens(world, "eye").count;
  };
  const double from = fb::kind().body.radius_m;
  EXPECT_EQ(count(from + 1.0, 0.0, 1.01, 0.5), 1U);
  EXPECT_EQ(count(from + 1.0, 0.0, 0.99, 0.5), 0U);
  const double half_width = 0.8 * std::tan(0.5);  // 640 of the diagonal's 800
  EXPECT_EQ(count(from + 1.0, half_width - 0.01, 2.0, 0.5), 1U);
  EXPECT_EQ(count(from + 1.0, half_width + 0.01, 2.0, 0.5), 0U);
  EXPECT_EQ(count(from + 1.0, half_width + 0.01, 2.0, 0.55), 1U);
}

TEST(PerspectiveCamera, LooksDownFromAnEyebot) {
  Scene scene = camera_scene();
  scene.engine("particle3d");
  scene.flyer("high", 0.0, 0.0, 2.0, kPi / 2);
  add_footbot(scene, "lamp", -0.1, 0.3);
  scene.scenario.robots.back().controller = 0;
  auto world = made(scene);
  beacon(world, "lamp", hal::kRed);
  world->step();
  const auto& port = lens(world, "high");
  const Pose at = world->space().pose(world->space().find_robot("high"));
  ASSERT_EQ(port.count, 1U);
  // Northwards is ahead: towards the image's top. Westwards is to its left.
  const double depth = at.z_m - fb::kind().part<hal::LedsPart>()->mounts.back().z_m;
  const double px_per_tangent = 400.0 / std::tan(kPi / 6);
  EXPECT_NEAR(port.x_px[0], 320.0 - (0.1 + at.x_m) / depth * px_per_tangent, 0.01);
  EXPECT_NEAR(port.y_px[0], 240.0 - (0.3 - at.y_m) / depth * px_per_tangent, 0.01);
}

TEST(PerspectiveCamera, IsBlockedByBodiesAndPutsTheNearestFirst) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0, 0);
  add_footbot(scene, "near", 0.6, 0.0);
  add_footbot(scene, "far", 1.2, 0.02);
  add_footbot(scene, "aside", 1.0, 0.25);
  scene.parts(&look_ahead);
  auto world = made(scene);
  // LEDs straight behind: on the side that faces the camera.
  command<hal::RingLeds>(world, "near").set(5, hal::kRed);
  command<hal::RingLeds>(world, "far").set(5, hal::kGreen);
  command<hal::RingLeds>(world, "aside").set(6, hal::kBlue);
  world->step();
  const auto& port = lens(world, "eye");
  ASSERT_EQ(port.count, 2U) << "a foot-bot hides the ring of one behind it";
  EXPECT_EQ(port.color(0), hal::kRed);
  EXPECT_EQ(port.color(1), hal::kBlue);
}

// --- noise ---

TEST(Cameras, NoiseHasTheDeviationThatWasAskedFor) {
  Scene scene = two(0.5, 0.0);
  scene.parts(&look_ahead);
  choose_everywhere(scene, "omnidirectional_camera", "noisy", {{"noise_std_dev", "0.02", 0}, {"miss_prob", "0.25", 0}});
  choose_everywhere(scene, "perspective_camera", "default", {{"noise_std_dev", "3", 0}});
  auto world = made(scene);
  beacon(world, "lamp", hal::kRed);
  constexpr int kSteps = 4000;
  int seen = 0;
  double sum_x = 0.0, sum_xx = 0.0, sum_y = 0.0, sum_yy = 0.0, sum_px = 0.0, sum_pxpx = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    world->step();
    ASSERT_EQ(lens(world, "eye").count, 1U);
    const double px = static_cast<double>(lens(world, "eye").x_px[0]) - 320.0;
    sum_px += px;
    sum_pxpx += px * px;
    const auto& port = omni(world, "eye");
    if (port.count == 0) continue;
    ++seen;
    const double x = static_cast<double>(port.distance_m[0]) * std::cos(static_cast<double>(port.bearing_rad[0])) - 0.5;
    const double y = static_cast<double>(port.distance_m[0]) * std::sin(static_cast<double>(port.bearing_rad[0]));
    sum_x += x;
    sum_xx += x * x;
    sum_y += y;
    sum_yy += y * y;
  }
  EXPECT_NEAR(static_cast<double>(seen) / kSteps, 0.75, 0.03);
  EXPECT_NEAR(sum_x / seen, 0.0, 0.002);
  EXPECT_NEAR(sum_y / seen, 0.0, 0.002);
  EXPECT_NEAR(std::sqrt(sum_xx / seen), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(sum_yy / seen), 0.02, 0.001);
  EXPECT_NEAR(sum_px / kSteps, 0.0, 0.25);
  EXPECT_NEAR(std::sqrt(sum_pxpx / kSteps), 3.0, 0.15);
}

TEST(Lamps, DifferInBrightnessAndSomeAreDead) {
  constexpr int kPairs = 24;  // along each side: one that looks at one that shines, 1.6 m from the next
  Scene scene = camera_scene(40.0);
  choose_everywhere(scene, "leds", "noisy", {{"brightness_std_dev", "0.1", 11}, {"dead_prob", "0.2", 11}});
  for (int k = 0; k < kPairs * kPairs; ++k) {
    const double x = 1.6 * (k % kPairs) - 18.4;
    const double y = 1.6 * (k / kPairs) - 18.4;
    add_footbot(scene, "eye" + std::to_string(k), x, y);
    add_footbot(scene, "lamp" + std::to_string(k), x + 0.3, y);
  }
  auto world = made(scene);
  int dead = 0, lit = 0;
  double sum = 0.0, squares = 0.0;
  for (int round = 0; round < 2; ++round) {
    for (int k = 0; k < kPairs * kPairs; ++k) beacon(world, "lamp" + std::to_string(k), {75, 75, 150});
    std::vector<int> before;
    for (int k = 0; k < kPairs * kPairs; ++k) {
      const auto& port = omni(world, "eye" + std::to_string(k));
      before.push_back(port.count == 0 ? -1 : port.color(0).b);
    }
    world->step();
    for (int k = 0; k < kPairs * kPairs; ++k) {
      const auto& port = omni(world, "eye" + std::to_string(k));
      const int seen = port.count == 0 ? -1 : port.color(0).b;
      if (round == 1) {
        EXPECT_EQ(seen, before[static_cast<std::size_t>(k)]) << "lamps keep their faults";
        continue;
      }
      if (seen < 0) {
        ++dead;
        continue;
      }
      EXPECT_NEAR(port.color(0).r, seen / 2.0, 0.76);  // one factor for all colours
      ++lit;
      sum += seen / 150.0;
      squares += (seen / 150.0 - 1.0) * (seen / 150.0 - 1.0);
    }
  }
  const double n = kPairs * kPairs;
  EXPECT_NEAR(dead / n, 0.2, 4.0 * std::sqrt(0.2 * 0.8 / n));
  EXPECT_NEAR(sum / lit, 1.0, 4.0 * 0.1 / std::sqrt(lit));
  EXPECT_NEAR(std::sqrt(squares / lit), 0.1, 4.0 * 0.1 / std::sqrt(2.0 * lit));
}

TEST(Cameras, SeeTheSameWithAnyNumberOfThreads) {
  const auto seen = [](std::int64_t threads) {
    Scene scene = camera_scene(10.0);
    for (int i = 0; i < 600; ++i)
      add_footbot(scene, "fb" + std::to_string(i), 0.3 * (i % 25) - 3.6, 0.3 * (i / 25) - 3.6, 0.7 * i);
    choose_everywhere(scene, "omnidirectional_camera", "noisy");
    choose_everywhere(scene, "perspective_camera", "noisy");
    WorldOptions options;
    options.threads = threads;
    auto world = made(scene, options);
    for (int i = 0; i < 600; i += 3) {
      shine(world, "fb" + std::to_string(i), hal::kRed);
      command<hal::WheelSpeeds>(world, "fb" + std::to_string(i)).set(0.1, 0.05);
    }
    steps(world, 5);
    std::string text;
    for (int i = 0; i < 600; ++i)
      text += hal::to_text(hal::port_type<hal::OmnidirectionalCamera>(), &omni(world, "fb" + std::to_string(i)));
    return text;
  };
  const std::string one = seen(1);
  EXPECT_THAT(one, HasSubstr("255"));
  EXPECT_EQ(one, seen(3));
}

// --- what is refused ---

TEST(Cameras, BadOptionsAreErrorsWithTheirLine) {
  Scene scene = two(0.5, 0.0);
  choose_everywhere(scene, "omnidirectional_camera", "default", {{"noise_std_dev", "-1", 12}, {"apperture", "1", 13}});
  auto world = make(scene);
  EXPECT_FALSE(world.world);
  EXPECT_THAT(world.all_problems(), HasSubstr("scene:12: error"));
  EXPECT_THAT(world.all_problems(), HasSubstr("scene:13: error"));
  choose_everywhere(scene, "omnidirectional_camera", "ideal", {{"noise_std_dev", "0.1", 14}});
  EXPECT_THAT(make(scene).all_problems(), HasSubstr("scene:14: error"));
  choose_everywhere(scene, "omnidirectional_camera", "medium");
  EXPECT_THAT(make(scene).all_problems(), HasSubstr("default, ideal, noisy, rot_z_only"));
}

TEST(Cameras, RobotsWithoutOneAreRefused) {
  Scene scene = camera_scene();
  scene.robot("ep", 0, 0);  // with the foot-bots' configuration
  EXPECT_THAT(make(scene).all_problems(), HasSubstr("'e-puck' has no device 'omnidirectional_camera'"));
}

// --- ports ---

TEST(OmnidirectionalCamera, MergesRealAndVirtualBlobsByDistance) {
  hal::OmnidirectionalCamera real, other;
  real.validity = other.validity = hal::Validity::Fresh;
  real.insert(0.2F, 0.1F, hal::kRed);
  real.insert(0.6F, 0.2F, hal::kGreen);
  other.insert(0.4F, 0.3F, hal::kBlue);
  hal::fuse(hal::port_type<hal::OmnidirectionalCamera>(), &real, &other);
  ASSERT_EQ(real.count, 3U);
  EXPECT_EQ(real.color(1), hal::kBlue);
  EXPECT_FLOAT_EQ(real.bearing_rad[2], 0.2F);
  const auto& type = hal::port_type<hal::OmnidirectionalCamera>();
  EXPECT_EQ(hal::used_count(type, &real, *type.field("rgb")), 9U) << "three numbers a blob";
}

TEST(PerspectiveCamera, CountsWhatDoesNotFit) {
  hal::PerspectiveCamera port;
  for (std::size_t i = 0; i < hal::PerspectiveCamera::kCapacity + 5; ++i) port.append(1.0F, 2.0F, hal::kRed);
  EXPECT_EQ(port.count, hal::PerspectiveCamera::kCapacity);
  EXPECT_EQ(port.dropped, 5U);
}

}  // namespace
}  // namespace tandem::core
