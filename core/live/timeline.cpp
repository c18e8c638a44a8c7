#include "core/live/timeline.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/live/source_files.hpp"
#include "core/live/touch.hpp"
#include "hal/json/json_access.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

using hal::Json;

/// A checkpoint is due when the ticks since the last cost so many times as much: all together slow the run by a
/// hundredth.
constexpr hal::TimeNs kCheaper = 100;
/// Whoever goes back a long way keeps a checkpoint so many ticks before, for the next single steps back.
constexpr std::int64_t kNear = 16;
/// How often somebody who waits for ticks that are computed again hears of it.
constexpr hal::TimeNs kSaidEvery_ns = 2 * hal::kNsPerSecond;

bool is_reset(const Json& action) {
  return hal::text_of(action, "do") == "reset";
}

std::string megabytes(std::size_t bytes) {
  return std::to_string((bytes + 999'999) / 1'000'000) + " MB";
}

}  // namespace

Timeline::Timeline(World& world, LiveClock& clock, const LiveOptions& options)
    : world_(world),
      clock_(clock),
      wanted_(options.can_go_back && !options.real_robots),
      memory_bytes_(options.memory_bytes),
      log_(options.log) {
  if (options.real_robots)
    no_way_back_ = "real robots take part, which cannot be put back";
  else if (!wanted_)
    no_way_back_ = "no checkpoints are kept";
  for (const RepeatedAction& action : options.repeat) touches_.push_back({action.step, 0, action.action, {}});
}

void Timeline::start() {
  begin_anew(world_.tick() == 0);
}

/// The way back ends here. `from_start`: a reset comes to the same state.
void Timeline::begin_anew(bool from_start) {
  first_step_ = latest_ = recorded_ = step_;
  base_tick_ = world_.tick();
  first_touch_ = applied_;
  if (applied_ > 0) went_back_ = true;
  checkpoints_.clear();
  bytes_ = 0;
  since_checkpoint_ns_ = 0;
  if (!wanted_) return;
  no_way_back_.clear();
  from_start_ = from_start;
  keep();
  if (!no_checkpoint_.empty() && no_way_back_.empty()) scripts_ = source_files(world_);
}

// --- checkpoints ---

hal::Result<Snapshot> Timeline::take() const {
  hal::Result<Snapshot> snapshot = world_.snapshot_of_all();
  if (!snapshot.ok() || snapshot.value().bytes() <= memory_bytes_) return snapshot;
  return hal::Error{"a checkpoint of this run takes " + megabytes(snapshot.value().bytes()) + ", more than the " +
                    megabytes(memory_bytes_) + " that may be kept; allow more (--view-memory)"};
}

/// Keeps this moment. What cannot be kept now cannot be kept later either.
void Timeline::keep() {
  since_checkpoint_ns_ = 0;
  if (!no_way_back_.empty() || world_.state() == RunState::Failed) return;
  const hal::TimeNs began_ns = clock_.now_ns();
  Checkpoint kept{step_, world_.state_hash(), {}};
  const bool could = no_checkpoint_.empty();
  if (could) {
    hal::Result<Snapshot> snapshot = take();
    if (snapshot.ok())
      kept.snapshot = std::move(snapshot).value();
    else
      no_checkpoint_ = snapshot.error().message;
  }
  if (!kept.snapshot && checkpoints_.empty() && !(from_start_ && world_.can_reset(world_.scenario()).ok())) {
    no_way_back_ = no_checkpoint_;
    return;
  }
  if (could && !kept.snapshot)
    log_.info("going back computes the run again from tick " +
              std::to_string(checkpoints_.empty() ? world_.tick() : tick_of(nearest(step_)->step)) + ": " +
              no_checkpoint_);
  bytes_ += kept.bytes();
  const auto after = std::ranges::upper_bound(checkpoints_, step_, {}, &Checkpoint::step);
  checkpoints_.insert(after, std::move(kept));
  checkpoint_cost_ns_ = clock_.now_ns() - began_ns;
  thin();
}

/// Drops those that are missed least: between the nearest neighbours. The first stays.
void Timeline::thin() {
  while (bytes_ > memory_bytes_ && checkpoints_.size() > 1) {
    std::size_t least = checkpoints_.size() - 1;
    if (checkpoints_.size() > 2) {
      const auto gap = [&](std::size_t i) { return checkpoints_[i + 1].step - checkpoints_[i - 1].step; };
      least = 1;
      for (std::size_t i = 2; i + 1 < checkpoints_.size(); ++i) least = gap(i) < gap(least) ? i : least;
    }
    bytes_ -= checkpoints_[least].bytes();
    checkpoints_.erase(checkpoints_.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

/// From which one can go on to that step.
const Timeline::Checkpoint* Timeline::nearest(std::int64_t step) const noexcept {
  const Checkpoint* found = nullptr;
  for (const Checkpoint& c : checkpoints_) {
    if (c.step <= step && (c.snapshot || &c == &checkpoints_.front())) found = &c;
  }
  return found;
}

hal::Tick Timeline::ticks_to(hal::Tick tick) const noexcept {
  const Checkpoint* const from = nearest(step_of(tick));
  return from == nullptr ? 0 : step_of(tick) - from->step;
}

// --- stepping ---

hal::Status Timeline::before_step() {
  hal::Status done = apply_due();
  if (done.ok() && !known()) tell();
  tick_before_ = world_.tick();
  return done;
}

bool Timeline::after_step(hal::TimeNs cost_ns) {
  const bool is_new = !known();
  ++step_;
  step_cost_ns_ = step_cost_ns_ == 0 ? cost_ns : (7 * step_cost_ns_ + cost_ns) / 8;
  if (world_.tick() != tick_before_ + 1) {  // a hook went back, or began anew
    begin_anew(false);
    return is_new;
  }
  if (!is_new) {
    compare();
    (void)apply_due();  // they could be done before
    return false;
  }
  recorded_ = step_;
  latest_ = std::max(latest_, step_);
  since_checkpoint_ns_ += cost_ns;
  if (wanted_ && since_checkpoint_ns_ >= kCheaper * checkpoint_cost_ns_) keep();
  return true;
}

/// Touches of this step that are not done yet.
hal::Status Timeline::apply_due() {
  while (applied_ < touches_.size() && touches_[applied_].step <= step_) {
    Touch& next = touches_[applied_];
    next.tick = world_.tick();
    const hal::Result<Json> done = perform(next.action);
    if (!done.ok()) {
      return hal::Error{"the action " + hal::to_text(next.action) + " could not be repeated at tick " +
                        std::to_string(next.tick) + ": " + done.error().message};
    }
    ++applied_;
    if (is_reset(next.action)) begin_anew(world_.all_anew());
  }
  return {};
}

/// Whether a tick that was computed again came out as before.
void Timeline::compare() {
  if (warned_) return;
  const auto known = std::ranges::lower_bound(checkpoints_, step_, {}, &Checkpoint::step);
  if (known == checkpoints_.end() || known->step != step_ || known->fingerprint == world_.state_hash()) return;
  warned_ = true;
  log_.warning("tick " + std::to_string(world_.tick()) +
               " came out different when it was computed again: a hook or a controller depends on something that "
               "going back does not put back (a hook's members that Hook::save leaves out, a file, a clock)");
}

// --- actions ---

hal::Result<Json> Timeline::perform(Json& action) {
  if (!is_reset(action)) return touch(world_, action);
  const auto seed = action.find("seed");
  if (seed == action.end() || seed->is_null()) action["seed"] = world_.seed();
  if (!action["seed"].is_number_integer() || action["seed"].get<std::int64_t>() < 0)
    return hal::Error{"\"seed\" is a whole number from 0 on"};
  const auto wanted = action["seed"].get<std::uint64_t>();
  if (const hal::Status begun = world_.reset(wanted); !begun.ok()) return begun.error();
  return Json{{"seed", wanted}};
}

/// Takes out what comes after this step; null: nothing does.
std::unique_ptr<Timeline::Way> Timeline::way_ahead() {
  if (latest_ == step_ && touches_.size() == applied_) return nullptr;
  auto way = std::make_unique<Way>(Way{{}, latest_, recorded_, told_, went_back_, tellings_});
  const auto next = touches_.begin() + static_cast<std::ptrdiff_t>(applied_);
  way->touches.assign(std::make_move_iterator(next), std::make_move_iterator(touches_.end()));
  return way;
}

/// Makes it the way ahead again. The record still has it, unless another one was told meanwhile.
void Timeline::bring_back(Way& way) {
  touches_.insert(touches_.end(), std::make_move_iterator(way.touches.begin()),
                  std::make_move_iterator(way.touches.end()));
  latest_ = way.latest;
  if (tellings_ != way.tellings) return;
  recorded_ = way.recorded;
  told_ = way.told;
  went_back_ = way.went_back;
}

/// From this step on the run takes another way, with so many of the touches.
void Timeline::drop_after(std::size_t touches, std::int64_t step) {
  if (recorded_ > step || told_ > touches) went_back_ = true;
  latest_ = recorded_ = step;
  touches_.resize(touches);
  told_ = std::min(told_, touches);
  while (!checkpoints_.empty() && checkpoints_.back().step > step) {
    bytes_ -= checkpoints_.back().bytes();
    checkpoints_.pop_back();
  }
}

hal::Result<Json> Timeline::act(Json action) {
  const hal::Tick tick = world_.tick();
  hal::Result<Json> done = perform(action);
  if (!done.ok()) return done;
  std::unique_ptr<Way> left = way_ahead();
  drop_after(applied_, step_);
  if (left != nullptr && !left->touches.empty()) done.value()["dropped"] = left->touches.size();
  if (left != nullptr && left->latest > step_) done.value()["dropped_ticks"] = left->latest - step_;
  const bool goes_on = left == nullptr && applied_ > std::max(told_, first_touch_) && touches_.back().step == step_ &&
                       continues(touches_.back().action, action);
  const bool reset = is_reset(action);
  if (goes_on)
    touches_.back().action = std::move(action);
  else
    touches_.push_back({step_, tick, std::move(action), std::move(left)});
  applied_ = touches_.size();
  if (reset) begin_anew(world_.all_anew());
  return done;
}

void Timeline::note(const Json& action) {
  if (on_event) on_event(world_.tick(), {{"kind", "action"}, {"action", action}, {"repeatable", false}});
}

void Timeline::tell() {
  ++tellings_;
  if (std::exchange(went_back_, false)) {
    // Whoever reads of it forgets all from this tick on: what was done at it is told again.
    told_ = first_touch_;
    while (told_ < applied_ && touches_[told_].step < step_) ++told_;
    Json before = Json::array();
    for (std::size_t i = 0; i < told_; ++i)
      before.push_back({{"step", touches_[i].step}, {"action", touches_[i].action}});
    if (on_event) on_event(world_.tick(), {{"kind", "back"}, {"to", world_.tick()}, {"before", std::move(before)}});
  }
  for (; told_ < applied_; ++told_) {
    const Touch& t = touches_[told_];
    Json event{{"kind", "action"}, {"action", t.action}};
    if (t.step != t.tick) event["step"] = t.step;
    if (on_event) on_event(t.tick, event);
  }
}

// --- going back ---

/// One step again, as it was done before.
hal::Status Timeline::again() {
  const hal::Tick before = world_.tick();
  world_.step();
  ++step_;
  if (world_.tick() != before + 1) {
    return hal::Error{"the run took another way when tick " + std::to_string(before) +
                      " was computed again: a hook or a controller depends on something that going back does not put "
                      "back"};
  }
  compare();
  return apply_due();
}

hal::Status Timeline::go_back_to(const Checkpoint& from) {
  step_ = from.step;
  applied_ = first_touch_;
  while (applied_ < touches_.size() && touches_[applied_].step < step_) ++applied_;
  if (from.snapshot) {
    if (hal::Status back = world_.restore(Snapshot(*from.snapshot)); !back.ok()) return back;
    return apply_due();
  }
  if (hal::Status begun = world_.reset(world_.seed(), &world_.scenario()); !begun.ok()) return begun;
  for (RepeatedAction& reload : reloads_to(scripts_, world_)) {  // whose files are others by now
    if (const hal::Result<Json> done = touch(world_, reload.action); !done.ok()) return done.error();
  }
  return apply_due();
}

hal::Status Timeline::way_to(std::int64_t step, bool from_checkpoint) {
  if (!no_way_back_.empty()) return hal::Error{"there is no way back: " + no_way_back_};
  const Checkpoint* const from = nearest(step);
  if (from == nullptr) return hal::Error{"there is no checkpoint before that tick"};
  world_.set_log({});  // it was said before
  hal::Status done;
  if (from_checkpoint || step < step_ || (from->snapshot && from->step > step_)) done = go_back_to(*from);
  const bool far = step - step_ > 4 * kNear && no_checkpoint_.empty();
  hal::TimeNs said_ns = clock_.now_ns();
  while (done.ok() && step_ < step) {
    if (far && step - step_ == kNear && (applied_ == first_touch_ || touches_[applied_ - 1].step < step_)) keep();
    done = again();
    if (!done.ok() || clock_.now_ns() - said_ns < kSaidEvery_ns) continue;
    said_ns = clock_.now_ns();
    log_.info("computing again: tick " + std::to_string(world_.tick()) + " of " + std::to_string(tick_of(step)));
    if (on_way && !on_way()) done = hal::Error{"the way to tick " + std::to_string(tick_of(step)) + " was left"};
  }
  world_.set_log(log_);
  return done;
}

hal::Status Timeline::go_to(hal::Tick tick) {
  if (!no_way_back_.empty()) return hal::Error{"there is no way back: " + no_way_back_};
  if (tick < first_tick() || tick > latest_tick()) {
    return hal::Error{"tick " + std::to_string(tick) + " cannot be gone to: it lies not between " +
                      std::to_string(first_tick()) + ", the first, and " + std::to_string(latest_tick()) +
                      ", the latest"};
  }
  return way_to(std::min(step_of(tick), recorded_), false);
}

hal::Result<Json> Timeline::undo() {
  if (!no_way_back_.empty()) return hal::Error{"nothing can be undone: there is no way back: " + no_way_back_};
  if (applied_ <= first_touch_)
    return hal::Error{"there is nothing to undo before tick " + std::to_string(world_.tick())};
  const Touch last = std::move(touches_[applied_ - 1]);
  drop_after(applied_ - 1, last.step);
  if (last.left != nullptr) bring_back(*last.left);
  const hal::Status there = way_to(last.step, true);
  if (!there.ok()) return there.error();
  return Json{{"tick", world_.tick()}, {"undone", last.action}};
}

hal::Status Timeline::look_back(hal::Tick from, hal::Tick to, const std::function<void(hal::Tick)>& look) {
  if (from < first_tick() || to > latest_tick() || from > to) {
    return hal::Error{"ticks " + std::to_string(from) + " to " + std::to_string(to) + " cannot be had: there are " +
                      std::to_string(first_tick()) + " to " + std::to_string(latest_tick())};
  }
  const hal::Result<Snapshot> now = no_checkpoint_.empty() ? take() : hal::Error{no_checkpoint_};
  const std::int64_t step = step_;
  const std::size_t applied = applied_;
  hal::Status done = way_to(step_of(from), true);
  world_.set_log({});
  while (done.ok()) {
    look(world_.tick());
    if (world_.tick() >= to) break;
    done = again();
  }
  world_.set_log(log_);
  const hal::Status here = now.ok() ? world_.restore(now.value()) : way_to(step, true);
  if (now.ok()) {
    step_ = step;
    applied_ = applied;
  }
  return done.ok() ? here : done;
}

}  // namespace tandem::core
