// The modules of the program: what each is for, and the commands that it brings, which help lists whether it is built
// or not.
#pragma once
#include <array>
#include <span>
#include <string_view>

#include "hal/command.hpp"

namespace tandem::app {

struct ModuleCommand {
  std::string_view name, summary;
  std::string_view group;  ///< heading in help
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
namespace group = hal::command_group;

inline constexpr std::array<ModuleCommand, 6> kReal = {
    {{"replay", "Compute a run with real robots again out of its record, without them, and compare every tick.",
      group::kRealRobots},
     {"preflight", "Look for everything that would stop a run with real robots, before anything moves.",
      group::kRealRobots},
     {"desk", "Command the real robots of a run that goes on.", group::kRealRobots},
     {"robot", "Run one real robot's controller here.", group::kRealRobots},
     {"inspect", "Say which robot is on a link and what it reads. Moves nothing.", group::kRealRobots},
     {"emulate", "Behave as a robot's firmware on a link.", group::kRealRobots}}};
inline constexpr std::array<ModuleCommand, 2> kPictures = {
    {{"picture", "Draw a picture of a record of `tandem run --record`.", group::kSimulate},
     {"film", "Make a film of a record of `tandem run --record`.", group::kSimulate}}};
inline constexpr std::array<ModuleCommand, 1> kWindow = {
    {{"view",
      "Run an experiment, or play a record, behind a page in the browser, until Ctrl-C: watch, stop, go back, click, "
      "drag, plot.",
      group::kSimulate}}};
inline constexpr std::array<ModuleCommand, 2> kStudy = {
    {{"sweep", "Make all runs of a study, on all cores, into one table.", group::kStudy},
     {"plot", "Draw what the table of a sweep holds, and say what differs.", group::kStudy}}};
inline constexpr std::array<ModuleCommand, 11> kLab = {
    {{"fit", "Find the parameters of simulated robots in records of real ones.", group::kStudy},
     {"gap", "Say how far a simulation is from what was recorded.", group::kStudy},
     {"calibrate", "Find a camera's lens and place, for the tracker 'apriltag'.", group::kRealRobots},
     {"calibrate board", "Make a board to print (A4): FILE.svg, .pdf or .png, and FILE.json.", group::kRealRobots},
     {"calibrate camera", "Find focal lengths, centre and distortion from frames of the board.", group::kRealRobots},
     {"calibrate arena", "Find where the camera hangs, from tags at known places.", group::kRealRobots},
     {"plugin", "Begin a plug-in, or check one: `plugin new NAME`, `plugin check FILE`.", group::kExtend},
     {"plugin new", "Make a folder with a plug-in that builds, an experiment and a test.", group::kExtend},
     {"plugin check", "Judge what a plug-in registers, each part by its table and in small worlds.", group::kExtend},
     {"validate", "Compare what the program computes with closed forms and references of their own, in one report.",
      group::kTools},
     {"bench", "Run a benchmark: one JSON object a line, and figures.", group::kTools}}};

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

/// A module's command as the table has it. Its command type says the same.
constexpr ModuleCommand command_in_table(std::string_view name) {
  for (const Module& module : kModules) {
    for (const ModuleCommand& c : module.commands) {
      if (c.name == name) return c;
    }
  }
  throw "no module has this command";
}

/// Its type, where there is nothing to call: it holds other commands, or its module is not loaded.
constexpr hal::CommandType command_of(const ModuleCommand& c) {
  return {c.name, c.summary, nullptr, c.group};
}

/// The type of a module's command with values of class `T` (hal::command_type).
template <class T, auto kRun>
constexpr hal::CommandType module_command(std::string_view name) {
  const ModuleCommand c = command_in_table(name);
  return hal::command_type<T, kRun>(c.name, c.summary, c.group);
}

}  // namespace tandem::app
