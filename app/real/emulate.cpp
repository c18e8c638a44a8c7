// `tandem emulate`: behaves as a robot's firmware on a link.
#include <csignal>
#include <cstdio>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugins.hpp"
#include "app/experiment/reading.hpp"
#include "app/module/module_table.hpp"
#include "app/process/signals.hpp"
#include "app/real/real_time_world.hpp"

namespace tandem::app {
namespace {

struct EmulateOptions {
  Libraries plugins;
  std::string robot;
  std::string link;
  std::string log;
  std::vector<std::string> faults;
  std::string arena;                                       ///< experiment one of whose robots is the body
  std::string body;                                        ///< which robot; empty: the first that can be
  std::vector<std::pair<std::string, std::string>> own{};  ///< the emulator's own options: name, value

  void describe(hal::CommandLine& line) {
    line.word("robot", robot, "Which; `tandem list emulators` names them").required().named_in("emulator");
    line.option("--link", link,
                "Where; pty:NAME makes a pseudo-terminal of that name; `tandem describe NAME` tells an emulator's")
        .required();
    line.option("--log", log, "File for one JSON object an event; default: none").file();
    line.option("--fault", faults,
                "A fault to show, e.g. silent@5s+2s, or silent@drive+5s+2s after the robot was first told to move; "
                "repeatable")
        .repeatable();
    line.option("--arena", arena,
                "Experiment file: one of its robots, driven by the emulator's puppet (`tandem describe NAME`), is the "
                "body")
        .file();
    line.option("--body", body, "Which of its robots; default: the first that can be").needs("--arena");
    describe_plugins(line, plugins);
    line.footer("Further options are the emulator's own: --firmware gctronic, --name eb0, …");
    line.further(own);
  }
};

using bridges::EmulatorType;

int complain(const std::string& message, int code = kBadInput) {
  fmt::print(stderr, "error: {}\n", message);
  return code;
}

/// The world of `options.arena` with its robot in it; null, when it was told what is wrong.
std::unique_ptr<RealTimeWorld> make_arena(const EmulateOptions& options, const EmulatorType& emulator,
                                          hal::PluginLoader& loader, bridges::SharedPorts& ports,
                                          const std::atomic<bool>& stop) {
  const auto scenario = read_or_complain(loader, {}, options.arena, {});
  if (!scenario) return nullptr;
  core::Problems problems;
  auto world = core::World::make(*scenario, loader, {}, problems);
  print_problems(problems);
  if (world == nullptr) return nullptr;
  const auto robot = SimulatedBody::find(*world, emulator, options.body);
  if (!robot.ok()) {
    complain(robot.error().message);
    return nullptr;
  }
  return std::make_unique<RealTimeWorld>(std::move(world), robot.value(), ports, stop);
}

/// What the command line says of the emulator's own options.
hal::Result<std::shared_ptr<const void>> read_own(const EmulateOptions& options, const EmulatorType& emulator) {
  hal::Element element;
  element.name = "emulate " + std::string(emulator.name);
  element.file = "tandem";
  for (const auto& [name, value] : options.own) element.attributes.push_back({name, value, 0});
  hal::Problems problems;
  hal::ElementReader reader(element, problems);
  auto own = emulator.read(reader);
  reader.finish();
  if (problems.empty()) return own;
  std::string message;
  for (const hal::Problem& p : problems) message += (message.empty() ? "" : "\n") + p.message;
  return hal::Error{message};
}

int emulate(const EmulateOptions& options) {
  hal::PluginLoader loader = make_loader();
  if (!open_plugins(loader, options.plugins)) return kBadInput;
  const auto* const emulator = loader.catalog().find<EmulatorType>(options.robot);
  if (emulator == nullptr) {
    fmt::print(stderr, "tandem emulate: there is no emulator of '{}'; there are: {}\n", options.robot,
               hal::listed(loader.catalog().names(EmulatorType::kCategory)));
    return kWrongUsage;
  }
  if (!options.arena.empty() && emulator->kind.empty())
    return complain("--arena is for emulated robots, and '" + options.robot + "' is none: leave it out");
  auto own = read_own(options, *emulator);
  if (!own.ok()) return complain(own.error().message);
  std::signal(SIGPIPE, SIG_IGN);  // who reads our frames may end before us
  const std::atomic<bool>& stop = catch_signals();
  bridges::EmulatorRequest request;
  request.link = options.link;
  request.log_file = options.log;
  request.faults = options.faults;
  request.options = std::move(own).value();
  request.log = hal::Log([](hal::Severity, std::string_view text) { fmt::print(stderr, "{}\n", text); });
  request.ready = [](const std::string& text) { fmt::print(stderr, "{}; Ctrl-C ends it\n", text); };
  bridges::SharedPorts ports(emulator->ports());
  std::unique_ptr<RealTimeWorld> arena;
  if (!options.arena.empty()) {
    arena = make_arena(options, *emulator, loader, ports, stop);
    if (arena == nullptr) return kBadInput;
  }
  const hal::Status ended = emulator->run(request, arena == nullptr ? nullptr : &ports, stop);
  if (ended.ok()) return kDone;
  request_stop();  // the arena's thread looks at the same flag
  return complain(ended.error().message);
}

}  // namespace

constinit const hal::CommandType emulate_command = module_command<EmulateOptions, emulate>("emulate");

}  // namespace tandem::app
