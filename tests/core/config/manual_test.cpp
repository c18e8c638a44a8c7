#include <algorithm>
#include <gmock/gmock.h>
#include <set>

#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

const ElementManual* find(const std::vector<ElementManual>& manuals, std::string_view name) {
  const auto at = std::find_if(manuals.begin(), manuals.end(), [&](const ElementManual& m) { return m.name == name; });
  return at == manuals.end() ? nullptr : &*at;
}

TEST(Manual, EveryElementIsDocumentedAndHasAPlace) {
  const auto manuals = element_manuals(known_names());
  for (const ElementManual& m : manuals) {
    SCOPED_TRACE(m.name);
    EXPECT_FALSE(m.doc.empty());
    EXPECT_EQ(m.parent.empty(), m.name == "tandem");
  }
}

TEST(Manual, EveryChildThatMayBeHeldHasAnEntry) {
  const std::set<std::string> others = {"*", "params", "led"};  // their content is somebody else's, or left out
  const auto manuals = element_manuals(known_names());
  for (const ElementManual& m : manuals) {
    for (const std::string& child : m.children) {
      EXPECT_TRUE(others.contains(child) || find(manuals, child) != nullptr) << m.name << " / " << child;
    }
  }
}

TEST(Manual, ShowsAttributesWithDefaultsRangesAndWhatMustBeGiven) {
  const auto manuals = element_manuals(known_names());
  const ElementManual* experiment = find(manuals, "experiment");
  ASSERT_NE(experiment, nullptr);
  EXPECT_EQ(experiment->parent, "framework");
  EXPECT_THAT(experiment->attributes, HasSubstr("ticks_per_second=\"10\""));
  EXPECT_THAT(experiment->attributes, HasSubstr("Control steps a virtual second."));
  const ElementManual* box = find(manuals, "box");
  ASSERT_NE(box, nullptr);
  EXPECT_EQ(box->parent, "arena or entity");
  EXPECT_THAT(box->attributes, HasSubstr("must have: id, size"));
}

TEST(Manual, NamesKindsOfRobotsAndEngines) {
  const auto manuals = element_manuals(catalog_with({"kinematics2d", "dynamics2d"}));
  for (const char* name : {"e-puck", "foot-bot", "kinematics2d", "dynamics2d", "range_and_bearing"})
    EXPECT_NE(find(manuals, name), nullptr) << name;
  EXPECT_THAT(find(manuals, "arena")->children, testing::Contains("foot-bot"));
  EXPECT_THAT(find(manuals, "battery")->parent, testing::StartsWith("e-puck or "));
  EXPECT_EQ(find(manuals, "dynamics2d")->parent, "physics_engines");
}

}  // namespace
}  // namespace tandem::core
