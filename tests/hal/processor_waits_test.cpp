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

TEST(ProcessorWaits, TellWhenThreadsHaveTooFewProcessors) {
  if (!std::filesystem::exists("/proc/thread-self/schedstat")) GTEST_SKIP() << "this kernel keeps no account";
  std::atomic<bool> end = false;
  std::vector<std::jthread> busy;
  for (unsigned i = 0; i < 4 * std::max(1U, std::thread::hardware_concurrency()); ++i)
    busy.emplace_back([&end] {
      while (!end) {
      }
    });
  ProcessorWaits waits;
  const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (waits.longest_ns() < 10 * kNsPerMs && std::chrono::steady_clock::now() < latest) {
    waits.look(::getpid());
    std::this_thread::yield();
  }
  end = true;
  EXPECT_GE(waits.longest_ns(), 10 * kNsPerMs);
}

TEST(ProcessorWaits, OfAProcessThatIsNotThereAreNone) {
  ProcessorWaits waits;
  waits.look(-1);
  EXPECT_EQ(waits.longest_ns(), 0);
}

}  // namespace
}  // namespace tandem::hal
