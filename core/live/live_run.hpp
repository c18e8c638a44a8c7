// One live run: the door between its viewers and the thread that steps it.
//
//   while (live.before_step()) {       carries out commands, waits while the run is paused or ahead of its speed
//     world.step();
//     if (live.after_step()) record(); conditions, checkpoints; false: this tick was done before, and is recorded
//   }
//
// In a purely simulated run, one can go back to any tick: the nearest checkpoint before it is restored, and the ticks
// from there are computed again, with what was touched at its tick (core/live/timeline.hpp). What is done again is not
// recorded again. With real robots there is no way back, and only whoever steps them can pause: `after_step` alone is
// called, within the tick's time, and carries out commands; `look` does while they stand.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/live/clock.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// {"ok": true, …} or {"ok": false, "error": "what, where, what to do"}.
using LiveReply = std::function<void(const hal::Json& answer)>;
/// Carries out a command. @returns what goes into the answer.
using LiveCommand = std::function<hal::Result<hal::Json>(const hal::Json& arguments)>;

/// An action that is to be done again: at the step before which it was done.
struct RepeatedAction {
  std::int64_t step = 0;  ///< steps done before it
  hal::Json action;
};

struct LiveOptions {
  std::int64_t ticks = 0;       ///< of the run; 0: no end of its own
  bool paused = false;          ///< at the start
  std::optional<double> speed;  ///< times real time, at the start; none: as fast as possible
  bool real_robots = false;     ///< take part: no way back, and a pause by `pause_real` alone
  std::function<hal::Status(bool paused)> pause_real = {};  ///< pauses a run with real robots, or has it go on
  bool stay = false;                       ///< when the run has ended, waits for commands until it is stopped
  bool can_go_back = true;                 ///< keeps checkpoints
  std::size_t memory_bytes = 500'000'000;  ///< of all checkpoints
  std::vector<RepeatedAction> repeat = {};
  hal::Log log = {};                        ///< of the world, which has it back after ticks that are done again
  LiveClock* clock = nullptr;               ///< null: the system's
  const std::atomic<bool>* stop = nullptr;  ///< ends the run, too
};

/// A viewer's view of a run.
struct LiveState {
  bool paused = false;
  std::optional<double> speed;  ///< that is asked for
  double reached = 0.0;         ///< times real time, of late
  hal::Tick tick = 0;           ///< ticks done
  hal::Tick latest = 0;         ///< that can be gone to
  hal::Tick first = 0;          ///< the same; `latest` where there is no way back
  std::string ended;            ///< why; empty: it goes on
  std::string stopped_by;       ///< the condition that has paused it
  std::string no_way_back;      ///< why; empty: there is one
  std::uint64_t seed = 0;
  std::uint64_t changes = 0;  ///< rises with every change of anything but the ticks
};
/// As the message "state" of the protocol, without its type.
hal::Json to_json(const LiveState& state);

/// What people watch and command while it goes on: a run, or the record of one.
class Watched {
 public:
  virtual ~Watched() = default;
  /// Has a command {"do": name, …} carried out between two ticks; on any thread. `reply` is called at most once: by the
  /// thread that steps, or at once where the command is refused.
  virtual void post(hal::Json command, LiveReply reply) = 0;
  /// On any thread.
  virtual LiveState state() const = 0;
  /// Adds a command, or replaces one; before it begins.
  virtual void add_command(std::string name, LiveCommand command) = 0;
};

class LiveRun final : public Watched {
 public:
  /// The world must outlive this.
  LiveRun(World& world, LiveOptions options);
  ~LiveRun() override;
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  // --- on any thread ---
  /// `reply` is called exactly once: at once where the queue is full or the run is over.
  void post(hal::Json command, LiveReply reply) override;
  /// Has a function of this program called as a command is, at the latest by `close`; no command can name it.
  void post_own(std::function<void()> call);
  /// Ends the run before its next step, and any waiting.
  void stop();
  LiveState state() const override;

  // --- on the thread that steps ---
  /// After World::start: the first checkpoint.
  void start();
  /// Carries out what was posted; waits while the run is paused, ahead of its speed, or over and to stay. @returns
  /// whether to step: else the run ends.
  bool before_step();
  /// @returns whether the tick is new.
  bool after_step();
  /// Carries out what was posted, while a run with real robots is paused.
  void look();
  /// What is posted from now on is refused. The destructor does it, too.
  void close();

  void add_command(std::string name, LiveCommand command) override;
  /// Called whenever something is to be shown that no new tick shows: after a touch, a tick that is done again, a way
  /// back; and once when the run comes to rest.
  void on_show(std::function<void()> show);
  /// Called for what belongs into a record, just before the next new tick; `tick` are done then:
  ///   {"kind": "action", "action": {…}, "step": where steps are not ticks any more}
  ///   {"kind": "back", "to": tick, "before": [{"step", "action"}, …]}: the run goes on from there, after these actions
  ///   alone; what was told of this tick and later ones does not count
  /// With real robots an action has "repeatable": false.
  void on_event(std::function<void(hal::Tick tick, const hal::Json& event)> tell);
  /// Why an action of `LiveOptions::repeat` could not be done again: the run ends then. Empty: all could.
  const std::string& failure() const noexcept;
  /// Ticks that began later than the speed wanted.
  std::uint64_t deadline_misses() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::core
