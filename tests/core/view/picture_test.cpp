#include "core/view/picture.hpp"

#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "core/field/floor/floor.hpp"
#include "core/space/stores.hpp"
#include "hal/device/leds.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/space_by_hand.hpp"
#include "tests/core/view/well_formed.hpp"

namespace tandem::core {
namespace {

void set_up(Space& space) {
  SpaceStores& s = space.stores();
  s.min_x_m = -2.0;
  s.max_x_m = 2.0;
  s.min_y_m = -1.0;
  s.max_y_m = 3.0;
  add_robot(space, hal::epuck::kind(), "ep0", 0.5, 0.25, 1.0, {&hal::port_type<hal::RingLeds>()});
  const RobotId real = add_robot(space, hal::epuck::kind(), "gina", -1.0, 0.0, -3.0);
  space.set_external(real, true);
}

TEST(Picture, TakesArenaRobotsAndTitleFromTheSpace) {
  Space space;
  set_up(space);
  space.port<hal::RingLeds>(space.robot(0))->set(5, hal::kGreen);
  const Drawing d = drawing_of(space, {.experiment = "mixed", .seed = 42, .time_ns = 1'500'000'000});
  EXPECT_EQ(d.title, "mixed, seed 42, t = 1.5 s");
  EXPECT_DOUBLE_EQ(d.min_x_m, -2.0);
  EXPECT_DOUBLE_EQ(d.max_y_m, 3.0);
  ASSERT_EQ(d.kinds.size(), 1U);
  EXPECT_EQ(d.kinds[0].name, "e-puck");
  ASSERT_EQ(d.robots.size(), 2U);
  EXPECT_NEAR(d.robots[0].heading_rad, 1.0, 1e-12);
  ASSERT_EQ(d.robots[0].lights, 1U);
  EXPECT_EQ(d.lit[0].lamp, 5U);
  EXPECT_EQ(d.lit[0].color, hal::kGreen);
  EXPECT_EQ(d.robots[1].lights, 0U);
  EXPECT_FALSE(d.floor);
}

TEST(Picture, TakesTurretsAndGrippersFromTheSpace) {
  Space space;
  set_up(space);
  add_robot(space, hal::footbot::kind(), "fb", 1.0, 1.0, 0.0, {&hal::port_type<hal::RingLeds>()});
  add_state<TurretState>(space, space.robot(2)).angle_rad = -0.75;
  add_state<GripState>(space, space.robot(2)).joint = 0;
  space.port<hal::RingLeds>(space.robot(2))->set(hal::footbot::kind().part<hal::LedsPart>()->beacon_led(), hal::kBlue);
  const Drawing d = drawing_of(space, {});
  ASSERT_EQ(d.kinds.size(), 2U);
  const auto coarse = [&d](std::size_t kind) {
    std::vector<hal::Appearance::Link> links = d.kinds[kind].look.links;
    std::erase_if(links, [](const hal::Appearance::Link& link) { return link.fine; });
    return links;
  };
  EXPECT_TRUE(coarse(0).empty());
  ASSERT_EQ(d.kinds[1].look.joints.size(), 1U);
  ASSERT_EQ(coarse(1).size(), 1U);
  EXPECT_EQ(coarse(1)[0].joint, 0);
  ASSERT_EQ(d.robots.size(), 3U);
  EXPECT_EQ(d.robots[2].first_value, 0U) << "nothing moves on the others";
  EXPECT_EQ(d.values, (std::vector<double>{-0.75, 1.0})) << "where the turret is, and that the gripper holds something";
  ASSERT_EQ(d.robots[2].lights, 1U) << "the beacon is the last of the LEDs";
  const hal::Appearance::Lamp& beacon = d.kinds[1].look.lamps[d.lit[d.robots[2].first_light].lamp];
  EXPECT_EQ(beacon.at_m[0], 0.0);
  EXPECT_EQ(beacon.joint, 0);
}

TEST(Picture, NamesRealRobotsAndWhatIsWrongWithThem) {
  Space space;
  set_up(space);
  PictureOptions options;
  Drawing d = drawing_of(space, options);
  ASSERT_EQ(d.real.size(), 1U);
  EXPECT_EQ(d.real[0].id, "gina");
  EXPECT_EQ(d.real[0].state, "");
  options.trouble.push_back({space.find_robot("gina"), "link lost"});
  d = drawing_of(space, options);
  EXPECT_EQ(d.real[0].state, "link lost");
}

TEST(Picture, ShowsStaticThingsLampsAndAPaintedFloor) {
  Space space;
  set_up(space);
  SpaceStores& s = space.stores();
  Object wall;
  wall.half_x_m = 1.0;
  wall.half_y_m = 0.1;
  wall.cos_h = 0.0;
  wall.sin_h = 1.0;
  Object column;
  column.kind = Object::Kind::Cylinder;
  column.radius_m = 0.2;
  s.objects = {wall, column};
  s.lights.push_back({"lamp", 1.0, 1.0, 0.5, 1.0, {255, 0, 0}});
  auto floor = std::make_unique<FloorField>(RasterArea{-2.0, -1.0, 4.0, 4.0}, 10.0);
  floor->paint([](double x, double, double) { return x < 0.0 ? 0.0 : 1.0; });
  s.fields.add("floor", std::move(floor));
  const Drawing d = drawing_of(space, {});
  ASSERT_EQ(d.objects.size(), 2U);
  EXPECT_DOUBLE_EQ(d.objects[0].sin_h, 1.0);
  EXPECT_DOUBLE_EQ(d.objects[1].radius_m, 0.2);
  ASSERT_EQ(d.lights.size(), 1U);
  ASSERT_TRUE(d.floor);
  EXPECT_NEAR(d.floor(-1.0, 0.0), 0.0, 1e-6);
  EXPECT_NEAR(d.floor(1.0, 0.0), 1.0, 1e-6);
}

TEST(Trails, AreTheLastPlacesOfEveryRobotInWhateverOrderTheyCame) {
  Trails trails(0.3, 10);
  for (int tick = 0; tick < 10; ++tick) {
    const double x = 0.1 * tick;
    std::vector<Trails::Place> places = {{7, x, 0.0}, {8, x, 1.0}};
    if (tick % 2 == 0) std::swap(places[0], places[1]);
    if (tick >= 8) places.push_back({9, x, 2.0});  // came late
    trails.note(tick, places);
  }
  Drawing d;
  const std::vector<std::uint64_t> who = {9, 7, 8};
  d.robots.resize(who.size());
  trails.add_to(d, who, 9);
  ASSERT_EQ(d.trails.size(), 3U);
  EXPECT_EQ(d.trails[0].count, 1U);
  ASSERT_EQ(d.trails[2].count, 3U) << "of three tenths of a second before this one";
  EXPECT_NEAR(d.trail_points[d.trails[2].first].x_m, 0.6, 1e-12);
  EXPECT_EQ(d.trail_points[d.trails[2].first].y_m, 1.0);
  trails.note(1, {{7, 0.0, 0.0}});  // a hook went back to the start
  Drawing anew;
  trails.add_to(anew, who, 2);
  ASSERT_EQ(anew.trails.size(), 1U);
  EXPECT_EQ(anew.trails[0].count, 1U);
}

TEST(Trails, OfManyTicksKeepSomeOfThem) {
  Trails trails(1000.0, 10);
  Space space;
  set_up(space);
  for (std::int64_t tick = 0; tick <= 10'000; ++tick) trails.note(tick, space);
  Drawing d;
  trails.add_to(d, space, 10'000);
  ASSERT_EQ(d.trails.size(), 2U);
  EXPECT_EQ(d.trails[0].count, 200U);
}

std::string written(const Space& space, const std::string& name) {
  const std::string path = testing::TempDir() + name;
  auto file = hal::OutputFile::open(path, "picture");
  EXPECT_TRUE(file.ok());
  const hal::Status status = write_picture(space, file.value(), {});
  EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().message);
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  std::remove(path.c_str());
  return text.str();
}

TEST(Picture, IsWrittenAsAWellFormedFile) {
  Space space;
  set_up(space);
  EXPECT_EQ(why_not_well_formed(written(space, "picture_test.svg")), "");
}

TEST(Picture, IsWrittenInTheFormatOfItsEnding) {
  Space space;
  set_up(space);
  const std::string png = written(space, "picture_test.PNG");
  ASSERT_GT(png.size(), 1000U);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto pixels = [&png](std::size_t at) {  // of IHDR [PNG, 11.2.2]
    return static_cast<unsigned char>(png[at + 2]) * 256 + static_cast<unsigned char>(png[at + 3]);
  };
  EXPECT_EQ(pixels(16), 1056);  // 1,000 and two margins
  EXPECT_GT(pixels(20), 1000);
  const std::string pdf = written(space, "picture_test.pdf");
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.rfind("%%EOF"), std::string::npos);
}

TEST(Picture, RefusesOtherEndingsAndNamesThoseThatThereAre) {
  for (const char* path : {"picture.jpg", "picture", "svg", "a.b/picture"}) {
    const auto format = picture_format(path);
    ASSERT_FALSE(format.ok()) << path;
    EXPECT_NE(format.error().message.find(".png"), std::string::npos);
    EXPECT_NE(format.error().message.find(path), std::string::npos);
  }
}

TEST(Picture, SaysWhatCannotBeRendered) {
  const auto rendered = render("<svg", PictureFormat::Png);
  ASSERT_FALSE(rendered.ok());
  EXPECT_NE(rendered.error().message.find("cannot be rendered"), std::string::npos);
}

}  // namespace
}  // namespace tandem::core
