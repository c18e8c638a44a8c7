// Worlds of Python: made, stepped, looked into, put back.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <thread>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/sim/snapshot.hpp"
#include "python/arrays.hpp"
#include "python/session.hpp"

namespace tandem::app {
class Progress;
}

namespace tandem::python {

namespace py = pybind11;

/// An experiment that is none, or cannot be made: "file:line: error: …", all of them.
class ExperimentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// A run that failed.
class RunFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Whether a reset can take over "path=value".
bool changes_at_reset(const std::string& parameter);

struct Snapshot {
  std::shared_ptr<Session> session;
  core::Snapshot moment;
};

/// What a world is made of.
struct WorldRequest {
  std::string file;  ///< or the name under which `text` is spoken of
  std::string text;  ///< XML; empty: the file's
  std::optional<std::uint64_t> seed;
  std::optional<std::int64_t> threads;
  std::vector<std::string> parameters;  ///< "path=value"
  py::dict controllers;                 ///< id of a configuration: a class of Python
  std::vector<std::string> driven;      ///< ids of configurations whose ports are written from outside; "*": all
  py::list hooks;
  std::vector<std::string> plugins;
  std::string record;  ///< of the first run; empty: none
};

/// Used by one thread at a time; while it steps, by the hooks, controllers and policies that are called, too. All else
/// is an error of Python, never a crash.
class World {
 public:
  explicit World(WorldRequest request);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  void start();
  std::int64_t step(std::int64_t ticks);
  /// `progress`: says how far it is, where that takes more than two seconds.
  std::int64_t run(std::optional<double> until_s, bool progress);
  void finish();
  /// Leaves the run, and begins another; `record`: of that one.
  void reset(std::optional<std::uint64_t> seed, const std::optional<std::vector<std::string>>& parameters,
             const std::string& record);
  std::shared_ptr<Snapshot> snapshot();
  void restore(const Snapshot& snapshot);
  void close();
  bool closed() const noexcept { return session_ == nullptr; }
  /// For Python's collector: visits the guests and hooks that this holds. @returns what `take` did.
  int visit(visitproc take, void* argument) const;
  /// Closes unless it is in use: nothing but what it holds itself refers to it.
  void collect() noexcept;

  /// For groups: steps without Python's lock, on a thread that the group says.
  void step_unlocked(std::int64_t ticks) noexcept;
  void add_policy(const std::string& controller, py::object policy);
  bool has_policies() const noexcept { return !policies_.empty(); }
  void call_policies();
  void raise_failure();
  std::int64_t steps_left(std::optional<double> until_s);

  std::string state();
  double length_s() const noexcept { return length_s_; }
  const std::vector<std::string>& parameters() const noexcept { return parameters_; }
  bool has_guests() const noexcept;
  /// While it is used.
  const std::shared_ptr<Session>& session() const noexcept { return session_; }

 private:
  friend class Use;
  friend class Group;
  core::Scenario read(const std::vector<std::string>& parameters, std::string& warnings) const;
  void invite(core::Scenario& scenario) const;
  void open_run(const std::string& record);
  void leave_run();
  std::int64_t step(std::int64_t ticks, app::Progress* progress);
  bool tick_unlocked();

  std::shared_ptr<Session> session_;
  WorldRequest request_;
  std::vector<std::string> parameters_;  // of the run
  double length_s_ = 0.0;
  bool started_ = false, finished_ = false;
  std::vector<std::pair<std::string, std::string>> controller_keys_;  // configuration, key
  std::vector<std::string> hook_keys_;
  std::vector<std::pair<std::string, py::object>> policies_;
  std::atomic<std::thread::id> user_{};
  int uses_ = 0;  // under Python's lock
};

/// Marks that this thread uses a world; @throws std::runtime_error when it is closed or another thread does.
class Use {
 public:
  enum class How { Look, Alone };  ///< Alone: not from within its own step
  explicit Use(World& world, How how = How::Look);
  ~Use();
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  World& world_;
};

using WorldClass = py::class_<World, std::shared_ptr<World>>;
void bind_world(py::module_& m);
/// What is seen of a world and changed in it between ticks.
void bind_looks(WorldClass& world);
/// Records of runs.
void bind_records(py::module_& m);

}  // namespace tandem::python
