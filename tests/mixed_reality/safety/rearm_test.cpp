#include "mixed_reality/safety/rearm.hpp"

#include <gtest/gtest.h>

namespace tandem::mixed_reality {
namespace {

TEST(RearmPolicy, IsReadAsItIsWritten) {
  EXPECT_EQ(parse_rearm("proved").value(), RearmPolicy{});
  EXPECT_EQ(parse_rearm("operator").value().by, RearmBy::Operator);
  EXPECT_EQ(parse_rearm("never").value().by, RearmBy::Never);
  EXPECT_EQ(parse_rearm("after 2 s").value(), (RearmPolicy{RearmBy::Time, 2.0}));
  EXPECT_EQ(parse_rearm("after 500ms").value(), (RearmPolicy{RearmBy::Time, 0.5}));
  EXPECT_EQ(parse_rearm("after 3").value(), (RearmPolicy{RearmBy::Time, 3.0}));
  for (const char* text : {"proved", "operator", "never", "after 2 s", "after 0.5 s"})
    EXPECT_EQ(to_text(parse_rearm(text).value()), text);
}

TEST(RearmPolicy, WhatIsNoneIsAnErrorThatSaysWhatWouldDo) {
  for (const char* text : {"", "always", "after", "after ", "after 2 m", "after -1 s", "2 s", "after nan"}) {
    const auto read = parse_rearm(text);
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_NE(read.error().message.find("operator, after 2 s, never"), std::string::npos) << read.error().message;
  }
}

}  // namespace
}  // namespace tandem::mixed_reality
