// `tandem emulate`: behaves as a robot's firmware on a link.
#include <cstdio>
#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/eyebot_puppeteer.hpp"
#include "app/footbot_puppeteer.hpp"
#include "app/living_arena.hpp"
#include "app/puppeteer.hpp"
#include "app/signals.hpp"
#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/eyebot_emulator/emulator.hpp"
#include "bridges/eyebot_emulator/shared_body.hpp"
#include "bridges/footbot_emulator/emulator.hpp"

namespace tandem::app {
namespace {

namespace epuck = bridges::epuck_emulator;
namespace footbot = bridges::footbot_emulator;
namespace eyebot = bridges::eyebot_emulator;

/// The world of `options.arena` with its robot in it; null, when it was told what is wrong.
template <class Arena, class Puppeteer>
std::unique_ptr<Arena> make_arena(const EmulateOptions& options, hal::PluginLoader& loader,
                                  const std::atomic<bool>& stop) {
  const auto scenario = read_or_complain(options.arena, {});
  if (!scenario) return nullptr;
  core::Problems problems;
  auto world = core::World::make(*scenario, loader, {}, problems);
  print_problems(problems);
  if (world == nullptr) return nullptr;
  const auto robot = Puppeteer::find(*world, options.body);
  if (!robot.ok()) {
    fmt::print(stderr, "error: {}\n", robot.error().message);
    return nullptr;
  }
  return std::make_unique<Arena>(std::move(world), robot.value(), stop);
}

/// Runs an emulator, whose options begin as `emulated`, in the arena that was asked for.
template <class Puppeteer, class Body, class Emulated>
int emulate_robot(const EmulateOptions& options, Emulated emulated) {
  using Arena = LivingArena<Puppeteer, Body>;
  const std::atomic<bool>& stop = catch_signals();
  emulated.link = options.link;
  emulated.log_file = options.log;
  emulated.faults = options.faults;
  emulated.log = hal::Log([](hal::Severity, std::string_view text) { fmt::print(stderr, "{}\n", text); });
  if constexpr (requires { emulated.firmware; }) {
    if (!options.firmware.empty()) emulated.firmware = options.firmware;
  }
  hal::PluginLoader loader(plugin_folders(), catalog());
  std::unique_ptr<Arena> arena;
  if (!options.arena.empty()) {
    arena = make_arena<Arena, Puppeteer>(options, loader, stop);
    if (arena == nullptr) return kBadInput;
    emulated.body = &arena->body();
  }
  const hal::Status ended = run(emulated, stop);
  if (ended.ok()) return kDone;
  fmt::print(stderr, "error: {}\n", ended.error().message);
  request_stop();  // the arena's thread looks at the same flag
  return kBadInput;
}

/// How a host reaches the foot-bot that is shown at `path`.
std::string host_link(const std::string& path) {
  if (path.starts_with("tcp:") || path.starts_with("can:")) return path;
  return "slcan:" + path + "@1000000";
}

int emulate_eyebots(const EmulateOptions& options) {
  eyebot::Options emulated;
  emulated.robot.name = options.name;
  emulated.robot.clock_synced = options.clock == "synced";
  emulated.robot.image_hz = options.images_Hz;
  emulated.count = options.count;
  emulated.ready = [&](const std::string& url) {
    const std::string who = options.count > 1 ? fmt::format("{} eye-bots", options.count) : "eye-bot " + options.name;
    fmt::print(stderr, "{} on {}: connect with --link lcm:{}; Ctrl-C ends it\n", who, url, url);
  };
  return emulate_robot<EyebotPuppeteer, eyebot::SharedBody>(options, std::move(emulated));
}

}  // namespace

int emulate(const EmulateOptions& options) {
  if (options.robot == "eyebot") return emulate_eyebots(options);
  if (options.robot == "epuck") {
    epuck::Options emulated;
    emulated.ready = [](const std::string& path) {
      fmt::print(stderr, "e-puck's firmware on {}: connect with --link serial:{}@115200; Ctrl-C ends it\n", path, path);
    };
    return emulate_robot<Puppeteer, epuck::SharedBody>(options, std::move(emulated));
  }
  if (options.robot == "footbot") {
    footbot::Options emulated;
    emulated.ready = [](const std::string& path) {
      fmt::print(stderr, "foot-bot's modules on {}: connect with --link {}; Ctrl-C ends it\n", path, host_link(path));
    };
    return emulate_robot<FootbotPuppeteer, footbot::SharedBody>(options, std::move(emulated));
  }
  fmt::print(stderr, "tandem emulate: there is no emulator of '{}'; there are: epuck, footbot, eyebot\n",
             options.robot);
  return kWrongUsage;
}

}  // namespace tandem::app
