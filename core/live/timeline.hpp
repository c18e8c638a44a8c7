// The way that a simulated run has taken: checkpoints to go back to, and touches by step.
//
//   step      0 . . . . | . . . . | . . . . | . . 14          | checkpoints, dropped where memory is wanted
//   touches             ^a        ^b  ^c
//
//   go to 9:  restores the checkpoint at 5, touches with a, steps to 9. Going on from there is the same again: b and c
//             come at their steps, and nothing of it is recorded twice. Whoever touches at 9 makes it another run: what
//             was after 9 is dropped. Undoing that touch brings it back: b, c and all ticks up to 14.
//
// Where no checkpoint can be kept (a controller that cannot be copied, no memory for one), the first stands for the
// start of the run: it is restarted and computed again from there, and the fingerprints of later ones say whether it
// is the same.
//
// Steps are counted from the start of the run. They are its ticks, until a hook goes back to a checkpoint of its own,
// or anybody resets the run: ticks fall then, steps do not, and the way back ends there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/live/clock.hpp"
#include "core/live/live_run.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"

namespace tandem::core {

class Timeline {
 public:
  /// The world and the clock must outlive this.
  Timeline(World& world, LiveClock& clock, const LiveOptions& options);

  /// After World::start: keeps the first checkpoint.
  void start();
  /// Why one cannot go back; empty: one can.
  const std::string& no_way_back() const noexcept { return no_way_back_; }
  /// Why going back may compute all again; empty: it need not.
  const std::string& no_checkpoint() const noexcept { return no_checkpoint_; }

  hal::Tick first_tick() const noexcept { return checkpoints_.empty() ? world_.tick() : base_tick_; }
  hal::Tick latest_tick() const noexcept { return tick_of(latest_); }
  /// Up to where the run is recorded. Below `latest_tick` after an undo that brought ticks back which the record had
  /// dropped: these are recorded again when they are stepped.
  hal::Tick recorded_tick() const noexcept { return tick_of(recorded_); }
  /// Whether the next step was done before, and is recorded.
  bool known() const noexcept { return step_ < recorded_; }

  /// Before World::step: does what is to be repeated now, and tells what is new. Error: it could not be done.
  hal::Status before_step();
  /// After World::step, which took `cost_ns`. @returns whether it was new.
  bool after_step(hal::TimeNs cost_ns);

  /// Carries out an action of a person (core/live/touch.hpp, or {"do": "reset", "seed"}), now. @returns members for the
  /// answer; "dropped" and "dropped_ticks": how many later touches and ticks do not count any more. Error: nothing was
  /// done, or the run has failed.
  hal::Result<hal::Json> act(hal::Json action);
  /// Tells at once of an action that cannot be repeated.
  void note(const hal::Json& action);
  /// To that tick, or to `recorded_tick` where that is earlier: the rest is to be stepped. Errors: no way back; not
  /// between the first tick and the latest.
  hal::Status go_to(hal::Tick tick);
  /// To just before the last touch, which is dropped with all that came after it; what the touch itself had dropped is
  /// there again. @returns that touch.
  hal::Result<hal::Json> undo();
  /// Computes the ticks from `from` to `to` again, calls `look` at each, and comes back to where it was. Errors: as
  /// `go_to`.
  hal::Status look_back(hal::Tick from, hal::Tick to, const std::function<void(hal::Tick)>& look);
  /// How many ticks are computed again to get from the nearest checkpoint to that tick.
  hal::Tick ticks_to(hal::Tick tick) const noexcept;
  /// How many by `look_back`.
  hal::Tick ticks_of_look(hal::Tick from, hal::Tick to) const noexcept {
    return ticks_to(from) + to - from + (no_checkpoint_.empty() ? 0 : ticks_to(world_.tick()));
  }
  /// What a tick costs, of late.
  hal::TimeNs step_cost_ns() const noexcept { return step_cost_ns_; }

  /// Tells what happened since the last call and is not told yet. `before_step` does so before a new step.
  void tell();
  std::function<void(hal::Tick tick, const hal::Json& event)> on_event;
  /// Called every two seconds while one waits for ticks that are computed again. False: they are not to be; the run
  /// stays where it is.
  std::function<bool()> on_way;

  std::size_t checkpoints() const noexcept { return checkpoints_.size(); }
  std::size_t bytes() const noexcept { return bytes_; }

 private:
  struct Way;
  struct Touch {
    std::int64_t step = 0;
    hal::Tick tick = 0;
    hal::Json action;
    std::unique_ptr<Way> left = {};  // for this touch; null: nothing came after it
  };
  /// What came after a step, and what was told of it.
  struct Way {
    std::vector<Touch> touches;
    std::int64_t latest = 0, recorded = 0;
    std::size_t told = 0;
    bool went_back = false;
    std::uint64_t tellings = 0;
  };
  struct Checkpoint {
    std::int64_t step = 0;
    std::uint64_t fingerprint = 0;
    std::optional<Snapshot> snapshot;  // none: it is computed again, and compared
    std::size_t bytes() const noexcept { return snapshot ? snapshot->bytes() : 0; }
  };

  hal::Result<Snapshot> take() const;
  void keep();
  void thin();
  void begin_anew(bool from_start);
  hal::Status go_back_to(const Checkpoint& from);
  std::unique_ptr<Way> way_ahead();
  void drop_after(std::size_t touches, std::int64_t step);
  void bring_back(Way& way);
  hal::Result<hal::Json> perform(hal::Json& action);
  hal::Status apply_due();
  hal::Status way_to(std::int64_t step, bool from_checkpoint);
  hal::Status again();
  void compare();
  const Checkpoint* nearest(std::int64_t step) const noexcept;
  std::int64_t step_of(hal::Tick tick) const noexcept { return first_step_ + (tick - base_tick_); }
  hal::Tick tick_of(std::int64_t step) const noexcept { return base_tick_ + (step - first_step_); }

  World& world_;
  LiveClock& clock_;
  bool wanted_;
  std::size_t memory_bytes_;
  hal::Log log_;
  std::string no_way_back_, no_checkpoint_;

  std::int64_t step_ = 0, latest_ = 0;  // where the run is, and where it has been
  std::int64_t recorded_ = 0;           // at most `latest_`
  std::int64_t first_step_ = 0;         // from where on ticks and steps go side by side
  hal::Tick base_tick_ = 0;             // of that step
  hal::Tick tick_before_ = 0;
  std::vector<Checkpoint> checkpoints_;  // by step
  bool from_start_ = false;              // the first of them: nothing happened before it, and a reset comes there
  hal::Json scripts_;                    // that controllers ran there
  std::size_t bytes_ = 0;
  hal::TimeNs checkpoint_cost_ns_ = 0, since_checkpoint_ns_ = 0, step_cost_ns_ = 0;

  std::vector<Touch> touches_;   // done, or to be done again
  std::size_t applied_ = 0;      // of these, up to this moment
  std::size_t first_touch_ = 0;  // that can be undone
  std::size_t told_ = 0;
  std::uint64_t tellings_ = 0;
  bool went_back_ = false;  // to be told
  bool warned_ = false;
};

}  // namespace tandem::core
