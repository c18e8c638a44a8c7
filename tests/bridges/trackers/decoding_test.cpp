#include "bridges/trackers/decoding.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "tests/bridges/trackers/bytes.hpp"

namespace tandem::bridges::trackers {
namespace {

std::vector<Sighting> json(std::string_view text) {
  std::vector<Sighting> seen;
  EXPECT_TRUE(decode_json(text_bytes(text), seen)) << text;
  return seen;
}

TEST(JsonPoses, SayWhoWhereAndWhen) {
  const auto seen = json(
      R"({"id":"fb0","t_ns":1234567890123456789,"x":1.5,"y":-2,"z":0.1,"heading":0.25,"sd":0.002,"sd_heading":0.01})"
      "\n");
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].who(), "fb0");
  EXPECT_EQ(seen[0].stamp_ns, 1234567890123456789);
  EXPECT_EQ(seen[0].p_m, (std::array<double, 3>{1.5, -2.0, 0.1}));
  EXPECT_EQ(seen[0].heading_rad, 0.25);
  EXPECT_EQ(seen[0].sd_m, 0.002);
  EXPECT_EQ(seen[0].sd_rad, 0.01);
}

TEST(JsonPoses, MayLeaveOutAllButIdAndPlaceAndNameTagsByNumber) {
  const auto seen = json(R"({"id":12,"x":0,"y":0})");
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].who(), "12");
  EXPECT_FALSE(seen[0].stamp_ns || seen[0].heading_rad || seen[0].sd_m || seen[0].sd_rad);
}

TEST(JsonPoses, ManyOfOneExposureShareItsTime) {
  const auto seen = json(
      "{\"t\":2.5,\"poses\":[{\"id\":\"a\",\"x\":1,\"y\":2},{\"id\":\"b\",\"x\":3,\"y\":4,\"heading\":null}]}\n\n"
      "{\"id\":\"c\",\"x\":5,\"y\":6}");
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].stamp_ns, 2'500'000'000);
  EXPECT_EQ(seen[1].stamp_ns, 2'500'000'000);
  EXPECT_FALSE(seen[2].stamp_ns.has_value());
  EXPECT_EQ(seen[1].p_m[0], 3.0);
}

TEST(JsonPoses, WhatIsMalformedGivesNothingAtAll) {
  for (const char* text : {"",
                           "\n",
                           "hello",
                           "{}",
                           "[]",
                           R"({"id":"a","x":1})",
                           R"({"id":"","x":1,"y":1})",
                           R"({"id":-1,"x":1,"y":1})",
                           R"({"id":"a name that is longer than any tracker's","x":1,"y":1})",
                           R"({"id":"a","x":"1","y":1})",
                           R"({"id":"a","x":1e999,"y":1})",
                           R"({"id":"a","x":1,"y":1,"sd":0})",
                           R"({"id":"a","x":1,"y":1,"sd":-1})",
                           R"({"id":"a","x":1,"y":1,"t":1e300})",
                           R"({"id":"a","x":1,"y":1,"t_ns":1.5})",
                           R"({"id":"a","x":1,"y":1,"t_ns":18446744073709551615})",
                           R"({"poses":3})",
                           R"({"poses":[3]})",
                           "{\"id\":\"a\",\"x\":1,\"y\":1}\n{\"id\":\"b\"",
                           R"({"id":"a","x":1,"x":2,"y":1})"}) {
    std::vector<Sighting> seen;
    EXPECT_FALSE(decode_json(text_bytes(text), seen)) << text;
    EXPECT_TRUE(seen.empty()) << text;
  }
}

const std::vector<Row> kRows = {{"fb0", 1.5, -2.0, 0.125, 0.25, 0.5, 0.75},
                                {"a_name_of_16_chr", 0.0, 0.0, 0.0, std::nan(""), 0.0, 0.0}};

TEST(CompactPoses, AreReadAsTheyAreWritten) {
  const Bytes bytes = compact(1234567890123456789, kRows);
  EXPECT_TRUE(is_compact(bytes));
  std::vector<Sighting> seen;
  ASSERT_TRUE(decode_compact(bytes, seen));
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].who(), "fb0");
  EXPECT_EQ(seen[0].stamp_ns, 1234567890123456789);
  EXPECT_EQ(seen[0].p_m, (std::array<double, 3>{1.5, -2.0, 0.125}));
  EXPECT_EQ(seen[0].heading_rad, 0.25);
  EXPECT_EQ(seen[0].sd_m, 0.5);
  EXPECT_EQ(seen[0].sd_rad, 0.75);
  EXPECT_EQ(seen[1].who(), "a_name_of_16_chr");
  EXPECT_FALSE(seen[1].heading_rad || seen[1].sd_m || seen[1].sd_rad);
}

TEST(CompactPoses, CutShortOrLengthenedTheyAreNone) {
  const Bytes good = compact(5, kRows);
  std::vector<Sighting> seen;
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(decode_compact(std::span(good).first(size), seen)) << size;
  Bytes longer = good;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(decode_compact(longer, seen));
  Bytes flags = good;
  flags[6] = std::byte{1};
  EXPECT_FALSE(decode_compact(flags, seen));
  EXPECT_FALSE(decode_compact(compact(5, {{"", 1.0}}), seen));
  EXPECT_FALSE(decode_compact(compact(5, {{"a", std::nan("")}}), seen));
  EXPECT_TRUE(seen.empty());
}

TEST(LcmPoses, AreReadAsTheyAreWritten) {
  std::vector<Sighting> seen;
  ASSERT_TRUE(decode_lcm(lcm_poses(42, kRows), seen));
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(seen[0].who(), "fb0");
  EXPECT_EQ(seen[0].stamp_ns, 42);
  EXPECT_EQ(seen[0].p_m, (std::array<double, 3>{1.5, -2.0, 0.125}));
  EXPECT_EQ(seen[0].heading_rad, 0.25);
  EXPECT_FALSE(seen[1].heading_rad.has_value());
  seen.clear();
  ASSERT_TRUE(decode_lcm(lcm_poses(0, {{"a"}}), seen));
  EXPECT_FALSE(seen[0].stamp_ns.has_value());
}

TEST(LcmPoses, DamagedTheyAreNone) {
  const Bytes good = lcm_poses(5, kRows);
  std::vector<Sighting> seen;
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_FALSE(decode_lcm(std::span(good).first(size), seen)) << size;
  for (const std::size_t at : {std::size_t{0}, std::size_t{16}, std::size_t{20}}) {  // fingerprint, count, length
    Bytes bad = good;
    bad[at] = std::byte{0xFF};
    EXPECT_FALSE(decode_lcm(bad, seen)) << at;
  }
  EXPECT_FALSE(decode_lcm(lcm_poses(5, {{"a", HUGE_VAL}}), seen));
  EXPECT_TRUE(seen.empty());
}

}  // namespace
}  // namespace tandem::bridges::trackers
