#include "bench/back.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <vector>

#include "app/exit_code.hpp"
#include "app/experiment/reading.hpp"
#include "app/process/measure.hpp"
#include "app/process/terminal.hpp"
#include "bench/scene.hpp"
#include "core/live/timeline.hpp"
#include "hal/json/json.hpp"
#include "hal/median.hpp"

namespace tandem::bench {
namespace {

constexpr int kVisited = 24;  // ticks that are gone to, besides the first

std::unique_ptr<core::World> make(const BenchCase& c, hal::PluginLoader& loader) {
  core::Problems problems;
  auto world = core::World::make(scene_of(c), loader, {}, problems);
  app::print_problems(problems);
  if (world != nullptr) world->start();
  return world;
}

/// CPU time of the whole run.
double plain_s(const BenchCase& c, hal::PluginLoader& loader) {
  const auto world = make(c, loader);
  if (world == nullptr) return 0.0;
  const double began = app::cpu_seconds();
  for (std::int64_t i = 0; i < c.ticks; ++i) world->step();
  return app::cpu_seconds() - began;
}

void walk(core::World& world, core::Timeline& timeline, core::LiveClock& clock, std::int64_t ticks) {
  for (std::int64_t i = 0; i < ticks; ++i) {
    (void)timeline.before_step();
    const hal::TimeNs began_ns = clock.now_ns();
    world.step();
    timeline.after_step(clock.now_ns() - began_ns);
  }
}

}  // namespace

int bench_back(const BenchCase& c, std::int64_t rounds, hal::PluginLoader& loader) {
  core::LiveClock clock;
  std::vector<double> plain, kept, quotients;
  std::unique_ptr<core::World> world;
  std::unique_ptr<core::Timeline> timeline;
  for (std::int64_t round = 0; round < rounds; ++round) {
    plain.push_back(plain_s(c, loader));
    timeline.reset();
    world = make(c, loader);
    if (world == nullptr) return app::kBadInput;
    const double began = app::cpu_seconds();
    timeline = std::make_unique<core::Timeline>(*world, clock, core::LiveOptions{});
    timeline->start();
    walk(*world, *timeline, clock, c.ticks);
    kept.push_back(app::cpu_seconds() - began);
    quotients.push_back(kept.back() / plain.back());
  }
  if (!timeline->no_way_back().empty()) {
    app::say("tandem bench: " + timeline->no_way_back());
    return app::kFailedRunning;
  }
  const std::uint64_t end = world->state_hash();
  const std::size_t checkpoints = timeline->checkpoints();
  std::vector<double> back_s;
  for (int i = 0; i <= kVisited; ++i) {
    // The first tick, then others all over the run, each after the end: nothing is near.
    const hal::Tick tick = i == 0 ? 0 : (c.ticks * ((i * 7) % (kVisited + 1))) / (kVisited + 1) + i;
    const double began = app::wall_seconds();
    const hal::Status there = timeline->go_to(std::min(tick, c.ticks));
    back_s.push_back(app::wall_seconds() - began);
    if (!there.ok() || !timeline->go_to(c.ticks).ok()) {
      app::say("tandem bench: " + there.error().message);
      return app::kFailedRunning;
    }
  }
  hal::Json json{{"bench", "back"},
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
                 {"back_to_start_s", back_s.front()},
                 {"back_median_s", hal::upper_median(back_s)},
                 {"back_longest_s", *std::max_element(back_s.begin(), back_s.end())},
                 {"same_bits", world->state_hash() == end},
                 {"peak_rss_mb", app::peak_rss_mb()}};
  fmt::print("{}\n", hal::to_text(json));
  return world->state_hash() == end ? app::kDone : app::kFailedRunning;
}

}  // namespace tandem::bench
