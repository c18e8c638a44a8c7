#include "bridges/epuck/driver.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "bridges/epuck/conversions.hpp"

namespace tandem::bridges::epuck {
namespace {

// A packet has at most 64 bytes; a link that does not take them at once is about to hang.
constexpr hal::TimeNs kWriteBudget = 2 * hal::kNsPerMs;

constexpr hal::TimeNs kNever = std::numeric_limits<hal::TimeNs>::max();

// Between an answer and the latch that it is for.
constexpr hal::TimeNs kLeastMargin = 4 * hal::kNsPerMs;
constexpr hal::TimeNs kLargestMargin = 20 * hal::kNsPerMs;

}  // namespace

EpuckDriver::EpuckDriver(DriverSettings settings, hal::Log log)
    : settings_(std::move(settings)),
      log_(std::move(log)),
      robot_(settings_.robot),
      wheels_(robot_.part<hal::DifferentialDrive>()),
      session_(make_conversation(settings_.wire, settings_.timing)),
      ask_due_ns_(kNever),
      margin_ns_(kLeastMargin) {}

void EpuckDriver::latch(hal::Tick tick, hal::TimeNs now) noexcept {
  robot_.fill(session_->samples(), session_->identity(), tick, now);
  judge_margin();
  foresee_latch(now);
}

// Latches come at even intervals, some of them late: an early one sets the rhythm, a late one hardly.
void EpuckDriver::foresee_latch(hal::TimeNs now) noexcept {
  const hal::TimeNs tick_ns = settings_.robot.tick_ns;
  const hal::TimeNs late = now - next_latch_ns_;
  if (next_latch_ns_ == 0 || late < 0 || late > tick_ns / 2)
    next_latch_ns_ = now + tick_ns;
  else
    next_latch_ns_ += tick_ns + late / 16;
}

void EpuckDriver::judge_margin() noexcept {
  if (asked_ns_ == 0) return;
  const hal::TimeNs taken = session_->samples().taken_ns[static_cast<std::size_t>(Quantity::Encoders)];
  if (taken >= asked_ns_) {
    margin_ns_ = std::max(kLeastMargin, margin_ns_ - margin_ns_ / 32);
  } else if (session_->state() == SessionState::Active) {
    ++statistics_.late_answers;
    margin_ns_ = std::min(2 * margin_ns_, kLargestMargin);
  }
  asked_ns_ = 0;
}

hal::WheelSpeeds EpuckDriver::filtered() noexcept {
  hal::WheelSpeeds wheels = robot_.port<hal::WheelSpeeds>();
  const hal::LimitResult limited = wheels.limit(wheels_).result;
  statistics_.clamped += limited == hal::LimitResult::Clamped ? 1 : 0;
  statistics_.not_finite += limited == hal::LimitResult::NotFinite ? 1 : 0;
  const bool wanted = wheels.left_m_s != 0.0 || wheels.right_m_s != 0.0;
  if (session_->state() != SessionState::Active) {
    interrupted_ = interrupted_ || wanted || armed_epoch_ != 0;
    return {};
  }
  if (session_->epoch() != armed_epoch_) {
    interrupted_ = interrupted_ || armed_epoch_ != 0;
    armed_epoch_ = session_->epoch();
  }
  statistics_.rearmed += interrupted_ ? 1 : 0;
  interrupted_ = false;
  return wheels;
}

void EpuckDriver::commit(hal::TimeNs now) noexcept {
  ++statistics_.commits;
  last_commit_ns_ = now;
  Actuation actuation;
  if (!halted_) {
    const hal::WheelSpeeds wheels = filtered();
    actuation = robot_.lamps();
    actuation.left = robot_.conversions().to_steps_per_s(wheels.left_m_s);
    actuation.right = robot_.conversions().to_steps_per_s(wheels.right_m_s);
  }
  moving_ = actuation.left.value != 0 || actuation.right.value != 0;
  const hal::TimeNs lead = session_->expected_round_trip(robot_.demand()) + margin_ns_;
  ask_due_ns_ = std::min(ask_due_ns_, next_latch_ns_ - lead);
  if (ask_due_ns_ > now) {
    session_->command(actuation, now);
    return;
  }
  session_->request(actuation, robot_.demand(), now);
  asked_ns_ = now;
  ask_due_ns_ = kNever;
}

void EpuckDriver::ask_when_due(hal::TimeNs now) noexcept {
  if (now < ask_due_ns_) return;
  session_->ask(robot_.demand(), now);
  asked_ns_ = now;
  ask_due_ns_ = kNever;
}

// Whoever was kept from pumping was probably not alone: the robot's side may have been as well.
void EpuckDriver::notice_stall(hal::TimeNs now) noexcept {
  const hal::TimeNs stall = stalls_.turn(now);
  if (stall > 0) {
    ++statistics_.stalls;
    session_->stalled(stall);
  }
  session_->be_patient(stalls_.patience_ns(now));
}

void EpuckDriver::send(ByteLink& link) noexcept {
  const auto bytes = session_->output().bytes();
  if (bytes.empty()) return;
  const std::size_t refused = bytes.size() - link.write(bytes, kWriteBudget);
  statistics_.refused_bytes += refused;
  if (refused > 0) session_->sent_in_part();
  session_->clear_output();
}

void EpuckDriver::pump(ByteLink& link, hal::TimeNs now) noexcept {
  std::array<std::uint8_t, 256> buffer;
  notice_stall(now);
  if (link.state() == LinkState::Open) session_->link_up(now);
  send(link);  // what commit or stop queued goes first
  for (Received r = link.read(buffer); r.size > 0; r = link.read(buffer)) {
    session_->on_bytes(std::span(buffer.data(), r.size), r.at_ns);
    send(link);
  }
  if (link.state() != LinkState::Open) session_->link_down(now);
  session_->poll(now);
  ask_when_due(now);
  if (moving_ && now - last_commit_ns_ > settings_.command_timeout_ns) {
    ++statistics_.watchdog_stops;
    moving_ = false;
    interrupted_ = true;
    session_->stop(now);
  }
  send(link);
}

hal::TimeNs EpuckDriver::next_deadline() const noexcept {
  const hal::TimeNs deadline = std::min(session_->next_deadline(), ask_due_ns_);
  return moving_ ? std::min(deadline, last_commit_ns_ + settings_.command_timeout_ns + 1) : deadline;
}

void EpuckDriver::stop(hal::TimeNs now) noexcept {
  halted_ = true;
  moving_ = false;
  interrupted_ = true;
  session_->stop(now);
}

void EpuckDriver::shut_down(hal::TimeNs now) noexcept {
  halted_ = true;
  moving_ = false;
  session_->shut_down(now);
}

Odometry EpuckDriver::odometry() const noexcept {
  const Samples& s = session_->samples();
  const Conversions& conversions = robot_.conversions();
  return {conversions.steps_to_m(s.left_steps), conversions.steps_to_m(s.right_steps),
          s.taken_ns[static_cast<std::size_t>(Quantity::Encoders)], session_->statistics().encoder_rebased};
}

void EpuckDriver::identify(RobotIdentity& identity) const {
  const Identity& told = session_->identity();
  const bool introduced =
      state() == SessionState::Ready || state() == SessionState::Active || state() == SessionState::Suspect;
  if (!introduced) return;
  // A radio speaks as an e-puck2's, and tells no version.
  const bool tells = settings_.wire != WireForm::Wifi && !told.version_text().empty();
  if (tells) identity.firmware = std::string(told.version_text());
  if (told.hardware == 0) return;
  std::array<char, 9> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), told.hardware, 16);
  if (error == std::errc{}) identity.hardware = std::string(digits.data(), end);
}

void EpuckDriver::tell_accelerometer(const std::string& who) {
  const AccelerometerCheck& accelerometer = session_->samples().accelerometer;
  if (accelerometer.verdict() == logged_accelerometer_) return;
  logged_accelerometer_ = accelerometer.verdict();
  if (logged_accelerometer_ != AccelerometerCheck::Verdict::Refused) return;
  log_.warning(who + "its accelerometer reads " + std::to_string(accelerometer.at_rest_m_s2()) +
               " m/s2 at rest instead of 9.8: its readings are not believed; is it another firmware than '" +
               std::string(session_->identity().version_text()) + "'?");
}

/// What the robot's kind has, its controller takes, and the firmware does not tell.
void EpuckDriver::tell_untold(const std::string& who) {
  if (session_->state() != SessionState::Active) return;
  std::string untold = robot_.untold(session_->layout(), session_->samples());
  if (untold == logged_untold_) return;
  logged_untold_ = std::move(untold);
  if (logged_untold_.empty()) return;
  const bool epuck2 = session_->identity().is_epuck2();
  log_.warning(who + std::string(firmware_name(session_->identity().firmware)) + " does not tell " + logged_untold_ +
               " over this link, or tells nothing but zeros: such readings stay absent; has the robot such a device" +
               (epuck2 ? "?" : ", and is it of the kind that the file says?"));
}

void EpuckDriver::tell() {
  const std::string who = "e-puck '" + settings_.robot.id + "': ";
  tell_accelerometer(who);
  tell_untold(who);
  if (statistics_.watchdog_stops != told_watchdog_stops_) {
    told_watchdog_stops_ = statistics_.watchdog_stops;
    log_.warning(who + "stopped, no commands came for " + std::to_string(settings_.command_timeout_ns / hal::kNsPerMs) +
                 " ms");
  }
  const SessionState state = session_->state();
  if (state == logged_) return;
  if (state == SessionState::Active) {
    log_.info(who + "active, " + std::string(firmware_name(session_->identity().firmware)) + ", " +
              std::string(session_->identity().version_text()));
  } else if (state == SessionState::Suspect || state == SessionState::Lost) {
    log_.warning(who + state_name(state) + ": " + session_->trouble());
  }
  logged_ = state;
}

}  // namespace tandem::bridges::epuck
