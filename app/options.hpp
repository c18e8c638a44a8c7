// What a command line asks for, as values: one for each command, and those that several share.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
  std::string desk_keys;        ///< file with the keys of who commands over LCM; empty: this user's
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
  bool anyway = false;                  ///< drive real robots although their last first motion failed
  std::vector<std::string> hub_faults;  ///< as `parse_hub_fault` reads them
  WatchRequest watch;
  ReplayRequest replay = {};
  bool quiet = false;           ///< no table
  double step_timeout_s = 5.0;  ///< after which a controller or hook that does not return is named; 0: never
  double step_limit_s = 0.0;    ///< after which it ends the run, as a failure; 0: never
};

struct CompareOptions {
  Libraries plugins;
  std::string a, b;  ///< experiments or dumps; an empty b is a
  std::optional<double> seconds;
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> threads_a, threads_b;
  std::vector<std::string> overrides, overrides_a, overrides_b;  ///< of both; of one
};

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

struct DrawOptions {
  std::string record;
  PictureRequest pictures;
  std::optional<std::int64_t> at;  ///< number of ticks; empty: the last that the record holds
};

struct CheckOptions {
  Libraries plugins;
  std::string experiment;
  std::vector<std::string> overrides;
};

struct UpgradeOptions {
  Libraries plugins;
  std::string experiment;
  bool dry_run = false;  ///< only say what would change
};

struct ListOptions {
  Libraries plugins;
  std::string file;  ///< whose plug-ins and kinds of robots are shown, too
  std::string kind;  ///< bridges, controllers, couplings, devices, elements, … robots; empty: all
};

struct DescribeOptions {
  Libraries plugins;
  std::string file;  ///< as above
  std::string name;
  bool xml = false;  ///< a kind of robot as an element of a file
};

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

struct PluginNewOptions {
  std::string name;
  std::string kind = "device";  ///< one of `plugin_kinds`
};

struct PluginCheckOptions {
  Libraries plugins;  ///< that the checked one needs
  std::string file;
  bool json = false;
};

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
  std::string desk_keys;  ///< as of `run`
};

struct DeskOptions {
  std::string where;    ///< "http://…?token=…" of the window, or "lcm:URL#CHANNEL"
  std::string command;  ///< status, preflight, start, pause, estop, arm, rearm, move, replace, halt, release
  std::string robot;
  std::string spare, link, as, seen_as;  ///< of replace
  std::vector<double> at;                ///< of replace: x, y, heading
  std::string who;
  std::string keys;  ///< file; empty: this user's
  bool json = false;
};

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

struct InspectOptions {
  Libraries plugins;
  std::string link;
  std::string kind;  ///< of the robot that is there; "": the link tells
  double seconds = 2.0;
};

}  // namespace tandem::app
