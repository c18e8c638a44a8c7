// Options of a run, as values: of `tandem run`, `view` and `replay`, and of drawings.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/exit_code.hpp"

namespace tandem::app {

/// Of --plugin: libraries whose parts this call may name besides the program's own.
using Libraries = std::vector<std::string>;

/// Pictures and films of a run or of a record.
struct PictureRequest {
  std::string picture;           ///< .svg, .png or .pdf
  std::vector<std::int64_t> at;  ///< numbers of ticks after which there are pictures, too
  std::int64_t size_px = 1000;   ///< of the longer side
  std::vector<double> region;    ///< x0, y0, x1, y1 in metres; empty: the whole arena
  double trails_s = 0.0;
  bool axes = false, ids = false, no_title = false, no_legend = false;
  std::vector<std::string> layers;  ///< over pictures and films
  std::string film;                 ///< .mp4, .mkv, .webp, or pictures: "FOLDER/" or "FOLDER/%06d.png"
  std::int64_t film_every = 1;      ///< ticks
  std::string povray;               ///< .pov, or .png beside one: a scene for POV-Ray
  double film_rate = 0.0;           ///< frames a second; 0: as fast as it was, 60 at most
};

/// Holding a run while it goes on (core/live/live_run.hpp).
struct HoldOptions {
  bool wanted = false;            ///< it is watched
  bool paused = false;            ///< at the start
  bool stay = false;              ///< at the end
  std::optional<double> speed;    ///< times real time; none: as the experiment says
  std::uint64_t memory_MB = 500;  ///< of checkpoints
  std::string desk_keys;          ///< file with the keys for commands over LCM; empty: this user's
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

/// Changes of an experiment (`--set`), and whether all its scripts in Lua may do input and output (`--allow-io`).
inline std::vector<std::string> with_io(std::vector<std::string> overrides, bool allow_io) {
  if (allow_io) overrides.emplace_back("controllers.lua_controller[*].params.allow_io=true");
  return overrides;
}

struct RunOptions {
  Libraries plugins;
  std::string experiment;
  std::optional<double> seconds;
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> threads;
  std::vector<std::string> overrides;
  bool allow_io = false;  ///< of all scripts in Lua
  std::string report;     ///< file, or "-"
  PictureRequest pictures;
  std::string trajectory;            ///< CSV file, of every robot unless the experiment says which
  std::string record;                ///< record file, as the experiment says or of every robot's pose and state
  std::string repeat;                ///< record whose actions are done again
  std::string checkpoint;            ///< file that keeps the state of the run
  double checkpoint_every_s = 60.0;  ///< of simulated time
  std::string resume;                ///< checkpoint to go on from, instead of the experiment
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

  /// `overrides`, and changes by other options.
  std::vector<std::string> all_overrides() const { return with_io(overrides, allow_io); }
};

}  // namespace tandem::app
