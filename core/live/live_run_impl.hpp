// Parts of a LiveRun, for the files that run it and carry out commands.
#pragma once
#include <cmath>
#include <utility>

#include "core/live/condition.hpp"
#include "core/live/live_run.hpp"
#include "core/live/timeline.hpp"

namespace tandem::core {

struct LiveRun::Impl {
  struct Posted {
    hal::Json command;
    LiveReply reply;
    std::function<void()> own = {};  // instead of the command
  };

  Impl(World& w, LiveOptions o)
      : world(w),
        options(std::move(o)),
        clock(options.clock != nullptr ? *options.clock : system_clock),
        timeline(world, clock, options),
        paused(options.paused && (!options.real_robots || options.pause_real)),
        speed(options.speed) {
    timeline.on_way = [this] {
      shown();
      return leaving || !stop_asked();
    };
  }

  World& world;
  const LiveOptions options;
  LiveClock system_clock;
  LiveClock& clock;
  Timeline timeline;
  Conditions conditions;
  std::map<std::string, LiveCommand, std::less<>> commands;
  std::function<void()> show;

  mutable std::mutex lock;
  std::condition_variable changed;
  std::deque<Posted> posted;  // with `lock`, as the next three
  bool stopped = false, closed = false;
  LiveState state;

  // Of the thread that steps:
  bool paused;
  std::optional<double> speed;
  std::int64_t steps_wanted = 0;  // single ticks
  bool leaving = false;
  std::string stopped_by;
  std::string failure;
  hal::TimeNs anchor_ns = 0;  // of the schedule
  std::int64_t slots = 0;     // ticks since then
  hal::TimeNs step_began_ns = 0;
  std::uint64_t misses = 0;
  hal::TimeNs measured_ns = 0;  // since when
  std::int64_t measured_ticks = 0;
  double reached = 0.0;

  // --- time ---

  double period_ns() const { return 1e9 / (static_cast<double>(world.ticks_per_second()) * *speed); }
  hal::TimeNs due_ns() const {
    return anchor_ns + static_cast<hal::TimeNs>(std::llround(static_cast<double>(slots) * period_ns()));
  }
  void begin_schedule() {
    anchor_ns = clock.now_ns();
    slots = 0;
    measured_ns = anchor_ns;
    measured_ticks = 0;
  }
  void measure(hal::TimeNs now_ns);

  std::string why_ended() const {
    if (world.state() == RunState::Failed) return world.failure();
    if (world.state() == RunState::Done) return "a hook ended the run";
    if (options.ticks > 0 && world.tick() >= options.ticks)
      return "its " + std::to_string(options.ticks) + " ticks are done";
    return {};
  }
  bool over() const {
    return world.state() != RunState::Running || (options.ticks > 0 && world.tick() >= options.ticks);
  }

  /// Brings what others see up to date; `told`: something that they are to be told of has changed.
  void publish(bool told) {
    const std::lock_guard hold(lock);
    state.tick = world.tick();
    state.latest = timeline.latest_tick();
    state.first = timeline.first_tick();
    state.reached = paused ? 0.0 : reached;
    if (!told) return;
    state.paused = paused;
    state.speed = options.real_robots ? std::optional<double>(1.0) : speed;
    state.ended = over() ? why_ended() : std::string();
    state.stopped_by = stopped_by;
    state.no_way_back = timeline.no_way_back();
    state.seed = world.seed();
    ++state.changes;
  }

  // --- commands ---

  hal::Result<hal::Json> carry_out(const hal::Json& command);
  bool carry_out_posted();

  void add_commands();
  hal::Status no_pause() const {
    if (!options.real_robots) return {};
    if (options.pause_real) return hal::Error{"real robots take part, and time has one speed: pause it, or halt them"};
    return hal::Error{"real robots take part, whose time cannot be held: halt them instead"};
  }
  hal::Result<hal::Json> play(const hal::Json& c);
  hal::Result<hal::Json> pause(const hal::Json& c);
  hal::Result<hal::Json> pause_real(bool on, const hal::Json& c);
  hal::Result<hal::Json> step(const hal::Json& c);
  hal::Result<hal::Json> set_speed(const hal::Json& c);
  hal::Result<hal::Json> go_to(const hal::Json& c);
  hal::Result<hal::Json> reset(const hal::Json& c);
  hal::Result<hal::Json> undo();
  hal::Result<hal::Json> stop_when(const hal::Json& c);
  hal::Result<hal::Json> history(const hal::Json& c);
  hal::Result<hal::Json> act(const hal::Json& c);
  hal::Json here() const { return {{"tick", world.tick()}}; }
  bool stop_asked() const {
    const std::lock_guard hold(lock);
    return stopped || (options.stop != nullptr && options.stop->load(std::memory_order_relaxed));
  }
  /// A look back at the end of the run leaves it as it is, not as it was.
  void leave() {
    if (!timeline.known()) return;
    leaving = true;
    if (const hal::Status there = timeline.go_to(timeline.recorded_tick()); !there.ok())
      options.log.warning(there.error().message);
  }
  void moved() {
    conditions.forget(world);
    begin_schedule();
    shown();
  }
  void shown() {
    publish(true);
    if (show) show();
  }
};

}  // namespace tandem::core
