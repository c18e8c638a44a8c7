#include "window/wire/viewer_text.hpp"

#include <gtest/gtest.h>

namespace tandem::window {
namespace {

TEST(ViewerText, IsACommandWithItsId) {
  const auto command = read_viewer_text(R"({"id":7,"do":"go_to","tick":12})");
  ASSERT_TRUE(command.ok());
  EXPECT_EQ(command.value().name, "go_to");
  EXPECT_EQ(command.value().id, 7);
  EXPECT_EQ(hal::to_text(command.value().whole), R"({"do":"go_to","tick":12})");
}

TEST(ViewerText, ThatIsNoneIsAnError) {
  for (const char* text : {"", "nonsense", "[]", "3", "{}", R"({"do":3})", R"({"id":[1],"do":"pause"})",
                           R"({"id":{},"do":"pause"})", R"({"do":"a","do":"b"})"}) {
    EXPECT_FALSE(read_viewer_text(text).ok()) << text;
  }
  EXPECT_FALSE(read_viewer_text(R"({"do":"x","id":")" + std::string(65, 'x') + "\"}").ok());
}

TEST(ViewerText, MayNotBeNestedDeeply) {
  const auto nested = [](int depth) {
    const auto n = static_cast<std::size_t>(depth - 1);
    return R"({"do":"x","a":)" + std::string(n, '[') + std::string(n, ']') + "}";
  };
  EXPECT_TRUE(read_viewer_text(nested(kMostTextDepth)).ok());
  EXPECT_FALSE(read_viewer_text(nested(kMostTextDepth + 1)).ok());
  EXPECT_FALSE(read_viewer_text(nested(30000)).ok());
  EXPECT_TRUE(read_viewer_text(R"({"do":"x","a":"\"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["})").ok());
}

TEST(ViewerText, ListsAreOfTexts) {
  const auto json = hal::parse_json_object(R"({"a":["x","y"],"b":[1],"c":"x"})");
  EXPECT_EQ(text_list(json.value(), "a").value(), (std::vector<std::string>{"x", "y"}));
  EXPECT_TRUE(text_list(json.value(), "none").value().empty());
  EXPECT_FALSE(text_list(json.value(), "b").ok());
  EXPECT_FALSE(text_list(json.value(), "c").ok());
}

}  // namespace
}  // namespace tandem::window
