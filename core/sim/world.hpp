// The mutable state of one running simulation. Made from a Scenario and a seed, then stepped.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/hook/hook.hpp"
#include "core/physics/accuracy.hpp"
#include "core/scenario/scenario.hpp"
#include "core/sim/external.hpp"
#include "core/sim/incidents.hpp"
#include "core/sim/snapshot.hpp"
#include "core/space/space.hpp"
#include "core/space/state_values.hpp"
#include "hal/log.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/time.hpp"

namespace tandem::core {

struct WorldOptions {
  std::optional<std::uint64_t> seed;         ///< overrides the scenario's
  std::optional<std::uint64_t> places_seed;  ///< draws the start places instead: of the run whose state is loaded
  std::optional<std::int64_t> threads;       ///< overrides the scenario's; 0 and 1: the caller alone
  std::optional<Assignment> assignment;
  hal::Log log;
  hal::Log excess_log;  ///< gets controllers' messages beyond those that people can read; `log` gets the rest
};

/// State of a run.
enum class RunState { Running, Done, Failed };

/// A simulated world. Not copyable; may be moved between threads between steps.
class World {
 public:
  /// Places every entity, loads every plug-in, constructs every controller. All problems are appended to `problems`,
  /// each with its line; null is returned when there is an error among them. `loader` must outlive the world.
  static std::unique_ptr<World> make(const Scenario& scenario, hal::PluginLoader& loader, const WorldOptions& options,
                                     Problems& problems);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Calls the hooks' `before_run`. Once, before the first step.
  void start();
  /// One tick: hooks, physics, sense + control, filter. Does nothing once `state()` is not Running. @returns false when
  /// the external robots gave the tick up half way: it is not done, and no other may follow
  bool step();
  /// Calls the hooks' `after_run`. Once, after the last step.
  void finish();

  /// Keeps this moment: the whole space, ports, devices, controllers, time, incidents, the state of the run, and what
  /// the hooks' `save` gives. Call between steps, or ask for it through HookContext::checkpoints.
  ///
  /// With it goes what engines hold beyond the stores (impulses of contacts that they start the next tick from, search
  /// trees), so that no bit of the run depends on whether snapshots are taken, nor of one that goes on from a snapshot.
  ///
  /// Errors: a controller whose class has no copy constructor, a copy constructor or `save` that throws; real robots
  /// take part: they cannot be put back.
  hal::Result<Snapshot> snapshot();
  /// The same, and the checkpoints that hooks keep with it: for who goes back without the hooks' knowing, and has the
  /// run take the same way again.
  hal::Result<Snapshot> snapshot_of_all();
  /// Goes back to a snapshot of this world. Robots and objects that were added since vanish, those that were removed
  /// are back; controllers and ports keep their addresses. Errors: another world's snapshot; real robots take part;
  /// a copy constructor or a hook's `restore` that throws: the run has failed then.
  hal::Status restore(const Snapshot& snapshot);

  /// After `start`, and before the first step or `load`: `save` will be called. A second call does nothing.
  void begin_saving();
  /// The state as bytes: everything that `snapshot` keeps. Call between steps. Error: names what of it no other process
  /// could take over.
  hal::Result<std::string> save();
  /// Goes on from what `save` of a world of the same scenario and seed gave, in this process or another of the same
  /// program, to the last bit. Once, on a world that was started and has not stepped. Error: what does not fit, by
  /// name; the world is of no use then.
  ///
  /// What if: `before` is the scenario that the state is of, and this world's another, whose places were drawn by that
  /// one's seed. What the run had changed is taken over, and what the settings have changed holds: lights, objects that
  /// stand where they stood, the floor, parameters of controllers and devices, options of hooks, the seed. Error also:
  /// what else differs, and what both have changed.
  hal::Status load(std::string_view saved, const Scenario* before = nullptr);

  /// Begins the run again, from the first tick, as a new world of this seed would, to the last bit; plug-ins, threads
  /// and the memory of robots stay. Controllers and hooks are reset or made again, as they want (Controller::reset,
  /// Hook::reset); which controller object drives which robot of its group may change with the seed. Snapshots from
  /// before are void. Calls `start`. Call between steps, or ask for it through HookContext::checkpoints. Errors: real
  /// robots take part; the places of this seed cannot be had; what is thrown: the run has failed then.
  ///
  /// With `changed` it is the run of those settings, and all controllers and hooks are made again. Errors: `can_reset`,
  /// then nothing has changed.
  hal::Status reset(std::uint64_t seed, const Scenario* changed = nullptr);
  /// Whether it can. Errors, with lines: what is wrong with parameters; what differs and needs another world.
  hal::Status can_reset(const Scenario& changed) const;
  /// Whether all controllers and hooks were made again at the run's start: none was reset, and remembers something.
  bool all_anew() const noexcept;

  /// Goes on with the settings of `changed`, which otherwise is the scenario that the world was made of, from the next
  /// step on. Bodies, mechanisms, chance and time stay, and so does all that nothing says otherwise of. Robots that
  /// have another configuration get a new controller and safe commands, like robots that are added. Those that have
  /// other parameters go on with what their controllers remember, as after `load`; where that cannot be told apart
  /// (`begin_saving` was not called at the start, the class owns memory, or cannot be copied), they restart, and the
  /// log says so. Devices that are listed with other options, and fitted parameters, count at once; a hook with other
  /// options is made again, called (`before_run`), and gets back what it gave to `Hook::save`; lights, objects and
  /// floors that the run has not changed are as they say. Snapshots from before are void, and there is no reset. Call
  /// between steps. Errors: `can_continue_with`, then nothing has changed; what cannot be made in this world, and what
  /// the run has changed, too: the run has failed then.
  hal::Status continue_with(const Scenario& changed);
  /// Whether it can. Error: names what differs and cannot change while a run goes on. `changed` is one of which a world
  /// can be made: that is not checked here.
  hal::Status can_continue_with(const Scenario& changed) const;

  /// Makes safe what was written into actuators from outside since the last step, as it is after the controllers' step;
  /// counted among the incidents. Between steps.
  void limit_commands();

  // --- controls that hooks and controllers declare (hal/controls.hpp); between steps ---
  std::size_t hooks() const noexcept;
  const std::string& hook_name(std::size_t hook) const noexcept;
  /// Hands `controls` to the hook, or to the robot's controller. Errors: gone; what it throws.
  hal::Status visit_controls(std::size_t hook, hal::Controls& controls);
  hal::Status visit_controls(RobotId robot, hal::Controls& controls);

  /// Where messages go from now on.
  void set_log(const hal::Log& log);

  /// Lets real robots take part; `external` must outlive the last step. Null: none.
  void set_external(ExternalRobots* external) noexcept;

  /// The robot's controller does not step here: `ExternalRobots::after_control` writes its commands, and what the
  /// controller publishes. Ends with the robot.
  void set_steps_elsewhere(RobotId robot, bool elsewhere);
  /// In `ExternalRobots::after_control`: the robot's controller, which steps elsewhere, threw in this tick.
  void controller_threw(RobotId robot, std::string what);
  /// Ends the run as failed; a first reason stays.
  void fail(std::string why);

  RunState state() const noexcept;
  /// Why the run failed: what, who, which tick. Empty while it did not.
  const std::string& failure() const noexcept;

  hal::Tick tick() const noexcept;
  std::int64_t ticks_per_second() const noexcept;
  std::uint64_t seed() const noexcept;
  std::int64_t threads() const noexcept;
  const Scenario& scenario() const noexcept;
  Space& space() noexcept;
  const Space& space() const noexcept;
  const Incidents& incidents() const noexcept;
  /// How exact its engines were so far.
  PhysicsAccuracy accuracy() const;
  /// What the hooks published.
  const Measures& measures() const noexcept;

  /// Fingerprint of everything that later steps depend on: equal for any number of threads.
  std::uint64_t state_hash() const noexcept;
  /// The same value by value: for `state_values`. Call between steps; what it shows is that of the next step then.
  StateView state_view() const noexcept;

 private:
  void do_requests(bool before_first_step);

  struct Impl;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::core
