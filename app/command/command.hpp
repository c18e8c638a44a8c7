// The commands of `tandem`, one file each. Every function returns the exit code of the program.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/options.hpp"
#include "hal/result.hpp"

namespace tandem::app {

int run(const RunOptions& options);

/// `run` behind a window until somebody ends it; or the same of a record of one.
int view(RunOptions options);

/// A run with real robots, computed again out of its record: `options.replay` says which, and what is to be different.
int replay(RunOptions options);

/// kDifferent: a value differs.
int compare(const CompareOptions& options);

/// All tables that are asked for, as an HDF5 file.
hal::Status write_hdf5(const ExportOptions& options);

int export_record(const ExportOptions& options);

/// A picture, or a scene, of a record.
int draw_picture(const DrawOptions& options);

int draw_film(const DrawOptions& options);

int check(const CheckOptions& options);

int upgrade(const UpgradeOptions& options);

int list(const ListOptions& options);

int describe(const DescribeOptions& options);

/// In the folder bench, which is above this one.
int bench(const BenchOptions& options);

/// Makes a folder of that name here: a plug-in that builds, runs and is tested.
int plugin_new(const PluginNewOptions& options);

std::vector<std::string> plugin_kinds();

/// Judges what a plug-in registers. kBadInput: a fault, or it cannot be loaded.
int plugin_check(const PluginCheckOptions& options);

int robot(const RobotOptions& options);

/// The same for a robot of a run in lock-step, where the link is "peer:tcp:HOST:PORT" or "peer:serial:…".
int robot_peer(const RobotOptions& options);

inline constexpr std::string_view kPeerScheme = "peer:";

/// kFailedRunning: something would stop the run.
int preflight(const PreflightOptions& options);

/// One command to a run. kBadInput: the run refuses it; kFailedRunning: it cannot be reached.
int desk(const DeskOptions& options);

int emulate(const EmulateOptions& options);

int inspect(const InspectOptions& options);

}  // namespace tandem::app
