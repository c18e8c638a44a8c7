// The effective settings: a file with every default written out, which reads back as the same experiment.
#include <gmock/gmock.h>

#include "hal/device/range_and_bearing.hpp"
#include "hal/xml/xml.hpp"
#include "tests/checkout.hpp"
#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

void expect_same(const Scenario& a, const Scenario& b) {
  EXPECT_EQ(a.length_s, b.length_s);
  EXPECT_EQ(a.ticks_per_second, b.ticks_per_second);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.threads, b.threads);
  EXPECT_EQ(a.assignment, b.assignment);
  EXPECT_EQ(a.time_mode, b.time_mode);
  EXPECT_EQ(a.arena_size, b.arena_size);
  EXPECT_EQ(a.arena_center, b.arena_center);
  EXPECT_EQ(a.escape, b.escape);
  EXPECT_EQ(a.engines.size(), b.engines.size());
  EXPECT_EQ(a.media.size(), b.media.size());
  EXPECT_EQ(a.hooks.size(), b.hooks.size());
  EXPECT_EQ(a.trajectory.has_value(), b.trajectory.has_value());
  ASSERT_EQ(a.controllers.size(), b.controllers.size());
  for (std::size_t i = 0; i < a.controllers.size(); ++i) {
    EXPECT_EQ(a.controllers[i].id, b.controllers[i].id);
    EXPECT_EQ(a.controllers[i].library, b.controllers[i].library);
    EXPECT_EQ(hal::to_xml(a.controllers[i].params), hal::to_xml(b.controllers[i].params));
    ASSERT_EQ(a.controllers[i].sensors.size(), b.controllers[i].sensors.size());
    for (std::size_t k = 0; k < a.controllers[i].sensors.size(); ++k) {
      EXPECT_EQ(hal::to_xml(a.controllers[i].sensors[k].options), hal::to_xml(b.controllers[i].sensors[k].options));
    }
  }
  ASSERT_EQ(a.robots.size(), b.robots.size());
  for (std::size_t i = 0; i < a.robots.size(); ++i) {
    EXPECT_EQ(a.robots[i].id, b.robots[i].id);
    EXPECT_EQ(a.robots[i].placement.p_W, b.robots[i].placement.p_W);
    EXPECT_EQ(a.robots[i].placement.yaw_rad, b.robots[i].placement.yaw_rad);
    ASSERT_EQ(a.robots[i].own_kind != nullptr, b.robots[i].own_kind != nullptr);
    if (a.robots[i].own_kind != nullptr) {
      EXPECT_EQ(a.robots[i].own_kind->part<hal::RangeAndBearingPart>()->range_m,
                b.robots[i].own_kind->part<hal::RangeAndBearingPart>()->range_m);
    }
    ASSERT_EQ(a.robots[i].distribute.has_value(), b.robots[i].distribute.has_value());
    if (!a.robots[i].distribute) continue;
    EXPECT_EQ(a.robots[i].distribute->quantity, b.robots[i].distribute->quantity);
    EXPECT_EQ(a.robots[i].distribute->max_trials, b.robots[i].distribute->max_trials);
    EXPECT_EQ(a.robots[i].distribute->position.min, b.robots[i].distribute->position.min);
    EXPECT_EQ(a.robots[i].distribute->orientation.max, b.robots[i].distribute->orientation.max);
  }
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].size, b.objects[i].size);
    EXPECT_EQ(a.objects[i].mass_kg, b.objects[i].mass_kg);
  }
  EXPECT_EQ(a.lights.size(), b.lights.size());
}

TEST(EffectiveSettings, ShowDefaultsAndOverrides) {
  Parts parts;
  parts.framework = R"(<framework><experiment length="10" real_time="true"/></framework>)";
  parts.engines = "";
  const std::string text = effective_settings(read(parts.text(), {"framework.experiment.length=33"}).good());
  EXPECT_THAT(text, HasSubstr("length=\"33\""));
  EXPECT_THAT(text, HasSubstr("ticks_per_second=\"10\""));
  EXPECT_THAT(text, HasSubstr("<system threads=\"0\" method=\"balance_quantity\""));
  EXPECT_THAT(text, HasSubstr("<time mode=\"realtime\" priority=\"0\"/>"));
  EXPECT_THAT(text, HasSubstr("<kinematics2d id=\"kinematics2d\""));
  EXPECT_THAT(text, HasSubstr("escape=\"error\""));
  EXPECT_THAT(text, HasSubstr("<proximity implementation=\"default\"/>"));
}

TEST(EffectiveSettings, AreWrittenTheSameWhenReadAgain) {
  Parts parts;
  const std::string once = effective_settings(read(parts.text()).good());
  EXPECT_EQ(effective_settings(read(once).good()), once);
}

TEST(EffectiveSettings, OfEveryExperimentHereReadBackAsTheSame) {
  for (const std::string& name : test::experiments()) {
    SCOPED_TRACE(name);
    Outcome first;
    first.scenario =
        read_experiment(std::string(test::kSourceDir) + "/configs/" + name, {}, known_names(), first.problems);
    const Outcome second = read(effective_settings(first.good()));
    EXPECT_TRUE(first.problems.empty()) << first.text();
    expect_same(first.good(), second.good());
  }
  EXPECT_GE(test::experiments().size(), 3U);
}

TEST(Effective, ShowsWhatAKindOfRobotAddsToItsBridge) {
  Parts parts;
  parts.things =
      R"(<e-puck id="real"><body position="0,0,0"/><controller config="w"/><bridge link="serial:x"/></e-puck>)";
  const Outcome out = read(parts.text());
  const std::string text = effective_settings(out.good());
  for (const char* part : {"firmware=\"auto\"", "timeout=\"0.5 s\""}) EXPECT_THAT(text, testing::HasSubstr(part));
  EXPECT_EQ(effective_settings(read(text).good()), text);
}

TEST(Effective, ABridgeHasNoAttributesOrChildrenOfOtherKinds) {
  Parts parts;
  parts.things = R"(<e-puck id="a"><body position="0,0,0"/><controller config="w"/>
<bridge link="serial:x" firmwear="y"><lense/></bridge></e-puck>
<foot-bot id="b"><body position="1,0,0"/><controller config="w"/><bridge link="can:can0" firmware="y"/></foot-bot>)";
  const std::string text = read(parts.text()).text();
  EXPECT_THAT(text, testing::HasSubstr("<bridge> has no attribute 'firmwear'. Did you mean 'firmware'?"));
  EXPECT_THAT(text, testing::HasSubstr("<bridge> cannot hold <lense>; it may hold: none"));
  EXPECT_THAT(text, testing::HasSubstr("file.xml:8: error: <bridge> has no attribute 'firmware'"));
}

}  // namespace
}  // namespace tandem::core
