// Controls that hooks and controllers declare: listed, set, pressed, kept by checkpoints, repeated.
#include "core/live/controls.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/live/held.hpp"

namespace tandem::core {
namespace {

using hal::Json;
using testing::HasSubstr;

Scene knobs() {
  Scene scene = crowd("kinematics2d", "shown", 5);
  with_hook(scene, "knobs");
  return scene;
}

Json set(const char* owner, const char* control, const Json& value) {
  return {{"do", "set"}, {"owner", owner}, {"control", control}, {"value", value}};
}
Json press(const char* owner, const char* control) {
  return {{"do", "press"}, {"owner", owner}, {"control", control}};
}

TEST(Controls, AreListedWithUnitsAndRanges) {
  auto world = make(knobs());
  const Json all = controls_json(*world.world);
  ASSERT_EQ(all.size(), 8U) << hal::to_text(all);
  EXPECT_EQ(all[0], (Json{{"owner", "hook:knobs"},
                          {"name", "size"},
                          {"kind", "number"},
                          {"doc", "Of what is put down."},
                          {"value", 10.0},
                          {"min", 2.0},
                          {"max", 20.0},
                          {"unit", "cm"}}));
  EXPECT_EQ(all[1]["kind"], "integer");
  EXPECT_EQ(all[2]["value"], false);
  EXPECT_EQ(all[3]["options"], (Json{"box", "cylinder"}));
  EXPECT_EQ(all[4]["kind"], "text");
  EXPECT_EQ(all[5]["kind"], "button");
  EXPECT_EQ(all[6]["owner"], "controller:c");
  EXPECT_EQ(all[6]["value"], 100.0);
  EXPECT_EQ(all[7]["name"], "rest");
}

TEST(Controls, AreSetAndPressed) {
  Held run(knobs());
  run.walk(5);
  EXPECT_EQ(run.error_of(set("hook:knobs", "size", 5)), "");
  EXPECT_EQ(run.error_of(set("hook:knobs", "count", 3)), "");
  EXPECT_EQ(run.error_of(set("hook:knobs", "shape", "cylinder")), "");
  EXPECT_EQ(run.error_of(press("hook:knobs", "drop")), "");
  EXPECT_EQ(run.error_of(set("controller:c", "pace", 50)), "");
  EXPECT_EQ(run.error_of(set("robot:ep1", "pace", 0)), "");
  const Json controls = run.ask({{"do", "controls"}})["controls"];
  EXPECT_EQ(controls[0]["value"], 5.0);
  EXPECT_EQ(controls[6]["value"], 50.0);
  run.walk(5);
  run.end();
  EXPECT_EQ(run.world().measures().get("size"), 0.05);
  const auto& objects = run.world().space().objects();
  ASSERT_EQ(objects.size(), 4U + 3U);
  EXPECT_EQ(objects.back().kind, Object::Kind::Cylinder);
}

TEST(Controls, SayWhatIsWrong) {
  Held run(knobs());
  const auto error = [&](const Json& command, const char* part) {
    EXPECT_THAT(run.error_of(command), HasSubstr(part));
  };
  error(set("hook:knobs", "size", 50), "'size' lies between 2 cm and 20 cm; it stays");
  error(set("hook:knobs", "size", "big"), "'size' is a number");
  error(set("hook:knobs", "count", 1.5), "'count' is a whole number");
  error(set("hook:knobs", "count", 9), "lies between 1 and 5");
  error(set("hook:knobs", "movable", 1), "is true or false");
  error(set("hook:knobs", "shape", "cone"), "is one of: box, cylinder");
  error(set("hook:knobs", "sise", 5), "Did you mean 'size'");
  error(set("hook:knobs", "drop", 1), "no value 'drop' to set");
  error(set("hook:knobs", "prefix", "bad"), "hook:knobs: a bad prefix");
  error(press("hook:knobs", "size"), "no button 'size' to press");
  error(press("hook:nobs", "drop"), "there is no owner 'hook:nobs'");
  error(set("robot:none", "pace", 50), "no robot 'none'");
  EXPECT_THAT(run.error_of({{"do", "set"}, {"owner", "hook:knobs"}, {"control", "size"}}),
              HasSubstr("\"value\" is missing"));
}

TEST(Controls, GoBackWithTheRunAndAreRepeated) {
  Held run(knobs());
  run.walk(10);
  EXPECT_EQ(run.error_of(set("hook:knobs", "size", 5)), "");
  EXPECT_EQ(run.error_of(set("controller:c", "pace", 25)), "");
  run.walk(10);
  EXPECT_EQ(run.error_of(set("hook:knobs", "size", 15)), "");
  EXPECT_EQ(run.error_of(press("controller:c", "rest")), "");
  run.walk(10);
  const auto size_at = [&](hal::Tick tick) {
    run.hash_at(tick);
    return run.ask({{"do", "controls"}})["controls"][0]["value"].get<double>();
  };
  EXPECT_EQ(size_at(5), 10.0);
  EXPECT_EQ(size_at(15), 5.0);
  EXPECT_EQ(run.hash_at(30), run.new_ticks.at(30));
  EXPECT_EQ(run.hash_at(25), run.new_ticks.at(25));

  LiveOptions again = Held::paused();
  again.repeat = actions_of(run.events);
  ASSERT_EQ(again.repeat.size(), 4U);
  Held repeated(knobs(), again);
  repeated.walk(30);
  EXPECT_EQ(repeated.new_ticks, run.new_ticks);
}

}  // namespace
}  // namespace tandem::core
