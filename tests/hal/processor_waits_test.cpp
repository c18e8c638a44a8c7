#include "hal/processor_waits.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <gtest/gtest.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace tandem::hal {
namespace {

/// More threads than processors, until one of them has waited for so long; they are there, and idle, until it ends.
class Crowd {
 public:
  explicit Crowd(TimeNs waited_ns) {
    for (unsigned i = 0; i < 4 * std::max(1U, std::thread::hardware_concurrency()); ++i)
      busy_.emplace_back([this] {
        while (!idle_) {
        }
        end_.wait(false);
      });
    const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (waits_.longest_ns() < waited_ns && std::chrono::steady_clock::now() < latest) {
      waits_ = {};
      waits_.look(::getpid());
      std::this_thread::yield();
    }
    idle_ = true;
  }
  ~Crowd() {
    end_ = true;
    end_.notify_all();
  }
  /// By a look at threads that are new to it.
  TimeNs waited_ns() const { return waits_.longest_ns(); }

 private:
  std::atomic<bool> idle_ = false, end_ = false;
  ProcessorWaits waits_;
  std::vector<std::jthread> busy_;
};

TEST(ProcessorWaits, TellWhenThreadsHaveTooFewProcessors) {
  if (!std::filesystem::exists("/proc/thread-self/schedstat")) GTEST_SKIP() << "this kernel keeps no account";
  EXPECT_GE(Crowd(10 * kNsPerMs).waited_ns(), 10 * kNsPerMs);
}

// Threads that were there before a trial have waited in what came before it.
TEST(ProcessorWaits, BeforeTheBeginningDoNotCount) {
  if (!std::filesystem::exists("/proc/thread-self/schedstat")) GTEST_SKIP() << "this kernel keeps no account";
  const Crowd crowd(kNsPerSecond);
  ASSERT_GE(crowd.waited_ns(), kNsPerSecond);
  ProcessorWaits waits;
  waits.begin(::getpid());
  waits.look(::getpid());
  EXPECT_LT(waits.longest_ns(), kNsPerSecond);
}

TEST(ProcessorWaits, OfAProcessThatIsNotThereAreNone) {
  ProcessorWaits waits;
  waits.look(-1);
  EXPECT_EQ(waits.longest_ns(), 0);
}

}  // namespace
}  // namespace tandem::hal
