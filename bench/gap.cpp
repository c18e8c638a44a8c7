// How well hidden parameters of emulated robots are found, and how well pseudo-realities drawn from them rank
// controllers.
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <vector>

#include "app/exit_code.hpp"
#include "app/experiment/reading.hpp"
#include "app/process/measure.hpp"
#include "bench/bench.hpp"
#include "bridges/epuck_emulator/body.hpp"
#include "core/config/reader.hpp"
#include "hal/angle.hpp"
#include "hal/device/fitted.hpp"
#include "hal/random.hpp"
#include "hal/robot/epuck.hpp"
#include "mixed_reality/gap/population.hpp"
#include "mixed_reality/gap/wheel_fit.hpp"

namespace tandem::bench {
namespace {

constexpr double kTick_s = 0.1;
constexpr double kFastest_m_s = 0.1;
// As a tracker over the arena sees them.
constexpr double kPoseNoise_m = 0.002;
constexpr double kPoseNoise_rad = 0.0175;
// Effects that the fitted model does not know.
constexpr double kBacklash_m = 0.0003;
constexpr double kBumps = 0.03;

struct Asked {
  std::int64_t robots = 50;  ///< emulated e-pucks with hidden parameters
  double seconds = 600.0;    ///< that each drives, in virtual time
  std::int64_t realities = 200;
};

// --- hidden parameters ---

bridges::WheelErrors hidden(std::int64_t number) {
  hal::Random random(hal::seed_of(2026, "hidden"), static_cast<std::uint32_t>(number));
  bridges::WheelErrors errors;
  errors.left = random.uniform(0.94, 1.06);
  errors.right = random.uniform(0.94, 1.06);
  errors.base = random.uniform(0.95, 1.05);
  errors.delay_s = random.uniform(0.02, 0.2);
  errors.noise_sqrt_m = random.uniform(0.001, 0.002);
  errors.backlash_m = kBacklash_m;
  errors.bumps = kBumps;
  errors.seed = number + 1;
  return errors;
}

/// What a record would say of an emulated e-puck that drives by chance, in virtual time.
mixed_reality::RecordedRobot driven(const bridges::WheelErrors& errors, double seconds, std::int64_t number) {
  namespace emulator = bridges::epuck_emulator;
  emulator::KinematicBody body({}, std::nullopt, errors);
  hal::Random random(hal::seed_of(7, "drive"), static_cast<std::uint32_t>(number));
  mixed_reality::RecordedRobot robot;
  robot.id = fmt::format("e{}", number);
  robot.kind = hal::epuck::kName;
  robot.real = true;
  double left = 0.0, right = 0.0;
  const auto ticks = static_cast<std::int64_t>(seconds / kTick_s);
  for (std::int64_t t = 0; t < ticks; ++t) {
    const hal::TimeNs now = t * static_cast<hal::TimeNs>(kTick_s * 1e9);
    body.advance(now);
    if (random.chance(kTick_s)) {  // a new command every second or so
      left = kFastest_m_s * random.uniform(-0.2, 1.0);
      right = kFastest_m_s * random.uniform(-0.2, 1.0);
    }
    mixed_reality::RobotTick tick;
    tick.posed = tick.told = true;
    tick.x_m = body.pose().x_m + random.normal(0.0, kPoseNoise_m);
    tick.y_m = body.pose().y_m + random.normal(0.0, kPoseNoise_m);
    tick.heading_rad = hal::wrapped(body.pose().heading_rad + random.normal(0.0, kPoseNoise_rad));
    tick.told_left_m_s = left;
    tick.told_right_m_s = right;
    robot.ticks.push_back(tick);
    body.actuate(now, {.left_m_s = left, .right_m_s = right});
  }
  return robot;
}

struct Found {
  bridges::WheelErrors truth;
  mixed_reality::WheelFit fit;
};

/// Of absolute errors: the median, the 95th percentile, the largest.
hal::Json spread_of(std::vector<double> errors) {
  std::sort(errors.begin(), errors.end());
  const auto at = [&](double part) {
    return errors[std::min(errors.size() - 1, static_cast<std::size_t>(part * static_cast<double>(errors.size())))];
  };
  return {{"median", at(0.5)}, {"p95", at(0.95)}, {"largest", errors.back()}};
}

hal::Json report_found(const Asked& c, const std::vector<Found>& all, double took_s) {
  std::array<std::vector<double>, 4> off;
  std::size_t in_bounds = 0;
  for (const Found& f : all) {
    const std::array<std::pair<const mixed_reality::Estimate*, double>, 4> values = {
        {{&f.fit.left, f.truth.left},
         {&f.fit.right, f.truth.right},
         {&f.fit.base, f.truth.base},
         {&f.fit.delay_s, f.truth.delay_s}}};
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double error = std::fabs(values[k].first->value - values[k].second);
      off[k].push_back(k < 3 ? 100.0 * error / values[k].second : 1e3 * error);
      if (error <= values[k].first->bound()) ++in_bounds;
    }
  }
  hal::Json json = {
      {"bench", "gap"},
      {"what", "parameters"},
      {"robots", c.robots},
      {"seconds_each", c.seconds},
      {"backlash_mm", kBacklash_m * 1e3},
      {"bumps_percent", kBumps * 100.0},
      {"within_95_percent_bounds", static_cast<double>(in_bounds) / (4.0 * static_cast<double>(all.size()))},
      {"wall_s", took_s}};
  const std::array<const char*, 4> names = {"left_percent", "right_percent", "base_percent", "delay_ms"};
  for (std::size_t k = 0; k < names.size(); ++k) json[names[k]] = spread_of(off[k]);
  return json;
}

// --- ranking ---

struct Contestant {
  const char* name;
  const char* params;
};

/// Alike enough that their order is a question.
constexpr std::array<Contestant, 5> kContestants = {{
    {"calm", R"(alpha="7.5" delta="0.1" velocity="5 cm/s")"},
    {"bold", R"(alpha="30" delta="0.8" velocity="6 cm/s")"},
    {"hasty", R"(alpha="7.5" delta="0.1" velocity="8 cm/s")"},
    {"timid", R"(alpha="2" delta="0.02" velocity="7 cm/s")"},
    {"reckless", R"(alpha="60" delta="2" velocity="9 cm/s")"},
}};
constexpr std::int64_t kSwarm = 20;
constexpr double kRun_s = 60.0;
constexpr double kCell_m = 0.15;
constexpr std::int64_t kTruthRuns = 40;

/// `errors`: options of the wheels that the fitted model does not know.
std::optional<core::Scenario> arena_of(const Contestant& who, const char* errors, hal::PluginLoader& loader) {
  core::Problems problems;
  auto scenario = core::read_experiment_text(
      fmt::format(fmt::runtime(hal::carried_text(scene_files(), "gap.xml")), errors, who.params), "bench gap", {},
      loader.catalog(), problems);
  app::print_problems(problems);
  return scenario;
}

/// How much of the arena was seen by anybody: cells.
hal::Result<double> score(core::Scenario scenario, const hal::FittedWheels& wheels, std::uint64_t seed,
                          hal::PluginLoader& loader) {
  const auto kind = std::make_shared<hal::RobotKind>(hal::epuck::kind());
  kind->add(wheels);
  for (core::RobotItem& robot : scenario.robots) robot.own_kind = kind;
  core::WorldOptions options;
  options.seed = seed;
  auto world = world_of(scenario, loader, options);
  if (world == nullptr) return hal::Error{"the arena cannot be made"};
  world->start();
  std::set<std::pair<int, int>> cells;
  const auto ticks = static_cast<std::int64_t>(kRun_s / kTick_s);
  for (std::int64_t t = 0; t < ticks; ++t) {
    world->step();
    for (std::size_t i = 0; i < world->space().robot_count(); ++i) {
      const core::Pose at = world->space().pose(world->space().robot(i));
      cells.emplace(static_cast<int>(std::floor(at.x_m / kCell_m)), static_cast<int>(std::floor(at.y_m / kCell_m)));
    }
  }
  if (world->state() == core::RunState::Failed) return hal::Error{world->failure()};
  return static_cast<double>(cells.size());
}

using Scores = std::array<double, kContestants.size()>;

/// Kendall's tau-b.
double tau(const Scores& a, const Scores& b) {
  double sum = 0.0, pairs_a = 0.0, pairs_b = 0.0;
  const auto sign = [](double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; };
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double x = sign(a[i] - a[j]), y = sign(b[i] - b[j]);
      sum += x * y;
      pairs_a += x * x;
      pairs_b += y * y;
    }
  }
  return pairs_a > 0.0 && pairs_b > 0.0 ? sum / std::sqrt(pairs_a * pairs_b) : 0.0;
}

/// The hidden values of the swarm: those of the first robots, under the ids that they have in the arena.
hal::FittedWheels truth_of(const std::vector<Found>& all) {
  hal::FittedWheels truth;
  for (std::size_t i = 0; i < static_cast<std::size_t>(kSwarm); ++i) {
    const bridges::WheelErrors& e = all[i % all.size()].truth;
    truth.robots.push_back({fmt::format("p{}", i), {}, {}});
    truth.robots.back().value.of = {e.left, e.right, e.base, e.left, e.right, e.noise_sqrt_m, e.delay_s};
  }
  return truth;
}

hal::Status rank(const Asked& c, const std::vector<Found>& all, hal::PluginLoader& loader,
                 const std::atomic<bool>& stop) {
  const double before_s = app::wall_seconds();
  std::vector<hal::FittedRobot<hal::WheelModel>> robots;
  for (const Found& f : all) robots.push_back({fmt::format("e{}", robots.size()), {f.fit.values()}, {f.fit.errors()}});
  auto fitted = mixed_reality::population<hal::FittedWheels>(std::move(robots));
  const hal::FittedWheels truth = truth_of(all);
  Scores in_truth{}, in_all{}, ideal{};
  std::vector<Scores> by_reality(static_cast<std::size_t>(c.realities));
  for (std::size_t k = 0; k < kContestants.size(); ++k) {
    // In the hidden truth wheels err in ways, too, that the fitted model does not have.
    const auto real = arena_of(kContestants[k], R"(noise_std_dev="0.05" bias_left="0.05" bias_right="-0.05")", loader);
    const auto model = arena_of(kContestants[k], "", loader);
    if (!real || !model) return hal::Error{"the arena of the ranking cannot be read"};
    for (std::int64_t i = 0; i < kTruthRuns; ++i) {
      const auto found = score(*real, truth, static_cast<std::uint64_t>(1000 + i), loader);
      if (!found.ok()) return found.error();
      in_truth[k] += found.value() / static_cast<double>(kTruthRuns);
      const auto plain = score(*model, hal::FittedWheels{}, static_cast<std::uint64_t>(2000 + i), loader);
      if (!plain.ok()) return plain.error();
      ideal[k] += plain.value() / static_cast<double>(kTruthRuns);
    }
    for (std::int64_t i = 0; i < c.realities; ++i) {
      if (stop.load(std::memory_order_relaxed)) return {};
      fitted.reality = i + 1;
      const auto found = score(*model, fitted, static_cast<std::uint64_t>(i + 1), loader);
      if (!found.ok()) return found.error();
      by_reality[static_cast<std::size_t>(i)][k] = found.value();
      in_all[k] += found.value() / static_cast<double>(c.realities);
    }
  }
  double taus = 0.0;
  for (const Scores& scores : by_reality) taus += tau(scores, in_truth) / static_cast<double>(by_reality.size());
  hal::Json json = {{"bench", "gap"},
                    {"what", "ranking"},
                    {"controllers", kContestants.size()},
                    {"realities", c.realities},
                    {"robots", kSwarm},
                    {"kendall_tau", tau(in_all, in_truth)},
                    {"kendall_tau_of_one_reality", taus},
                    {"kendall_tau_of_plain_simulation", tau(ideal, in_truth)},
                    {"wall_s", app::wall_seconds() - before_s}};
  for (std::size_t k = 0; k < kContestants.size(); ++k) {
    json["cells"][kContestants[k].name] = {
        {"truth", in_truth[k]}, {"pseudo_realities", in_all[k]}, {"plain_simulation", ideal[k]}};
  }
  print_line(json);
  return {};
}

}  // namespace

hal::Result<int> bench_gap(const Call& call) {
  const Asked c{.robots = call.options.robots_or({50}).front(), .realities = call.options.repeat_or(200)};
  const double before_s = app::wall_seconds();
  std::vector<Found> all;
  for (std::int64_t i = 0; i < c.robots; ++i) {
    if (call.stop.load(std::memory_order_relaxed)) return app::kDone;
    const bridges::WheelErrors errors = hidden(i);
    auto fit = fit_wheels(driven(errors, c.seconds, i), kTick_s, {hal::epuck::kind().drive()->wheel_base_m, false});
    if (!fit.flaw.empty()) return hal::Error{fmt::format("robot {}: {}", i, fit.flaw)};
    all.push_back({errors, std::move(fit)});
  }
  print_line(report_found(c, all, app::wall_seconds() - before_s));
  const hal::Status ranked = rank(c, all, call.loader, call.stop);
  return ranked.ok() ? hal::Result<int>(app::kDone) : ranked.error();
}

}  // namespace tandem::bench
