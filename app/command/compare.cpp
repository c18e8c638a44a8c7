#include <algorithm>
#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/outputs/state_dump.hpp"
#include "app/process/progress.hpp"
#include "app/process/signals.hpp"
#include "app/process/terminal.hpp"
#include "core/sim/world.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

struct CompareOptions {
  Libraries plugins;
  std::string a, b;  ///< experiments or dumps; an empty b is a
  std::optional<double> seconds;
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> threads_a, threads_b;
  std::vector<std::string> overrides, overrides_a, overrides_b;  ///< of both; of one

  void describe(hal::CommandLine& line) {
    line.footer("Exit code: 0 equal, 4 different. Real robots are simulated; hooks do not learn of the end.");
    line.word("a", a, "An experiment, which is run, or what `tandem run --dump` wrote").required().file();
    line.word("b", b, "The other one; default: the same again").file();
    line.option("--seconds", seconds, "Virtual duration of runs, instead of the file's").positive();
    line.option("--steps", steps, "Number of control steps, instead of the file's length")
        .positive()
        .excludes("--seconds");
    line.option("--seed", seed, "Seed of all chance in both, instead of the files'");
    line.option("--threads-a", threads_a, "Threads that step A").range(0, 1024);
    line.option("--threads-b", threads_b, "Threads that step B").range(0, 1024);
    line.option("--set", overrides, "Change both experiments: path=value; repeatable").repeatable();
    line.option("--set-a", overrides_a, "Change A alone; repeatable").repeatable();
    line.option("--set-b", overrides_b, "Change B alone; repeatable").repeatable();
    describe_plugins(line, plugins);
  }
};

constexpr std::size_t kShown = 20;

/// One of the two: a run, or what was dumped of one, moment by moment.
class Side {
 public:
  virtual ~Side() = default;
  /// Goes on to the next moment. @returns false at the end, or after an error.
  virtual bool next() = 0;
  virtual hal::Tick tick() const = 0;
  virtual std::vector<core::StateValue> values() const = 0;
  /// Of the values, where that is cheaper than they are.
  virtual std::optional<std::uint64_t> fingerprint() const { return std::nullopt; }
  virtual std::string why_ended() const { return {}; }
  /// Its last tick; 0: not known.
  virtual hal::Tick last() const { return 0; }

  std::string name;
  std::string error;  ///< what went wrong on the way
};

class Run final : public Side {
 public:
  Run(std::unique_ptr<hal::PluginLoader> loader, core::Scenario scenario, std::int64_t steps)
      : loader_(std::move(loader)), scenario_(std::move(scenario)), steps_left_(steps) {}

  bool make(const core::WorldOptions& options) {
    core::Problems problems;
    world_ = core::World::make(scenario_, *loader_, options, problems);
    print_problems(problems);
    return world_ != nullptr;
  }
  std::uint64_t seed() const { return world_->seed(); }

  bool next() override {
    if (world_->state() != core::RunState::Running || steps_left_ == 0) return false;
    if (!started_) {
      started_ = true;
      world_->start();
    } else {
      world_->step();
      --steps_left_;
    }
    return true;
  }
  hal::Tick tick() const override { return world_->tick(); }
  hal::Tick last() const override { return world_->tick() + steps_left_; }
  std::vector<core::StateValue> values() const override { return core::state_values(world_->state_view()); }
  std::optional<std::uint64_t> fingerprint() const override { return world_->state_hash(); }
  std::string why_ended() const override {
    if (world_->state() == core::RunState::Failed) return world_->failure();
    return world_->state() == core::RunState::Done ? "a hook was done" : "its time was over";
  }

 private:
  std::unique_ptr<hal::PluginLoader> loader_;
  core::Scenario scenario_;
  std::unique_ptr<core::World> world_;
  std::int64_t steps_left_;
  bool started_ = false;
};

class Dump final : public Side {
 public:
  explicit Dump(const std::string& path) : reader_(path) {}

  bool next() override {
    auto read = reader_.next();
    if (!read.ok()) error = read.error().message;
    if (!read.ok() || !read.value()) return false;
    state_ = std::move(*read.value());
    return true;
  }
  hal::Tick tick() const override { return state_.tick; }
  std::vector<core::StateValue> values() const override { return state_.values; }
  std::string why_ended() const override { return "it has no more"; }

 private:
  StateDumpReader reader_;
  DumpedState state_;
};

struct SideOptions {
  const std::string& path;
  std::optional<std::int64_t> threads;
  const std::vector<std::string>& overrides;
};

/// Null, after a message, when there is none. `seed`: for experiments that say none; set by the first of them.
std::unique_ptr<Side> make_side(const CompareOptions& options, const SideOptions& side,
                                std::optional<std::uint64_t>& seed) {
  if (StateDumpReader::is_dump(side.path)) {
    auto dump = std::make_unique<Dump>(side.path);
    dump->name = side.path;
    return dump;
  }
  std::vector<std::string> overrides = options.overrides;
  overrides.insert(overrides.end(), side.overrides.begin(), side.overrides.end());
  auto loader = std::make_unique<hal::PluginLoader>(plugin_folders(), catalog());
  auto scenario = read_or_complain(*loader, options.plugins, side.path, overrides);
  if (!scenario) return nullptr;
  for (core::RobotItem& robot : scenario->robots) robot.bridge.reset();
  const std::int64_t steps = steps_of(options.steps, options.seconds, *scenario);
  if (steps == 0) {
    complain(kBadInput, side.path + " has no length: say how long with --steps or --seconds");
    return nullptr;
  }
  core::WorldOptions world_options;
  world_options.seed = options.seed;
  if (!options.seed && !scenario->seed) world_options.seed = seed;
  world_options.threads = side.threads;
  auto run = std::make_unique<Run>(std::move(loader), std::move(*scenario), steps);
  if (!run->make(world_options)) return nullptr;
  if (!seed) seed = run->seed();
  run->name = side.path;
  for (const std::string& one : side.overrides) run->name += " --set " + one;
  if (side.threads) run->name += fmt::format(", {} threads", *side.threads);
  return run;
}

std::string shown(const std::string& value) {
  return value.empty() ? "-" : value;
}

void print_differences(const std::vector<core::StateDifference>& all) {
  const std::size_t count = std::min(all.size(), kShown);
  std::vector<core::StateDifference> rows = {{"who", "what", "field", "A", "B"}};
  rows.insert(rows.end(), all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  std::size_t who = 0, what = 0, field = 0, a = 0;
  for (const core::StateDifference& d : rows) {
    who = std::max(who, d.who.size());
    what = std::max(what, d.what.size());
    field = std::max(field, d.field.size());
    a = std::max(a, shown(d.a).size());
  }
  for (const core::StateDifference& d : rows) {
    fmt::print("  {:<{}}  {:<{}}  {:<{}}  {:<{}}  {}\n", printable(d.who), who, d.what, what, d.field, field,
               shown(d.a), a, shown(d.b));
  }
  if (all.size() > count) fmt::print("  … and {} more\n", all.size() - count);
}

/// Whether both are alike at this moment; says what differs.
bool same(const Side& a, const Side& b, std::optional<hal::Tick> last_equal, std::optional<Progress>& progress) {
  const auto print_a = a.fingerprint();
  const auto print_b = b.fingerprint();
  if (print_a && print_b && *print_a == *print_b) return true;
  const auto found = core::differences(a.values(), b.values());
  if (found.empty() && !(print_a && print_b)) return true;
  progress.reset();
  fmt::print("A: {}\nB: {}\n", printable(a.name), printable(b.name));
  if (last_equal) fmt::print("equal until tick {}\n", *last_equal);
  fmt::print("tick {}: {}\n", a.tick(),
             found.empty() ? "the bits of values that are not numbers differ"
                           : fmt::format("{} {} differ{}", found.size(), found.size() == 1 ? "value" : "values",
                                         found.size() == 1 ? "s" : ""));
  if (!found.empty()) print_differences(found);
  return false;
}

/// Takes whichever is behind to where the other is. @returns false when one ends before.
bool meet(Side& a, Side& b) {
  if (a.fingerprint() && b.fingerprint()) return true;  // two runs go step by step
  while (a.tick() != b.tick()) {
    if (!(a.tick() < b.tick() ? a : b).next()) return false;
  }
  return true;
}

int compare_sides(Side& a, Side& b) {
  const std::atomic<bool>& stop = catch_signals();
  std::optional<hal::Tick> equal;
  std::int64_t moments = 0;
  const std::int64_t end = std::max(a.last(), b.last());
  std::optional<Progress> progress(std::in_place, end, 1, "compare", "ticks");
  for (;;) {
    if (stop.load(std::memory_order_relaxed)) return interrupted_code();
    if (end > 0) progress->step(equal.value_or(0));
    const bool a_goes_on = a.next();
    const bool b_goes_on = b.next();
    const bool both = a_goes_on && b_goes_on && meet(a, b);
    for (const Side* side : {&a, &b}) {
      if (!side->error.empty()) return complain(kBadInput, side->error);
    }
    if (!both) {
      progress.reset();
      const bool runs = a.fingerprint() && b.fingerprint();
      if (!runs || a_goes_on == b_goes_on) break;
      const Side& ended = a_goes_on ? b : a;
      fmt::print("equal until tick {}; then only {} ended: {}\n", equal.value_or(0), a_goes_on ? "B" : "A",
                 printable(ended.why_ended()));
      return kDifferent;
    }
    if (!same(a, b, equal, progress)) return kDifferent;
    equal = a.tick();
    ++moments;
  }
  if (moments == 0) return complain(kBadInput, "there is no tick that both have: nothing was compared");
  fmt::print("equal at {} {}, the last one tick {}\n", moments, moments == 1 ? "moment" : "moments", *equal);
  return kDone;
}

int compare(const CompareOptions& options) {
  std::optional<std::uint64_t> seed;
  const auto a = make_side(options, {options.a, options.threads_a, options.overrides_a}, seed);
  if (a == nullptr) return kBadInput;
  const auto b =
      make_side(options, {options.b.empty() ? options.a : options.b, options.threads_b, options.overrides_b}, seed);
  if (b == nullptr) return kBadInput;
  return compare_sides(*a, *b);
}

}  // namespace

constinit const hal::CommandType compare_command = hal::command_type<CompareOptions, compare>(
    "compare", "Name the first tick and the values in which two runs differ.", hal::command_group::kStudy);

}  // namespace tandem::app
