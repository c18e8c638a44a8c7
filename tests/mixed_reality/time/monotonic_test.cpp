#include "mixed_reality/time/monotonic.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <thread>

namespace tandem::mixed_reality {
namespace {

TEST(MonotonicTime, NeverReturnsFromASleepTooEarly) {
  MonotonicTime time;
  const std::atomic<bool> go_on{false};
  const hal::TimeNs until = time.now_ns() + 2 * hal::kNsPerMs;
  time.sleep_until(until, go_on);
  EXPECT_GE(time.now_ns(), until);
}

TEST(MonotonicTime, ReturnsAtOnceWhenTheTimeHasPassedOrWhenToldToStop) {
  MonotonicTime time;
  const std::atomic<bool> go_on{false};
  time.sleep_until(1, go_on);
  const std::atomic<bool> stop{true};
  time.sleep_until(time.now_ns() + 3'600 * hal::kNsPerSecond, stop);  // an hour: the test would run into its limit
}

TEST(RealtimePriority, IsInForceWhenGrantedAndExplainedWhenNot) {
  std::thread([] {
    const hal::Status status = ask_for_realtime_priority(10);
    int policy = -1;
    sched_param param{};
    ASSERT_EQ(pthread_getschedparam(pthread_self(), &policy, &param), 0);
    if (status.ok()) {
      EXPECT_EQ(policy, SCHED_FIFO);
      EXPECT_EQ(param.sched_priority, 10);
    } else {
      EXPECT_EQ(policy, SCHED_OTHER);
      EXPECT_NE(status.error().message.find("SCHED_FIFO"), std::string::npos);
    }
  }).join();
}

TEST(RealtimePriority, RefusesAPriorityThatThereIsNot) {
  const hal::Status status = ask_for_realtime_priority(1'000);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("1 to 99"), std::string::npos);
}

}  // namespace
}  // namespace tandem::mixed_reality
