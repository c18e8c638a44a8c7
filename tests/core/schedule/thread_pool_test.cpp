#include "core/schedule/thread_pool.hpp"

#include <gtest/gtest.h>
#include <vector>

namespace tandem::core {
namespace {

TEST(ThreadPool, DoesEveryItemOnceUnderEitherAssignment) {
  for (const Assignment assignment : {Assignment::Static, Assignment::Dynamic}) {
    for (const std::size_t threads : {0U, 1U, 2U, 5U}) {
      ThreadPool pool(threads, assignment);
      for (const std::size_t count : {0U, 1U, 7U, 1000U}) {
        std::vector<int> done(count, 0);
        for (int round = 0; round < 50; ++round) {
          pool.run(count, 3, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ++done[i];
          });
        }
        for (const int n : done) ASSERT_EQ(n, 50);
      }
    }
  }
}

TEST(ThreadPool, SmallPhasesRunOnTheCaller) {
  ThreadPool pool(4, Assignment::Static);
  const auto caller = std::this_thread::get_id();
  pool.run(9, 5, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(begin, 0U);
    EXPECT_EQ(end, 9U);
  });
}

TEST(ThreadPool, PartsAreEachRunOnce) {
  ThreadPool pool(3, Assignment::Dynamic);
  std::vector<int> done(3, 0);
  pool.run_parts([&](std::size_t part) { ++done[part]; });
  EXPECT_EQ(done, (std::vector<int>{1, 1, 1}));
}

}  // namespace
}  // namespace tandem::core
