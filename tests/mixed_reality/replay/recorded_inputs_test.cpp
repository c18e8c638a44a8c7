#include "mixed_reality/replay/recorded_inputs.hpp"

#include <fstream>

#include "core/record/block_file.hpp"
#include "tests/mixed_reality/replay/story.hpp"

namespace tandem::mixed_reality {
namespace {

using testing::HasSubstr;

core::Scene one_real() {
  core::Scene scene(4.0, "drive");
  scene.param("left", "0.06").param("right", "0.05").robot("ep0", -1.0, 0.0);
  return std::move(made_real(scene, "ep0"));
}

std::size_t place_of_inputs(const std::string& path, hal::Tick tick) {
  auto file = core::BlockFileReader::open(path);
  EXPECT_TRUE(file.ok());
  while (const auto block = file.value().next()) {
    if (block->type == static_cast<std::uint16_t>(core::RecordBlock::Inputs) && block->tick == tick) return block->at;
  }
  return 0;
}

TEST(RecordedInputs, EndWhereABlockIsDamagedAndSayWhere) {
  RecordedStory story(one_real(), "damaged");
  ASSERT_NO_FATAL_FAILURE(story.run(60));
  {
    std::fstream file(story.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(place_of_inputs(story.path(), 25) + core::kBlockHeaderBytes + 2));
    file.put('\x55');
  }
  const auto again = story.again();
  EXPECT_EQ(again.recorded, 25);
  EXPECT_EQ(again.equal, 25);
  EXPECT_THAT(again.end, HasSubstr("a block of tick 25 is damaged"));
}

TEST(RecordedInputs, OfARunThatWasKilledEndWithItsLastTick) {
  RecordedStory story(one_real(), "killed");
  ASSERT_NO_FATAL_FAILURE(story.run(60));
  std::filesystem::resize_file(story.path(), place_of_inputs(story.path(), 40) + 7);
  const auto again = story.again();
  EXPECT_EQ(again.recorded, 40);
  EXPECT_EQ(again.equal, 40);
  EXPECT_THAT(again.end, HasSubstr("cut"));
}

TEST(RecordedInputs, OfARunWithoutRealRobotsAreAnError) {
  core::Scene scene(4.0, "drive");
  scene.robot("sim", 0.0, 0.0);
  RecordedStory story(scene, "nobody");
  ASSERT_NO_FATAL_FAILURE(story.run(5));
  EXPECT_THAT(story.again().failure, HasSubstr("holds no inputs of real robots"));
}

TEST(RecordedInputs, OfARobotThatTheExperimentLacksAreAnError) {
  RecordedStory story(one_real(), "lacks");
  ASSERT_NO_FATAL_FAILURE(story.run(5));
  core::Scene other(4.0, "drive");
  other.robot("ep7", 0.0, 0.0);
  core::MadeWorld made = core::make(other);
  EXPECT_THAT(Replay::make(*made.world, story.path(), {}).error().message,
              HasSubstr("robot 'ep0' took part as a real one, and is not in the experiment"));
}

/// As a release to come may have it.
struct OddTwin {
  static constexpr std::string_view kName = "twin";
  static constexpr std::string_view kDoc = "";
  float x = 0.0F;
  void describe(hal::FieldList& f) const { f.add("x", x, hal::unit::m, ""); }
};

TEST(RecordedInputs, OfAnotherReleaseAreAnErrorThatNamesTheField) {
  RecordedStory story(one_real(), "odd");
  core::MadeWorld made = core::make(one_real());
  const OddTwin row;
  const core::SpaceInputs inputs{{{made.world->space().find_robot("ep0"), &hal::row_type<OddTwin>(), &row}}};
  core::RecordConfig config;
  config.path = story.path();
  auto recorder = core::Recorder::open(config, made.world->space(), {{"seed", 7}});
  ASSERT_TRUE(recorder.value()->set_inputs(made.world->space(), inputs).ok());
  ASSERT_TRUE(recorder.value()->close(0, hal::Json::object()).ok());
  EXPECT_THAT(story.again().failure, HasSubstr("'twin' has other fields in the record than in this program ('x')"));
}

}  // namespace
}  // namespace tandem::mixed_reality
