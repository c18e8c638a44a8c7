// What may be written in <dynamics2d>, and what is refused with its line.
#include "tests/core/physics/dynamics2d/by_hand.hpp"

namespace tandem::core {
namespace {

std::string problems_of(const Element& element) {
  Problems problems;
  dynamics2d_type().read(element, problems);
  std::string all;
  for (const Problem& problem : problems) all += to_text(problem) + "\n";
  return all;
}

Element element(const std::vector<Element::Attribute>& attributes, const std::vector<Element>& children = {}) {
  Element e;
  e.name = "dynamics2d";
  e.file = "f";
  e.line = 3;
  e.attributes = attributes;
  e.children = children;
  return e;
}

Element child(const std::string& name, const std::vector<Element::Attribute>& attributes) {
  Element e;
  e.name = name;
  e.file = "f";
  e.line = 4;
  e.attributes = attributes;
  return e;
}

TEST(Dynamics2dOptions, TakeWhatArgosFilesHave) {
  EXPECT_EQ(problems_of(element({{"id", "dyn2d", 3}})), "");
  EXPECT_EQ(problems_of(element(
                {{"id", "dyn2d", 3},
                 {"iterations", "10", 3},
                 {"box_linear_friction", "1.49", 3},
                 {"box_angular_friction", "1.49", 3},
                 {"cylinder_linear_friction", "1.49", 3},
                 {"cylinder_angular_friction", "1.49", 3},
                 {"elevation", "0.1", 3}},
                {child("spatial_hash", {{"cell_size", "0.1", 4}, {"cell_num", "1000", 4}}), child("boundaries", {})})),
            "");
}

TEST(Dynamics2dOptions, RefuseWhatTheyDoNotKnow) {
  EXPECT_NE(problems_of(element({{"iteration", "1", 3}})).find("iterations"), std::string::npos);
  EXPECT_NE(problems_of(element({{"iterations", "-1", 3}})).find("f:3: error"), std::string::npos);
  EXPECT_NE(problems_of(element({{"friction", "-0.1", 3}})).find("f:3: error"), std::string::npos);
  EXPECT_NE(problems_of(element({}, {child("spatial_has", {})})).find("f:4: error"), std::string::npos);
  EXPECT_NE(problems_of(element({}, {child("spatial_hash", {{"cell_size", "x", 4}})})).find("f:4: error"),
            std::string::npos);
  EXPECT_NE(problems_of(element({}, {child("spatial_hash", {{"cells", "5", 4}})})).find("f:4: error"),
            std::string::npos);
}

TEST(Dynamics2dOptions, AskedForSubStepsAreTaken) {
  // With a sub-step a tick the ground brakes before the body moves, so it glides less far than with many.
  double way_m[2] = {0.0, 0.0};
  for (const int k : {0, 1}) {
    FlatByHand hand({{"iterations", k == 0 ? "1" : "50", 0}});
    hand.box(0, 0, 0.1, 0.1, 0.2);
    hand.object_motion().v_m_s = {0.5, 0, 0};
    hand.ticks(20);
    way_m[k] = hand.object().x_m;
  }
  EXPECT_NEAR(way_m[1], 0.25 / (2 * 1.49), 2e-3);
  EXPECT_LT(way_m[0], way_m[1] - 0.01);
}

}  // namespace
}  // namespace tandem::core
