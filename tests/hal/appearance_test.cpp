#include "hal/appearance.hpp"

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
