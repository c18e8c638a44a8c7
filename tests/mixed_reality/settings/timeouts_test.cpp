#include "mixed_reality/settings/timeouts.hpp"

#include <gtest/gtest.h>

namespace tandem::mixed_reality {
namespace {

TEST(LostAfter, IsTheBridgesTimeoutButTwoTicksAtLeast) {
  core::RobotItem item;
  item.bridge = core::BridgeConfig{};
  item.bridge->timeout_s = 0.5;
  EXPECT_EQ(lost_after_ns(item, 10), 500 * hal::kNsPerMs);
  EXPECT_EQ(lost_after_ns(item, 1), 2'000 * hal::kNsPerMs);
}

}  // namespace
}  // namespace tandem::mixed_reality
