// Mixed runs in faked time, with faults and people's actions drawn from a seed, recorded and computed again.
#pragma once
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gmock/gmock.h>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <unistd.h>

#include "core/live/live_run.hpp"
#include "core/live/repeat.hpp"
#include "core/record/record.hpp"
#include "mixed_reality/replay/replay.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "tests/core/scenes.hpp"
#include "tests/mixed_reality/fake_robot.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::mixed_reality {

inline const std::atomic<bool> kNeverStop{false};

inline core::Scene& made_real(core::Scene& scene, const std::string& id) {
  for (core::RobotItem& item : scene.scenario.robots) {
    if (item.id == id) item.bridge = core::BridgeConfig{"fake:" + id, 0.5, {}, 7};
  }
  return scene;
}

/// A mixed run that is recorded.
class RecordedStory {
 public:
  explicit RecordedStory(core::Scene scene, const std::string& name = "story")
      : scene_(std::move(scene)), path_(testing::TempDir() + "tandem_" + std::to_string(getpid()) + "_" + name) {}
  ~RecordedStory() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  FakeBody& body(const std::string& id) { return bodies_[id]; }
  MixedOptions& options() { return options_; }
  FakeTime& time() { return time_; }
  MixedSession& session() { return *session_; }
  core::LiveRun& live() { return *live_; }
  const core::Scene& scene() const { return scene_; }
  const std::string& path() const { return path_; }
  void ask(const hal::Json& command) { live_->post(command, {}); }

  /// `after_tick` is called after every tick, and what it posts is done before the next.
  void run(hal::Tick ticks, const std::function<void(core::World&)>& after_tick = {}) {
    core::MadeWorld made = core::make(scene_);
    ASSERT_TRUE(made.world) << made.all_problems();
    for (const core::RobotItem& item : scene_.scenario.robots) {
      if (item.bridge)
        bodies_[item.id].pose = core::Pose::at(item.placement.p_W[0], item.placement.p_W[1], item.placement.yaw_rad);
    }
    core::World& world = *made.world;
    auto session = MixedSession::make(
        std::move(made.world),
        [this](const bridges::BridgeRequest& request) -> bridges::MadeBridge {
          return std::unique_ptr<bridges::RobotBridge>(std::make_unique<FakeRobot>(bodies_[request.robot]));
        },
        time_, options_);
    ASSERT_TRUE(session.ok()) << session.error().message;
    session_ = std::move(session).value();
    core::RecordConfig config;
    config.path = path_;
    auto recorder = core::Recorder::open(
        config, world.space(),
        {{"experiment", "scene"}, {"seed", world.seed()}, {"ticks_per_second", world.ticks_per_second()}});
    ASSERT_TRUE(recorder.ok()) << recorder.error().message;
    core::LiveOptions live;
    live.real_robots = true;
    live_ = std::make_unique<core::LiveRun>(world, std::move(live));
    live_->on_event(
        [&](hal::Tick tick, const hal::Json& event) { EXPECT_TRUE(recorder.value()->event(tick, event).ok()); });
    const hal::Status connected = session_->connect(kNeverStop);
    ASSERT_TRUE(connected.ok()) << connected.error().message;
    ASSERT_TRUE(recorder.value()->set_inputs(world.space(), session_->inputs()).ok());
    const hal::Status ran = session_->run(ticks, kNeverStop, [&](core::World& w) {
      const hal::Tick done = w.tick() - 1;
      ASSERT_TRUE(recorder.value()->tick_done(w.space(), done).ok());
      const core::StateChecks checks = core::checks_of(w.state_view());
      ASSERT_EQ(checks.fingerprint, w.state_hash());
      ASSERT_TRUE(recorder.value()->fingerprint(done, checks.fingerprint).ok());
      ASSERT_TRUE(recorder.value()->checks(done, checks).ok());
      if (after_tick) after_tick(w);
      (void)live_->after_step();
    });
    ASSERT_TRUE(ran.ok()) << ran.error().message;
    live_->close();
    ASSERT_TRUE(recorder.value()->close(world.tick() - 1, hal::Json::object()).ok());
    live_.reset();
    loader_ = std::move(made.loader);
  }

  /// Computes it again; `before_step` is called before every tick. Stops at the first tick that is not as it was, and
  /// says so.
  struct Again {
    hal::Tick equal = 0;     ///< ticks that were as recorded
    std::string difference;  ///< at the first that was not
    std::string failure;
    std::vector<Deviation> deviations;
    hal::Tick recorded = 0;
    std::string end;
    std::vector<std::uint64_t> hashes;  ///< after each tick
  };
  Again again(std::int64_t threads = 0, const std::function<void(core::World&)>& before_step = {},
              std::optional<hal::Tick> from = {}) {
    Again result;
    const auto repeated = core::read_repeatable(path_);
    if (!repeated.ok()) {
      result.failure = repeated.error().message;
      return result;
    }
    core::WorldOptions world_options;
    world_options.threads = threads;
    core::MadeWorld made = core::make(scene_, world_options);
    auto replay = Replay::make(*made.world, path_, {from, {}});
    if (!replay.ok()) {
      result.failure = replay.error().message;
      return result;
    }
    result.recorded = replay.value()->recorded_ticks();
    result.end = replay.value()->recorded_end();
    core::LiveOptions options;
    options.ticks = replay.value()->recorded_ticks();
    options.can_go_back = false;
    options.repeat = repeated.value().actions;
    core::LiveRun live(*made.world, std::move(options));
    made.world->start();
    live.start();
    while (live.before_step()) {
      if (before_step) before_step(*made.world);
      made.world->step();
      (void)live.after_step();
      result.hashes.push_back(made.world->state_hash());
      const hal::Tick done = made.world->tick() - 1;
      if (done >= replay.value()->ticks()) continue;
      const auto known = repeated.value().fingerprints.find(done);
      if (known == repeated.value().fingerprints.end() || known->second != made.world->state_hash()) {
        result.difference = replay.value()->difference();
        break;
      }
      ++result.equal;
    }
    result.failure = live.failure();
    result.deviations = replay.value()->deviations();
    return result;
  }

 private:
  core::Scene scene_;
  std::string path_;
  FakeTime time_{7'000'000'000};
  std::map<std::string, FakeBody> bodies_;
  MixedOptions options_;
  std::unique_ptr<hal::PluginLoader> loader_;  // outlives the session's world
  std::unique_ptr<MixedSession> session_;
  std::unique_ptr<core::LiveRun> live_;
};

}  // namespace tandem::mixed_reality
