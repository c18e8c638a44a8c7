// `tandem inspect`: who is there, and what it reads. Moves nothing, and first stops what dead programs have left
// moving.
#include <cstdio>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/module_table.hpp"
#include "app/outputs/report.hpp"
#include "app/process/signals.hpp"
#include "app/real/guarded_robots.hpp"
#include "bridges/inspector_type.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::app {
namespace {

struct InspectOptions {
  Libraries plugins;
  std::string link;
  std::string kind;  ///< of the robot that is there; "": the link tells
  double seconds = 2.0;

  void describe(hal::CommandLine& line) {
    line.word("link", link,
              "e.g. serial:/dev/rfcomm0@115200, can:can0, tcp:ROBOT:33333, lcm:udpm://239.255.76.67:7667?ttl=1")
        .required();
    line.option("--as", kind, "Kind of robot that is there, where several are reached over such links")
        .named_in("robot inspector");
    line.option("--seconds", seconds, "How long to listen").show_default().range(0.1, 3600.0);
    describe_plugins(line, plugins);
  }
};

int inspect(const InspectOptions& options) {
  const auto complain = [](int code, const std::string& message) {
    fmt::print(stderr, "error: {}\n", message);
    return code;
  };
  hal::PluginLoader loader = make_loader();
  if (!open_plugins(loader, options.plugins)) return kBadInput;
  const bridges::InspectorType* chosen = nullptr;
  std::string known;
  for (const auto* type : loader.catalog().all<bridges::InspectorType>()) {
    const bool meant = options.kind.empty() ? type->reads(options.link) : type->name == options.kind;
    if (chosen == nullptr && meant) chosen = type;
    known += "\n  " + std::string(type->name) + ": " + std::string(type->summary);
  }
  if (chosen == nullptr && !options.kind.empty())
    return complain(kBadInput, "nobody inspects a '" + options.kind + "'; robots are reached over" + known);
  if (chosen == nullptr) {
    const auto address = bridges::parse_link(options.link);
    return complain(kBadInput,
                    (address.ok() ? "nobody understands the link '" + options.link + "'" : address.error().message) +
                        "; robots are reached over" + known);
  }
  const hal::Log log([](hal::Severity severity, std::string_view text) {
    if (severity != hal::Severity::Info) fmt::print(stderr, "{}\n", text);
  });
  (void)stop_abandoned_robots(loader.catalog(), log);  // before any thread
  const bridges::InspectRequest request{.link = options.link,
                                        .seconds = options.seconds,
                                        .log = log,
                                        .stop = catch_signals(),
                                        .print = [](const std::string& line) { fmt::print("{}\n", line); },
                                        .print_table = &print_table};
  const hal::Status seen = chosen->run(request);
  return seen.ok() ? kDone : complain(kFailedRunning, seen.error().message);
}

}  // namespace

constinit const hal::CommandType inspect_command = module_command<InspectOptions, inspect>("inspect");

}  // namespace tandem::app
