// Steps the scene without checkpoints and with them, in turns, and then goes to ticks all over the run.
#include <algorithm>

#include "app/exit_code.hpp"
#include "app/process/measure.hpp"
#include "bench/bench.hpp"
#include "core/live/timeline.hpp"
#include "hal/median.hpp"

namespace tandem::bench {
namespace {

constexpr int kVisited = 24;  // ticks that are gone to, besides the first

/// CPU time of the whole run.
double plain_s(core::World& world, std::int64_t ticks, const std::atomic<bool>& stop) {
  world.start();
  const double began = app::cpu_seconds();
  for (std::int64_t i = 0; i < ticks && !stop.load(); ++i) world.step();
  return app::cpu_seconds() - began;
}

void walk(core::World& world, core::Timeline& timeline, core::LiveClock& clock, std::int64_t ticks,
          const std::atomic<bool>& stop) {
  for (std::int64_t i = 0; i < ticks && !stop.load(); ++i) {
    (void)timeline.before_step();
    const hal::TimeNs began_ns = clock.now_ns();
    world.step();
    timeline.after_step(clock.now_ns() - began_ns);
  }
}

/// The first tick, then others all over the run, each after the end: nothing is near. Seconds of each.
hal::Result<std::vector<double>> visit(core::Timeline& timeline, std::int64_t ticks, const std::atomic<bool>& stop) {
  std::vector<double> back_s;
  for (int i = 0; i <= kVisited; ++i) {
    if (stop.load()) return hal::Error{"interrupted"};
    const hal::Tick tick = i == 0 ? 0 : (ticks * ((i * 7) % (kVisited + 1))) / (kVisited + 1) + i;
    const double began = app::wall_seconds();
    hal::Status there = timeline.go_to(std::min(tick, ticks));
    back_s.push_back(app::wall_seconds() - began);
    if (there.ok()) there = timeline.go_to(ticks);
    if (!there.ok()) return there.error();
  }
  return back_s;
}

hal::Result<int> back(const BenchCase& c, const Call& call) {
  const core::Scenario scenario = scene_of(c);
  core::LiveClock clock;
  std::vector<double> plain, kept, quotients;
  std::unique_ptr<core::World> world;
  std::unique_ptr<core::Timeline> timeline;
  for (std::int64_t round = 0; round < call.options.repeat; ++round) {
    timeline.reset();
    world = world_of(scenario, call.loader);
    if (world == nullptr) return app::kBadInput;
    plain.push_back(plain_s(*world, c.ticks, call.stop));
    world.reset();
    world = world_of(scenario, call.loader);
    world->start();
    const double began = app::cpu_seconds();
    timeline = std::make_unique<core::Timeline>(*world, clock, core::LiveOptions{});
    timeline->start();
    walk(*world, *timeline, clock, c.ticks, call.stop);
    kept.push_back(app::cpu_seconds() - began);
    quotients.push_back(kept.back() / plain.back());
    if (call.stop.load()) return hal::Error{"interrupted"};
  }
  if (!timeline->no_way_back().empty()) return hal::Error{timeline->no_way_back()};
  const std::uint64_t end = world->state_hash();
  const std::size_t checkpoints = timeline->checkpoints();
  const auto back_s = visit(*timeline, c.ticks, call.stop);
  if (!back_s.ok()) return back_s.error();
  const std::vector<double>& s = back_s.value();
  print_line({{"bench", "back"},
              {"robot", c.robot},
              {"engine", c.engine},
              {"robots", c.robots},
              {"threads", c.threads},
              {"ticks", c.ticks},
              {"cpu_s", hal::upper_median(kept)},
              {"cpu_s_without", hal::upper_median(plain)},
              {"cost", hal::upper_median(quotients) - 1.0},
              {"checkpoints", checkpoints},
              {"checkpoints_MB", static_cast<double>(timeline->bytes()) * 1e-6},
              {"back_to_start_s", s.front()},
              {"back_median_s", hal::upper_median(s)},
              {"back_longest_s", *std::max_element(s.begin(), s.end())},
              {"same_bits", world->state_hash() == end},
              {"peak_rss_mb", app::peak_rss_mb()}});
  return world->state_hash() == end ? app::kDone : app::kFailedRunning;
}

}  // namespace

hal::Result<int> bench_back(const Call& call) {
  BenchCase c{
      .robot = call.robot, .partition = call.partitions.front(), .ticks = call.options.ticks, .kinds = call.kinds};
  if (call.options.density.empty()) c.density = "40 m";
  for (const std::string& engine : call.engines) {
    for (const std::int64_t robots : call.options.robots_or({1000})) {
      for (const std::int64_t threads : call.threads) {
        c.engine = engine;
        c.robots = robots;
        c.threads = threads;
        if (const auto code = back(c, call); !code.ok() || code.value() != app::kDone) return code;
      }
    }
  }
  return app::kDone;
}

}  // namespace tandem::bench
