// What every engine promises over minutes, and of ticks that are long for what moves in them.
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

class LongTicks : public EveryEngine {};

TEST_P(LongTicks, NobodyPassesAThinWall) {
  for (const std::int64_t per_second : {10, 2, 1}) {
    for (const bool few : {false, true}) {
      Scene s(4.0);
      s.engine(GetParam(), "",
               few ? std::vector<Element::Attribute>{{"iterations", "1", 100}}
                   : std::vector<Element::Attribute>{});  // as few sub-steps as a file may ask for
      s.scenario.ticks_per_second = per_second;
      s.robot("a", 0.0, 0.0).wheels(0.12, 0.12).box(0.5, 0.0, 0.005, 1.0);
      auto world = make(s);
      if (!world.world) {  // refused is as good: it says why
        EXPECT_NE(world.all_problems().find("error"), std::string::npos);
        continue;
      }
      world->start();
      for (int i = 0; i < 12 * per_second; ++i) {
        world->step();
        ASSERT_LT(pose_of(world, "a").x_m, 0.5 - kRobotRadius_m + 0.02) << per_second << " ticks a second, tick " << i;
      }
      EXPECT_GT(pose_of(world, "a").x_m, 0.3) << per_second;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, LongTicks, testing::ValuesIn(test::engine_kinds()), name_of_kind);

/// Engines in which things stand on one another.
class Heaps : public EveryEngine {};

std::vector<std::string> kinds_with_heaps() {
  std::vector<std::string> kinds = kinds_with_forces();
  std::erase_if(kinds, [](const std::string& kind) { return test::engine_traits(kind).plane; });
  return kinds;
}

TEST_P(Heaps, AnUntouchedStackOfEightBoxesStandsForTwoMinutes) {
  constexpr std::size_t kBoxes = 8;
  Scene s = scene(2.0);
  for (std::size_t i = 0; i < kBoxes; ++i) {
    s.box(0.0, 0.0, 0.1, 0.1, 0.0, 0.1).movable(0.5);
    s.scenario.objects.back().placement.p_W[2] = 0.1 * static_cast<double>(i);
  }
  s.scenario.arena_size[2] = 4.0;
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  steps(world, 120 * 10);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  for (std::size_t i = 0; i < kBoxes; ++i) {
    const Object& box = world->space().objects()[i];
    EXPECT_NEAR(box.z_low_m, 0.1 * static_cast<double>(i), 2e-3) << i;
    EXPECT_NEAR(std::hypot(box.x_m, box.y_m), 0.0, 2e-3) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, Heaps, testing::ValuesIn(kinds_with_heaps()), name_of_kind);

}  // namespace
}  // namespace tandem::core
