#include "bridges/aseba/rest_message.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::aseba {
namespace {

TEST(FootbotStopBody, IsReadBackAsItWasWritten) {
  const std::vector<RestMessage> messages = {{0xA001, {0x07, 0x00, 0xFF, 0x10}}, {3, {}}, {0xA00C, {1}, true}};
  EXPECT_EQ(to_stop_body(messages), "40961 0700ff10\n3 \n40972 01 read back\n");
  EXPECT_EQ(from_stop_body(to_stop_body(messages)), messages);
  EXPECT_EQ(from_stop_body(""), std::vector<RestMessage>{});
}

TEST(FootbotStopBody, IsRefusedWhenItIsCutShortOrNoNumbers) {
  for (const char* body : {"1", "1 00", "1 0\n", "x 00\n", "1 0g\n", " 00\n", "70000 00\n", "-1 00\n"}) {
    EXPECT_FALSE(from_stop_body(body)) << body;
  }
}

}  // namespace
}  // namespace tandem::bridges::aseba
