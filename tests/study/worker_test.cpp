#include "study/sweep/worker.hpp"

#include <cstdio>
#include <cstdlib>
#include <gmock/gmock.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::study {
namespace {

TEST(Worker, ItsLastWordsAreOfTheRunThatEndedItHoweverLateTheyAreHeard) {
  const auto make = [](std::int64_t run) {
    std::fprintf(stderr, "words of run %d\n", static_cast<int>(run));
    if (run == 2) _exit(3);
    return RunOutcome{};
  };
  auto started = Worker::start(make, {}, false);
  ASSERT_TRUE(started) << started.error().message;
  Worker& worker = **started;
  ASSERT_TRUE(worker.give(1, 0.0));
  ASSERT_TRUE(worker.give(2, 0.0));
  siginfo_t ended{};
  ASSERT_EQ(waitid(P_ALL, 0, &ended, WEXITED | WNOWAIT), 0) << "both runs are over before this process looks";

  worker.listen();
  std::vector<ToldOutcome> told;
  while (worker.receive(told, 0.1)) {
  }
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].run, 1);
  EXPECT_THAT(worker.given(), testing::ElementsAre(2));
  EXPECT_EQ(worker.end(), "words of run 2");
}

TEST(Worker, ARunWithoutWordsIsNotGivenThoseOfTheRunBefore) {
  const auto make = [](std::int64_t run) {
    if (run == 2) _exit(3);
    std::fprintf(stderr, "words of run %d\n", static_cast<int>(run));
    return RunOutcome{};
  };
  auto started = Worker::start(make, {}, false);
  ASSERT_TRUE(started) << started.error().message;
  Worker& worker = **started;
  ASSERT_TRUE(worker.give(1, 0.0));
  ASSERT_TRUE(worker.give(2, 0.0));
  std::vector<ToldOutcome> told;
  pollfd results{worker.results(), POLLIN, 0};
  while (poll(&results, 1, 10'000) > 0 && worker.receive(told, 0.1)) {
  }
  EXPECT_EQ(told.size(), 1U);
  EXPECT_EQ(worker.end(), "its process ended with exit code 3");
}

}  // namespace
}  // namespace tandem::study
