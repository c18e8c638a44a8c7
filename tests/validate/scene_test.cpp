#include "validate/scene.hpp"

#include <gtest/gtest.h>

namespace tandem::validate {
namespace {

TEST(Scenes, AreAllReadAndHaveAClosedForm) {
  std::size_t scenes = 0;
  for (const hal::CarriedFile& file : scene_files()) {
    if (!file.name.starts_with("scenes/")) continue;
    const auto scene = read_scene(file.name, std::string(file.text));
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_FALSE(scene.value().series.empty()) << file.name;
    ++scenes;
  }
  EXPECT_GE(scenes, 10U);
}

TEST(Scenes, NameTheLineOfAMistake) {
  const auto scene = read_scene("a.xml", "<scene seconds=\"1\">\n<drive id=\"x\"/>\n</scene>");
  ASSERT_FALSE(scene.ok());
  EXPECT_NE(scene.error().message.find("a.xml:2"), std::string::npos) << scene.error().message;
}

TEST(Scenes, PutTheVariedSettingIntoTheExperiment) {
  const auto scene = read_scene("scenes/slide.xml", scene_text("scenes/slide.xml"));
  ASSERT_TRUE(scene.ok());
  const std::string text = experiment_of(scene.value(), scene.value().series.front(), 50.0);
  EXPECT_NE(text.find("ticks_per_second=\"50\""), std::string::npos) << text;
  EXPECT_NE(text.find("<dynamics2d"), std::string::npos) << text;
}

}  // namespace
}  // namespace tandem::validate
