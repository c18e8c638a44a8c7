// What layers draw, against closed forms; which are on; what happens to those that throw.
#include "core/view/layers/layers.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>
#include <stdexcept>

#include "core/view/layers/layer_set.hpp"
#include "core/view/layers/segments.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/time_of_flight.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/epuck2.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/eyebots.hpp"
#include "tests/core/watchers.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;
using Shape = Sketch::Shape;
using Point = Sketch::Point;

class Thrower final : public Layer {
 public:
  void draw(const LayerView& now, Sketch& out) override {
    out.circle({}, 1.0);
    if (now.tick >= 2) throw std::runtime_error("no more");
  }
};
class Counter final : public Layer {
 public:
  void panel(const LayerView& now, Panel& out) override { out.row("robots", static_cast<double>(now.robots.size())); }
};

const hal::Catalog& catalog() {
  static const hal::Catalog all = [] {
    hal::Catalog made = test::catalog();
    const hal::Status good = made.add_from("tests of layers", [](hal::Registrar& r) {
      register_layers(r);
      static const LayerType thrower = layer_type<Thrower>("thrower", "Throws.");
      static const LayerType counter = layer_type<Counter>("counter", "Counts.");
      r.add(thrower);
      r.add(counter);
    });
    EXPECT_TRUE(good.ok());
    return made;
  }();
  return all;
}

Observation now(const MadeWorld& world) {
  return {world->space(), world->measures(), std::max<hal::Tick>(0, world->tick() - 1), world->ticks_per_second(),
          world->seed()};
}

MadeWorld made(const Scene& scene) {
  auto world = make(scene, {}, catalog());
  EXPECT_TRUE(world.world) << world.all_problems();
  if (world.world) world->start();
  return world;
}

/// What one layer draws now of one robot.
std::vector<Shape> drawn(const MadeWorld& world, const std::string& layer, const std::string& robot = "*") {
  LayerSet layers(catalog());
  EXPECT_TRUE(layers.switch_on({layer}).ok());
  layers.choose_robots({robot});
  auto shown = layers.show(now(world));
  return shown.empty() ? std::vector<Shape>{} : shown.front().sketch.shapes();
}

double length_m(const Shape& line) {
  const Point& a = line.points.front();
  const Point& b = line.points.back();
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m, b.z_m - a.z_m);
}

/// How far `p` is from the straight line through the ends of `line`.
double aside_m(const Shape& line, const Point& p) {
  const Point& a = line.points.front();
  const Point& b = line.points.back();
  const double length = length_m(line);
  const double u[3] = {(b.x_m - a.x_m) / length, (b.y_m - a.y_m) / length, (b.z_m - a.z_m) / length};
  const double w[3] = {p.x_m - a.x_m, p.y_m - a.y_m, p.z_m - a.z_m};
  return std::hypot(w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]);
}

// --- sensors ---

TEST(ProximityLayer, RaysEndAtTheWallOrAtTheEndOfTheirRange) {
  const auto& part = *hal::epuck::kind().part<hal::ProximityPart>();
  for (const double heading_rad : {0.0, 0.7, -2.0}) {
    Scene scene(4.0, "everything");
    const auto world = made(scene.robot("ep", 0.0, 0.0, heading_rad).box(0.165, 0.0, 0.2, 2.0));
    world->step();
    const auto rays = drawn(world, "proximity");
    ASSERT_EQ(rays.size(), part.mounts.size());
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Point& from = rays[i].points.front();
      const Point& to = rays[i].points.back();
      const double way_rad = heading_rad + part.mounts[i].bearing_rad;
      EXPECT_NEAR(std::hypot(from.x_m, from.y_m), std::hypot(part.mounts[i].x_m, part.mounts[i].y_m), 1e-9);
      EXPECT_NEAR(from.z_m, part.mounts[i].z_m, 1e-9);
      EXPECT_NEAR(to.z_m, from.z_m, 1e-9);
      const double to_wall_m = std::cos(way_rad) > 0.0 ? (0.065 - from.x_m) / std::cos(way_rad) : 1e9;
      EXPECT_NEAR(length_m(rays[i]), std::min(to_wall_m, part.range_m), 1e-5) << i;
      const bool hit = to_wall_m < part.range_m;
      EXPECT_EQ(rays[i].pen.color == ink::kRed, hit);
      EXPECT_EQ(rays[i].pen.opacity == 1.0, hit) << "the others are faint";
      hits += hit ? 1 : 0;
    }
    EXPECT_GT(hits, 0);
  }
}

TEST(ProximityLayer, HasNoRaysOfSensorsThatTheControllerDidNotTake) {
  Scene scene;
  const auto world = made(scene.robot("ep", 0.0, 0.0));
  world->step();
  EXPECT_TRUE(drawn(world, "proximity").empty());
  EXPECT_TRUE(drawn(world, "cameras").empty());
}

TEST(ScannerLayer, RaysEndAtTheWallAtTheHeightOfTheHeads) {
  Scene scene = footbot_scene("dynamics2d");
  add_footbot(scene, "fb", 0.0, 0.0, 0.3);
  const auto world = made(scene.box(0.9, 0.0, 0.2, 3.6));
  command<hal::ScannerDrive>(world, "fb").turn(3.0);
  steps(world, 3);
  const double height_m = hal::footbot::kind().part<hal::ScannerPart>()->height_m;
  const auto rays = drawn(world, "distance_scanner");
  ASSERT_EQ(rays.size(), reading<hal::DistanceScanner>(world, "fb").count);
  int hits = 0;
  for (const Shape& ray : rays) {
    EXPECT_NEAR(ray.points.front().x_m, 0.0, 1e-9);
    EXPECT_NEAR(ray.points.front().z_m, height_m, 1e-9);
    EXPECT_LT(ray.points.back().x_m, 0.8 + 1e-3);
    if (ray.pen.color != ink::kPurple || ray.points.back().x_m < 0.5) continue;
    EXPECT_NEAR(ray.points.back().x_m, 0.8, 1e-3);
    ++hits;
  }
  EXPECT_GT(hits, 0);
}

TEST(TimeOfFlightLayer, TheConeEndsAtTheNearestThing) {
  Scene scene(10.0, "epuck2_puppet");
  scene.scenario.controllers.back().sensors.clear();
  for (const char* name : {"gyroscope", "time_of_flight", "cliff", "selector"})
    scene.scenario.controllers.back().sensors.push_back({name, "default", {}});
  scene.scenario.controllers.back().actuators = {{"differential_steering", "default", {}}};
  scene.robot("ep", 0.0, 0.0).scenario.robots.back().kind = "e-puck2";
  const auto world = made(scene.box(1.5, 0.0, 0.2, 4.0));
  world->step();
  const auto& part = *hal::epuck2::kind().part<hal::TimeOfFlightPart>();
  const auto cones = drawn(world, "time_of_flight");
  ASSERT_EQ(cones.size(), 1U);
  const auto& corners = cones[0].points;
  ASSERT_EQ(corners.size(), 6U);
  EXPECT_NEAR(corners[0].x_m, part.mount.x_m, 1e-9);
  EXPECT_NEAR(corners[3].x_m, 1.4, 1e-3) << "the middle of the arc";
  EXPECT_NEAR(corners[3].y_m, 0.0, 1e-9);
  EXPECT_NEAR(std::atan2(corners[1].y_m, corners[1].x_m - part.mount.x_m), -0.5 * part.cone_rad, 1e-9);
}

TEST(LightLayer, StrokesAreAsLongAsTheReadings) {
  Scene scene(4.0, "everything");
  const auto world = made(scene.robot("ep", 0.0, 0.0));
  world->step();
  auto& port = *world->space().port<hal::Light>(world->space().robot(0));
  port.level.fill(0.0F);
  port.level[2] = 0.5F;
  const auto strokes = drawn(world, "light");
  ASSERT_EQ(strokes.size(), 1U);
  EXPECT_NEAR(length_m(strokes[0]), hal::epuck::kind().body.radius_m, 1e-9) << "half of the body's width";
}

TEST(RangeAndBearingLayer, IsHalfALineFromTheHearerAndAWholeOneWhereBothHear) {
  Scene scene = footbot_scene("dynamics2d");
  add_footbot(scene, "a", -0.5, 0.1, 0.4);
  add_footbot(scene, "b", 0.5, -0.1, 2.4);
  const auto world = made(scene);
  command<hal::RangeAndBearingSend>(world, "a").say(7);
  steps(world, 2);
  EXPECT_TRUE(drawn(world, "range_and_bearing", "a").empty()) << "nobody has said anything to it";
  const auto one = drawn(world, "range_and_bearing");
  ASSERT_EQ(one.size(), 1U);
  EXPECT_NEAR(one[0].points.front().x_m, 0.5, 1e-6);
  EXPECT_NEAR(one[0].points.front().y_m, -0.1, 1e-6);
  EXPECT_NEAR(one[0].points.back().x_m, 0.0, 1e-6);
  EXPECT_NEAR(one[0].points.back().y_m, 0.0, 1e-6);
  command<hal::RangeAndBearingSend>(world, "b").say(8);
  steps(world, 2);
  EXPECT_EQ(drawn(world, "range_and_bearing").size(), 2U);
}

TEST(CamerasLayer, TheOmnidirectionalCamerasLinesEndBeneathTheLamps) {
  Scene scene = camera_scene();
  add_footbot(scene, "eye", 0.2, 0.0, 0.9);
  add_footbot(scene, "lamp", 0.5, -0.4);
  const auto world = made(scene);
  const auto& leds = *hal::footbot::kind().part<hal::LedsPart>();
  command<hal::RingLeds>(world, "lamp").set(leds.beacon_led(), {10, 200, 30});
  world->step();
  const auto shapes = drawn(world, "cameras", "eye");
  ASSERT_EQ(shapes.size(), 2U + 5U) << "and where its other camera looks";
  const auto& camera = *hal::footbot::kind().part<hal::OmniCameraPart>();
  EXPECT_EQ(shapes[0].kind, Shape::Kind::Circle);
  EXPECT_NEAR(shapes[0].radius_m, camera.height_m * std::tan(camera.aperture_rad), 1e-9);
  EXPECT_NEAR(shapes[1].points.back().x_m, 0.5, 1e-6);
  EXPECT_NEAR(shapes[1].points.back().y_m, -0.4, 1e-6);
  EXPECT_EQ(shapes[1].pen.color, (hal::Rgb{10, 200, 30}));
}

TEST(CamerasLayer, LinesThroughALensMeetTheLampsWhereverTheHeadLooks) {
  for (const bool turned : {false, true}) {
    Scene scene = eyebot_scene();
    scene.box(0.3, -0.2, 0.02, 0.02, 0.0, 0.01).flyer("eye", 0.0, 0.0, 2.0, 0.8);
    add_led(scene, {0.0, 0.0, 0.02}, {0, 255, 0});
    const auto world = made(scene);
    if (turned) {
      command<hal::PanTiltDrive>(world, "eye").pan_rad = -1.0;
      command<hal::PanTiltDrive>(world, "eye").tilt_rad = 0.2;
    }
    steps(world, 30);
    const auto shapes = drawn(world, "cameras", "eye");
    ASSERT_EQ(shapes.size(), 6U) << "the picture's edge, four lines to its corners, a blob";
    EXPECT_EQ(shapes[0].kind, Shape::Kind::Polygon);
    for (const Point& corner : shapes[0].points) EXPECT_NEAR(corner.z_m, 0.0, 1e-9) << "on the ground";
    EXPECT_LT(aside_m(shapes[5], {0.3, -0.2, 0.02}), 1e-3);
    EXPECT_EQ(shapes[5].pen.color, (hal::Rgb{0, 255, 0}));
  }
}

// --- bodies ---

TEST(TrailsLayer, BeginWhereTheLayerWasSwitchedOnAndEndAtTheRobot) {
  Scene scene;
  const auto world = made(scene.robot("ep", -0.5, 0.0).wheels(0.05, 0.05));
  LayerSet layers(catalog());
  ASSERT_TRUE(layers.switch_on({"trails"}).ok());
  for (int i = 0; i < 20; ++i) {
    world->step();
    layers.note(now(world));
  }
  const auto shown = layers.show(now(world));
  ASSERT_EQ(shown.size(), 1U);
  ASSERT_EQ(shown[0].sketch.shapes().size(), 1U);
  const Shape path = shown[0].sketch.shapes()[0];
  EXPECT_NEAR(path.points.front().x_m, -0.5 + 0.05 * 0.1, 1e-2);
  EXPECT_NEAR(path.points.back().x_m, pose_of(world, "ep").x_m, 1e-12);
  EXPECT_EQ(path.points.size(), 20U);
  Observation earlier = now(world);
  earlier.tick = 3;
  layers.note(earlier);
  EXPECT_TRUE(layers.show(earlier)[0].sketch.shapes().empty()) << "the run went back: a new trail";
}

TEST(VelocityLayer, PointsToWhereTheRobotWouldBeInASecond) {
  Scene scene;
  const auto world =
      made(scene.robot("ep", 0.0, 0.0, 0.5 * std::numbers::pi).wheels(0.1, 0.1).robot("still", 1, 1).wheels(0, 0));
  steps(world, 5);
  EXPECT_TRUE(drawn(world, "velocity", "still").empty());
  const auto arrow = drawn(world, "velocity", "ep");
  ASSERT_EQ(arrow.size(), 3U);
  EXPECT_NEAR(length_m(arrow[0]), 0.1, 1e-3);
  EXPECT_NEAR(arrow[0].points.back().y_m - arrow[0].points.front().y_m, 0.1, 1e-3);
  EXPECT_LT(arrow[1].points.back().y_m, arrow[1].points.front().y_m) << "barbs go back";
}

TEST(OtherLayers, HaveIdsAndWhatHooksDrewAndPublished) {
  Scene scene;
  const auto world = made(scene.robot("ep", 0.3, 0.4));
  world->step();
  world->space().sketch().line({0, 0}, {1, 1, 0.5});
  const auto ids = drawn(world, "ids");
  ASSERT_EQ(ids.size(), 1U);
  EXPECT_EQ(ids[0].text, "ep");
  EXPECT_NEAR(ids[0].points[0].z_m, hal::epuck::kind().body.height_m, 1e-9);
  const auto hooks = drawn(world, "hooks");
  ASSERT_EQ(hooks.size(), 1U);
  EXPECT_EQ(hooks[0].points[1].z_m, 0.5);
  Measures measures;
  measures.set("food", 12.5);
  LayerSet layers(catalog());
  ASSERT_TRUE(layers.switch_on({"measures"}).ok());
  const auto shown = layers.show({world->space(), measures});
  ASSERT_EQ(shown.size(), 1U);
  ASSERT_TRUE(shown[0].panel);
  EXPECT_EQ(shown[0].panel->rows()[0].label, "food");
  EXPECT_EQ(shown[0].panel->rows()[0].value, "12.5");
}

// --- which are on ---

TEST(LayerSet, KnowsWhatEachLayerHas) {
  const LayerSet layers(catalog());
  for (const LayerType* type : layers.types()) {
    EXPECT_FALSE(type->summary.empty()) << type->name;
    EXPECT_EQ(type->panels, type->name == "measures" || type->name == "counter") << type->name;
    EXPECT_EQ(type->draws, !type->panels) << type->name;
    EXPECT_EQ(type->notes, type->name == "trails") << type->name;
  }
}

TEST(LayerSet, RefusesNamesThatAreNoneAndStaysAsItWas) {
  LayerSet layers(catalog());
  ASSERT_TRUE(layers.switch_on({"ids", "velocity"}).ok());
  const hal::Status wrong = layers.switch_on({"ids", "proximty"});
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().message, HasSubstr("Did you mean 'proximity'?"));
  EXPECT_EQ(layers.on().size(), 2U);
  ASSERT_TRUE(layers.switch_on({}).ok());
  EXPECT_FALSE(layers.any_on());
}

TEST(LayerSet, AsksForTheRobotsThatAreChosen) {
  Scene scene;
  const auto world = made(scene.robot("ep1", 0, 0).robot("ep2", 0.5, 0).robot("other", 1, 0));
  world->step();
  EXPECT_EQ(drawn(world, "ids").size(), 3U);
  EXPECT_EQ(drawn(world, "ids", "ep*").size(), 2U);
  EXPECT_EQ(drawn(world, "ids", "ep2").size(), 1U);
  EXPECT_EQ(drawn(world, "ids", "gone").size(), 0U);
}

TEST(LayerSet, ALayerThatThrowsIsNamedOnceAndOffWhileOthersGoOn) {
  Scene scene;
  const auto world = made(scene.robot("ep", 0, 0));
  std::vector<std::string> told;
  LayerSet layers(catalog(), hal::Log([&](hal::Severity, std::string_view text) { told.emplace_back(text); }));
  ASSERT_TRUE(layers.switch_on({"thrower", "ids", "counter"}).ok());
  for (int i = 0; i < 6; ++i) {
    world->step();
    EXPECT_EQ(layers.show(now(world)).size(), i < 2 ? 3U : 2U);
  }
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told[0], testing::AllOf(HasSubstr("layer 'thrower'"), HasSubstr("no more"), HasSubstr("it is off")));
  EXPECT_THAT(layers.switch_on({"thrower"}).error().message, HasSubstr("has failed"));
  EXPECT_EQ(layers.on().size(), 2U);
}

TEST(LayerSet, ChangesNoBitOfTheRun) {
  Scene scene = footbot_scene("dynamics2d");
  for (int i = 0; i < 6; ++i) add_footbot(scene, "fb" + std::to_string(i), 0.4 * i - 1.0, 0.1 * (i % 2), 0.3 * i);
  const auto drive = [](const MadeWorld& world, LayerSet* layers) {
    for (int i = 0; i < 6; ++i) {
      command<hal::RangeAndBearingSend>(world, "fb" + std::to_string(i)).say(static_cast<std::uint8_t>(i));
      command<hal::ScannerDrive>(world, "fb" + std::to_string(i)).turn(2.0);
      command<hal::WheelSpeeds>(world, "fb" + std::to_string(i)).set(0.1, 0.05 + 0.01 * i);
    }
    for (int i = 0; i < 20; ++i) {
      world->step();
      if (layers == nullptr) continue;
      layers->note(now(world));
      EXPECT_FALSE(layers->show(now(world)).empty());
    }
    return world->state_hash();
  };
  LayerSet layers(catalog());
  std::vector<std::string> all;
  for (const LayerType* type : layers.types()) all.emplace_back(type->name);
  ASSERT_TRUE(layers.switch_on(all).ok());
  EXPECT_EQ(drive(made(scene), &layers), drive(made(scene), nullptr));
}

// --- segments ---

TEST(Segments, AreTheStraightPiecesOfEveryShapeWithItsColour) {
  Sketch sketch;
  sketch.line({0, 0}, {1, 2, 3}, {{1, 2, 3}, 0.0, false, 0.5});
  sketch.polygon(std::vector<Point>{{0, 0}, {1, 0}, {1, 1}}, {});
  sketch.circle({1, 1, 0.25}, 2.0);
  sketch.text({4, 5, 6}, "here");
  const auto segments = segments_of(sketch);
  ASSERT_EQ(segments.size(), 1U + 3U + 24U);
  EXPECT_EQ(segments[0].x2, 1.0F);
  EXPECT_EQ(segments[0].z2, 3.0F);
  EXPECT_EQ(segments[0].g, 2);
  EXPECT_EQ(segments[0].a, 128);
  EXPECT_EQ(segments[3].x2, 0.0F) << "closed";
  EXPECT_EQ(segments[3].a, 255);
  for (std::size_t i = 4; i < segments.size(); ++i) {
    EXPECT_NEAR(std::hypot(segments[i].x1 - 1.0F, segments[i].y1 - 1.0F), 2.0, 1e-5);
    const double middle_m =
        std::hypot(0.5F * (segments[i].x1 + segments[i].x2) - 1.0F, 0.5F * (segments[i].y1 + segments[i].y2) - 1.0F);
    EXPECT_GT(middle_m, 0.99 * 2.0);
    EXPECT_EQ(segments[i].z1, 0.25F);
  }
  const auto texts = texts_of(sketch);
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0].text, "here");
  EXPECT_EQ(texts[0].at.z_m, 6.0);
}

}  // namespace
}  // namespace tandem::core
