// The stop against every state of the firmware's parser and every pattern of lost, doubled and flipped bytes.
#include "bridges/epuck/stop.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

#include "tests/bridges/epuck/parser_automaton.hpp"

namespace tandem::bridges::epuck {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
using Bytes = std::vector<std::uint8_t>;
using States = std::set<ParserState>;

Bytes one_round() {
  Bytes bytes;
  for (std::size_t i = 0; i < kStopBursts; ++i) bytes.insert(bytes.end(), stop_burst(i).begin(), stop_burst(i).end());
  return bytes;
}

Bytes one_round_and_question() {
  Bytes bytes = one_round();
  bytes.insert(bytes.end(), rest_question().begin(), rest_question().end());
  return bytes;
}

/// A line that the host left half-received may be one that it meant: "D,300,300" as well as "D".
bool half_received_speeds(const ParserState& s) {
  return (s.mode == ParserState::Mode::Payload && moves_wheels(s.command, 0)) ||
         (s.mode == ParserState::Mode::Line && (s.first == 'D' || s.first == 'd'));
}

/// Everything that can become of `start` when at most `most_lost` of `bytes` do not arrive, by the number that did not,
/// and with `wrong` of them doubled or with a flipped bit. `seen` is told every state on the way.
template <class F>
std::vector<std::vector<States>> explore(const std::vector<ParserState>& start, const Bytes& bytes,
                                         std::size_t most_lost, std::size_t most_wrong, F&& seen) {
  std::vector now(most_wrong + 1, std::vector<States>(most_lost + 1));
  now[0][0].insert(start.begin(), start.end());
  for (const std::uint8_t byte : bytes) {
    std::vector next(most_wrong + 1, std::vector<States>(most_lost + 1));
    for (std::size_t wrong = 0; wrong <= most_wrong; ++wrong) {
      for (std::size_t lost = 0; lost <= most_lost; ++lost) {
        for (const ParserState& s : now[wrong][lost]) {
          const auto go = [&](const ParserState& to, std::size_t w, std::size_t l) {
            if (w > most_wrong || l > most_lost) return;
            if (next[w][l].insert(to).second) seen(to, l);
          };
          go(after(s, byte), wrong, lost);
          go(s, wrong, lost + 1);
          if (wrong == most_wrong) continue;
          go(after(after(s, byte), byte), wrong + 1, lost);
          for (unsigned bit = 0; bit < 8; ++bit)
            go(after(s, static_cast<std::uint8_t>(byte ^ (1U << bit))), wrong + 1, lost);
        }
      }
    }
    now = std::move(next);
  }
  return now;
}

TEST(EpuckStop, EndsAtRestFromEveryStateWithEightBytesLostAndOneDoubledOrFlipped) {
  const auto ends = explore(all_states(), one_round(), 8, 1, [](const ParserState&, std::size_t) {});
  std::size_t states = 0;
  for (const auto& by_lost : ends) {
    for (const States& reached : by_lost) {
      states += reached.size();
      for (const ParserState& s : reached) ASSERT_EQ(s.wheels, Motion::Zero) << int(s.mode) << " " << int(s.command);
    }
  }
  EXPECT_GT(states, 50U);  // it was an exploration
}

TEST(EpuckStop, StaysAtRestWhenItsQuestionSuffersTheSame) {
  const auto ends = explore(all_states(), one_round_and_question(), 8, 0, [](const ParserState&, std::size_t) {});
  for (const States& reached : ends[0]) {
    for (const ParserState& s : reached) EXPECT_EQ(s.wheels, Motion::Zero);
  }
}

TEST(EpuckStop, LeavesParserAndVariablesCleanWhenNothingIsLost) {
  const auto ends = explore(all_states(), one_round(), 0, 0, [](const ParserState&, std::size_t) {});
  EXPECT_EQ(ends[0][0], States{ParserState{}});
}

/// The fewest lost bytes with which a byte of the stop becomes a speed, however briefly.
std::size_t fewest_losses_to_move(const std::vector<ParserState>& start) {
  constexpr std::size_t kMost = 60;
  std::size_t fewest = kMost + 1;
  explore(start, one_round_and_question(), kMost, 0, [&](const ParserState& s, std::size_t lost) {
    if (s.wheels == Motion::Strange) fewest = std::min(fewest, lost);
  });
  return fewest;
}

TEST(EpuckStop, NeedsTheseLossesToTurnItsOwnBytesIntoSpeeds) {
  std::vector<ParserState> half, whole;
  for (const ParserState& s : all_states()) (half_received_speeds(s) ? half : whole).push_back(s);
  // bridges/epuck/README.md names both numbers.
  EXPECT_EQ(fewest_losses_to_move(whole), 53U);
  EXPECT_EQ(fewest_losses_to_move(half), 40U);
}

TEST(EpuckStop, FitsTheRobotsBufferBurstByBurst) {
  for (std::size_t i = 0; i < kStopBursts; ++i) EXPECT_LE(stop_burst(i).size(), Packet::kCapacity);
  EXPECT_LE(rest_question().size(), Packet::kCapacity);
}

/// The procedure with a time that the test moves.
struct Talk {
  StopProcedure stop;
  Packet out;
  hal::TimeNs now = 1000 * kMs;
  Bytes sent;

  void run(hal::TimeNs duration) {
    for (const hal::TimeNs end = now + duration; now < end; now += kMs) {
      stop.poll(now, out);
      sent.insert(sent.end(), out.bytes().begin(), out.bytes().end());
      out.clear();
    }
  }
  bool asked() {
    const auto question = rest_question();
    const bool yes = std::search(sent.begin(), sent.end(), question.begin(), question.end()) != sent.end();
    sent.clear();
    return yes;
  }
  void answer(const Bytes& bytes) {
    for (const std::uint8_t byte : bytes) stop.on_byte(byte, now);
  }
};

TEST(EpuckStop, IsConfirmedByTwoReadingsOfARobotAtRest) {
  Talk talk;
  talk.stop.begin(talk.now);
  talk.run(60 * kMs);
  ASSERT_TRUE(talk.asked());
  talk.answer({1, 0, 2, 0, 0, 0, 0, 0});
  EXPECT_FALSE(talk.stop.confirmed());
  talk.run(60 * kMs);
  ASSERT_TRUE(talk.asked());
  talk.answer({1, 0, 2, 0, 0, 0, 0, 0});
  EXPECT_TRUE(talk.stop.confirmed());
  EXPECT_EQ(talk.stop.counters(), (std::array<std::int16_t, 2>{1, 2}));
}

TEST(EpuckStop, IsSaidAgainWhileTheWheelsTurnOrTheirSpeedIsNotZero) {
  for (const bool turning : {true, false}) {
    Talk talk;
    talk.stop.begin(talk.now);
    talk.run(60 * kMs);
    ASSERT_TRUE(talk.asked());
    talk.answer({1, 0, 2, 0, 0, 0, 0, 0});
    talk.run(60 * kMs);
    ASSERT_TRUE(talk.asked());
    talk.answer(turning ? Bytes{3, 0, 2, 0, 0, 0, 0, 0} : Bytes{1, 0, 2, 0, 0, 1, 0, 0});
    EXPECT_FALSE(talk.stop.confirmed());
    EXPECT_EQ(talk.stop.failed_rounds(), 1);
    talk.run(15 * kMs);
    EXPECT_GE(talk.sent.size(), stop_burst(0).size());
  }
}

TEST(EpuckStop, IsSaidEvery200MsForAsLongAsNobodyAnswers) {
  Talk talk;
  talk.stop.begin(talk.now);
  talk.run(10'000 * kMs);
  EXPECT_GE(talk.stop.failed_rounds(), 50);
  EXPECT_FALSE(talk.stop.answered());
}

TEST(EpuckStop, DoesNotTakeOlderAnswersForItsOwn) {
  Talk talk;
  talk.stop.begin(talk.now);
  for (int i = 0; i < 8; ++i) {  // what was under way trickles in
    talk.answer({0, 0, 0, 0});
    talk.run(10 * kMs);
  }
  EXPECT_FALSE(talk.stop.answered());
  talk.run(30 * kMs);
  ASSERT_TRUE(talk.asked());
  talk.answer({0, 0, 0, 0, 0, 0, 0, 0, 0});  // a byte too many
  talk.run(30 * kMs);
  EXPECT_EQ(talk.stop.failed_rounds(), 1);
}

}  // namespace
}  // namespace tandem::bridges::epuck
