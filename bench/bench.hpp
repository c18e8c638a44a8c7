// Benches: their options, their common parts, and the list of all.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/command/shared_options.hpp"
#include "bench/partition.hpp"
#include "bench/result_line.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sim/world.hpp"
#include "hal/carried_file.hpp"
#include "hal/command.hpp"
#include "hal/json/json.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

/// Lists that are left empty: the usual values when measuring, every saved line with `from`.
struct BenchOptions {
  app::Libraries plugins;
  std::string file;  ///< with kinds of robots that may be measured, too
  std::string name = "diffusion";
  std::vector<std::int64_t> robots;
  std::string robot;                 ///< empty: the benchmark's own
  std::vector<std::string> devices;  ///< besides proximity sensors and wheels
  std::vector<std::string> engines;
  std::vector<std::int64_t> threads;
  std::vector<std::string> partitions;  ///< by name: A1 to A16
  std::vector<std::string> regions;     ///< other splits: "5x3" or "auto"
  std::int64_t ticks = 600;
  std::string density;     ///< "equal": the arena grows with the robots
  std::string assignment;  ///< of work to threads: "static" or "dynamic"
  std::int64_t repeat = 1;
  std::string plot;  ///< SVG or PNG file
  std::string from;  ///< saved lines, instead of measuring
  bool compare_threads = false;
  double seconds = 5.0;    ///< sense_to_act: that are timed
  bool real_time = false;  ///< sense_to_act: with SCHED_FIFO

  void describe(hal::CommandLine& line);
  /// Those that are asked for, or the usual ones of a bench.
  std::vector<std::int64_t> robots_or(std::vector<std::int64_t> usual) const { return robots.empty() ? usual : robots; }
  /// How often, or what is usual where that is not said.
  std::int64_t repeat_or(std::int64_t usual) const { return repeat > 1 ? repeat : usual; }
};

/// One call of a bench: what it is asked for, checked.
struct Call {
  const BenchOptions& options;
  hal::PluginLoader& loader;
  const std::atomic<bool>& stop;
  std::string robot;
  std::vector<core::KindConfig> kinds;  ///< of a file, one of which `robot` may be
  std::vector<std::string> engines;     ///< with saved lines empty: all that there are; so with the next three
  std::vector<Partition> partitions;
  std::vector<std::int64_t> robots, threads;
};

/// A scene that is measured: everything that tells it from the others.
struct BenchCase {
  std::string bench = "diffusion";  ///< or "flocking", or "lua"
  std::string robot = "e-puck", engine = "kinematics2d";
  Partition partition = {"auto", "auto"};
  std::string devices = {};       ///< that the robots have besides proximity sensors and wheels, with commas between
  std::string density = "equal";  ///< the arena grows with the robots; "40 m": always that arena
  std::int64_t robots = 1, threads = 0;
  bool dynamic = false;  ///< work is handed out to threads
  std::int64_t ticks = 600;
  std::int64_t repeat = 0;                   ///< how many runs of the same kind were before
  std::string script = {};                   ///< of "lua": the file
  std::vector<core::KindConfig> kinds = {};  ///< of a file, one of which `robot` may be
};

/// Every case once a round, so that what the machine does besides meets all of them; those that differ in threads alone
/// follow one another.
std::vector<BenchCase> cases_of(const Call& call, const std::string& script = {});

core::Scenario scene_of(const BenchCase& c);
/// Null: its problems have been printed.
std::unique_ptr<core::World> world_of(const core::Scenario& scenario, hal::PluginLoader& loader,
                                      const core::WorldOptions& options = {});

/// Those of bench/scenes. Written by the build.
std::span<const hal::CarriedFile> scene_files();

/// Says it on standard error. @returns `code`
int refuse(int code, const std::string& message);
/// One result, to standard output at once.
void print_line(const hal::Json& line);
/// A bench. @returns the exit code; an error is a failure while running
using Run = hal::Result<int>(const Call& call);
Run bench_scene;         ///< diffusion, flocking, lua: how fast a scene steps
Run bench_codec;         ///< messages a second of the foot-bot's codec and its two framings
Run bench_record;        ///< what a record of all poses adds to a run: turns with and without it in one world
Run bench_sense_to_act;  ///< from an eye-bot's report, 50 a second, to the command that answers it, over LCM
Run bench_back;          ///< what the way back to earlier ticks costs a run, and how long it is
Run bench_view;          ///< what a window costs the run that it shows, and how soon it shows something
Run bench_sweep;         ///< how much more a sweep on all cores costs than its runs
Run bench_gap;           ///< hidden parameters of emulated robots found again, and controllers ranked by them
Run bench_lockstep;      ///< a hub here, its peers in processes of their own
Run bench_python;        ///< becomes the machine's Python with `tandem.bench`, or says why not

struct Bench {
  std::string_view name;
  Run* run = nullptr;
  std::string_view text;  ///< for people; empty: it is not offered
};

}  // namespace tandem::bench
