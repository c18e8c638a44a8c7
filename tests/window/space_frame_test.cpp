#include "window/space_frame.hpp"

#include <gtest/gtest.h>
#include <numbers>

#include "core/space/stores.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::window {
namespace {

using core::Scene;

core::MadeWorld world_of(const Scene& scene) {
  core::MadeWorld made = core::make(scene);
  EXPECT_NE(made.world, nullptr) << made.all_problems();
  return made;
}

TEST(SpaceFrames, HoldWhereEverybodyIs) {
  const auto world = world_of(Scene(4.0, "everything").robot("a", 0.5, -0.25, 1.0).robot("b", -1.0, 1.0));
  SpaceFrames frames;
  Frame frame;
  frames.fill(world->space(), 5, 10, true, frame);
  EXPECT_EQ(frame.tick, 5);
  EXPECT_EQ(frame.time_s, 0.5);
  ASSERT_EQ(frame.x_m.size(), 2U);
  const auto& ids = frame.members->json["ids"];
  const std::size_t a = ids[0] == "a" ? 0 : 1;
  EXPECT_EQ(frame.x_m[a], 0.5);
  EXPECT_EQ(frame.y_m[a], -0.25);
  EXPECT_NEAR(std::atan2(frame.sin_h[a], frame.cos_h[a]), 1.0, 1e-12);
  EXPECT_EQ(frame.members->first_led.size(), 3U);
  EXPECT_GT(frame.members->first_led.back(), 0U);
  EXPECT_EQ(frame.leds.size(), frame.members->first_led.back());
}

TEST(SpaceFrames, MembersAndSceneAreNewWhenTheyChange) {
  const auto world = world_of(Scene().robot("a", 0.5, 0.0).robot("b", -1.0, 1.0).box(1.5, 1.5, 0.1, 0.1));
  core::Space& space = world->space();
  SpaceFrames frames;
  Frame first, second, third;
  frames.fill(space, 0, 10, true, first);
  frames.fill(space, 1, 10, true, second);
  EXPECT_EQ(first.members, second.members);
  EXPECT_EQ(first.scene, second.scene);
  space.remove_robot(space.find_robot("a"));
  space.remove_object(space.find_object("box0"));
  frames.fill(space, 2, 10, true, third);
  EXPECT_NE(third.members->number, second.members->number);
  EXPECT_EQ(hal::to_text(third.members->json["ids"]), R"(["b"])");
  EXPECT_EQ(third.x_m.size(), 1U);
  EXPECT_EQ(third.x_m[0], -1.0);
  EXPECT_TRUE(third.scene->json["objects"].empty());
}

TEST(SpaceFrames, ShowLedsAndWhoIsHalted) {
  const auto world = world_of(Scene(4.0, "everything").robot("a", 0.5, 0.0).robot("b", -1.0, 1.0));
  core::Space& space = world->space();
  const core::RobotId b = space.find_robot("b");
  space.set_halted(b, true);  // its actuators are safe: LEDs are off
  space.port<hal::RingLeds>(b)->set(1, hal::kGreen);
  SpaceFrames frames;
  Frame frame;
  frames.fill(space, 0, 10, true, frame);
  const std::uint32_t i = frame.members->json["ids"][0] == "b" ? 0 : 1;
  EXPECT_EQ(frame.leds[frame.members->first_led[i] + 1], hal::kGreen);
  EXPECT_EQ(frame.leds[frame.members->first_led[i]], hal::kBlack);
  EXPECT_EQ(frame.halted, (std::vector<std::uint32_t>{i}));
}

TEST(SpaceFrames, MovableObjectsAreNamedByTheirPlaceInTheScene) {
  const auto world = world_of(
      Scene().robot("a", 0.5, 0.0).box(1.5, 1.5, 0.1, 0.1).box(-1.0, -1.0, 0.2, 0.2).movable(0.1).engine("dynamics2d"));
  core::Space& space = world->space();
  space.remove_object(space.find_object("box0"));
  SpaceFrames frames;
  Frame frame;
  frames.fill(space, 0, 10, true, frame);
  ASSERT_EQ(frame.objects.size(), 1U);
  EXPECT_EQ(frame.objects[0].number, 0U);
  EXPECT_EQ(frame.scene->json["objects"][0]["id"], "box1");
  EXPECT_EQ(frame.objects[0].x_m, -1.0);
}

TEST(SpaceFrames, ASpaceThatIsCopiedStaysTheSame) {
  const auto run = [](bool watched) {
    const auto world = world_of(Scene().robots(50, 1.5).walls());
    SpaceFrames frames;
    Frame frame;
    world->start();
    for (int tick = 0; tick < 20; ++tick) {
      world->step();
      if (!watched) continue;
      frame.clear();
      frames.fill(world->space(), world->tick(), 10, false, frame);
    }
    return world->state_hash();
  };
  EXPECT_EQ(run(true), run(false));
}

}  // namespace
}  // namespace tandem::window
