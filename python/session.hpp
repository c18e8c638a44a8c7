// A world with all that it needs to live: what Python's worlds, arrays and snapshots hold together.
#pragma once
#include <Python.h>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/run/run.hpp"
#include "core/sim/world.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::python {

class World;
class PortArrays;
struct SwarmRows;

/// The world with what Python has taken of it. Destroyed with Python's lock held.
struct Session {
  explicit Session(std::vector<std::filesystem::path> folders, hal::Catalog catalog)
      : loader(std::move(folders), std::move(catalog)) {}
  ~Session();

  hal::PluginLoader loader;
  std::unique_ptr<core::World> world;
  std::atomic<bool> stop{false};              ///< the run is left before its end
  std::unique_ptr<core::Run> run;             ///< of that world; another one after each reset
  World* owner = nullptr;                     ///< null once that is closed
  core::HookContext* hook_context = nullptr;  ///< while a hook of Python is called
  bool writes = false;                        ///< commands may be written between steps
  std::vector<std::string> keys;              ///< of its guests (guests.hpp)
  /// The references that it holds to guests and hooks, one each, so that Python's collector finds a hook that keeps its
  /// world. With Python's lock.
  std::vector<PyObject*> held;

  /// Rows of the swarms, and the arrays of ports over them that were asked for, by the swarm's first block.
  std::map<std::size_t, std::shared_ptr<SwarmRows>> rows;
  std::map<std::pair<std::size_t, const hal::PortType*>, std::shared_ptr<PortArrays>> arrays;
  std::mutex arrays_lock;  ///< `arrays` and their fields: they are made with Python's lock, and copied without
  /// Copies the world's memory into those arrays: after ticks, and before something of Python is called within one.
  void read_arrays() noexcept;
  /// Copies commands that Python wrote into the world's memory: before ticks, and before anything looks at them.
  void write_arrays() noexcept;

  /// Messages of the world; may be called from any thread.
  void note(hal::Severity severity, std::string_view text);
  std::vector<std::pair<std::string, std::string>> messages();

 private:
  static constexpr std::size_t kMostMessages = 1000;
  std::mutex lock_;
  std::vector<std::pair<std::string, std::string>> messages_;
};

}  // namespace tandem::python
