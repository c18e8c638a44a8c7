#include "bridges/epuck/bridge.hpp"

#include <algorithm>
#include <chrono>

#include "bridges/epuck/stop.hpp"
#include "bridges/epuck/stopper.hpp"
#include "bridges/link/device.hpp"
#include "bridges/link/pending_link.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

constexpr TimeNs kLongestWait = 20 * hal::kNsPerMs;  // then deadlines and the end are looked at

LinkStatistics sum(const LinkStatistics& a, const LinkStatistics& b) noexcept {
  return {a.bytes_in + b.bytes_in, a.bytes_out + b.bytes_out, a.bytes_refused + b.bytes_refused, a.errors + b.errors};
}

}  // namespace

SessionTiming timing_for(std::string_view link_name) noexcept {
  SessionTiming timing;
  const StopTiming stop = stop_timing_for(link_name);
  timing.answer_ns = stop.answer_ns;
  timing.quiet_ns = stop.quiet_ns;
  if (link_name.find("rfcomm") != std::string_view::npos) timing.gap_ns = 200 * hal::kNsPerMs;
  if (in_network(link_name)) timing.gap_ns = 150 * hal::kNsPerMs;
  return timing;
}

EpuckBridge::EpuckBridge(BridgeSettings settings, LinkOpener opener, hal::Log log)
    : settings_(std::move(settings)), opener_(std::move(opener)), log_(log), driver_(settings_.driver, std::move(log)) {
  reached_.link = absolute_link(settings_.link);
}

EpuckBridge::~EpuckBridge() {
  shut_down();
}

// --- the thread ---

void EpuckBridge::run() {
  while (!ending_) {
    const std::unique_ptr<ByteLink> link = open_link();
    if (!link) continue;
    {
      const std::lock_guard lock(mutex_);
      note_link(*link);
    }
    serve(*link);
    if (ending_) run_shutdown(*link);
    const std::lock_guard lock(mutex_);
    link_ = nullptr;
    bytes_before_ = sum(bytes_before_, link->statistics());
    if (!ending_) driver_.link_gone(monotonic_ns());
    driver_.tell();
    changed_.notify_all();
  }
}

void EpuckBridge::note_link(ByteLink& link) {
  link_ = &link;
  ++reached_.session;
  reached_.device = device_of(link.descriptor());
  reached_.address = serial_number_of(link.descriptor());
}

/// Tries until the link opens; null at the end.
std::unique_ptr<ByteLink> EpuckBridge::open_link() {
  std::string logged;
  while (!ending_) {
    Pending<ByteLink> pending(opener_);
    auto opened = pending.take();
    std::unique_lock lock(mutex_);
    const auto ended = [this] { return ending_.load(); };
    while (!opened && !changed_.wait_for(lock, std::chrono::milliseconds(5), ended)) opened = pending.take();
    if (!opened) break;
    if (opened->ok()) {
      link_error_.clear();
      return std::move(*opened).value();
    }
    link_error_ = opened->error().message;
    if (link_error_ != logged)
      log_.warning("e-puck '" + std::string(driver_.robot().id()) + "': " + link_error_ + "; trying on");
    logged = link_error_;
    changed_.wait_for(lock, std::chrono::nanoseconds(settings_.reopen_ns), ended);
  }
  return nullptr;
}

bool EpuckBridge::wants_new_link() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.wants_new_link();
}

void EpuckBridge::serve(ByteLink& link) {
  while (!ending_ && link.state() == LinkState::Open && !wants_new_link()) {
    const TimeNs now = monotonic_ns();
    TimeNs wait = kLongestWait;
    {
      const std::lock_guard lock(mutex_);
      pump_now(now);
      driver_.tell();
      wait = std::clamp<TimeNs>(driver_.next_deadline() - now, 0, kLongestWait);
    }
    link.wait(wait);
  }
}

void EpuckBridge::run_shutdown(ByteLink& link) {
  const TimeNs end = monotonic_ns() + settings_.shutdown_ns;
  {
    const std::lock_guard lock(mutex_);
    driver_.shut_down(monotonic_ns());
    pump_now(monotonic_ns());
  }
  for (TimeNs now = monotonic_ns(); now < end && link.state() == LinkState::Open; now = monotonic_ns()) {
    link.wait(std::min(kLongestWait, end - now));
    const std::lock_guard lock(mutex_);
    pump_now(monotonic_ns());
    if (driver_.idle()) break;
  }
}

/// Every handshake stops the robot.
Interruptions EpuckBridge::interruptions() const noexcept {
  const SessionStatistics& s = driver_.session().statistics();
  return {s.handshakes, s.restarts};
}

void EpuckBridge::pump_now(TimeNs now) noexcept {
  if (link_ == nullptr) return;
  const SessionState before = driver_.state();
  driver_.pump(*link_, now);
  if (driver_.state() != before) changed_.notify_all();
}

// --- the loop ---

std::string EpuckBridge::silence() const {
  const std::string trouble = driver_.session().trouble();
  return trouble.empty() ? state_name(driver_.state()) : trouble;
}

// --- what is known ---

bool EpuckBridge::is_another() const noexcept {
  return driver_.state() == SessionState::Active &&
         !firmware_fits(settings_.firmware, driver_.session().identity().firmware);
}

bool EpuckBridge::mismatched() const noexcept {
  const std::lock_guard lock(mutex_);
  return is_another();
}

bool EpuckBridge::at_rest() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.stopped() && driver_.at_rest();
}

std::string EpuckBridge::robot_trouble() const {
  if (is_another()) {
    return "it runs the firmware '" + std::string(driver_.session().identity().version_text()) + "', not '" +
           settings_.firmware + "' as the file says; correct firmware=\"…\" or say auto";
  }
  return driver_.session().trouble();
}

std::string EpuckBridge::advice() const {
  if (settings_.driver.wire == WireForm::Wifi)
    return "is it switched on, its selector at 15, and no other program connected?";
  return "is it switched on, its selector at 3 (Bluetooth) or 8 (USB, e-puck2), and the baud rate 115200?";
}

/// With the lock held.
RobotIdentity EpuckBridge::who() const {
  RobotIdentity all = reached_;
  driver_.identify(all);
  return all;
}

StopMessages EpuckBridge::stop_messages() const {
  const std::lock_guard lock(mutex_);
  const bool connected = link_ != nullptr && in_network(settings_.link);
  return {.robot = settings_.driver.robot.id,
          .kind = std::string(hal::epuck::kName),
          .link = reached_.link,
          .body = connected ? stop_body(link_->descriptor()) : "",
          .version = 1 + reached_.session + driver_.session().epoch(),
          .identity = who()};
}

std::uint64_t EpuckBridge::stop_version() const noexcept {
  const std::lock_guard lock(mutex_);
  return 1 + reached_.session + driver_.session().epoch();
}

LinkReport EpuckBridge::report() const {
  const std::lock_guard lock(mutex_);
  const SessionStatistics& s = driver_.session().statistics();
  LinkReport report;
  report.questions = s.packets;
  report.answers = s.answers;
  report.time_outs = s.silent + s.cut_short;
  report.bad_answers = s.implausible;
  report.resynchronised = s.resynchronised;
  report.links_lost = s.links_lost;
  report.set(s.round_trips);
  return report;
}

void EpuckBridge::describe(StatusVisitor& visitor) const {
  const BridgeStatus s = status();
  visitor.text("firmware", s.identity.version_text());
  visitor.text("state", state_name(s.state));
  visitor.count("silent", s.session.silent);
  visitor.count("cut_short", s.session.cut_short);
  visitor.count("asked_again", s.session.asked_again);
  visitor.count("overdue", s.session.overdue);
  visitor.count("late_answers", s.driver.late_answers);
  visitor.count("wrong_speeds", s.session.wrong_speeds);
  visitor.count("restarts", s.session.restarts);
  visitor.count("not_understood", s.session.not_understood);
  visitor.count("encoder_jumps", s.session.encoder_jumps);
  visitor.flag("accelerometer_believed", s.samples.accelerometer.verdict() != AccelerometerCheck::Verdict::Refused);
  visitor.count("stops_for_want_of_commands", s.driver.watchdog_stops);
  visitor.count("commands_clamped", s.driver.clamped);
  visitor.count("commands_not_finite", s.driver.not_finite);
  visitor.count("links_opened", s.links_opened);
  visitor.count("bytes_in", s.bytes.bytes_in);
  visitor.count("bytes_out", s.bytes.bytes_out);
  visitor.number("rolled_left_m", s.odometry.left_m);
  visitor.number("rolled_right_m", s.odometry.right_m);
}

Odometry EpuckBridge::odometry() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.odometry();
}

BridgeStatus EpuckBridge::status() const {
  const std::lock_guard lock(mutex_);
  const Conversation& session = driver_.session();
  BridgeStatus status;
  status.state = session.state();
  status.trouble = link_error_.empty() ? session.trouble() : link_error_;
  status.link = link_ != nullptr ? link_->name() : "";
  status.stopped = driver_.stopped();
  status.identity = session.identity();
  status.layout = session.layout();
  status.samples = session.samples();
  status.odometry = driver_.odometry();
  status.session = session.statistics();
  status.driver = driver_.statistics();
  status.bytes = link_ != nullptr ? sum(bytes_before_, link_->statistics()) : bytes_before_;
  status.links_opened = reached_.session;
  return status;
}

}  // namespace tandem::bridges::epuck
