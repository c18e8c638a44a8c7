#include "hal/appearance.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "hal/element.hpp"
#include "hal/robot/footbot.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::hal {
namespace {

Appearance looks_of(LookPart part) {
  RobotKind kind;
  kind.add(std::move(part));
  return appearance_of(kind);
}

TEST(Appearance, HasJointsBehindThoseThatTheySitOn) {
  const Appearance look =
      looks_of({.joints = {{.name = "hand", .on = "arm"}, {.name = "arm", .on = "mast"}, {.name = "mast"}},
                .links = {{.name = "claw", .on = "hand"}, {.name = "plate"}, {.name = "lost", .on = "nowhere"}},
                .upper = "mast"});
  ASSERT_EQ(look.joints.size(), 3U);
  EXPECT_EQ(look.joints[0].name, "mast");
  EXPECT_EQ(look.joints[0].parent, Appearance::kBody);
  EXPECT_EQ(look.joints[1].parent, 0);
  EXPECT_EQ(look.joints[2].parent, 1);
  EXPECT_EQ(look.links[0].joint, 2);
  EXPECT_EQ(look.links[1].joint, Appearance::kBody);
  EXPECT_EQ(look.links[2].joint, Appearance::kBody) << "it sits on a joint that there is not";
  EXPECT_EQ(look.upper_joint, 0);
}

TEST(Appearance, OfJointsThatSitOnEachOtherBeginsOnTheBody) {
  const Appearance look = looks_of({.joints = {{.name = "a", .on = "b"}, {.name = "b", .on = "a"}}});
  ASSERT_EQ(look.joints.size(), 2U);
  EXPECT_EQ(look.joints[0].parent, Appearance::kBody);
  EXPECT_EQ(look.joints[1].parent, 0);
}

TEST(Appearance, OfAFootBotIsThatOfItsParts) {
  const Appearance look = appearance_of(footbot::kind());
  EXPECT_EQ(look.lamps.size(), 13U);
  for (const Appearance::Lamp& lamp : look.lamps) EXPECT_EQ(lamp.joint, 0) << "they turn with the turret";
  ASSERT_EQ(look.drivers().size(), 2U);
  EXPECT_EQ(look.drivers()[0]->row, "turret");
  EXPECT_TRUE(look.drivers()[1]->as_switch) << "whether the gripper holds something";
}

TEST(Appearance, OfAKindThatSaysNothingIsADrumOnItsWheels) {
  RobotKind kind;
  kind.body = {.radius_m = 0.1, .height_m = 0.08, .mass_kg = 1.0};
  kind.locomotion = DifferentialDrive{.wheel_radius_m = 0.03, .wheel_base_m = 0.16};
  const Appearance look = appearance_of(kind);
  EXPECT_TRUE(look.whole);
  double wheels_left_m = 0.0, wheels_right_m = 0.0, hull_m = 1.0;
  for (const Appearance::Link& link : look.links) {
    EXPECT_TRUE(link.fine) << "pictures from above have a symbol";
    if (link.shape == "wheel") {
      EXPECT_EQ(link.low_m[2], 0.0);
      EXPECT_DOUBLE_EQ(link.high_m[2], 0.06);
      const double y_m = 0.5 * (link.low_m[1] + link.high_m[1]);
      (y_m > 0.0 ? wheels_left_m : wheels_right_m) = y_m;
    } else if (link.low_m[2] < 0.03) {
      hull_m = std::min(hull_m, link.high_m[1]);
    }
  }
  EXPECT_DOUBLE_EQ(wheels_left_m, 0.08);
  EXPECT_DOUBLE_EQ(wheels_right_m, -0.08);
  EXPECT_LT(hull_m, 0.08) << "the wheels are seen";
}

TEST(Appearance, OfAKindWhoseLookIsWholeHasNothingElse) {
  RobotKind kind;
  kind.body = {.radius_m = 0.1, .height_m = 0.08, .mass_kg = 1.0};
  kind.add(LookPart{.links = {{.name = "plate"}}, .whole = true});
  EXPECT_EQ(appearance_of(kind).links.size(), 1U);
}

TEST(LookPart, IsReadFromAnElement) {
  const auto of = [](const char* name, std::vector<Element::Attribute> attributes, std::vector<Element> children = {}) {
    return Element{name, "file.xml", 2, std::move(attributes), std::move(children)};
  };
  const Element by = of("by", {{"row", "sensor battery", 2}, {"field", "voltage", 2}});
  const Element element = of("look", {},
                             {of("joint", {{"name", "mast", 2}, {"slides", "true", 2}}, {by}),
                              of("link", {{"low", "0,-0.01,0", 2}, {"on", "mast", 2}, {"color", "#c92a2a", 2}})});
  Problems problems;
  const auto part = read_settings<LookPart>(element, problems);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(part.flaw(), "");
  ASSERT_EQ(part.joints.size(), 1U);
  EXPECT_TRUE(part.joints[0].slides);
  EXPECT_EQ(part.joints[0].by, (Driver{"sensor battery", "voltage"}));
  EXPECT_EQ(part.links[0].on, "mast");
  LookPart bad = part;
  bad.links[0].color = "red\" onload=\"";
  EXPECT_NE(bad.flaw().find("#rrggbb"), std::string::npos);
}

}  // namespace
}  // namespace tandem::hal
