// A robot's board reads the experiment files that the whole program reads.
#include "app/board_names.hpp"

#include <algorithm>
#include <gmock/gmock.h>

#include "app/catalog.hpp"

namespace tandem::app {
namespace {

void expect_all(const std::vector<std::string>& board, const std::vector<std::string>& whole) {
  for (const std::string& name : whole) EXPECT_THAT(board, testing::Contains(name));
}

TEST(BoardNames, AreAllThatTheWholeProgramKnows) {
  const core::KnownNames board = board_names();
  expect_all(board.robots, known_names().robots);
  expect_all(board.engine_names(), known_names().engine_names());
  for (const core::KnownEngine& engine : known_names().engines) {
    const core::EngineTraits& traits = board.engine(engine.name)->traits;
    EXPECT_EQ(board.engine(engine.name)->argos_name, engine.argos_name) << engine.name;
    EXPECT_EQ(traits.plane, engine.traits.plane) << engine.name;
    EXPECT_EQ(traits.air, engine.traits.air) << engine.name;
    EXPECT_EQ(traits.forces, engine.traits.forces) << engine.name;
    EXPECT_EQ(traits.joints, engine.traits.joints) << engine.name;
  }
  expect_all(board.sensors, known_names().sensors);
  expect_all(board.actuators, known_names().actuators);
  EXPECT_GT(known_names().sensors.size(), 10U);
}

}  // namespace
}  // namespace tandem::app
