#include "hal/token.hpp"

#include <gtest/gtest.h>
#include <set>
#include <string>

namespace tandem::hal {
namespace {

TEST(Token, Are128RandomBits) {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const auto token = make_token();
    ASSERT_TRUE(token.ok());
    EXPECT_EQ(token.value().size(), 32U);
    EXPECT_EQ(token.value().find_first_not_of("0123456789abcdef"), std::string::npos);
    seen.insert(token.value());
  }
  EXPECT_EQ(seen.size(), 100U);
}

TEST(Token, IsTheSameOnlyWhenItIsWhole) {
  EXPECT_TRUE(same_token("abc", "abc"));
  EXPECT_FALSE(same_token("abd", "abc"));
  EXPECT_FALSE(same_token("ab", "abc"));
  EXPECT_FALSE(same_token("", "abc"));
}

}  // namespace
}  // namespace tandem::hal
