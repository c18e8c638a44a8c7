// The loop of the servers: it turns when it should, ends when it is told, and says when it came too late.
#include "bridges/emulation/serving.hpp"

#include <gtest/gtest.h>
#include <string>

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;

struct Told {
  std::string text;
  EventSink sink = [this](hal::TimeNs at, std::string_view event, const EventFields& fields) {
    text += to_json(at, event, fields) + "\n";
  };
};

TEST(Serving, TellsOfATurnThatBeginsLate) {
  Told told;
  tell_late(100 * kMs, 100 * kMs + kLateNs - 1, told.sink);
  tell_late(100 * kMs, 99 * kMs, told.sink);
  EXPECT_EQ(told.text, "");
  tell_late(100 * kMs, 137 * kMs, told.sink);
  EXPECT_EQ(told.text, "{\"t_ns\":137000000,\"event\":\"late\",\"by_ms\":37}\n");
}

TEST(Serving, TellsOfATurnThatWasLateBecauseTheOneBeforeWasLong) {
  Told told;
  std::atomic<bool> stop{false};
  int turns = 0;
  const hal::Status ended = turn_until(
      stop, told.sink,
      [&](hal::TimeNs now) {
        if (turns++ == 0) {
          while (monotonic_ns() < now + 60 * kMs) {
          }
        }
        stop = turns == 2;
        return hal::Status{};
      },
      [](hal::TimeNs now) { return now - 500 * kMs; },  // a wake time of the past is now
      [](hal::TimeNs, hal::TimeNs) { return hal::Status{}; });
  EXPECT_TRUE(ended.ok());
  const std::string mark = "\"event\":\"late\",\"by_ms\":";
  const std::size_t at = told.text.rfind(mark);
  ASSERT_NE(at, std::string::npos) << told.text;
  const int by_ms = std::stoi(told.text.substr(at + mark.size()));
  EXPECT_GE(by_ms, 60);
  EXPECT_LT(by_ms, 500 + 60) << "not counted from a wake time before the turn";
}

TEST(Serving, TellsOfALateTurnThatIsNoMoreBecauseItIsToldToStop) {
  Told told;
  std::atomic<bool> stop{false};
  const hal::Status ended = turn_until(
      stop, told.sink, [](hal::TimeNs) { return hal::Status{}; }, [](hal::TimeNs now) { return now; },
      [&](hal::TimeNs, hal::TimeNs now) {
        while (monotonic_ns() < now + 60 * kMs) {
        }
        stop = true;
        return hal::Status{};
      });
  EXPECT_TRUE(ended.ok());
  EXPECT_NE(told.text.find("\"event\":\"late\""), std::string::npos) << told.text;
}

TEST(Serving, EndsWithTheErrorOfATurnOrAWait) {
  Told told;
  const std::atomic<bool> stop{false};
  const auto fine = [](auto...) { return hal::Status{}; };
  const auto fails = [](auto...) { return hal::Status(hal::Error{"gone"}); };
  const auto soon = [](hal::TimeNs now) { return now; };
  EXPECT_EQ(turn_until(stop, told.sink, fails, soon, fine).error().message, "gone");
  EXPECT_EQ(turn_until(stop, told.sink, fine, soon, fails).error().message, "gone");
}

}  // namespace
}  // namespace tandem::bridges
