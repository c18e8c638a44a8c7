// What files say of cameras, of the LEDs that they see, and of their media.
#include "hal/device/cameras.hpp"

#include <gmock/gmock.h>
#include <numbers>

#include "hal/xml/xml.hpp"
#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180.0;

/// As in the documentation of ARGoS, but for the places.
Parts argos() {
  Parts parts;
  parts.controllers =
      R"(<controllers><wander id="w" library="wander"><actuators><leds implementation="default" medium="leds"/></actuators><sensors><colored_blob_omnidirectional_camera implementation="rot_z_only" medium="leds" show_rays="true"/><colored_blob_perspective_camera implementation="default" medium="leds" show_rays="true"/></sensors></wander></controllers>)";
  parts.things =
      R"(<foot-bot id="fb" omnidirectional_camera_aperture="50" perspective_camera_front="true" perspective_camera_aperture="40" perspective_camera_focal_length="0.05" perspective_camera_range="7"><body position="0,0,0"/><controller config="w"/></foot-bot>)"
      R"(<eye-bot id="eb" camera_front="true" camera_aperture="20" camera_range="10"><body position="1,1,1"/><controller config="w"/></eye-bot>)"
      R"(<box id="b" size="0.4,0.2,0.3" movable="false"><body position="-1,0,0"/><leds medium="leds"><led offset="0.2,0,0.3" anchor="origin" color="red"/><led offset="0,0,0.3" color="1,2,3"/></leds></box>)"
      R"(<light id="l" position="0,1,1" color="green" medium="leds"/>)";
  parts.rest = R"(<media><led id="leds" index="grid" grid_size="1,1,1"/></media>)";
  return parts;
}

TEST(Cameras, AreReadFromFilesOfArgos) {
  const Outcome out = read(argos().text(), {}, catalog_with({"kinematics2d"}));
  const Scenario& s = out.good();
  EXPECT_EQ(out.text(), "");
  ASSERT_EQ(s.controllers[0].sensors.size(), 2U);
  EXPECT_EQ(s.controllers[0].sensors[0].device, "omnidirectional_camera");
  EXPECT_EQ(s.controllers[0].sensors[0].implementation, "rot_z_only");
  EXPECT_EQ(s.controllers[0].sensors[1].device, "perspective_camera");
  ASSERT_EQ(s.robots.size(), 2U);
  ASSERT_NE(s.robots[0].own_kind, nullptr);
  const auto& foot = *s.robots[0].own_kind->part<hal::CameraPart>();
  EXPECT_NEAR(s.robots[0].own_kind->part<hal::OmniCameraPart>()->aperture_rad, 50 * kDeg, 1e-12);
  EXPECT_NEAR(foot.aperture_rad, 40 * kDeg, 1e-12);
  EXPECT_EQ(foot.focal_length_m, 0.05);
  EXPECT_EQ(foot.range_m, 7.0);
  EXPECT_TRUE(foot.in_front);
  ASSERT_NE(s.robots[1].own_kind, nullptr);
  const auto& eye = *s.robots[1].own_kind->part<hal::CameraPart>();
  EXPECT_NEAR(eye.aperture_rad, 20 * kDeg, 1e-12);
  EXPECT_EQ(eye.range_m, 10.0);
  EXPECT_TRUE(eye.in_front);
  ASSERT_EQ(s.objects.size(), 1U);
  ASSERT_EQ(s.objects[0].leds.size(), 2U);
  EXPECT_EQ(s.objects[0].leds[0].p_O, (Vec3{0.2, 0.0, 0.3}));
  EXPECT_EQ(s.objects[0].leds[0].rgb, (std::array<std::uint8_t, 3>{255, 0, 0}));
  EXPECT_EQ(s.objects[0].leds[1].rgb, (std::array<std::uint8_t, 3>{1, 2, 3}));
  EXPECT_EQ(medium_number(s.media, "led", s.objects[0].led_medium).value(), 1);
  EXPECT_EQ(medium_number(s.media, "led", s.lights[0].medium).value(), 1);
  EXPECT_EQ(medium_number(s.media, "led", "").value(), 0);
  EXPECT_FALSE(medium_number(s.media, "led", "none").ok());
  EXPECT_FALSE(medium_number(s.media, "range_and_bearing", "leds").ok()) << "that is an LED medium's";
}

TEST(Cameras, RobotsThatSayTheSameShareAKind) {
  Parts parts = argos();
  for (const char* id : {"c", "d"})
    parts.things += R"(<eye-bot id=")" + std::string(id) +
                    R"(" camera_range="10"><body position="1,-1,1"/><controller config="w"/></eye-bot>)";
  const Scenario s = read(parts.text(), {}, catalog_with({"kinematics2d"})).good();
  ASSERT_EQ(s.robots.size(), 4U);
  EXPECT_NE(s.robots[2].own_kind, nullptr);
  EXPECT_EQ(s.robots[2].own_kind, s.robots[3].own_kind);
  EXPECT_NE(s.robots[1].own_kind, s.robots[2].own_kind);
}

TEST(Cameras, EffectiveSettingsReadBackAsTheSame) {
  const hal::Catalog known = catalog_with({"kinematics2d"});
  Parts parts = argos();
  parts.things += R"(<foot-bot id="plain"><body position="2,0,0"/><controller config="w"/></foot-bot>)";
  const Scenario a = read(parts.text(), {}, known).good();
  const std::string effective = effective_settings(a);
  EXPECT_THAT(effective, HasSubstr("omnidirectional_camera_aperture=\"70 deg\""));
  const Scenario b = read(effective, {}, known).good();
  ASSERT_EQ(a.robots.size(), b.robots.size());
  EXPECT_EQ(b.robots[0].own_kind->part<hal::CameraPart>()->range_m, 7.0);
  EXPECT_EQ(b.robots.back().own_kind, nullptr) << "as the catalog has it";
  ASSERT_EQ(b.objects[0].leds.size(), 2U);
  EXPECT_EQ(a.objects[0].leds[1].p_O, b.objects[0].leds[1].p_O);
  EXPECT_EQ(effective_settings(b), effective);
}

TEST(Cameras, ErrorsNameTheirLine) {
  const auto problem_with = [](const std::string& things) {
    Parts parts;
    parts.things = things;
    return read(parts.text()).text();
  };
  const std::string rest = R"(><body position="0,0,0"/><controller config="w"/></)";
  EXPECT_THAT(problem_with(R"(<e-puck id="ep" omnidirectional_camera_aperture="70")" + rest + "e-puck>"),
              HasSubstr("file.xml:6: error"));
  EXPECT_THAT(problem_with(R"(<foot-bot id="fb" omnidirectional_camera_aperture="90")" + rest + "foot-bot>"),
              HasSubstr("file.xml:6: error"));
  EXPECT_THAT(problem_with(R"(<foot-bot id="fb" camera_front="true")" + rest + "foot-bot>"),
              HasSubstr("has no attribute 'camera_front'"));
  EXPECT_THAT(problem_with(R"(<eye-bot id="eb" camera_range="-1")" + rest + "eye-bot>"),
              HasSubstr("file.xml:6: error"));
}

TEST(Leds, ErrorsNameTheirLine) {
  const auto problem_with = [](const std::string& leds, const std::string& media = "") {
    Parts parts;
    parts.things = "<box id=\"b\" size=\"0.4,0.2,0.3\"><body position=\"-1,0,0\"/>\n" + leds + "</box>";
    parts.rest = media;
    return read(parts.text()).text();
  };
  EXPECT_EQ(problem_with(R"(<leds><led offset="0,0,0.3" color="red"/></leds>)"), "");
  EXPECT_THAT(problem_with(R"(<leds><led offset="0,0,0.3" color="rad"/></leds>)"),
              HasSubstr("file.xml:7: error: <led color>: 'rad'"));
  EXPECT_THAT(problem_with(R"(<leds><led offset="0,0,0.3"/></leds>)"), HasSubstr("color"));
  EXPECT_THAT(problem_with(R"(<leds><led offset="0,0,0.3" color="red" anchor="top"/></leds>)"),
              HasSubstr("file.xml:7: error"));
  EXPECT_THAT(
      problem_with(R"(<leds medium="b"><led offset="0,0,0.3" color="red"/></leds>)", R"(<media><led id="a"/></media>)"),
      HasSubstr("file.xml:7: error: <leds medium>: <media> has no <led> with id 'b'; it has: a"));
  const std::string inside = problem_with(R"(<leds><led offset="0.1,0,0.15" color="red"/></leds>)");
  EXPECT_THAT(inside, HasSubstr("file.xml:7: warning"));
  EXPECT_THAT(inside, HasSubstr("no camera sees it"));
}

}  // namespace
}  // namespace tandem::core
