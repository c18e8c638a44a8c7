// Watches the files that controllers of a run run, and has the run read them again after changes.
#pragma once
#include <memory>

#include "core/live/live_run.hpp"
#include "core/sim/world.hpp"
#include "hal/log.hpp"

namespace tandem::app {

/// Looks at the files on a thread of its own, a few times a second; a text that stays for two looks goes to the run as
/// the action "reload" (core/live/source_files.hpp), between two ticks.
class ScriptWatch {
 public:
  /// By the thread that steps, before the run; both must outlive this. `log` tells what was read, and what is wrong.
  ScriptWatch(core::LiveRun& live, core::World& world, const hal::Log& log);
  ~ScriptWatch();
  ScriptWatch(const ScriptWatch&) = delete;
  ScriptWatch& operator=(const ScriptWatch&) = delete;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;  // answers may come after the end
};

}  // namespace tandem::app
