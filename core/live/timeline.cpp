#include "core/live/timeline.hpp"

#include <algorithm>
#include <utility>

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
  for (const RepeatedAction& action : options.repeat) touches_.push_back({action.step, 0, action.action});
}

void Timeline::start() {
  base_tick_ = world_.tick();
  begin_anew();
}

/// The way back ends here.
void Timeline::begin_anew() {
  first_step_ = latest_ = step_;
  base_tick_ = world_.tick();
  first_touch_ = applied_;
  if (applied_ > 0) went_back_ = true;
  checkpoints_.clear();
  bytes_ = 0;
  since_checkpoint_ns_ = 0;
  if (wanted_) keep();
}

// --- checkpoints ---

/// Keeps this moment. What cannot be kept now cannot be kept later either.
bool Timeline::keep() {
  since_checkpoint_ns_ = 0;
  if (!no_way_back_.empty() || world_.state() == RunState::Failed) return false;
  const hal::TimeNs began_ns = clock_.now_ns();
  hal::Result<Snapshot> snapshot = world_.snapshot_of_all();
  if (!snapshot.ok()) {
    no_way_back_ = snapshot.error().message;
  } else if (snapshot.value().bytes() > memory_bytes_) {
    no_way_back_ = "a checkpoint of this run takes " + megabytes(snapshot.value().bytes()) + ", more than the " +
                   megabytes(memory_bytes_) + " that may be kept; allow more (--view-memory)";
  }
  if (!no_way_back_.empty()) {
    checkpoints_.clear();
    bytes_ = 0;
    return false;
  }
  bytes_ += snapshot.value().bytes();
  const auto after =
      std::find_if(checkpoints_.begin(), checkpoints_.end(), [&](const Checkpoint& c) { return c.step > step_; });
  checkpoints_.insert(after, {step_, world_.state_hash(), std::move(snapshot).value()});
  checkpoint_cost_ns_ = clock_.now_ns() - began_ns;
  thin();
  return true;
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
    bytes_ -= checkpoints_[least].snapshot.bytes();
    checkpoints_.erase(checkpoints_.begin() + static_cast<std::ptrdiff_t>(least));
  }
}

const Timeline::Checkpoint* Timeline::nearest(std::int64_t step) const noexcept {
  const Checkpoint* found = nullptr;
  for (const Checkpoint& c : checkpoints_) {
    if (c.step <= step) found = &c;
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
    begin_anew();
    return is_new;
  }
  if (!is_new) {
    compare();
    (void)apply_due();  // they could be done before
    return false;
  }
  latest_ = step_;
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
    if (is_reset(next.action)) begin_anew();
  }
  return {};
}

/// Whether a tick that was computed again came out as before.
void Timeline::compare() {
  if (warned_) return;
  for (const Checkpoint& c : checkpoints_) {
    if (c.step != step_ || c.fingerprint == world_.state_hash()) continue;
    warned_ = true;
    log_.warning("tick " + std::to_string(world_.tick()) +
                 " came out different when it was computed again: a hook or a controller depends on something that "
                 "going back does not put back (a hook's members that Hook::save leaves out, a file, a clock)");
  }
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

/// From this step on the run takes another way, with so many of the touches.
void Timeline::drop_after(std::size_t touches, std::int64_t step) {
  if (latest_ > step || told_ > touches) went_back_ = true;
  latest_ = step;
  touches_.resize(touches);
  told_ = std::min(told_, touches);
  while (!checkpoints_.empty() && checkpoints_.back().step > step) {
    bytes_ -= checkpoints_.back().snapshot.bytes();
    checkpoints_.pop_back();
  }
}

hal::Result<Json> Timeline::act(Json action) {
  const hal::Tick tick = world_.tick();
  hal::Result<Json> done = perform(action);
  if (!done.ok()) return done;
  const std::size_t dropped = touches_.size() - applied_;
  drop_after(applied_, step_);
  if (dropped > 0) done.value()["dropped"] = dropped;
  const bool goes_on = applied_ > std::max(told_, first_touch_) && touches_.back().step == step_ &&
                       continues(touches_.back().action, action);
  const bool reset = is_reset(action);
  if (goes_on)
    touches_.back().action = std::move(action);
  else
    touches_.push_back({step_, tick, std::move(action)});
  applied_ = touches_.size();
  if (reset) begin_anew();
  return done;
}

void Timeline::note(const Json& action) {
  if (on_event) on_event(world_.tick(), {{"kind", "action"}, {"action", action}, {"repeatable", false}});
}

void Timeline::tell() {
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

hal::Status Timeline::way_to(std::int64_t step, bool from_checkpoint) {
  if (!no_way_back_.empty()) return hal::Error{"there is no way back: " + no_way_back_};
  const Checkpoint* const from = nearest(step);
  if (from == nullptr) return hal::Error{"there is no checkpoint before that tick"};
  world_.set_log({});  // it was said before
  hal::Status done;
  if (from_checkpoint || step < step_ || from->step > step_) {
    const std::int64_t start = from->step;
    done = world_.restore(Snapshot(from->snapshot));
    step_ = start;
    applied_ = first_touch_;
    while (applied_ < touches_.size() && touches_[applied_].step < step_) ++applied_;
    if (done.ok()) done = apply_due();
  }
  const bool far = step - step_ > 4 * kNear;
  while (done.ok() && step_ < step) {
    if (far && step - step_ == kNear && (applied_ == first_touch_ || touches_[applied_ - 1].step < step_)) keep();
    done = again();
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
  return way_to(step_of(tick), false);
}

hal::Result<Json> Timeline::undo() {
  if (!no_way_back_.empty()) return hal::Error{"nothing can be undone: there is no way back: " + no_way_back_};
  if (applied_ <= first_touch_)
    return hal::Error{"there is nothing to undo before tick " + std::to_string(world_.tick())};
  const Touch last = touches_[applied_ - 1];
  drop_after(applied_ - 1, last.step);
  const hal::Status there = way_to(last.step, true);
  if (!there.ok()) return there.error();
  return Json{{"tick", world_.tick()}, {"undone", last.action}};
}

hal::Status Timeline::look_back(hal::Tick from, hal::Tick to, const std::function<void(hal::Tick)>& look) {
  if (from < first_tick() || to > latest_tick() || from > to) {
    return hal::Error{"ticks " + std::to_string(from) + " to " + std::to_string(to) + " cannot be had: there are " +
                      std::to_string(first_tick()) + " to " + std::to_string(latest_tick())};
  }
  hal::Result<Snapshot> now = world_.snapshot_of_all();
  if (!now.ok()) return now.error();
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
  const hal::Status here = world_.restore(now.value());
  step_ = step;
  applied_ = applied;
  return done.ok() ? here : done;
}

}  // namespace tandem::core
