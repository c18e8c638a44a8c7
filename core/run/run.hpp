// A run: what is stepped, a world as a rule, and the parts that have joined it.
//
//   core::Run run(world, stop);
//   run.add(std::make_unique<core::Length>(300));       ends it
//   run.add(std::make_unique<MyPart>());                writes, shows, paces, drives real robots
//   run.go();
//
// What is not the world is a part: records, pictures, the window, the terminal's table, replay, real robots. Their
// turns in a tick are those of `RunTurn`, whatever order they were added in; README.md has the table. Who has a loop
// of their own call `begin`, `tick` and `end` instead of `go`.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"
#include "hal/time.hpp"

namespace tandem::core {

class Run;

/// What a run steps: a world, or the controller of one real robot.
class Stepped {
 public:
  virtual ~Stepped() = default;
  virtual void start() {}
  /// One tick. False: it was given up, and no other may follow.
  virtual bool step() = 0;
  virtual void finish() {}
  /// So many were done.
  virtual hal::Tick tick() const = 0;
  /// False: it has failed, or come to an end of its own.
  virtual bool running() const = 0;
};

/// When a part has its turn, before a tick and after it. Parts of one turn have theirs in the order in which they were
/// added. At the end the order is reversed: robots stop before anything is written.
enum class RunTurn : std::uint8_t {
  Length,   ///< how long the run is
  Hold,     ///< people who pause it, or go back; says whether a tick is new
  Outputs,  ///< records, pictures, dumps, the report
  Tell,     ///< progress or a table on the terminal
  Compare,  ///< with the run that is replayed or repeated
  Desk,     ///< commands of people to real robots
  View,     ///< the window
  Added,    ///< parts of plug-ins
  Pace      ///< real robots, real time: what waits for the next tick
};

/// Joins a run. All calls come from the thread that steps. What a part throws, or returns as an error, ends the
/// run before its next tick, as a failure that names the part; all parts finish, also that one.
class RunPart {
 public:
  RunPart() noexcept;
  virtual ~RunPart() = default;
  /// For people: "record", "ros2".
  virtual std::string_view name() const = 0;
  virtual RunTurn turn() const = 0;

  /// Before the world starts. Error: the run does not begin.
  virtual hal::Status join(Run& /*run*/) { return {}; }
  /// Before every tick; may wait. False: no further tick comes.
  virtual bool before_tick(Run& /*run*/) { return true; }
  /// After every tick. False: this tick was done before, and is nothing new for the parts whose turn is later.
  virtual bool after_tick(Run& /*run*/) { return true; }
  /// An action of a person on the run after `tick` ticks, as records keep it ({"kind": …}).
  virtual void event(hal::Tick /*tick*/, const hal::Json& /*event*/) {}
  /// After the last tick and before the hooks' after_run; also where another part could not join. What it drives is to
  /// stand still when this returns.
  virtual hal::Status finish(Run& /*run*/) { return {}; }
  /// When all have finished: writes what the run was for, and lets go of what it holds.
  virtual hal::Status close(Run& /*run*/) { return {}; }
};

/// Goes once. Belongs to one thread.
class Run {
 public:
  /// `stop` ends it before the next tick. Both must outlive this.
  Run(World& world, const std::atomic<bool>& stop);
  /// Of something that is no world.
  Run(Stepped& stepped, const std::atomic<bool>& stop) : stepped_(&stepped), stop_(stop) {}
  /// Parts that were added last go first.
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  /// @throws std::logic_error where this steps something else
  World& world() const;
  /// Ticks that were done.
  hal::Tick tick_count() const { return stepped_->tick(); }
  /// Whether what is stepped goes on.
  bool running() const { return stepped_->running(); }
  const std::atomic<bool>& stop() const noexcept { return stop_; }
  bool stopped() const noexcept { return stop_.load(std::memory_order_relaxed); }
  /// Before it begins; may be null.
  void add(std::unique_ptr<RunPart> part);

  /// All of it: begins, ticks until a part ends it, ends. @returns whether it went: false, where a part could not join,
  /// and nothing was stepped.
  bool go();
  /// Joins the parts, starts the world. False: a part could not join; all have finished, and nothing else may follow.
  bool begin() {
    if (!join()) return false;
    stepped_->start();
    return true;
  }
  /// One tick, with the parts' turns before and after it. False: no further one comes.
  bool tick() {
    if (!before_tick() || !stepped_->step()) return false;
    after_tick();
    return true;
  }
  /// The parts finish, the world's hooks have their after_run, the parts close.
  void end();

  /// Of `begin` what is not the world's, for a world that was started, as `World::reset` does.
  bool join();
  /// Of `end` what is not the world's, for a world that goes on without this.
  void leave();

  /// To all parts, in the order of their turns.
  void tell(hal::Tick tick, const hal::Json& event);
  /// The run has failed, and goes on; the first failure is reported at the end.
  void fail(const std::string& why);
  /// Why the run has failed besides the world's own failure; empty: it has not.
  const std::string& failure() const noexcept { return failure_; }
  /// The part that wanted no further tick; null: none yet.
  const RunPart* ended_by() const noexcept { return ended_by_; }
  /// The names of the parts in the order of their turns.
  std::vector<std::string_view> order() const;

 private:
  struct Row {
    RunPart* part;
    bool joined = false, failed = false;
  };
  bool before_tick();
  void after_tick();
  template <class Call>
  bool in_order(std::string_view when, Call&& call);
  template <class Call>
  void in_reverse(std::string_view when, Call&& call);
  template <class Call>
  bool asked(Row& row, std::string_view when, Call&& call);

  World* world_ = nullptr;
  std::unique_ptr<Stepped> world_steps_;
  Stepped* stepped_;
  const std::atomic<bool>& stop_;
  std::vector<std::unique_ptr<RunPart>> parts_;  // as they were added
  std::vector<Row> rows_;                        // by turn
  bool broken_ = false;                          // a part has failed
  const RunPart* ended_by_ = nullptr;
  std::string failure_;
};

/// Runs as a surface of their own: what plug-ins with parts must have been built against.
struct RunSurface {
  static constexpr std::string_view kCategory = "run";
  using Crosses = hal::Layouts<Run, RunPart, RunTurn, World, hal::Json>;
};

inline RunPart::RunPart() noexcept {
  hal::detail::note_surface<RunSurface>();
}

/// Ends a run after so many ticks (0: not by their number), when a hook ends it or it fails, and when it is stopped.
class Length final : public RunPart {
 public:
  explicit Length(std::int64_t ticks) noexcept : ticks_(ticks) {}
  std::string_view name() const override { return "length"; }
  RunTurn turn() const override { return RunTurn::Length; }
  bool before_tick(Run& run) override;

 private:
  std::int64_t ticks_;
};

}  // namespace tandem::core
