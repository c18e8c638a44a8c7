#include "bridges/trackers/lcm_tracker.hpp"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

#include "tests/bridges/trackers/bytes.hpp"

namespace tandem::bridges::trackers {
namespace {

TEST(LcmTracker, TakesPosesOfItsChannelAndCountsWhatIsNone) {
  auto link = lcm_bus::LcmLink::open("memq://");
  ASSERT_TRUE(link.ok());
  const auto tracker = make_lcm_tracker(link.value(), "tandem/poses");
  ASSERT_TRUE(tracker->start().ok());
  link.value()->publish("tandem/poses", lcm_poses(7, {{"fb0", 1.0, 2.0, 0.0, 0.5}}));
  link.value()->publish("tandem/other", lcm_poses(8, {{"fb1"}}));
  link.value()->publish("tandem/poses", text_bytes("nonsense"));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (tracker->report().messages < 2 && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  std::vector<Sighting> seen(10);
  seen.resize(tracker->take(seen));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].who(), "fb0");
  EXPECT_EQ(seen[0].stamp_ns, 7);
  EXPECT_GT(seen[0].received_ns, 0);
  EXPECT_EQ(tracker->report().malformed, 1U);
}

}  // namespace
}  // namespace tandem::bridges::trackers
