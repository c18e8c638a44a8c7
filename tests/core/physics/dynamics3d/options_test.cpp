// What may be written in <dynamics3d>, and what is refused with its line.
#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

std::string problems_of(const std::vector<Element::Attribute>& attributes, const std::vector<Element>& children = {}) {
  Element e;
  e.name = "dynamics3d";
  e.file = "f";
  e.line = 3;
  e.attributes = attributes;
  e.children = children;
  Problems problems;
  dynamics3d_type().read(e, problems);
  std::string all;
  for (const Problem& problem : problems) all += to_text(problem) + "\n";
  return all;
}

TEST(Dynamics3dOptions, TakeWhatTheyKnow) {
  EXPECT_EQ(problems_of({{"id", "dyn3d", 3}, {"iterations", "10", 3}, {"drive", "wheels", 3}, {"erp", "0.3", 3}},
                        {child("gravity", {{"g", "9.81", 4}}), child("floor", {{"height", "0.1", 4}}),
                         child("boundaries", {})}),
            "");
}

TEST(Dynamics3dOptions, RefuseWhatTheyDoNotKnow) {
  EXPECT_NE(problems_of({{"iteration", "1", 3}}).find("iterations"), std::string::npos);
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{{"iterations", "-1"},
                                                                                    {"default_friction", "-1.5"},
                                                                                    {"robot_friction", "nan"},
                                                                                    {"wheel_friction", "-0.1"},
                                                                                    {"erp", "1.5"},
                                                                                    {"cfm", "-1"},
                                                                                    {"solver_iterations", "-1"},
                                                                                    {"drive", "wings"}})
    EXPECT_NE(problems_of({{name, value, 3}}).find("f:3: error"), std::string::npos) << name;
  EXPECT_NE(problems_of({{"drive", "wings", 3}}).find("wheels"), std::string::npos);
  EXPECT_NE(problems_of({}, {child("gravity", {{"g", "-9.81", 4}})}).find("f:4: error"), std::string::npos);
  EXPECT_NE(problems_of({}, {child("gravity", {{"h", "1", 4}})}).find("f:4: error"), std::string::npos);
  EXPECT_NE(problems_of({}, {child("floor", {{"height", "x", 4}})}).find("f:4: error"), std::string::npos);
  EXPECT_NE(problems_of({}, {child("flor", {})}).find("f:4: error"), std::string::npos);
}

TEST(Dynamics3dOptions, AskedForSubStepsAreTaken) {
  // After t of free fall in sub-steps of h, g t h / 2 below the parabola.
  for (const int sub_steps : {1, 4, 50}) {
    ByHand hand({{"iterations", std::to_string(sub_steps), 3}});
    hand.block(0, 0, 10.0, 0.1, 0.1, 0.1, 0.3);
    hand.ticks(5);
    EXPECT_NEAR(hand.z_m(), 10.0 - 0.5 * kGravity_m_s2 * 0.5 * (0.5 + kTick_s / sub_steps), 1e-9) << sub_steps;
  }
}

}  // namespace
}  // namespace tandem::core
