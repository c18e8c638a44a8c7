// The modules of the program: what each is for, and the commands that it brings, which help lists whether it is built
// or not.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace tandem::app {

struct ModuleCommand {
  std::string_view name, summary;
};

struct Module {
  std::string_view name;
  std::string_view summary;
  int minutes;                                   ///< that building takes on two processors, about
  std::span<const std::string_view> needs;       ///< modules that are loaded before it
  std::span<const ModuleCommand> commands;       ///< in the order of help
  std::span<const std::string_view> categories;  ///< of entries that plug-ins may add when it is there
  std::span<const std::string_view> elements;    ///< of files that need it
  std::span<const std::string_view> lists = {};  ///< what `tandem list` has more of when it is there
};

namespace module_table {

using Word = std::string_view;

inline constexpr std::array<ModuleCommand, 6> kReal = {
    {{"replay", "Compute a run with real robots again out of its record, without them, and compare every tick."},
     {"preflight", "Look for everything that would stop a run with real robots, before anything moves."},
     {"desk", "Command the real robots of a run that goes on."},
     {"robot", "Run one real robot's controller here."},
     {"inspect", "Say which robot is on a link and what it reads. Moves nothing."},
     {"emulate", "Behave as a robot's firmware on a link."}}};
inline constexpr std::array<ModuleCommand, 2> kPictures = {
    {{"picture", "Draw a picture of a record of `tandem run --record`."},
     {"film", "Make a film of a record of `tandem run --record`."}}};
inline constexpr std::array<ModuleCommand, 1> kWindow = {
    {{"view",
      "Run an experiment, or play a record, behind a page in the browser, until Ctrl-C: watch, stop, go back, click, "
      "drag, plot."}}};
inline constexpr std::array<ModuleCommand, 2> kStudy = {
    {{"sweep", "Make all runs of a study, on all cores, into one table."},
     {"plot", "Draw what the table of a sweep holds, and say what differs."}}};
inline constexpr std::array<ModuleCommand, 11> kLab = {
    {{"fit", "Find the parameters of simulated robots in records of real ones."},
     {"gap", "Say how far a simulation is from what was recorded."},
     {"calibrate", "Find a camera's lens and place, for the tracker 'apriltag'."},
     {"calibrate board", "Make a board to print (A4): FILE.svg, .pdf or .png, and FILE.json."},
     {"calibrate camera", "Find focal lengths, centre and distortion from frames of the board."},
     {"calibrate arena", "Find where the camera hangs, from tags at known places."},
     {"plugin", "Begin a plug-in, or check one: `plugin new NAME`, `plugin check FILE`."},
     {"plugin new", "Make a folder with a plug-in that builds, an experiment and a test."},
     {"plugin check", "Judge what a plug-in registers, each part by its table and in small worlds."},
     {"validate", "Compare what the program computes with closed forms and references of their own, in one report."},
     {"bench", "Run a benchmark: one JSON object a line, and figures."}}};

inline constexpr std::array<Word, 1> kRealNeeds = {"live"};
inline constexpr std::array<Word, 2> kOfWindow = {"live", "pictures"};
inline constexpr std::array<Word, 6> kOfLab = {"dynamics", "live", "pictures", "real", "window", "study"};
inline constexpr std::array<Word, 5> kRealCategories = {"bridge", "inspector", "emulator", "tracker", "stopper"};
inline constexpr std::array<Word, 1> kPictureCategories = {"layer"};
inline constexpr std::array<Word, 1> kArgosCategories = {"argos3"};
inline constexpr std::array<Word, 4> kRealElements = {"bridge", "peer", "trackers", "footbot_map"};
inline constexpr std::array<Word, 1> kStudyElements = {"study"};
inline constexpr std::array<Word, 3> kRealLists = {"bridges", "emulators", "trackers"};
inline constexpr std::array<Word, 1> kPictureLists = {"layers"};
inline constexpr std::array<Word, 1> kStudyLists = {"elements"};
inline constexpr std::array<Word, 3> kDynamicsEngines = {"dynamics2d", "dynamics3d", "particle3d"};
inline constexpr std::array<Word, 4> kDynamicsElements = {"dynamics2d", "dynamics3d", "particle3d", "pointmass3d"};

}  // namespace module_table

/// In the order in which they can be loaded.
inline constexpr std::array<Module, 8> kModules = {
    {{"dynamics", "physics engines with forces", 1, {}, {}, {}, module_table::kDynamicsElements},
     {"live", "runs that people hold and watch", 1, {}, {}, {}, {}},
     {"pictures",
      "pictures, films, layers",
      1,
      {},
      module_table::kPictures,
      module_table::kPictureCategories,
      {},
      module_table::kPictureLists},
     {"real", "real robots: bridges, trackers, their emulators", 4, module_table::kRealNeeds, module_table::kReal,
      module_table::kRealCategories, module_table::kRealElements, module_table::kRealLists},
     {"window", "the page in the browser", 2, module_table::kOfWindow, module_table::kWindow, {}, {}},
     {"study",
      "sweeps, tables, plots",
      2,
      {},
      module_table::kStudy,
      {},
      module_table::kStudyElements,
      module_table::kStudyLists},
     {"lab", "fits, benchmarks, validation, checks of plug-ins", 5, module_table::kOfLab, module_table::kLab, {}, {}},
     {"argos3", "sources for ARGoS 3: its headers and classes", 1, {}, {}, module_table::kArgosCategories, {}}}};

/// What help says of a module's command. Its command type says the same.
consteval std::string_view module_summary(std::string_view command) {
  for (const Module& module : kModules) {
    for (const ModuleCommand& c : module.commands) {
      if (c.name == command) return c.summary;
    }
  }
  throw "no module has this command";
}

}  // namespace tandem::app
