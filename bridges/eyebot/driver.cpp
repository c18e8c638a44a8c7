#include "bridges/eyebot/driver.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>

#include "bridges/eyebot/readings.hpp"
#include "bridges/eyebot_messages/codec.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::eyebot {
namespace {

namespace messages = eyebot_messages;
using hal::TimeNs;

constexpr TimeNs kStatusFresh = 600 * hal::kNsPerMs;  // ten a second are promised
constexpr TimeNs kReleasedAfter = 10 * hal::kNsPerSecond;
constexpr TimeNs kComplainAgain = 10 * hal::kNsPerSecond;
constexpr TimeNs kSilence = 2 * hal::kNsPerSecond;      // then it is told who is heard instead
constexpr TimeNs kOthersRobot = 2 * hal::kNsPerSecond;  // after another hub's last command
constexpr TimeNs kOthersSpread = 100 * hal::kNsPerMs;   // two hubs do not try again at the same moment
constexpr TimeNs kAskClock = 10 * hal::kNsPerSecond;    // its answer bounds the error of its clock
constexpr TimeNs kOwnJump = 150 * hal::kNsPerMs;        // robots refuse what is stamped 250 ms off
constexpr double kPushed = 1.5;                         // times as fast as it flies by itself a robot may be

std::string id_of_session(std::int32_t session) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "tandem-%08x", static_cast<unsigned>(session));
  return text.data();
}

}  // namespace

hal::TimeNs unix_ns() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
}

const char* state_name(RobotState state) noexcept {
  static constexpr std::array<const char*, 5> kNames = {"absent", "ready", "active", "suspect", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

const std::vector<const hal::PortType*>& port_types() {
  static const auto all =
      port_types_of<hal::Positioning, hal::FlightState, hal::Altimeter, hal::Gyroscope, hal::Proximity, hal::Light,
                    hal::DistanceScanner, hal::PerspectiveCamera, hal::PanTiltEncoder, hal::RangeAndBearing,
                    hal::Battery, hal::Clock, hal::QuadrotorPosition, hal::QuadrotorSpeed, hal::FlightTask,
                    hal::RingLeds, hal::UpperRingLeds, hal::CameraLed, hal::PanTiltDrive, hal::ScannerDrive,
                    hal::RangeAndBearingSend>();
  return all;
}

EyebotDriver::EyebotDriver(DriverSettings settings, Inbox& inbox, Outbox& outbox, hal::Log log)
    : settings_(std::move(settings)),
      inbox_(inbox),
      outbox_(outbox),
      log_(std::move(log)),
      robot_(settings_.robot),
      flight_(robot_.part<hal::Quadrotor>()),
      place_gate_(kPushed * flight_.max_speed_m_s) {
  if (settings_.name.empty()) settings_.name = settings_.robot.id;
  if (settings_.hub.empty()) settings_.hub = id_of_session(settings_.session);
  for (std::size_t i = 0; i < kTold; ++i) {
    voices_[i].channel = channel_of(settings_.name, settings_.hub, static_cast<Told>(i));
    voices_[i].seq = settings_.first_seq;
  }
  orders_.begin_with(settings_.first_seq);
  controlled_ = settings_.controlled;
  own_heartbeat_.name = settings_.hub;
  own_heartbeat_.role = messages::Heartbeat::ROLE_HUB;
  own_heartbeat_.proto_major = 1;
  own_heartbeat_.period_ms = static_cast<std::int32_t>(kBeat / hal::kNsPerMs);
  radio_.data.reserve(hal::kRabPayloadMax);
}

// --- what it says ---

template <class Message, class... Use>
void EyebotDriver::take_in(Topic topic, Newest<Message>& newest, TimeNs now, Use... use) {
  while (inbox_.take(topic, letter_)) {
    const messages::Flaw flaw = messages::decode(letter_.data, newest.next);
    if (flaw != messages::Flaw::None) {
      complain(topic, messages::flaw_name(flaw), now);
      continue;
    }
    if (!accept(newest.next.hdr, letter_.received_ns)) continue;
    std::swap(newest.message, newest.next);
    taken(topic) = clock_.local(ClockEstimator::from_us(newest.message.hdr.utime), letter_.received_ns);
    (use(), ...);
  }
}

void EyebotDriver::take_all(TimeNs now) {
  Newests& n = newests_;
  take_in(Topic::Heartbeat, n.heartbeat, now,
          [&] {  // What lay on the way while we slept is no sign of life of now.
            liveness_.note_heartbeat(n.heartbeat.message.period_ms,
                                     std::max(liveness_.heartbeat_ns(), taken(Topic::Heartbeat)));
          });
  take_in(Topic::Ack, n.ack, now, [&] { use_ack(letter_.received_ns); });
  take_in(Topic::Status, n.status, now, [&] { use_status(); });
  take_in(Topic::State, n.state, now, [&] { use_state(); });
  take_in(Topic::Altitude, n.altitude, now);
  take_in(Topic::Battery, n.battery, now);
  take_in(Topic::Scan, n.scan, now);
  take_in(Topic::Rab, n.rab, now, [&] { add(n.rab.message, heard_); });
  take_in(Topic::Prox, n.prox, now);
  take_in(Topic::Light, n.light, now);
  take_in(Topic::PanTilt, n.pan_tilt, now);
  take_in(Topic::Blobs, n.blobs, now);
}

bool EyebotDriver::accept(const messages::Header& header, TimeNs received_ns) {
  const Sender sender = liveness_.note(header.session, received_ns);
  if (sender == Sender::Other) return false;
  if (sender == Sender::Restarted) begin_anew();
  clock_.note(ClockEstimator::from_us(header.utime), received_ns);
  watch_clock();
  return true;
}

/// Until it was learnt anew nothing that it said had a time, and nothing that it was told was young enough.
void EyebotDriver::watch_clock() {
  if (clock_.jumps() == clock_jumps_) return;
  clock_jumps_ = clock_.jumps();
  robots_clock_ = true;
  log_.warning(who() + "its clock was set; commands are now stamped by it");
  interrupt();
}

/// The robot would refuse for ever what is stamped by a clock that was set here.
void EyebotDriver::watch_own_clock(TimeNs now) noexcept {
  const TimeNs ahead = settings_.unix_clock() - now;
  const TimeNs jump = ahead - own_clock_ns_.value_or(ahead);
  own_clock_ns_ = ahead;
  robots_clock_ = robots_clock_ || jump > kOwnJump || jump < -kOwnJump;
}

/// Whatever becomes of it, whoever has it fly must be told that something was between. One that is not active has been
/// counted already.
void EyebotDriver::interrupt() noexcept {
  statistics_.link_stops += state_ == RobotState::Active && goal_ == Goal::Obey ? 1 : 0;
  interrupted_ = interrupted_ || was_active_;
  end_flying();
}

void EyebotDriver::begin_anew() {
  log_.warning(who() + "it was started anew");
  interrupt();
  place_gate_.forget();
  controlled_ = refused_ = doubts_control_ = false;
  status_.known = false;
  // It stands on the ground, if all is well: it must be told again to take off.
  pending_ = pending_ && order_ == hal::FlightOrder::Land;
  orders_.withdraw();
  orders_.forget();
}

void EyebotDriver::complain(Topic topic, const char* flaw, TimeNs now) {
  ++statistics_.not_understood;
  if (complained_ns_ != 0 && now - complained_ns_ < kComplainAgain) return;
  complained_ns_ = now;
  log_.warning(who() + "a message on " + channel_of(settings_.name, topic) + " is damaged: " + flaw);
}

void EyebotDriver::use_state() {
  const messages::State& m = newests_.state.message;
  if (m.pos_valid == 0 || !place_gate_.take({m.pos[0], m.pos[1], m.pos[2]}, taken(Topic::State))) return;
  place_ = m;
  place_taken_ns_ = taken(Topic::State);
}

void EyebotDriver::use_status() {
  const messages::Status& m = newests_.status.message;
  // It refuses to go where it is told: somebody may have taken it over while we could not hear it.
  const bool refuses = status_.known && m.cmd_rejected > status_.rejected && mode_of(m.mode) == Mode::Hover;
  if (refuses && setpoint_ != Told::Heartbeat) doubts_control_ = true;
  const FlightStatus before = status_;
  status_.known = true;
  status_.mode = mode_of(m.mode);
  status_.armed = m.armed != 0;
  status_.magnet_on = m.magnet_on != 0;
  status_.failsafe = failsafe_of(m.failsafe);
  status_.rejected = m.cmd_rejected;
  status_.taken_ns = std::max(status_.taken_ns, taken(Topic::Status));
  const bool begins = status_.failsafe != before.failsafe && status_.failsafe != hal::FlightFailsafe::None;
  // Commands that we ourselves left out are no surprise.
  const bool late = status_.failsafe == hal::FlightFailsafe::CommandTimeout && setpoint_ == Told::Heartbeat;
  const bool told = ordered_ == Action::Land || ordered_ == Action::Disarm;
  const bool sinks = in_the_air(before.mode) && controlled_ && !told &&
                     (status_.mode == Mode::Land || status_.mode == Mode::Idle || status_.mode == Mode::Off ||
                      status_.mode == Mode::Stopped);
  if (!before.known || !was_active_ || settings_.observe || !((begins && !late) || sinks)) return;
  // A command that came late is the link's stop, and over with it. One that has heard nothing for 2 s was absent.
  statistics_.saved_itself += status_.failsafe == hal::FlightFailsafe::CommandTimeout ? 0 : 1;
  log_.warning(
      who() + "it goes to safety by itself, " + mode_name(status_.mode) +
      (status_.failsafe == hal::FlightFailsafe::None ? "" : std::string(": ") + failsafe_name(status_.failsafe)));
  interrupt();
}

void EyebotDriver::use_ack(TimeNs received_ns) {
  const messages::Ack& m = newests_.ack.message;
  if (m.channel != voice(Told::Mode).channel) return;
  const auto answered = orders_.take(m, settings_.session, received_ns);
  if (!answered) return;
  clock_.note_answer(ClockEstimator::from_us(m.hdr.utime), orders_.answered_issue_ns(), received_ns);
  exchanged_ns_ = received_ns;
  const Outcome outcome = orders_.last(*answered).outcome;
  if (outcome == Outcome::RejectedStale) robots_clock_ = !robots_clock_;  // then by the other clock
  watch_clock();
  if (outcome == Outcome::Done) {
    doubts_control_ = doubts_control_ && *answered == Action::Nop;
    if (*answered == Action::Arm) {
      controlled_ = true;
      refused_ = false;
    }
    if (*answered == Action::Disarm) controlled_ = false;
    return;
  }
  if (outcome == Outcome::RejectedSource) {
    controlled_ = doubts_control_ = false;
    refused_ = true;
    ++statistics_.refused_control;
  }
  // One that is armed, and listened to us last, need not be armed again.
  const bool ours = newests_.status.message.cmd_session == settings_.session && status_.armed;
  if (*answered == Action::Arm && outcome == Outcome::RejectedMode && ours) controlled_ = true;
  if (*answered == Action::Nop) return;
  log_.warning("eye-bot '" + settings_.robot.id + "' did not " + action_name(*answered) + ": " + outcome_name(outcome) +
               (m.text.empty() ? "" : " (" + m.text + ")"));
}

// --- readings ---

template <class Port, class Message>
void EyebotDriver::fill(Topic topic, const Newest<Message>& newest, TimeNs now) noexcept {
  if (!robot_.uses<Port>() || taken(topic) == 0) return;
  auto& port = robot_.port<Port>();
  if constexpr (requires { read(newest.message, robot_.kind(), port); })
    read(newest.message, robot_.kind(), port);
  else
    read(newest.message, port);
  robot_.stamp(port, taken(topic), topic_period_ns(topic), now);
}

void EyebotDriver::fill_flight(TimeNs now) noexcept {
  const bool placed = place_taken_ns_ != 0;
  if (robot_.uses<hal::Positioning>() && placed) {
    auto& port = robot_.port<hal::Positioning>();
    read(place_, settings_.world, port);
    robot_.stamp(port, place_taken_ns_, topic_period_ns(Topic::State), now);
  }
  if (robot_.uses<hal::FlightState>() && taken(Topic::Status) != 0) {
    auto& port = robot_.port<hal::FlightState>();
    read(newests_.status.message, port);
    if (placed) read(place_, settings_.world, port);
    robot_.stamp(port, taken(Topic::Status), topic_period_ns(Topic::Status), now);
  }
}

void EyebotDriver::latch(hal::Tick tick, TimeNs now) noexcept {
  const Newests& n = newests_;
  fill_flight(now);
  fill<hal::Gyroscope>(Topic::State, n.state, now);
  fill<hal::Altimeter>(Topic::Altitude, n.altitude, now);
  fill<hal::Battery>(Topic::Battery, n.battery, now);
  fill<hal::DistanceScanner>(Topic::Scan, n.scan, now);
  fill<hal::Proximity>(Topic::Prox, n.prox, now);
  fill<hal::Light>(Topic::Light, n.light, now);
  fill<hal::PanTiltEncoder>(Topic::PanTilt, n.pan_tilt, now);
  fill<hal::PerspectiveCamera>(Topic::Blobs, n.blobs, now);
  if (robot_.uses<hal::RangeAndBearing>() && taken(Topic::Rab) != 0) {
    auto& port = robot_.port<hal::RangeAndBearing>();
    port = heard_;
    robot_.stamp(port, taken(Topic::Rab), topic_period_ns(Topic::Rab), now);
  }
  heard_ = {};
  robot_.tell_time(tick);
}

// --- what it does ---

RobotState EyebotDriver::judge(TimeNs now) const noexcept {
  const TimeNs patience = stalls_.patience_ns(now);
  const Pulse pulse = liveness_.pulse(now - patience);
  if (pulse == Pulse::Never) return RobotState::Absent;
  if (pulse == Pulse::Lost) return was_active_ ? RobotState::Lost : RobotState::Absent;
  const bool well = pulse == Pulse::Beating && liveness_.settled(now) && !liveness_.contested(now) &&
                    !liveness_.namesakes(now) && !others_robot(now) && status_.known &&
                    now - status_.taken_ns <= kStatusFresh + patience && newests_.heartbeat.message.proto_major == 1 &&
                    place_gate_.known() && !saves_itself(status_.mode, status_.failsafe) &&
                    status_.mode != Mode::Stopped;
  if (well) return RobotState::Active;
  return was_active_ ? RobotState::Suspect : RobotState::Ready;
}

void EyebotDriver::update_state(TimeNs now) {
  // So long without its hub, a robot lets another one take it over.
  if (state_ == RobotState::Lost && now - liveness_.heartbeat_ns() > kReleasedAfter) controlled_ = false;
  const RobotState next = judge(now);
  if (next == state_) return;
  const RobotState before = state_;
  state_ = next;
  if (next == RobotState::Active) {
    statistics_.recovered += was_active_ ? 1 : 0;
    interrupted_ = interrupted_ || was_active_;
    was_active_ = true;
    log_.info(who() + "active");
    return;
  }
  if (next == RobotState::Lost) ++statistics_.lost;
  if (before == RobotState::Active || next == RobotState::Lost) {
    log_.warning(who() + state_name(next) + ": " + trouble());
  }
}

/// Another hub has just commanded it, and it has not accepted us.
bool EyebotDriver::others_robot(TimeNs now) const noexcept {
  const TimeNs commanded_ns = inbox_.neighbours().commanded_ns();
  const TimeNs wait_ns = kOthersRobot + kOthersSpread * (settings_.session & 15);
  return (!controlled_ || doubts_control_) && commanded_ns != 0 && now - commanded_ns < wait_ns;
}

bool EyebotDriver::battery_low() const noexcept {
  if (taken(Topic::Battery) == 0) return false;
  if (newests_.battery.message.low != 0) return true;
  const auto* const part = robot_.kind().part<hal::BatteryPart>();
  if (part == nullptr) return false;
  hal::Battery battery;
  read(newests_.battery.message, robot_.kind(), battery);
  return battery.charge <= static_cast<float>(part->low_charge);
}

void EyebotDriver::report_silence(TimeNs now) {
  if (silence_told_ || state_ != RobotState::Absent || now - started_ns_ < kSilence) return;
  silence_told_ = true;
  log_.warning(who() + trouble());
}

bool EyebotDriver::overdue(TimeNs now) const noexcept {
  return !committed_ || now - last_commit_ns_ > settings_.command_timeout_ns;
}

Goal EyebotDriver::goal(TimeNs now) const noexcept {
  if (goal_ != Goal::Obey) return goal_;
  return state_ != RobotState::Active || overdue(now) ? Goal::Hover : Goal::Obey;
}

/// What the controller wants is noted in `commit` alone: it may write its ports at any other time.
void EyebotDriver::note_order() noexcept {
  steers_ =
      robot_.uses<hal::FlightTask>() || robot_.uses<hal::QuadrotorPosition>() || robot_.uses<hal::QuadrotorSpeed>();
  if (!robot_.uses<hal::FlightTask>()) return;
  hal::FlightTask task = robot_.port<hal::FlightTask>();
  count(task.limit(flight_));
  const hal::FlightOrder order = task.order;
  order_m_s_ = static_cast<float>(task.speed_m_s);
  if (order == order_) return;
  order_ = order;
  pending_ = order != hal::FlightOrder::Fly;
  orders_.forget();
}

void EyebotDriver::guide(TimeNs now) noexcept {
  may_fly_ = false;
  if (settings_.observe || !status_.known) return;
  const Goal wanted = goal(now);
  const Situation situation = {status_.mode, status_.armed, status_.failsafe, controlled_,
                               wanted,       order_,        pending_,         goal_ == Goal::Hover && battery_low()};
  Step step = next_step(situation);
  if (wanted == Goal::Obey && step.done) pending_ = false;
  if (goal_ != Goal::Obey) {
    reached_ = !controlled_ || (step.done && status_.taken_ns > goal_since_ns_);
  } else if (wanted == Goal::Obey && !steers_) {
    step = {};
  }
  // A robot may want its fail-safe cleared before it is armed, or armed before it lets that be cleared.
  const bool refused_arming = orders_.last(Action::Arm).outcome == Outcome::RejectedMode &&
                              orders_.last(Action::Arm).at_ns >= orders_.last(Action::ClearFailsafe).at_ns;
  if (step.action == Action::Arm && status_.failsafe == hal::FlightFailsafe::LinkLost && refused_arming) {
    step.action = Action::ClearFailsafe;
  }
  const bool takes_speed =
      step.action == Action::TakeOff || step.action == Action::Land || step.action == Action::Attach;
  const TimeNs asked_ns = std::max(exchanged_ns_, orders_.last(Action::Nop).at_ns);
  const bool asks_clock = controlled_ && state_ == RobotState::Active && now - asked_ns >= kAskClock;
  if (step.action == Action::Nop && (asks_clock || clock_.doubtful())) {
    orders_.want(Action::Nop, 0.0F, now);  // its answer tells whether the clock was set
  } else if (step.action == Action::Nop) {
    orders_.withdraw();
  } else {
    orders_.want(step.action, takes_speed && goal_ == Goal::Obey ? order_m_s_ : 0.0F, now);
  }
  may_fly_ = step.fly;
}

void EyebotDriver::end_flying() noexcept {
  interrupted_ = interrupted_ || setpoint_ != Told::Heartbeat;
  setpoint_ = Told::Heartbeat;
}

void EyebotDriver::set_goal(Goal goal, TimeNs now) noexcept {
  if (goal_ == goal) return;
  goal_ = goal;
  goal_since_ns_ = now;
  reached_ = false;
  orders_.forget();
}

void EyebotDriver::stop(TimeNs now) noexcept {
  if (goal_ == Goal::Obey) set_goal(Goal::Hover, now);
  pump(now);
}

void EyebotDriver::land(TimeNs now) noexcept {
  if (goal_ != Goal::Land && status_.known && status_.mode != Mode::Idle && status_.mode != Mode::Off)
    log_.info("eye-bot '" + settings_.robot.id + "' lands; nothing but its landing ends that");
  set_goal(Goal::Land, now);
  pump(now);
}

// --- when ---

void EyebotDriver::commit(TimeNs now) noexcept {
  ++statistics_.commits;
  committed_ = true;
  last_commit_ns_ = now;
  note_order();
  advance(now);
  if (settings_.observe) return;
  if (may_fly_) say_setpoint(now);
  if (was_active_ && !others_robot(now)) say_devices(now);
}

void EyebotDriver::pump(TimeNs now) noexcept {
  advance(now);
  if (setpoint_ == Told::Heartbeat) return;
  Voice& v = voice(setpoint_);
  if (now - v.said_ns >= (setpoint_ == Told::Velocity ? kVelocityAgain : kPositionAgain)) send(v, now);
}

void EyebotDriver::advance(TimeNs now) noexcept {
  now_ns_ = now;
  statistics_.stalls += stalls_.turn(now) > 0 ? 1 : 0;
  if (started_ns_ == 0) started_ns_ = now;
  watch_own_clock(now);
  take_all(now);
  update_state(now);
  report_silence(now);
  if (setpoint_ != Told::Heartbeat && goal_ == Goal::Obey) {
    if (state_ != RobotState::Active) {
      ++statistics_.link_stops;
      end_flying();
    } else if (overdue(now)) {
      ++statistics_.watchdog_stops;
      log_.warning(who() + "hovers, no commands came for " + std::to_string((now - last_commit_ns_) / hal::kNsPerMs) +
                   " ms");
      end_flying();
    }
  }
  guide(now);
  if (settings_.observe) return;
  if (!may_fly_) end_flying();
  say_heartbeat(now);
  say_order(now);
}

TimeNs EyebotDriver::next_deadline() const noexcept {
  TimeNs deadline = voices_[static_cast<std::size_t>(Told::Heartbeat)].said_ns + kBeat;
  deadline = std::min({deadline, orders_.next_deadline(), liveness_.next_change(now_ns_)});
  if (setpoint_ != Told::Heartbeat) {
    deadline = std::min(deadline, voices_[static_cast<std::size_t>(setpoint_)].said_ns + kVelocityAgain);
    deadline = std::min(deadline, last_commit_ns_ + settings_.command_timeout_ns + 1);
  }
  return deadline;
}

void EyebotDriver::skip_ahead(std::uint32_t by) noexcept {
  const auto ahead = [by](std::int32_t seq) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(seq) + by); };
  for (Voice& v : voices_) v.seq = ahead(v.seq);
  orders_.withdraw();
  orders_.forget();
  orders_.begin_with(ahead(orders_.next_seq()));
}

// --- for people ---

std::string EyebotDriver::missing_readings() const {
  const auto row = [this]<class Port>(Topic topic) {
    return robot_.uses<Port>() && taken(topic) == 0 ? " " + channel_of(settings_.name, topic) : std::string();
  };
  return row.operator()<hal::Positioning>(Topic::State) + row.operator()<hal::Altimeter>(Topic::Altitude) +
         row.operator()<hal::Battery>(Topic::Battery) + row.operator()<hal::DistanceScanner>(Topic::Scan) +
         row.operator()<hal::RangeAndBearing>(Topic::Rab) + row.operator()<hal::Proximity>(Topic::Prox) +
         row.operator()<hal::Light>(Topic::Light) + row.operator()<hal::PanTiltEncoder>(Topic::PanTilt) +
         row.operator()<hal::PerspectiveCamera>(Topic::Blobs);
}

/// The order that is wanted and was refused or not answered.
std::string EyebotDriver::refused_order() const {
  for (std::size_t i = 1; i < kActions; ++i) {
    const auto action = static_cast<Action>(i);
    const Outcome outcome = orders_.last(action).outcome;
    if (outcome == Outcome::Never || outcome == Outcome::Done || orders_.saying() != action) continue;
    return std::string("it did not ") + action_name(action) + ": " + outcome_name(outcome);
  }
  return {};
}

std::string EyebotDriver::trouble() const {
  const std::string beat = channel_of(settings_.name, Topic::Heartbeat);
  if (state_ == RobotState::Absent) {
    const std::string robots = inbox_.neighbours().robots();
    return "no heartbeat is heard on " + beat + (robots.empty() ? "" : "; heard are: " + robots);
  }
  if (state_ == RobotState::Lost) return "its heartbeat on " + beat + " is gone";
  const auto& heartbeat = newests_.heartbeat.message;
  if (heartbeat.proto_major != 1) {
    return "it speaks version " + std::to_string(heartbeat.proto_major) + " of the messages, and we version 1";
  }
  if (liveness_.namesakes(now_ns_))
    return "two robots are called '" + settings_.name + "'; give one of them another name";
  if (others_robot(now_ns_)) return inbox_.neighbours().commander() + " commands it";
  if (status_.known && status_.failsafe != hal::FlightFailsafe::None) return failsafe_name(status_.failsafe);
  if (status_.known && status_.mode == Mode::Stopped) return "its motors were cut in an emergency";
  if (state_ != RobotState::Active) {
    if (liveness_.contested(now_ns_)) return "it was started anew, or another one has its name";
    if (!status_.known) return "it does not say its status on " + channel_of(settings_.name, Topic::Status);
    if (!place_gate_.known()) return "it has not said a valid place on " + channel_of(settings_.name, Topic::State);
    return liveness_.settled(now_ns_) ? "its heartbeat or its status does not come in time"
                                      : "it has just been started";
  }
  if (refused_) return inbox_.neighbours().hub_of(newests_.status.message.cmd_session) + " controls it";
  if (const std::string refused = refused_order(); !refused.empty()) return refused;
  const std::string missing = missing_readings();
  return missing.empty() ? "" : "it does not say anything on" + missing;
}

}  // namespace tandem::bridges::eyebot
