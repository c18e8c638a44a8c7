#include "bridges/footbot/bridge.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <poll.h>

#include "hal/check.hpp"

namespace tandem::bridges::footbot {
namespace {

using hal::TimeNs;

constexpr TimeNs kLongestWait = 20 * hal::kNsPerMs;  // then deadlines and the end are looked at
constexpr TimeNs kBlindWait = hal::kNsPerMs;         // where there is nothing to wait on

}  // namespace

FootbotBridge::FootbotBridge(BridgeSettings settings, aseba::MessageLinkOpener opener, hal::Log log)
    : settings_(std::move(settings)), link_(std::move(opener)), driver_(settings_.driver, link_, std::move(log)) {}

FootbotBridge::~FootbotBridge() {
  shut_down();
}

void FootbotBridge::start() {
  TANDEM_CHECK(!thread_.joinable() && !ending_, "a bridge is started once");
  driver_.note_ports();
  thread_ = std::thread([this] { run(); });
}

void FootbotBridge::shut_down() {
  ending_ = true;
  if (thread_.joinable()) thread_.join();
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

// --- the thread ---

void FootbotBridge::run() {
  while (!ending_) {
    const TimeNs now = monotonic_ns();
    TimeNs wait = 0;
    int descriptor = -1;
    {
      const std::lock_guard lock(mutex_);
      const RobotState before = driver_.state();
      driver_.pump(now);
      if (driver_.state() != before) changed_.notify_all();
      wait = std::clamp<TimeNs>(driver_.next_deadline() - now, 0, kLongestWait);
      descriptor = link_.descriptor();
    }
    wait_outside(wait, descriptor);
  }
  say_farewell();
}

void FootbotBridge::wait_outside(TimeNs timeout_ns, int descriptor) {
  if (descriptor < 0) timeout_ns = std::min(timeout_ns, kBlindWait);
  pollfd p{descriptor, POLLIN, 0};
  const timespec t{0, static_cast<long>(timeout_ns)};
  const bool ready = ::ppoll(&p, descriptor < 0 ? 0 : 1, &t, nullptr) > 0;
  if (!ready || (p.revents & POLLIN) != 0) return;
  const timespec pause{0, kBlindWait};  // the line is dead: a loop of waits must not spin
  ::nanosleep(&pause, nullptr);
}

void FootbotBridge::say_farewell() {
  const TimeNs end = monotonic_ns() + settings_.farewell_ns;
  for (bool said = false; true; said = true) {
    int descriptor = -1;
    {
      const std::lock_guard lock(mutex_);
      const TimeNs now = monotonic_ns();
      if (!said) {
        driver_.stop(now);
      } else {
        driver_.pump(now);
      }
      if (settings_.driver.observe || driver_.at_rest() || now >= end || link_.state() != aseba::Carrier::Up) return;
      descriptor = link_.descriptor();
    }
    wait_outside(kBlindWait, descriptor);
  }
}

// --- the loop ---

hal::Status FootbotBridge::wait_active(TimeNs timeout_ns) {
  std::unique_lock lock(mutex_);
  const auto active = [this] { return ending_ || driver_.state() == RobotState::Active; };
  if (changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), active) && !ending_) return {};
  const std::string who = "foot-bot '" + std::string(driver_.robot().id()) + "' is not there: ";
  if (!link_.trouble().empty()) return hal::Error{who + link_.trouble()};
  const std::string trouble = driver_.trouble();
  return hal::Error{who + (trouble.empty() ? "its nodes do not answer" : trouble) +
                    "; is it switched on, and are its nodes and their variables called as in the map?"};
}

void FootbotBridge::latch(hal::Tick tick, TimeNs now) noexcept {
  const std::lock_guard lock(mutex_);
  driver_.latch(tick, now);
}

void FootbotBridge::commit(TimeNs now) noexcept {
  const std::lock_guard lock(mutex_);
  driver_.commit(now);
}

void FootbotBridge::fault(TimeNs now, std::string_view why) {
  const std::lock_guard lock(mutex_);
  driver_.fault(now, why);
}

void FootbotBridge::stop(TimeNs now) noexcept {
  const std::lock_guard lock(mutex_);
  driver_.stop(now);
}

void FootbotBridge::resume() noexcept {
  const std::lock_guard lock(mutex_);
  driver_.resume();
}

RobotState FootbotBridge::state() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.state();
}

bool FootbotBridge::at_rest() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.at_rest();
}

DriverStatistics FootbotBridge::statistics() const noexcept {
  const std::lock_guard lock(mutex_);
  return driver_.statistics();
}

BridgeStatus FootbotBridge::status() const {
  const std::lock_guard lock(mutex_);
  BridgeStatus status;
  status.state = driver_.state();
  status.trouble = link_.trouble().empty() ? driver_.trouble() : link_.trouble();
  status.link_trouble = link_.trouble();
  status.link = link_.name();
  status.stopped = driver_.stopped();
  status.at_rest = driver_.at_rest();
  status.nodes = driver_.wiring().nodes();
  status.driver = driver_.statistics();
  status.wiring = driver_.wiring().statistics();
  status.network = driver_.network().statistics();
  status.messages = link_.statistics();
  status.links_opened = link_.openings();
  return status;
}

std::vector<LastWords> FootbotBridge::last_words() const {
  const std::lock_guard lock(mutex_);
  return driver_.wiring().last_words();
}

}  // namespace tandem::bridges::footbot
