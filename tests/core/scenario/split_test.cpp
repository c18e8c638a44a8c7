#include "core/scenario/split.hpp"

#include <gtest/gtest.h>

namespace tandem::core {
namespace {

TEST(Split, IsColumnsByLines) {
  const auto split = parse_split("4x12");
  ASSERT_TRUE(split);
  EXPECT_EQ(split->columns, 4U);
  EXPECT_EQ(split->lines, 12U);
  EXPECT_TRUE(parse_split("1x1"));
  EXPECT_TRUE(parse_split("999x999"));
}

TEST(Split, IsNothingElse) {
  for (const char* text : {"", "auto", "4", "4x", "x4", "0x4", "4x0", "04x4", "4x4x4", "4X4", " 4x4", "4x4 ", "-4x4",
                           "+4x4", "4.0x4", "1000x1", "1x99999999999999999999"})
    EXPECT_FALSE(parse_split(text)) << text;
}

}  // namespace
}  // namespace tandem::core
