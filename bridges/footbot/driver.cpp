#include "bridges/footbot/driver.hpp"

#include <algorithm>

#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::footbot {
namespace {

namespace spec = hal::footbot;

constexpr hal::TimeNs kSayAgain = 50 * hal::kNsPerMs;  // a stop that is not confirmed
constexpr hal::TimeNs kLeastSuspect = 250 * hal::kNsPerMs;
constexpr hal::TimeNs kSpare = 8 * hal::kNsPerMs;  // between the last answer and the tick that uses it

/// The lines of the nodes, with the robot's name before them.
hal::Log named(const hal::Log& log, const std::string& id) {
  return hal::Log([log, who = "foot-bot '" + id + "': "](hal::Severity severity, std::string_view text) {
    const std::string line = who + std::string(text);
    if (severity == hal::Severity::Info) return log.info(line);
    if (severity == hal::Severity::Warning) return log.warning(line);
    log.error(line);
  });
}

}  // namespace

const char* state_name(RobotState state) noexcept {
  switch (state) {
    case RobotState::Absent:
      return "absent";
    case RobotState::Searching:
      return "searching";
    case RobotState::Ready:
      return "ready";
    case RobotState::Active:
      return "active";
    case RobotState::Suspect:
      return "suspect";
    case RobotState::Lost:
      return "lost";
  }
  return "";
}

FootbotDriver::FootbotDriver(DriverSettings settings, aseba::MessageLink& link, hal::Log log)
    : settings_(std::move(settings)),
      log_(std::move(log)),
      robot_(settings_.robot, settings_.map),
      network_(link, settings_.timing, named(log_, settings_.robot.id)),
      wiring_(settings_.map, network_, robot_, settings_.observe) {
  settings_.robot.tick_ns = std::max<hal::TimeNs>(settings_.robot.tick_ns, 1);
  if (settings_.suspect_ns <= 0) {
    settings_.suspect_ns = std::max(kLeastSuspect, settings_.robot.tick_ns * 5 / 2);
  }
}

void FootbotDriver::latch(hal::Tick tick, hal::TimeNs now) noexcept {
  latched_ns_ = now;
  wiring_.fill(now);
  robot_.complete(tick);
}

// --- what the robot's state is ---

RobotState FootbotDriver::judge(hal::TimeNs now) const noexcept {
  if (network_.carrier() != aseba::Carrier::Up) {
    if (was_active_) return RobotState::Lost;
    return state_ == RobotState::Absent ? RobotState::Absent : RobotState::Searching;
  }
  if (!wiring_.complete()) {
    if (!was_active_) return RobotState::Searching;
    return wiring_.lost_needed() ? RobotState::Lost : RobotState::Suspect;
  }
  const hal::TimeNs oldest = wiring_.oldest_ns();
  if (oldest == 0) return RobotState::Ready;
  if (now - std::min(oldest, now) <= settings_.suspect_ns + stalls_.patience_ns(now)) return RobotState::Active;
  return was_active_ ? RobotState::Suspect : RobotState::Ready;
}

void FootbotDriver::update_state(hal::TimeNs now) {
  const RobotState next = judge(now);
  if (next == state_) return;
  const RobotState before = state_;
  state_ = next;
  const std::string who = "foot-bot '" + settings_.robot.id + "': ";
  if (next == RobotState::Active) {
    statistics_.recovered += was_active_ ? 1 : 0;
    interrupted_ = interrupted_ || was_active_;
    was_active_ = true;
    const std::string missing = wiring_.trouble();
    log_.info(who + "active" + (missing.empty() ? "" : ", but " + missing));
    return;
  }
  if (next == RobotState::Lost) ++statistics_.lost;
  if (before == RobotState::Active || next == RobotState::Lost) {
    log_.warning(who + state_name(next) + ": " + trouble());
  }
}

std::string FootbotDriver::trouble() const {
  if (network_.carrier() != aseba::Carrier::Up) return "nothing passes on the link";
  const std::string missing = wiring_.needed_trouble();
  if (!missing.empty()) return missing;
  if (state_ == RobotState::Suspect) return "a node that is needed does not answer";
  return wiring_.trouble();
}

// --- commands ---

void FootbotDriver::count(const hal::Limited& limited) noexcept {
  statistics_.clamped += limited.result == hal::LimitResult::Clamped ? 1 : 0;
  statistics_.not_finite += limited.result == hal::LimitResult::NotFinite ? 1 : 0;
}

/// Limits the commands in their ports.
void FootbotDriver::filter_commands() noexcept {
  robot_.limit_commands([this](const hal::Limited& limited) { count(limited); });
  statistics_.rearmed += interrupted_ ? 1 : 0;
  interrupted_ = false;
}

void FootbotDriver::commit(hal::TimeNs now) noexcept {
  ++statistics_.commits;
  last_commit_ns_ = now;
  wiring_.note_demand();
  update_state(now);
  const bool drive = !halted_ && !settings_.observe && state_ == RobotState::Active;
  if (drive) {
    at_rest_ = resting_ = false;
    driving_ = true;
    send_commands(now);
  } else {
    interrupted_ = interrupted_ || was_active_;
    if (driving_) rest(now);
    wiring_.command(false, now);
  }
  plan_question(now);
  pump(now);
}

/// What the controller wrote stays as it is: it may write once and never again.
void FootbotDriver::send_commands(hal::TimeNs now) noexcept {
  robot_.keep_commands();
  filter_commands();
  wiring_.command(true, now);
  robot_.restore_commands();
}

/// The next tick's readings are asked for so late that they are just there when it begins.
void FootbotDriver::plan_question(hal::TimeNs now) noexcept {
  const hal::TimeNs tick_ns = settings_.robot.tick_ns;
  const bool ticks = latched_ns_ != 0 && now - latched_ns_ < tick_ns;
  const hal::TimeNs lead = round_ns_ + round_ns_ / 4 + kSpare;
  if (!ticks || round_ns_ == 0 || latched_ns_ + tick_ns - lead <= now) return ask(now);
  ask_at_ns_ = latched_ns_ + tick_ns - lead;
}

void FootbotDriver::ask(hal::TimeNs now) noexcept {
  asked_ns_ = now;
  ask_at_ns_ = 0;
  answers_open_ = true;
  wiring_.ask(now);
}

void FootbotDriver::take_turn(hal::TimeNs now) noexcept {
  const hal::TimeNs stall = stalls_.turn(now);
  if (stall > 0) {
    ++statistics_.stalls;
    statistics_.longest_stall_ns = std::max(statistics_.longest_stall_ns, stall);
    network_.stalled(stall);
  }
  network_.poll(now);
  if (!answers_open_ || network_.reading()) return;
  answers_open_ = false;
  round_ns_ = std::max<hal::TimeNs>({now - asked_ns_, round_ns_ - round_ns_ / 50, 1});
}

void FootbotDriver::rest(hal::TimeNs now) noexcept {
  if (settings_.observe) return;
  driving_ = false;
  resting_ = true;
  at_rest_ = false;
  rest_said_ns_ = now;
  interrupted_ = true;
  wiring_.rest(now);
}

/// A module that lost its memory has stopped, and may have more than that to be told: nothing moves until the loop has
/// been told. @returns whether there is something to send.
bool FootbotDriver::look_for_restarts(hal::TimeNs now) noexcept {
  const std::string_view who = wiring_.look_for_restarts();
  if (who.empty() || !was_active_) return false;
  ++statistics_.restarts;
  log_.warning("foot-bot '" + settings_.robot.id + "': its node '" + std::string(who) + "' restarted");
  if (driving_) rest(now);
  return true;
}

void FootbotDriver::pump(hal::TimeNs now) noexcept {
  take_turn(now);
  wiring_.take_packets();
  bool more = look_for_restarts(now);
  if (wiring_.look()) {
    if (!driving_) wiring_.command(false, now);  // a module that is new here rests until told otherwise
    ask(now);
    more = true;
  } else if ((ask_at_ns_ != 0 && now >= ask_at_ns_) || now - asked_ns_ >= settings_.robot.tick_ns * 5 / 2) {
    ask(now);  // as planned; or the loop does not run, or not yet
    more = true;
  }
  update_state(now);
  if (driving_ && state_ != RobotState::Active) {
    ++statistics_.link_stops;
    rest(now);
    more = true;
  }
  if (driving_ && now - last_commit_ns_ > settings_.command_timeout_ns) {
    ++statistics_.watchdog_stops;
    log_.warning("foot-bot '" + settings_.robot.id + "': stopped, no commands came for " +
                 std::to_string((now - last_commit_ns_) / hal::kNsPerMs) + " ms");
    rest(now);
    more = true;
  }
  if (resting_ && wiring_.rests()) {
    resting_ = false;
    at_rest_ = true;
    ++statistics_.stops_confirmed;
  }
  if (resting_ && now - rest_said_ns_ >= kSayAgain) {
    rest_said_ns_ = now;
    wiring_.rest_again(now);
    more = true;
  }
  if (more) network_.poll(now);
}

hal::TimeNs FootbotDriver::next_deadline() const noexcept {
  hal::TimeNs deadline = std::min(network_.next_deadline(), asked_ns_ + settings_.robot.tick_ns * 5 / 2);
  if (ask_at_ns_ != 0) deadline = std::min(deadline, ask_at_ns_);
  if (driving_) deadline = std::min(deadline, last_commit_ns_ + settings_.command_timeout_ns + 1);
  if (resting_) deadline = std::min(deadline, rest_said_ns_ + kSayAgain);
  return deadline;
}

void FootbotDriver::stop(hal::TimeNs now) noexcept {
  halted_ = true;
  rest(now);
  pump(now);
}

}  // namespace tandem::bridges::footbot
