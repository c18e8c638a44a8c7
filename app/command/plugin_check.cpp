// `tandem plugin check`: judges what a plug-in registers.
#include <algorithm>
#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/conformance/judge.hpp"
#include "app/conformance/probe.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/process/terminal.hpp"
#include "bridges/bridge_type.hpp"
#include "hal/json/json.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

std::string_view word_of(Verdict verdict) noexcept {
  return verdict == Verdict::Good ? "good" : verdict == Verdict::Fault ? "fault" : "not judged";
}

bool brings_bridge(const hal::Catalog& catalog, const std::string& origin) {
  return std::any_of(catalog.entries().begin(), catalog.entries().end(), [&](const hal::Catalog::Entry& e) {
    return e.origin == origin && e.category == bridges::BridgeType::kCategory;
  });
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

}  // namespace

int plugin_check(const PluginCheckOptions& options) {
  hal::Catalog inside = catalog();
  const hal::Status added = inside.add_from(std::string(hal::Catalog::kInside), &register_probe);
  if (!added.ok()) return complain(kFailedRunning, added.error().message);
  hal::PluginLoader loader(plugin_folders(), std::move(inside));
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

}  // namespace tandem::app
