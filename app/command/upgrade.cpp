// `tandem upgrade`: brings an experiment file to this program's version of the vocabulary.
#include "core/config/upgrade.hpp"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/outputs/report.hpp"
#include "app/process/terminal.hpp"
#include "hal/input_file.hpp"
#include "hal/output_file.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::app {
namespace {

struct UpgradeOptions {
  Libraries plugins;
  std::string experiment;
  bool dry_run = false;  ///< only say what would change

  void describe(hal::CommandLine& line) {
    line.word("experiment", experiment, "The experiment file (.xml)").required().file();
    line.flag("--dry-run", dry_run, "Only say what would change");
    describe_plugins(line, plugins);
  }
};

int upgrade(const UpgradeOptions& options) {
  const std::string& path = options.experiment;
  core::Problems problems;
  const auto root = hal::read_xml_file(path, problems);  // judges what kind of file it is, too
  if (!root) {
    print_problems(problems);
    return kBadInput;
  }
  hal::PluginLoader loader = make_loader();
  if (!open_plugins(loader, options.plugins)) return kBadInput;
  loader.look_beside(path);
  for (const core::PluginConfig& plugin : core::plugins_of(*root)) {  // one that is not built yet is no obstacle
    const hal::Status opened = loader.open(plugin.library);
    if (!opened.ok()) print_problems({{path, plugin.line, "<plugins>: " + opened.error().message, true}});
  }
  const auto text = hal::read_whole_file(path, "the experiment");
  if (!text.ok()) return complain(kBadInput, text.error().message);
  const auto made = core::upgraded(text.value(), path, loader.catalog());
  if (!made.ok()) return complain(kBadInput, made.error().message);
  if (made.value().changes.empty()) {
    fmt::print("{}: up to date\n", path);
    return kDone;
  }
  if (!options.dry_run) {
    hal::Status written = keep_old(path);
    if (written.ok()) written = hal::write_whole_file(path, "experiment", made.value().text);
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  for (const std::string& change : made.value().changes) fmt::print("{}: {}\n", path, change);
  fmt::print("{}: {} to version {}\n", path, options.dry_run ? "would be brought" : "brought", core::kFileVersion);
  return kDone;
}

}  // namespace

constinit const hal::CommandType upgrade_command = hal::command_type<UpgradeOptions, upgrade>(
    "upgrade",
    "Rewrite an experiment file in this program's vocabulary; layout and comments stay, the old file as FILE.bak.",
    hal::command_group::kTools);

}  // namespace tandem::app
