#include "bench/lockstep.hpp"

#include <array>
#include <cmath>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "app/build_info.hpp"
#include "app/process/measure.hpp"
#include "app/process/signals.hpp"
#include "app/real/lockstep_peers.hpp"
#include "core/config/reader.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"

namespace tandem::bench {
namespace {

/// Robots that drive among walls, so close together that they meet.
std::string experiment(const LockstepCase& c) {
  const double side_m = std::sqrt(0.1 * static_cast<double>(c.peers)) + 0.6;
  return fmt::format(
      R"(<tandem><framework><experiment length="0" ticks_per_second="10" random_seed="1"/>
<time mode="lockstep"><peers listen="127.0.0.1:0" timeout="60 s"/></time></framework>
<controllers><obstacle_avoidance id="c" library="obstacle_avoidance"><actuators><differential_steering/></actuators>
<sensors><proximity/></sensors></obstacle_avoidance></controllers>
<arena size="{0},{0},1">
<box id="n" size="{0},0.1,0.2" movable="false"><body position="0,{2},0"/></box>
<box id="s" size="{0},0.1,0.2" movable="false"><body position="0,-{2},0"/></box>
<box id="e" size="0.1,{0},0.2" movable="false"><body position="{2},0,0"/></box>
<box id="w" size="0.1,{0},0.2" movable="false"><body position="-{2},0,0"/></box>
<distribute><position method="uniform" min="-{1},-{1},0" max="{1},{1},0"/>
<orientation method="uniform" min="0,0,0" max="360,0,0"/><entity quantity="{3}" max_trials="1000">
<e-puck id="ep"><controller config="c"/><peer/></e-puck></entity></distribute></arena></tandem>
)",
      side_m, 0.5 * side_m - 0.15, 0.5 * side_m - 0.05, c.peers);
}

/// Processes of this program, each the peer of one robot; ended with this.
class Peers {
 public:
  Peers(const std::string& file, const std::string& address, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) {
      std::vector<std::string> words = {"tandem", "robot",          file, "--robot", "ep" + std::to_string(i),
                                        "--link", "peer:" + address};
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      posix_spawn_file_actions_t actions;
      posix_spawn_file_actions_init(&actions);
      for (const int descriptor : {0, 1, 2})
        posix_spawn_file_actions_addopen(&actions, descriptor, "/dev/null", O_RDWR, 0);
      pid_t pid = -1;
      if (posix_spawn(&pid, "/proc/self/exe", &actions, nullptr, argv.data(), environ) == 0) pids_.push_back(pid);
      posix_spawn_file_actions_destroy(&actions);
    }
  }
  ~Peers() {
    for (const pid_t pid : pids_) kill(pid, SIGTERM);
    for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
  }
  Peers(const Peers&) = delete;
  Peers& operator=(const Peers&) = delete;

 private:
  std::vector<pid_t> pids_;
};

/// A file of its own, removed at the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text) {
    const int descriptor = mkstemps(name_.data(), 4);
    if (descriptor < 0) return;
    good_ = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    close(descriptor);
  }
  ~TemporaryFile() { unlink(name_.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  bool good() const noexcept { return good_; }
  const std::string& name() const noexcept { return name_; }

 private:
  std::string name_ = "/tmp/tandem_lockstep_XXXXXX.xml";
  bool good_ = false;
};

}  // namespace

hal::Status bench_lockstep(const LockstepCase& c, hal::PluginLoader& loader) {
  const TemporaryFile file(experiment(c));
  if (!file.good()) return hal::Error{"no file can be written in /tmp"};
  core::Problems problems;
  const auto scenario = core::read_experiment(file.name(), {}, loader.catalog(), problems);
  if (!scenario) return hal::Error{problems.empty() ? "the scene cannot be read" : hal::to_text(problems.front())};
  const auto pure = core::World::make(*scenario, loader, {}, problems);
  const auto world = core::World::make(*scenario, loader, {}, problems);
  if (pure == nullptr || world == nullptr) return hal::Error{hal::to_text(problems.front())};
  const std::atomic<bool>& stop = app::catch_signals();
  mixed_reality::LockstepOptions options;
  options.stop = &stop;
  auto made = mixed_reality::LockstepRun::make(*world, options);
  if (!made.ok()) return made.error();
  const auto run = std::move(made).value();
  const Peers peers(file.name(), run->address(), c.peers);
  if (const hal::Status connected = run->connect(); !connected.ok()) return connected;
  world->start();
  const double began_s = app::wall_seconds();
  for (std::int64_t i = 0; i < c.ticks && world->step() && world->state() == core::RunState::Running; ++i) continue;
  const double wall_s = app::wall_seconds() - began_s;
  run->finish(false, "the run is over");
  if (world->tick() != c.ticks)
    return hal::Error{world->failure().empty() ? std::string("interrupted") : world->failure()};
  pure->start();
  for (std::int64_t i = 0; i < c.ticks; ++i) pure->step();
  if (pure->state_hash() != world->state_hash())
    return hal::Error{"the fingerprint is not that of the simulation: a run whose hash is wrong is none"};
  const double virtual_s = static_cast<double>(c.ticks) / static_cast<double>(scenario->ticks_per_second);
  hal::Json json;
  json["bench"] = "lockstep";
  json["peers"] = c.peers;
  json["ticks"] = c.ticks;
  json["wall_s"] = wall_s;
  json["us_per_tick"] = 1e6 * wall_s / static_cast<double>(c.ticks);
  json["times_real_time"] = virtual_s / wall_s;
  json["state_hash"] = fmt::format("{:#018x}", world->state_hash());
  json["cpu_model"] = app::build_info().processor;
  fmt::print("{}\n", hal::to_text(json));
  return {};
}

}  // namespace tandem::bench
