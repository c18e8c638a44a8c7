// A world that is held, stepped by a thread of its own, for tests that send it commands.
#pragma once
#include <algorithm>
#include <future>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include "core/live/live_run.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {

/// Time passes when somebody waits.
class FakedClock final : public LiveClock {
 public:
  hal::TimeNs now_ns() noexcept override { return now_ns_.load(); }
  void wait_until(std::unique_lock<std::mutex>& lock, std::condition_variable&, hal::TimeNs until_ns) override {
    lock.unlock();
    std::this_thread::yield();
    lock.lock();
    now_ns_.store(std::max(now_ns_.load(), until_ns));
  }

 private:
  std::atomic<hal::TimeNs> now_ns_{0};
};

/// Robots that sense, talk and push one another, in a room with walls and, where the engine moves them, crates.
inline Scene crowd(const std::string& kind = "kinematics2d", const std::string& controller = "everything",
                   int robots = 40) {
  Scene s(4.0, controller);
  s.engine(kind).walls().robots(robots, 0.6);
  if (controller == "everything") s.param("left", "0.06").param("right", "0.05").implementations("noisy");
  if (kind != "particle3d") s.split("2x2");
  s.scenario.escape = EscapePolicy::Stop;
  s.scenario.robots[0].battery.delta = 0.001;
  if (test::engine_traits(kind).forces) s.box(1.0, 0, 0.1, 0.2, 0.0, 0.06).movable(0.2);
  return s;
}

class Held {
 public:
  explicit Held(const Scene& scene, LiveOptions options = paused(), const WorldOptions& world_options = {})
      : made_(make(scene, world_options)), live_(world(), with_clock(std::move(options))) {
    live_.on_event([this](hal::Tick tick, const hal::Json& event) { events.emplace_back(tick, event); });
    live_.on_show([this] { ++shows; });
    live_.add_command("hash", [this](const hal::Json&) -> hal::Result<hal::Json> {
      return hal::Json{{"tick", world().tick()}, {"hash", world().state_hash()}};
    });
    world().start();
    live_.start();
    new_ticks[0] = world().state_hash();
    thread_ = std::thread([this] {
      while (live_.before_step()) {
        world().step();
        if (live_.after_step()) new_ticks[world().tick()] = world().state_hash();
      }
      live_.close();
    });
  }
  ~Held() { end(); }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  static LiveOptions paused() {
    LiveOptions options;
    options.paused = true;
    options.stay = true;
    return options;
  }

  /// Sends a command and waits for the answer.
  hal::Json ask(const hal::Json& command) {
    std::promise<hal::Json> answer;
    live_.post(command, [&answer](const hal::Json& json) { answer.set_value(json); });
    return answer.get_future().get();
  }
  std::string error_of(const hal::Json& command) {
    const hal::Json answer = ask(command);
    return answer["ok"] == false ? answer["error"].get<std::string>() : "";
  }
  /// Of the run as it is now.
  std::uint64_t hash() { return ask({{"do", "hash"}})["hash"].get<std::uint64_t>(); }
  hal::Tick tick() { return ask({{"do", "hash"}})["tick"].get<hal::Tick>(); }
  /// Single steps, to their end.
  void walk(int steps) {
    const hal::Tick to = tick() + steps;
    EXPECT_EQ(ask({{"do", "step"}, {"ticks", steps}})["ok"], true);
    while (live_.state().tick < to && live_.state().ended.empty()) std::this_thread::yield();
    (void)hash();  // after the last of it
  }
  std::uint64_t hash_at(hal::Tick tick) {
    const hal::Json gone = ask({{"do", "go_to"}, {"tick", tick}});
    EXPECT_EQ(gone["ok"], true) << hal::to_text(gone);
    return hash();
  }
  void end() {
    live_.stop();
    if (thread_.joinable()) thread_.join();
  }

  World& world() {
    if (made_.world == nullptr) throw std::runtime_error(made_.all_problems());
    return *made_.world;
  }
  LiveRun& live() { return live_; }
  FakedClock& clock() { return clock_; }

  // Of the thread that steps; to be looked at between answers.
  std::vector<std::pair<hal::Tick, hal::Json>> events;
  std::map<hal::Tick, std::uint64_t> new_ticks;
  std::atomic<int> shows{0};

 private:
  LiveOptions with_clock(LiveOptions options) {
    options.clock = &clock_;
    return options;
  }
  FakedClock clock_;
  MadeWorld made_;
  LiveRun live_;
  std::thread thread_;
};

/// The actions among events, as another run would repeat them.
inline std::vector<RepeatedAction> actions_of(const std::vector<std::pair<hal::Tick, hal::Json>>& events) {
  std::vector<RepeatedAction> actions;
  for (const auto& [tick, event] : events) {
    if (event["kind"] == "back") {
      actions.clear();
      for (const hal::Json& one : event["before"]) actions.push_back({one["step"].get<std::int64_t>(), one["action"]});
    }
    if (event["kind"] == "action")
      actions.push_back({event.contains("step") ? event["step"].get<std::int64_t>() : tick, event["action"]});
  }
  return actions;
}

}  // namespace tandem::core
