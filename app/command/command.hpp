// The commands of `tandem`, one file each. Every function returns the exit code of the program.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::app {

enum ExitCode : int { kDone = 0, kBadInput = 1, kWrongUsage = 2, kFailedRunning = 3, kDifferent = 4 };

/// Of --plugin: libraries whose parts this call may name besides the program's own.
using Libraries = std::vector<std::string>;

/// Pictures and films of a run or of a record.
struct PictureRequest {
  std::string picture;           ///< .svg, .png or .pdf
  std::vector<std::int64_t> at;  ///< numbers of ticks after which there are pictures, too
  std::int64_t size_px = 1000;   ///< of the longer side
  std::vector<double> region;    ///< x0, y0, x1, y1 in metres; empty: the whole arena
  double trails_s = 0.0;
  bool axes = false, ids = false;
  std::vector<std::string> layers;  ///< of a run alone
  std::string film;                 ///< .mp4, .mkv, or pictures: "FOLDER/" or "FOLDER/%06d.png"
  std::int64_t film_every = 1;      ///< ticks
  std::string povray;               ///< .pov, or .png beside one: a scene for POV-Ray
  double film_rate = 0.0;           ///< frames a second; 0: as fast as it was, 60 at most
};

/// Holding a run while it goes on (core/live/live_run.hpp).
struct HoldOptions {
  bool wanted = false;          ///< somebody watches it
  bool paused = false;          ///< at the start
  bool stay = false;            ///< at the end
  std::optional<double> speed;  ///< times real time; none: as the experiment says
  std::size_t memory_MB = 500;  ///< of checkpoints
};

/// A window in browsers, for a run or a record.
struct ViewRequest {
  bool on = false;
  std::int64_t port = 0;  ///< 0: any that is free
  std::string address = "127.0.0.1";
  std::vector<std::string> origins;  ///< of pages that may use it besides its own
  bool no_browser = false;           ///< else one is opened, where there is one
  bool projector = false;            ///< … and what a projector shows is told, and opened, too
};

/// The table of a run on a terminal.
struct WatchRequest {
  bool watch = false;
  std::vector<std::string> robots;  ///< ids, or patterns with '*'; empty: all
  std::string port;                 ///< whose fields are shown; empty: what controllers publish
};

/// A run out of the record of one with real robots.
struct ReplayRequest {
  std::string record;                         ///< empty: this is none
  std::optional<std::int64_t> from;           ///< tick from which the robots are simulated
  std::optional<std::int64_t> until;          ///< ticks that are done
  std::vector<std::string> controllers = {};  ///< "ROBOT=ID" or "KIND=ID"
  bool accept_changes = false;                ///< of files and plug-ins
};

struct RunOptions {
  Libraries plugins;
  std::string experiment;
  std::optional<double> seconds;
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> threads;
  std::vector<std::string> overrides;
  std::string report;  ///< file, or "-"
  PictureRequest pictures;
  std::string trajectory;  ///< CSV file, of every robot unless the experiment says which
  std::string record;      ///< record file, as the experiment says or of every robot's pose and state
  std::string repeat;      ///< record whose actions are done again
  HoldOptions hold;
  ViewRequest view;
  std::string dump;                     ///< CSV file of every value of the state
  std::int64_t dump_every = 0;          ///< ticks; 0: at the end alone
  std::string log;                      ///< file for all messages
  std::vector<std::string> without;     ///< real robots that are simulated instead, by id
  std::vector<std::string> hub_faults;  ///< as `parse_hub_fault` reads them
  WatchRequest watch;
  ReplayRequest replay = {};
  bool quiet = false;           ///< no table
  double step_timeout_s = 5.0;  ///< after which a controller or hook that does not return is named; 0: never
};
int run(const RunOptions& options);
/// `run` behind a window until somebody ends it; or the same of a record of one.
int view(RunOptions options);
/// A run with real robots, computed again out of its record: `options.replay` says which, and what is to be different.
int replay(RunOptions options);

struct CompareOptions {
  Libraries plugins;
  std::string a, b;  ///< experiments or dumps; an empty b is a
  std::optional<double> seconds;
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> threads_a, threads_b;
  std::vector<std::string> overrides, overrides_a, overrides_b;  ///< of both; of one
};
/// kDifferent: a value differs.
int compare(const CompareOptions& options);

struct ExportOptions {
  std::string record;
  std::string csv;                          ///< file, or "-"; empty: only say what the record holds
  std::string hdf5;                         ///< file; empty: none
  std::string stream;                       ///< which of its tables; empty: in CSV "pose", in HDF5 all
  std::vector<std::string> fields;          ///< of HDF5: only these; empty: all
  std::vector<std::string> entities;        ///< ids, or patterns with '*'; empty: all
  std::optional<std::int64_t> from, until;  ///< ticks, both included
  std::int64_t every = 1;                   ///< of the ticks that are there

  bool wants(std::int64_t tick) const;
  bool wants(const std::string& id) const;
};
/// All tables that are asked for, as an HDF5 file.
hal::Status write_hdf5(const ExportOptions& options);
int export_record(const ExportOptions& options);

struct DrawOptions {
  std::string record;
  PictureRequest pictures;
  std::optional<std::int64_t> at;  ///< number of ticks; empty: the last that the record holds
};
/// A picture, or a scene, of a record.
int draw_picture(const DrawOptions& options);
int draw_film(const DrawOptions& options);

struct CheckOptions {
  Libraries plugins;
  std::string experiment;
  std::vector<std::string> overrides;
};
int check(const CheckOptions& options);

struct UpgradeOptions {
  Libraries plugins;
  std::string experiment;
  bool dry_run = false;  ///< only say what would change
};
int upgrade(const UpgradeOptions& options);

struct ListOptions {
  Libraries plugins;
  std::string file;  ///< whose plug-ins and kinds of robots are shown, too
  std::string kind;  ///< bridges, controllers, couplings, devices, elements, … robots; empty: all
};
int list(const ListOptions& options);

struct DescribeOptions {
  Libraries plugins;
  std::string file;  ///< as above
  std::string name;
  bool xml = false;  ///< a kind of robot as an element of a file
};
int describe(const DescribeOptions& options);

/// Lists that are left empty: the usual values when measuring, every saved line with `from`.
struct BenchOptions {
  Libraries plugins;
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
};
/// In the folder bench, which is above this one.
int bench(const BenchOptions& options);

struct PluginNewOptions {
  std::string name;
  std::string kind = "device";  ///< one of `plugin_kinds`
};
/// Makes a folder of that name here: a plug-in that builds, runs and is tested.
int plugin_new(const PluginNewOptions& options);
std::vector<std::string> plugin_kinds();

struct PluginCheckOptions {
  Libraries plugins;  ///< that the checked one needs
  std::string file;
  bool json = false;
};
/// Judges what a plug-in registers. kBadInput: a fault, or it cannot be loaded.
int plugin_check(const PluginCheckOptions& options);

struct RobotOptions {
  Libraries plugins;
  std::string file;
  std::string link;
  std::optional<double> seconds;
  std::string report;
  std::vector<std::string> hub_faults;  ///< as `parse_hub_fault` reads them
  double step_timeout_s = 5.0;          ///< as for `run`
  std::string robot;                    ///< of a hub, whose peer this is; empty: the file's; "*": any that waits
};
int robot(const RobotOptions& options);
/// The same for a robot of a run in lock-step, where the link is "peer:tcp:HOST:PORT" or "peer:serial:…".
int robot_peer(const RobotOptions& options);
inline constexpr std::string_view kPeerScheme = "peer:";

struct PreflightOptions {
  Libraries plugins;
  std::string experiment;
  std::vector<std::string> overrides;
  std::vector<std::string> without;  ///< real robots that are simulated instead, by id
  std::optional<double> wait_s;      ///< for robots to answer; none: as long as the run would
  double listen_s = 2.0;             ///< to robots and trackers, after that
  bool move = false;                 ///< the first motion test
  bool yes = false;                  ///< … without asking
  bool json = false;
  std::string report;
};
/// kFailedRunning: something would stop the run.
int preflight(const PreflightOptions& options);

struct DeskOptions {
  std::string where;    ///< "http://…?token=…" of the window, or "lcm:URL#CHANNEL"
  std::string command;  ///< status, preflight, start, pause, estop, arm, rearm, replace, halt, release
  std::string robot;
  std::string spare, link, as, seen_as;  ///< of replace
  std::vector<double> at;                ///< of replace: x, y, heading
  std::string who;
  bool json = false;
};
/// One command to a run. kBadInput: the run refuses it; kFailedRunning: it cannot be reached.
int desk(const DeskOptions& options);

struct EmulateOptions {
  Libraries plugins;
  std::string robot;
  std::string link;
  std::string log;
  std::vector<std::string> faults;
  std::string arena;                                       ///< experiment one of whose robots is the body
  std::string body;                                        ///< which robot; empty: the first that can be
  std::vector<std::pair<std::string, std::string>> own{};  ///< the emulator's own options: name, value
};
int emulate(const EmulateOptions& options);

struct InspectOptions {
  Libraries plugins;
  std::string link;
  std::string kind;  ///< of the robot that is there; "": the link tells
  double seconds = 2.0;
};
int inspect(const InspectOptions& options);

// --- shared by the commands ---

/// Steps to do; 0: until interrupted or a hook ends the run.
std::int64_t steps_of(std::optional<std::int64_t> steps, std::optional<double> seconds, const core::Scenario& scenario);

void print_problems(const core::Problems& problems);
/// `check` for files of kinds of robots, and of the catalog's other types; nothing when it is none.
std::optional<int> check_other_file(const std::string& path, const hal::Catalog& catalog);

}  // namespace tandem::app
