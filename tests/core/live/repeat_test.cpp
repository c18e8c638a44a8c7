// Records of held runs, and runs that repeat them.
#include "core/live/repeat.hpp"

#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/record/record.hpp"
#include "tests/core/live/held.hpp"

namespace tandem::core {
namespace {

using hal::Json;
using testing::HasSubstr;

/// A held run with a record: events and ticks in the order in which they come.
class Recorded {
 public:
  explicit Recorded(const std::string& path, const Scene& scene, int every = 1)
      : path_(path), made_(make(scene)), live_(*made_.world, options(clock_)) {
    RecordConfig config;
    config.path = path;
    config.every = every;
    config.fingerprint_every = 5;
    recorder_ = std::move(Recorder::open(config, world().space(),
                                         {{"experiment", "scene"}, {"seed", world().seed()}, {"ticks_per_second", 10}}))
                    .value();
    live_.on_event([this](hal::Tick tick, const Json& event) {
      if (event["kind"] == "back") {
        EXPECT_TRUE(recorder_->went_back(tick).ok());
      }
      EXPECT_TRUE(recorder_->event(tick, event).ok());
    });
    world().start();
    live_.start();
  }
  void ask(const Json& command) {
    live_.post(command, [](const Json& answer) { EXPECT_EQ(answer["ok"], true) << answer; });
  }
  void walk(int steps) {
    ask({{"do", "step"}, {"ticks", steps}});
    for (int i = 0; i < steps; ++i) {
      ASSERT_TRUE(live_.before_step());
      world().step();
      if (!live_.after_step()) continue;
      const hal::Tick done = world().tick() - 1;
      EXPECT_TRUE(recorder_->tick_done(world().space(), done).ok());
      if (done >= 0 && recorder_->wants_fingerprint(done)) {
        EXPECT_TRUE(recorder_->fingerprint(done, world().state_hash()).ok());
      }
    }
  }
  Repeatable close() {
    EXPECT_TRUE(recorder_->close(world().tick() - 1, Json::object()).ok());
    auto read = read_repeatable(path_);
    EXPECT_TRUE(read.ok()) << read.error().message;
    return std::move(read).value();
  }
  World& world() { return *made_.world; }

 private:
  static LiveOptions options(FakedClock& clock) {
    LiveOptions options = Held::paused();
    options.clock = &clock;
    return options;
  }
  std::string path_;
  FakedClock clock_;
  MadeWorld made_;
  LiveRun live_;
  std::unique_ptr<Recorder> recorder_;
};

class Repeating : public testing::Test {
 protected:
  Repeating() { std::filesystem::create_directories(folder); }
  ~Repeating() override { std::filesystem::remove_all(folder); }
  std::string file(const std::string& name) const { return (folder / name).string(); }

  /// Runs what the record says as far, and compares fingerprints.
  static void expect_same(const Scene& scene, const Repeatable& repeated, hal::Tick ticks, std::uint64_t end) {
    LiveOptions again = Held::paused();
    again.repeat = repeated.actions;
    WorldOptions options;
    options.seed = repeated.seed;
    Held run(scene, again, options);
    run.walk(static_cast<int>(ticks));
    EXPECT_EQ(run.hash(), end);
    for (const auto& [tick, fingerprint] : repeated.fingerprints)
      EXPECT_EQ(run.new_ticks[tick + 1], fingerprint) << tick;
  }

  std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("tandem_repeating_" + std::to_string(::getpid()));
};

TEST_F(Repeating, HasTheFingerprintsOfTheRecord) {
  for (const int every : {1, 10}) {
    Recorded run(file("run.record"), crowd(), every);
    run.walk(12);
    run.ask({{"do", "halt"}, {"robot", "ep1"}});
    run.walk(8);
    run.ask({{"do", "move"}, {"robot", "ep2"}, {"x", 1.4}, {"y", 1.4}});
    run.walk(10);
    run.ask({{"do", "go_to"}, {"tick", 12}});  // before the second; with the first
    run.ask({{"do", "add"}, {"robot", {{"x", -1.4}, {"y", 1.4}}}});
    run.walk(5);
    run.ask({{"do", "halt"}, {"robot", "ep3"}});
    run.ask({{"do", "undo"}});
    run.walk(1);
    run.ask({{"do", "release"}, {"robot", "*"}});
    run.walk(8);
    run.ask({{"do", "undo"}});
    run.walk(8);
    const std::uint64_t end = run.world().state_hash();
    const Repeatable repeated = run.close();
    EXPECT_EQ(repeated.seed, 7U);
    EXPECT_EQ(repeated.experiment, "scene");
    ASSERT_EQ(repeated.actions.size(), 2U);
    EXPECT_EQ(repeated.actions[1].action["robot"]["id"], "added1");
    EXPECT_EQ(repeated.fingerprints.size(), 6U);
    expect_same(crowd(), repeated, 26, end);
  }
}

TEST_F(Repeating, GoesThroughResetsToo) {
  Recorded run(file("run.record"), crowd());
  run.walk(6);
  run.ask({{"do", "halt"}, {"robot", "ep1"}});
  run.walk(2);
  run.ask({{"do", "reset"}, {"seed", 31}});
  run.walk(5);
  run.ask({{"do", "halt"}, {"robot", "ep2"}});
  run.walk(5);
  const std::uint64_t end = run.world().state_hash();
  const Repeatable repeated = run.close();
  ASSERT_EQ(repeated.actions.size(), 3U);
  EXPECT_EQ(repeated.actions[1].action["do"], "reset");
  EXPECT_EQ(repeated.actions[2].step, 13);
  LiveOptions again = Held::paused();
  again.repeat = repeated.actions;
  Held straight(crowd(), again);
  EXPECT_EQ(straight.ask({{"do", "step"}, {"ticks", 18}})["ok"], true);
  while (straight.live().state().seed != 31 || straight.live().state().tick < 10) std::this_thread::yield();
  EXPECT_EQ(straight.hash(), end);
}

TEST_F(Repeating, SaysWhatCannotBeRepeated) {
  EXPECT_THAT(read_repeatable(file("none")).error().message, HasSubstr("there is no such file"));
  const auto with_event = [&](const Json& event) {
    auto made = make(crowd());
    RecordConfig config;
    config.path = file("odd.record");
    auto recorder = Recorder::open(config, made->space(), {{"seed", 1}});
    EXPECT_TRUE(recorder.value()->event(3, event).ok());
    EXPECT_TRUE(recorder.value()->close(3, Json::object()).ok());
    const auto read = read_repeatable(config.path);
    return read.ok() ? std::string() : read.error().message;
  };
  EXPECT_EQ(with_event({{"kind", "incident"}, {"text", "ouch"}}), "");
  EXPECT_EQ(with_event({{"kind", "action"}, {"action", {{"do", "halt"}, {"robot", "*"}}}}), "");
  EXPECT_THAT(with_event({{"kind", "action"}, {"action", 7}}), HasSubstr("at tick 3"));
  EXPECT_THAT(with_event({{"kind", "back"}}), HasSubstr("makes no sense"));
  EXPECT_THAT(with_event({{"kind", "back"}, {"to", 1}, {"before", {1}}}), HasSubstr("makes no sense"));
}

}  // namespace
}  // namespace tandem::core
