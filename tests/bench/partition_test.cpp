#include "bench/partition.hpp"

#include <gtest/gtest.h>

namespace tandem::bench {
namespace {

TEST(Partitions, HaveTheNumberOfPartsThatTheirNamesSay) {
  ASSERT_EQ(partitions().size(), 5U);
  for (const Partition& p : partitions()) EXPECT_EQ("A" + std::to_string(parts_of(p.regions)), p.name);
}

TEST(Partitions, AreFoundByNameAndBySplit) {
  EXPECT_EQ(partition_named("A8").value().regions, "4x2");
  EXPECT_EQ(partition_split("4x2").value().name, "A8");
  EXPECT_EQ(partition_split("2x4").value().name, "2x4");
  EXPECT_EQ(partition_split("auto").value().regions, "auto");
  EXPECT_EQ(parts_of("5x3"), 15);
  EXPECT_EQ(parts_of("auto"), 0);
}

TEST(Partitions, ThatAreNoneAreRefusedWithTheChoices) {
  for (const char* name : {"A3", "a1", "", "4x4"}) {
    auto p = partition_named(name);
    ASSERT_FALSE(p.ok()) << name;
    EXPECT_NE(p.error().message.find("A1, A2, A4, A8, A16"), std::string::npos) << p.error().message;
  }
  for (const char* split : {"4", "4x", "x4", "0x4", "4x0", "4x4x4", "1000x1", "-1x1", "4 x 4", "A4", ""}) {
    auto p = partition_split(split);
    ASSERT_FALSE(p.ok()) << split;
    EXPECT_NE(p.error().message.find("columns x lines"), std::string::npos) << p.error().message;
    EXPECT_EQ(parts_of(split), 0) << split;
  }
}

}  // namespace
}  // namespace tandem::bench
