// `tandem emulate`: behaves as a robot's firmware on a link.
#include <cstdio>
#include <fmt/format.h>
#include <thread>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/puppeteer.hpp"
#include "app/signals.hpp"
#include "bridges/epuck_emulator/emulator.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {
namespace {

namespace emulator = bridges::epuck_emulator;

/// A world that runs in real time on its own thread until `stop`.
class LivingArena {
 public:
  LivingArena(std::unique_ptr<core::World> world, core::RobotId robot, const std::atomic<bool>& stop)
      : world_(std::move(world)), puppeteer_(robot, body_) {
    world_->set_external(&puppeteer_);
    thread_ = std::thread([this, &stop] {
      mixed_reality::MonotonicTime clock;
      mixed_reality::Pacer pacer(clock, world_->ticks_per_second());
      world_->start();
      pacer.start();
      while (world_->state() == core::RunState::Running) {
        world_->step();
        if (!pacer.wait_for_next(stop)) break;
      }
      world_->finish();
      if (world_->state() == core::RunState::Failed)
        fmt::print(stderr, "error: the arena stands still: {}\n", world_->failure());
    });
  }
  ~LivingArena() { thread_.join(); }
  LivingArena(const LivingArena&) = delete;
  LivingArena& operator=(const LivingArena&) = delete;

  emulator::SharedBody& body() { return body_; }

 private:
  std::unique_ptr<core::World> world_;
  emulator::SharedBody body_;
  Puppeteer puppeteer_;
  std::thread thread_;
};

}  // namespace

int emulate(const EmulateOptions& options) {
  if (options.robot != "epuck") {
    fmt::print(stderr, "tandem emulate: there is no emulator of '{}'; there is: epuck\n", options.robot);
    return kWrongUsage;
  }
  const std::atomic<bool>& stop = catch_signals();
  emulator::Options emulated;
  emulated.link = options.link;
  emulated.firmware = options.firmware;
  emulated.log_file = options.log;
  emulated.faults = options.faults;
  emulated.log = hal::Log([](hal::Severity, std::string_view text) { fmt::print(stderr, "{}\n", text); });
  emulated.ready = [](const std::string& path) {
    fmt::print(stderr, "e-puck's firmware on {}: connect with --link serial:{}@115200; Ctrl-C ends it\n", path, path);
  };

  hal::PluginLoader loader(plugin_folders());
  std::unique_ptr<LivingArena> arena;
  if (!options.arena.empty()) {
    const auto scenario = read_or_complain(options.arena, {});
    if (!scenario) return kBadInput;
    core::Problems problems;
    auto world = core::World::make(*scenario, loader, {}, problems);
    print_problems(problems);
    if (world == nullptr) return kBadInput;
    const auto robot = Puppeteer::find(*world, options.body);
    if (!robot.ok()) {
      fmt::print(stderr, "error: {}\n", robot.error().message);
      return kBadInput;
    }
    arena = std::make_unique<LivingArena>(std::move(world), robot.value(), stop);
    emulated.body = &arena->body();
  }
  const hal::Status ended = emulator::run(emulated, stop);
  if (!ended.ok()) {
    fmt::print(stderr, "error: {}\n", ended.error().message);
    request_stop();  // the arena's thread looks at the same flag
    return kBadInput;
  }
  return kDone;
}

}  // namespace tandem::app
