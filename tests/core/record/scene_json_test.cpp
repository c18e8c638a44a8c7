#include "core/record/scene_json.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "core/record/floor_image.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {
namespace {

TEST(SceneVersion, ChangesWithEverythingThatTheSceneShows) {
  Space space;
  SpaceStores& s = space.stores();
  s.lights.push_back({"lamp", 1.0, 2.0, 0.5});
  Object crate;
  crate.id = "crate";
  crate.movable = true;
  s.objects.push_back(crate);
  SceneVersion before = scene_version(s);
  EXPECT_EQ(before, scene_version(s));
  const auto changed = [&] {
    const SceneVersion now = scene_version(s);
    const bool different = now != before;
    before = now;
    return different;
  };
  s.lights[0].intensity = 0.0;
  EXPECT_TRUE(changed());
  s.lights[0].color = hal::Rgb{0, 0, 255};
  EXPECT_TRUE(changed());
  s.lights[0].alive = false;
  EXPECT_TRUE(changed());
  ++s.objects[0].version;
  EXPECT_TRUE(changed());
  s.objects[0].alive = false;
  EXPECT_TRUE(changed());
  ++s.immovables_version;
  EXPECT_TRUE(changed());
  ++s.object_leds_version;
  EXPECT_TRUE(changed());
  s.objects[0].x_m = 3.0;  // engines move it: its poses are told by themselves
  EXPECT_FALSE(changed());
}

TEST(MembersJson, SaysWhoIsInTheRowsAndWhatTheyLookLike) {
  Space space;
  add_robot(space, hal::epuck::kind(), "ep0", 0.0, 0.0, 0.0);
  const RobotId twin = add_robot(space, hal::epuck::kind(), "ep1", 1.0, 0.0, 0.0);
  space.set_external(twin, true);
  KindBodies bodies;
  const hal::Json members = members_json(space, living_rows(space.stores()), bodies);
  EXPECT_EQ(members["ids"], (hal::Json{"ep0", "ep1"}));
  EXPECT_EQ(members["kinds"], (hal::Json{"e-puck"}));
  EXPECT_EQ(members["kind"], (hal::Json{0, 0}));
  EXPECT_EQ(members["real"], (hal::Json{1}));
  EXPECT_EQ(members["bodies"][0]["radius"], hal::epuck::kind().body.radius_m);
}

TEST(BodyJson, ComesBackAsAKindThatLooksTheSame) {
  for (const hal::RobotKind* kind : {&hal::footbot::kind(), &hal::eyebot::kind(), &hal::epuck::kind()}) {
    const hal::RobotKind read = kind_of_body(kind->name, hal::parse_json(hal::to_text(body_json(*kind))).value());
    EXPECT_TRUE(looks_alike(*kind, read)) << kind->name;
    EXPECT_EQ(body_json(read), body_json(*kind));
  }
  EXPECT_FALSE(looks_alike(hal::footbot::kind(), hal::epuck::kind()));
}

TEST(BodyJson, OfTheReleaseBeforeLooksAsItDidThen) {
  hal::Json body = {{"radius", hal::footbot::kind().body.radius_m},
                    {"height", hal::footbot::kind().body.height_m},
                    {"gripper_reach", hal::footbot::kind().part<hal::GripperPart>()->reach_m},
                    {"leds_on_turret", true}};
  for (const hal::Mount& led : hal::footbot::kind().part<hal::LedsPart>()->mounts)
    body["leds"].push_back({led.x_m, led.y_m, led.z_m});
  const hal::Appearance then = hal::appearance_of(kind_of_body("foot-bot", body));
  const hal::Appearance now = hal::appearance_of(hal::footbot::kind());
  EXPECT_EQ(then.joints, now.joints);
  EXPECT_EQ(then.lamps, now.lamps);
  const auto gripper = [](const hal::Appearance& look) {
    return *std::find_if(look.links.begin(), look.links.end(), [](const auto& link) { return link.name == "gripper"; });
  };
  EXPECT_EQ(gripper(then).held, gripper(now).held);
  EXPECT_EQ(gripper(then).high_m[0], gripper(now).high_m[0]);
}

TEST(BodyJson, ThatIsDamagedIsReadInAMoment) {
  hal::Json body = {{"look", {{"joints", hal::Json::array()}, {"links", 3}, {"lamps", {"x", nullptr}}}}};
  for (int i = 0; i < 20'000; ++i)
    body["look"]["joints"].push_back({{"name", std::to_string(i)}, {"on", std::to_string(i + 1)}, {"at", "here"}});
  body["look"]["upper"] = "nowhere";
  const hal::Appearance look = hal::appearance_of(kind_of_body("x", body));
  EXPECT_LE(look.joints.size(), 1000U);
  EXPECT_EQ(look.upper_joint, hal::Appearance::kBody);
}

FloorImage image_of(std::size_t columns, std::size_t lines) {
  FloorImage image{columns, lines, {}};
  for (std::size_t i = 0; i < columns * lines; ++i) image.pixels.push_back(static_cast<std::uint8_t>(i * 37));
  return image;
}

TEST(FloorImage, ComesBackFromItsPngAsItWas) {
  const FloorImage image = image_of(31, 17);
  const auto read = floor_of_png(png_of(image));
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value().columns, 31U);
  EXPECT_EQ(read.value().lines, 17U);
  EXPECT_EQ(read.value().pixels, image.pixels);
}

TEST(FloorImage, HasItsFirstLineInTheNorth) {
  const FloorImage image{2, 2, {0, 255, 51, 102}};
  EXPECT_EQ(image.at(0.1, 0.9), 0.0);
  EXPECT_EQ(image.at(0.9, 0.9), 1.0);
  EXPECT_NEAR(image.at(0.1, 0.1), 0.2, 1e-6);
  EXPECT_NEAR(image.at(1.0, -7.0), 0.4, 1e-6);
}

TEST(FloorImage, IsRefusedWhereThePictureIsDamaged) {
  const std::string png = png_of(image_of(20, 20));
  for (std::size_t size = 0; size < png.size() - 16; ++size) EXPECT_FALSE(floor_of_png(png.substr(0, size)).ok());
  EXPECT_FALSE(floor_of_png("something else altogether, and long enough to be looked into").ok());
}

}  // namespace
}  // namespace tandem::core
