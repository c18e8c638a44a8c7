// Worlds for programs of one's own: an experiment file, and with it all that comes with Tandem, as one object.
//
//   #include <core/sim/world.hpp>
//   #include <library/open_world.hpp>
//
//   auto opened = tandem::library::open_world({.file = "flock.xml", .seed = 7});
//   if (!opened.ok()) …                                    // opened.error().message: every problem, with its line
//   tandem::core::Run& run = opened.value()->run();
//   run.add(std::make_unique<tandem::core::Length>(600));
//   run.go();                                              // or begin, tick and end, with a loop of one's own
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "hal/log.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::library {

/// What a world is made of.
struct WorldRequest {
  std::string file;       ///< the experiment file; with `text`, the name under which that is spoken of
  std::string text = {};  ///< the experiment itself; empty: the file is read
  std::vector<std::string> parameters = {};  ///< "path=value", as `tandem run --set` takes them
  std::vector<std::string> plugins = {};     ///< libraries beside those that the experiment names
  std::optional<std::uint64_t> seed = {};    ///< overrides the file's
  std::optional<std::int64_t> threads = {};  ///< overrides the file's; 0 and 1: the caller's thread alone
  std::string record = {};                   ///< a record of the run is written there; empty: none
  hal::Log log = {};                         ///< messages of the world, its hooks and controllers
};

/// The experiment of a request, with its plug-ins opened by `loader`, which must outlive what is made of it; `seed`,
/// `threads`, `record` and `log` count for the world alone. Problems are appended, warnings among them; nothing when
/// there is an error.
std::optional<core::Scenario> read_scenario(hal::PluginLoader& loader, const WorldRequest& request,
                                            core::Problems& problems);

/// Adds to a run what there is besides the world: the parts that the experiment names in <run>, and a record at
/// `record`, of what <record> chooses; empty: none is written. Before the run begins. Problems are appended.
void add_parts(core::Run& run, hal::PluginLoader& loader, const std::string& record, core::Problems& problems);

/// A world, the plug-ins that it lives from, and its run.
class OpenWorld {
 public:
  OpenWorld(std::unique_ptr<hal::PluginLoader> loader, std::unique_ptr<core::World> world, core::Problems warnings)
      : loader_(std::move(loader)), world_(std::move(world)), warnings_(std::move(warnings)), run_(*world_, stop_) {}

  core::World& world() noexcept { return *world_; }
  const core::World& world() const noexcept { return *world_; }
  /// Steps the world, with the parts that the experiment names, and yours. Goes once. Who steps the world without it
  /// has no parts.
  core::Run& run() noexcept { return run_; }
  hal::PluginLoader& loader() noexcept { return *loader_; }
  /// Ends the run before its next tick; from any thread.
  void stop() noexcept { stop_ = true; }
  /// What the file could say better.
  const core::Problems& warnings() const noexcept { return warnings_; }

 private:
  std::unique_ptr<hal::PluginLoader> loader_;  // outlives the world
  std::unique_ptr<core::World> world_;
  core::Problems warnings_;
  std::atomic<bool> stop_{false};
  core::Run run_;
};

/// Reads the experiment, places its robots, constructs their controllers. Robots with a `<bridge>` are simulated. Each
/// world has its own plug-ins and state: several may live at once, each used by one thread at a time. Error: all
/// problems, a line each: "file:line: error: …".
hal::Result<std::unique_ptr<OpenWorld>> open_world(const WorldRequest& request);

}  // namespace tandem::library
