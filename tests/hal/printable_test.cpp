#include "hal/printable.hpp"

#include <gtest/gtest.h>

namespace tandem::hal {
namespace {

TEST(Printable, LeavesTextsOfPeopleAsTheyAre) {
  for (const char* text : {"plain", "Grüße, 東京 ✓ 🤖", "two\nlines\tand a tab", ""})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, WhatCommandsATerminalIsSpelledOut) {
  EXPECT_EQ(printable("\033[2Jgone"), "\\x1b[2Jgone");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\r\x7f\xc2\x9b"), "\\x0d\\x7f\\xc2\\x9b");
  EXPECT_EQ(printable("\xff\xed\xa0\x80"), "\\xff\\xed\\xa0\\x80") << "no UTF-8";
}

TEST(Printable, WhatTurnsOrHidesItsNeighboursIsSpelledOut) {
  EXPECT_EQ(printable("safe\u202Eexe.txt"), "safe\\u202eexe.txt");
  EXPECT_EQ(printable("\u2066a\u2069\u200B\uFEFF\u2028"), "\\u2066a\\u2069\\u200b\\ufeff\\u2028");
  EXPECT_EQ(printable("\U000E0041"), "\\U000e0041");
  EXPECT_EQ(printable("\u2013\u2014\u2019\u2026"), "\u2013\u2014\u2019\u2026") << "dashes, quotes, ellipsis";
}

TEST(Printable, NoLineOfAMessagePassesForAnEntryOfALog) {
  EXPECT_EQ(printable_entry("failed\nerror: the arena burns"), "failed\n    error: the arena burns");
  EXPECT_EQ(printable_entry("one"), "one");
}

TEST(Printable, LongTextsAreCutAtACharacterAndSaySo) {
  EXPECT_EQ(shortened("abc", 3), "abc");
  EXPECT_EQ(shortened("abcd", 3), "abc… (cut: 4 bytes in all)");
  EXPECT_EQ(shortened("aü", 2), "a… (cut: 3 bytes in all)");
  EXPECT_LT(shortened(std::string(20'000'000, 'x')).size(), kLongestMessage + 100);
}

}  // namespace
}  // namespace tandem::hal
