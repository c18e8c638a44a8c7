// Robots from the inside.
#include "core/live/inspection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/live/held.hpp"

namespace tandem::core {
namespace {

using hal::Json;

const Json& named(const Json& list, const std::string& name) {
  static const Json none;
  for (const Json& entry : list) {
    if (entry["name"] == name) return entry;
  }
  ADD_FAILURE() << "no " << name << " in " << hal::to_text(list);
  return none;
}

TEST(Inspection, ShowsEveryPortFieldByField) {
  Scene scene(4.0, "everything");
  scene.param("left", "0.06").param("right", "0.05").robot("a", 0, 0, 0.5).robot("b", 0.1, 0);
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 5);
  const Json all = inspection_of(*world.world, {"a", "b", "nobody"});
  EXPECT_EQ(all["tick"], 5);
  ASSERT_EQ(all["robots"].size(), 3U);
  EXPECT_EQ(all["robots"][2], (Json{{"id", "nobody"}, {"alive", false}}));
  const Json& a = all["robots"][0];
  EXPECT_EQ(a["kind"], "e-puck");
  EXPECT_EQ(a["controller"], "c");
  EXPECT_EQ(a["halted"], Json::array());
  const Pose pose = world->space().pose(world->space().find_robot("a"));
  EXPECT_EQ(a["pose"]["x"], pose.x_m);
  EXPECT_EQ(a["ports"].size(), world->space().ports(world->space().find_robot("a")).size());
  const Json& proximity = named(a["ports"], "proximity");
  EXPECT_EQ(proximity["role"], "sensor");
  EXPECT_EQ(proximity["validity"], "fresh");
  EXPECT_EQ(proximity["stamp_age_s"], 0.0);
  const Json& wheels = named(a["ports"], "differential_steering");
  EXPECT_EQ(wheels["role"], "actuator");
  EXPECT_EQ(named(wheels["fields"], "left")["values"], Json{0.06});
  EXPECT_EQ(named(wheels["fields"], "left")["unit"], "m/s");
  EXPECT_EQ(named(a["params"], "left")["value"], 0.06);
  EXPECT_EQ(named(a["params"], "left")["unit"], "m/s");
  EXPECT_EQ(named(a["params"], "left")["doc"], "Speed of the left wheel.");
  EXPECT_EQ(hal::parse_json_object(hal::to_text(all)).ok(), true);
}

TEST(Inspection, ShowsPublishedStateInWordsAndOwnParameters) {
  Scene scene(4.0, "shown");
  scene.robot("a", 0, 0).robot("b", 1, 0);
  Element params;
  params.name = "params";
  params.attributes = {{"learns", "true", 0}};
  scene.scenario.robots.back().params = params;
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  run(*world.world, 4);
  world->space().set_halted(world->space().find_robot("b"), true, HaltOwner::Operator);
  const Json all = inspection_of(*world.world, {"a", "b"})["robots"];
  EXPECT_EQ(named(all[0]["published"], "mode")["value"], "rest");
  EXPECT_EQ(named(all[0]["published"], "steps")["value"], 4);
  EXPECT_EQ(named(all[0]["params"], "learns")["value"], false);
  EXPECT_EQ(named(all[1]["params"], "learns")["value"], true);
  EXPECT_EQ(all[1]["halted"], Json{"operator"});
  EXPECT_EQ(named(all[0]["controls"], "pace")["owner"], "robot:a");
}

}  // namespace
}  // namespace tandem::core
