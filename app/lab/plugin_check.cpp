// `tandem plugin check`: judges what a plug-in registers.
#include <algorithm>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/command/command_line.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/lab/conformance/judge.hpp"
#include "app/lab/conformance/probe.hpp"
#include "app/module/modules.hpp"
#include "app/process/terminal.hpp"
#include "bridges/bridge_type.hpp"
#include "hal/json/json.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

struct PluginCheckOptions {
  Libraries plugins;  ///< that the checked one needs
  std::string file;
  bool json = false;

  void describe(hal::CommandLine& line) {
    line.footer("Exit code: 0 no fault was found, 1 faults, or a library that cannot be loaded.");
    line.word("file", file, "The library").required().file();
    line.flag("--json", json, "One JSON object instead of lines");
    describe_plugins(line, plugins);
  }
};

std::string_view word_of(Verdict verdict) noexcept {
  return verdict == Verdict::Good ? "good" : verdict == Verdict::Fault ? "fault" : "not judged";
}

bool brings_bridge(const hal::Catalog& catalog, const std::string& origin) {
  return std::any_of(catalog.entries().begin(), catalog.entries().end(), [&](const hal::Catalog::Entry& e) {
    return e.origin == origin && e.category == bridges::BridgeType::kCategory;
  });
}

/// Whether lines can be read as the library's commands describe them, and each word of them is documented.
void judge_commands(const hal::Catalog& catalog, const std::string& origin, Judgements& all) {
  for (const hal::CommandType* type : catalog.all<hal::CommandType>()) {
    if (catalog.origin_of(type) != origin || type->make == nullptr) continue;
    const std::string flaw = flaw_of_line(*type);
    all.push_back({flaw.empty() ? Verdict::Good : Verdict::Fault, "command '" + std::string(type->name) + "'", "line",
                   flaw.empty() ? "lines are read as it describes them, and each word has a text" : flaw});
  }
}

void print_lines(const Judgements& all) {
  for (const Judgement& j : all)
    fmt::print("{:<10}  {}, {}: {}\n", word_of(j.verdict), printable(j.part), j.what, printable(j.found));
}

void print_json(const std::string& file, const Judgements& all, bool good) {
  hal::Json json;
  json["plugin"] = file;
  json["good"] = good;
  json["judgements"] = hal::Json::array();
  for (const Judgement& j : all) {
    hal::Json one;
    one["verdict"] = word_of(j.verdict);
    one["part"] = j.part;
    one["what"] = j.what;
    one["found"] = j.found;
    json["judgements"].push_back(std::move(one));
  }
  fmt::print("{}\n", hal::to_text(json));
}

int plugin_check(const PluginCheckOptions& options, const hal::CommandContext& context) {
  hal::Catalog inside = context.catalog();
  const hal::Status added = inside.add_from(std::string(hal::Catalog::kInside), &register_probe);
  if (!added.ok()) return complain(kFailedRunning, added.error().message);
  hal::PluginLoader loader(plugin_folders(), std::move(inside), on_demand());
  if (!open_plugins(loader, options.plugins)) return kBadInput;

  Judgements all;
  std::string path = options.file;
  const std::ptrdiff_t threads = thread_count();
  if (const hal::Status opened = loader.open(options.file); !opened.ok()) {
    all.push_back({Verdict::Fault, "library '" + options.file + "'", "loads", opened.error().message});
  } else {
    path = loader.find(options.file).value().string();
    std::size_t entries = 0;
    for (const hal::Catalog::Entry& e : loader.catalog().entries()) entries += e.origin == path ? 1 : 0;
    all.push_back({entries > 0 ? Verdict::Good : Verdict::Fault, "library '" + options.file + "'", "loads",
                   entries > 0 ? fmt::format("registers {} entries", entries) : "it registers nothing"});
    if (brings_bridge(loader.catalog(), path) && thread_count() != threads)
      all.push_back({Verdict::Fault, "library '" + options.file + "'", "guardian",
                     "it starts a thread while it is loaded, and brings a bridge: the guardian process could not be "
                     "forked safely. Start it when the bridge starts"});
    const Judgements judged = judge_plugin(loader, path);
    all.insert(all.end(), judged.begin(), judged.end());
    judge_commands(loader.catalog(), path, all);
  }
  const auto faults = std::count_if(all.begin(), all.end(), [](const auto& j) { return j.verdict == Verdict::Fault; });
  if (options.json) {
    print_json(path, all, faults == 0);
  } else {
    print_lines(all);
    fmt::print("{} judgement{}, {} fault{}\n", all.size(), all.size() == 1 ? "" : "s", faults, faults == 1 ? "" : "s");
  }
  return faults == 0 ? kDone : kBadInput;
}

}  // namespace

constinit const hal::CommandType plugin_check_command =
    module_command<PluginCheckOptions, plugin_check>("plugin check");

}  // namespace tandem::app
