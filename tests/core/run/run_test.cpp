// A run of parts: their turns, their ends, and what becomes of those that fail.
#include "core/run/run.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Calls = std::vector<std::string>;

/// Notes its calls, and fails in one of them.
class Noting final : public RunPart {
 public:
  Noting(std::string name, RunTurn turn, Calls& calls, std::string fails_in = {})
      : name_(std::move(name)), turn_(turn), calls_(calls), fails_in_(std::move(fails_in)) {}
  ~Noting() override { calls_.push_back(name_ + " gone"); }
  std::string_view name() const override { return name_; }
  RunTurn turn() const override { return turn_; }
  hal::Status join(Run&) override { return called("join"); }
  bool before_tick(Run&) override {
    if (!called("before").ok()) throw std::runtime_error("no more");
    return true;
  }
  bool after_tick(Run&) override {
    if (!called("after").ok()) throw std::runtime_error("no more");
    return fresh;
  }
  void event(hal::Tick tick, const hal::Json& event) override {
    (void)called(event["kind"].get<std::string>() + std::to_string(tick));
  }
  hal::Status finish(Run&) override { return called("finish"); }
  hal::Status close(Run&) override { return called("close"); }
  bool fresh = true;

 private:
  hal::Status called(const std::string& what) {
    calls_.push_back(name_ + " " + what);
    return what == fails_in_ ? hal::Status(hal::Error{"the disk is full"}) : hal::Status();
  }
  std::string name_;
  RunTurn turn_;
  Calls& calls_;
  std::string fails_in_;
};

class RunOfParts : public testing::Test {
 protected:
  RunOfParts() : made(make(Scene().robot("a", 0, 0))), run(std::in_place, *made.world, stop) {}
  Noting& add(const std::string& name, RunTurn turn, const std::string& fails_in = {}) {
    auto part = std::make_unique<Noting>(name, turn, calls, fails_in);
    Noting& added = *part;
    run->add(std::move(part));
    return added;
  }
  void length(std::int64_t ticks) { run->add(std::make_unique<Length>(ticks)); }

  std::atomic<bool> stop{false};
  Calls calls;
  MadeWorld made;
  std::optional<core::Run> run;
};

TEST_F(RunOfParts, HaveTheirTurnsInOrderAndEndInReverse) {
  add("pace", RunTurn::Pace);
  add("record", RunTurn::Outputs);
  length(1);
  EXPECT_TRUE(run->go());
  EXPECT_THAT(calls, ElementsAre("record join", "pace join", "record before", "pace before", "record after",
                                 "pace after", "pace finish", "record finish", "pace close", "record close"));
  EXPECT_EQ(made.world->tick(), 1);
  EXPECT_EQ(run->failure(), "");
  calls.clear();
  run.reset();
  EXPECT_THAT(calls, ElementsAre("record gone", "pace gone")) << "as they were added, backwards";
}

TEST_F(RunOfParts, OfOneTurnStandAsTheyWereAdded) {
  add("b", RunTurn::Added);
  add("v", RunTurn::View);
  add("a", RunTurn::Added);
  EXPECT_THAT(run->order(), ElementsAre("v", "b", "a"));
}

TEST_F(RunOfParts, ATickThatIsNotNewIsTheirsAloneWhoseTurnWasBefore) {
  add("hold", RunTurn::Hold).fresh = false;
  add("record", RunTurn::Outputs);
  length(2);
  run->go();
  EXPECT_EQ(std::ranges::count(calls, "record after"), 0);
  EXPECT_EQ(std::ranges::count(calls, "record before"), 2);
}

TEST_F(RunOfParts, AFailureToJoinEndsTheRunBeforeItBegins) {
  add("record", RunTurn::Outputs);
  add("view", RunTurn::View, "join");
  add("pace", RunTurn::Pace);
  EXPECT_FALSE(run->go());
  EXPECT_THAT(run->failure(), HasSubstr("part 'view', join: the disk is full"));
  EXPECT_THAT(calls, ElementsAre("record join", "view join", "view finish", "record finish"));
  EXPECT_EQ(made.world->tick(), 0);
}

TEST_F(RunOfParts, AFailureInATickEndsTheRunAndTheOthersFinish) {
  for (const char* when : {"before", "after"}) {
    calls.clear();
    made = make(Scene().robot("a", 0, 0));
    run.emplace(*made.world, stop);
    add("record", RunTurn::Outputs);
    add("ros", RunTurn::Added, when);
    add("pace", RunTurn::Pace);
    length(100);
    EXPECT_TRUE(run->go());
    EXPECT_THAT(run->failure(), HasSubstr("part 'ros', " + std::string(when) + "_tick: no more"));
    EXPECT_EQ(made.world->tick(), when == std::string("before") ? 0 : 1);
    const Calls end(calls.end() - 6, calls.end());
    EXPECT_THAT(end,
                ElementsAre("pace finish", "ros finish", "record finish", "pace close", "ros close", "record close"));
  }
}

TEST_F(RunOfParts, AFailureAtTheEndLetsTheOthersFinish) {
  add("record", RunTurn::Outputs);
  add("view", RunTurn::View, "finish");
  length(1);
  EXPECT_TRUE(run->go());
  EXPECT_THAT(run->failure(), HasSubstr("part 'view', finish: the disk is full"));
  EXPECT_EQ(calls.back(), "record close");
}

TEST_F(RunOfParts, HearOfEvents) {
  add("view", RunTurn::View);
  add("record", RunTurn::Outputs);
  run->tell(3, {{"kind", "action"}});
  EXPECT_THAT(calls, ElementsAre("record action3", "view action3"));
}

TEST_F(RunOfParts, GoTickByTickWhereTheLoopIsSomebodyElses) {
  add("record", RunTurn::Outputs);
  length(2);
  ASSERT_TRUE(run->begin());
  EXPECT_TRUE(run->tick());
  EXPECT_TRUE(run->tick());
  EXPECT_FALSE(run->tick());
  EXPECT_EQ(run->tick_count(), 2);
  run->end();
  EXPECT_THAT(calls, ElementsAre("record join", "record before", "record after", "record before", "record after",
                                 "record finish", "record close"));
}

/// Counts down, and has no world.
class Countdown final : public Stepped {
 public:
  bool step() override { return ++done_ < 3; }
  hal::Tick tick() const override { return done_; }
  bool running() const override { return true; }

 private:
  hal::Tick done_ = 0;
};

TEST_F(RunOfParts, StepWhatIsNoWorld) {
  Countdown countdown;
  core::Run other(countdown, stop);
  other.add(std::make_unique<Noting>("pace", RunTurn::Pace, calls));
  EXPECT_TRUE(other.go());
  EXPECT_EQ(other.tick_count(), 3) << "the tick that was given up is the last";
  EXPECT_EQ(std::ranges::count(calls, "pace after"), 2);
  EXPECT_THROW((void)other.world(), std::logic_error);
}

TEST_F(RunOfParts, AStopEndsTheRunBeforeItsNextTick) {
  length(0);
  stop = true;
  EXPECT_TRUE(run->go());
  EXPECT_EQ(made.world->tick(), 0);
}

}  // namespace
}  // namespace tandem::core
