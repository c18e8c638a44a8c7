#include "bridges/guardian/watched_robot.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "hal/monotonic.hpp"

namespace tandem::bridges::guardian {
namespace {

using hal::TimeNs;

constexpr TimeNs kShortestStep = 5 * hal::kNsPerMs;
constexpr TimeNs kUnreachablePause = 100 * hal::kNsPerMs;
constexpr TimeNs kHubMayBeDying = 500 * hal::kNsPerMs;  // its guardian has not noticed yet
constexpr TimeNs kLetGoWithin = 3 * hal::kNsPerSecond;  // a guardian that is asked to
constexpr TimeNs kTryLockEvery = 10 * hal::kNsPerMs;

using hal::monotonic_ns;

void sleep_for(TimeNs ns) noexcept {
  const timespec t{static_cast<time_t>(ns / hal::kNsPerSecond), static_cast<long>(ns % hal::kNsPerSecond)};
  ::nanosleep(&t, nullptr);
}

/// Asks the guardian that was left behind by its hub for one robot.
void ask_to_let_go(const std::string& folder, pid_t guardian, const std::string& key) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = takeover_socket(folder, guardian);
  if (path.size() >= sizeof address.sun_path) return;
  std::strcpy(address.sun_path, path.c_str());
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return;
  ::sendto(fd, key.data(), key.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::close(fd);
}

}  // namespace

WatchedRobot::WatchedRobot(const GuardianContext& context, const StopMessages& robot)
    : context_(context), key_(lock_key(robot)), robot_(robot) {}

WatchedRobot::~WatchedRobot() {
  let_go();
  if (thread_.joinable()) thread_.join();
}

hal::Status WatchedRobot::start() {
  try {
    thread_ = std::thread([this] { run(); });
    return {};
  } catch (const std::system_error& e) {
    return hal::Error{"the guardian process gets no thread for robot '" + robot_.robot + "': " + e.what()};
  }
}

// --- from the main loop ---

void WatchedRobot::watch(const StopMessages& robot) {
  const std::lock_guard lock(mutex_);
  if (watched_ && !released_ && robot == robot_) return;
  watched_ = true;
  released_ = false;
  robot_ = robot;
  confirmed_ = false;
  ++order_;
  write_lock_file();
  wake_.notify_all();
}

void WatchedRobot::release() {
  const std::lock_guard lock(mutex_);
  released_ = true;
  stopping_ = false;
  ++order_;
  wake_.notify_all();
}

void WatchedRobot::stop(StopCause cause) {
  const std::lock_guard lock(mutex_);
  if (!watched_ || released_ || quit_) return;
  cause_ = cause;
  stopping_ = true;
  confirmed_ = false;
  ++order_;
  wake_.notify_all();
  if (cause == StopCause::HubGone) write_lock_file();
}

void WatchedRobot::hold() {
  const std::lock_guard lock(mutex_);
  stopping_ = false;
  ++order_;
  wake_.notify_all();
}

void WatchedRobot::let_go() {
  const std::lock_guard lock(mutex_);
  quit_ = true;
  stopping_ = false;
  ++order_;
  wake_.notify_all();
  if (!busy_) file_.reset();  // else the thread does, once its link is closed
}

WatchedRobot::View WatchedRobot::view() const {
  const std::lock_guard lock(mutex_);
  const bool given_up = released_ || claim_ == Claim::Refused;
  return {watched_ && !released_ && !quit_, !busy_, given_up, confirmed_, state_, trouble_, robot_.robot, robot_.link};
}

void WatchedRobot::write_lock_file() const {
  if (file_) file_->write({robot_, context_.hub, ::getpid(), stopping_ && cause_ == StopCause::HubGone});
}

// --- the thread ---

void WatchedRobot::run() {
  std::unique_lock lock(mutex_);
  while (!quit_) {
    if (claim_ == Claim::Due) {
      lock.unlock();
      take_lock();
      lock.lock();
    } else if (stopping_ && obeyed_ != order_) {
      stop_robot(lock);
    } else {
      wake_.wait(lock);
    }
  }
  file_.reset();
}

void WatchedRobot::take_lock() {
  const std::string refused = try_to_lock();
  {
    const std::lock_guard lock(mutex_);
    claim_ = refused.empty() ? Claim::Held : Claim::Refused;
    write_lock_file();
  }
  context_.say_to_hub({Word::Claimed, robot_, refused});
}

/// @returns why it was refused; "" when it was not.
std::string WatchedRobot::try_to_lock() {
  if (std::ranges::find(context_.types, robot_.kind, &StopperType::kind) == context_.types.end()) {
    return "no guardian knows how to stop a robot of the kind '" + robot_.kind + "'";
  }
  const TimeNs begin = monotonic_ns();
  bool asked = false;
  std::optional<LockHolder> holder;  // the last one that was seen: who lets go removes his file
  for (;;) {
    std::optional<LockHolder> seen;
    auto taken = RobotLock::take(context_.folder, key_, seen);
    if (!taken.ok()) return taken.error().message;
    if (seen) holder = seen;
    const std::lock_guard lock(mutex_);
    if (taken.value()) {
      file_ = std::move(*taken.value());
      // What its last guardian knew is better than nothing until the hub has found the robot.
      const bool inherits = holder && robot_.body.empty() && holder->robot.kind == robot_.kind;
      if (inherits) robot_.body = holder->robot.body;
      watched_ = watched_ || (inherits && !robot_.body.empty());
      return {};
    }
    if (quit_) return "given up";
    const bool left = holder && holder->left;
    if (left && !asked) ask_to_let_go(context_.folder, holder->guardian, key_);
    asked = asked || left;
    if (monotonic_ns() - begin >= (asked ? kLetGoWithin : kHubMayBeDying)) {
      const std::string who = "robot '" + robot_.robot + "' on " + robot_.link;
      if (!holder) return who + " is driven by another program";
      if (left) {
        return who + " is still being stopped by process " + std::to_string(holder->guardian) +
               ", which does not let go of it; end that one with: kill " + std::to_string(holder->guardian);
      }
      return who + " is driven by process " + std::to_string(holder->hub) +
             (holder->robot.robot != robot_.robot ? ", as '" + holder->robot.robot + "'" : "") +
             "; end that one first, a robot has one hub";
    }
    sleep_for(kTryLockEvery);
  }
}

std::unique_ptr<Stopper> WatchedRobot::make_stopper() const {
  const auto type = std::ranges::find(context_.types, robot_.kind, &StopperType::kind);
  return type == context_.types.end() ? nullptr : type->make(robot_, cause_);
}

/// Until the robot has confirmed, or another order came.
void WatchedRobot::stop_robot(std::unique_lock<std::mutex>& lock) {
  const std::uint64_t order = order_;
  busy_ = true;
  std::unique_ptr<Stopper> stopper;
  while (order == order_) {
    if (!stopper) stopper = make_stopper();
    lock.unlock();
    StopState state = StopState::Unreachable;
    std::string trouble;
    const TimeNs begin = monotonic_ns();
    try {
      if (stopper) state = stopper->step(begin);
      if (stopper && state != StopState::Confirmed) trouble = stopper->trouble();
    } catch (const std::exception& e) {
      trouble = e.what();  // out of memory, no more threads: the next step tries again
    }
    const TimeNs took = monotonic_ns() - begin;
    lock.lock();
    if (order != order_) break;
    const bool told = state == state_ && trouble == trouble_;
    state_ = state;
    trouble_ = trouble;
    if (state == StopState::Confirmed) {
      confirmed_ = true;
      obeyed_ = order;
      break;
    }
    if (!told) context_.wake();
    const TimeNs pause = (state == StopState::Unreachable ? kUnreachablePause : kShortestStep) - took;
    if (pause > 0) wake_.wait_for(lock, std::chrono::nanoseconds(pause), [&] { return order != order_; });
  }
  lock.unlock();
  stopper.reset();  // closes its link
  lock.lock();
  busy_ = false;
  context_.wake();
}

}  // namespace tandem::bridges::guardian
