#include "bridges/guardian/watched_robot.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#include <utility>

#include "hal/monotonic.hpp"

namespace tandem::bridges::guardian {
namespace {

using hal::TimeNs;

constexpr TimeNs kShortestStep = 5 * hal::kNsPerMs;
constexpr TimeNs kUnreachablePause = 100 * hal::kNsPerMs;
constexpr TimeNs kHubMayBeDying = 500 * hal::kNsPerMs;  // its guardian has not noticed yet
constexpr TimeNs kLetGoWithin = 3 * hal::kNsPerSecond;  // a guardian that is asked to
constexpr TimeNs kTryLockEvery = 10 * hal::kNsPerMs;
constexpr TimeNs kLentAtLeast = kLetGoWithin + hal::kNsPerSecond;  // then whoever asked has the locks, or gave up

using hal::monotonic_ns;

void sleep_for(TimeNs ns) noexcept {
  const timespec t{static_cast<time_t>(ns / hal::kNsPerSecond), static_cast<long>(ns % hal::kNsPerSecond)};
  ::nanosleep(&t, nullptr);
}

/// Asks the guardian that was left behind by its hub for a robot's line.
void ask_to_lend(const std::string& folder, pid_t guardian, const std::vector<std::string>& keys) {
  std::string text = std::to_string(::getpid());
  for (const std::string& key : keys) text += "\n" + key;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = takeover_socket(folder, guardian);
  if (path.size() >= sizeof address.sun_path) return;
  std::strcpy(address.sun_path, path.c_str());
  const int fd = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return;
  ::sendto(fd, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  ::close(fd);
}

struct Asked {
  StopState state = StopState::Unreachable;
  std::string trouble;
};

Asked ask(Stopper* stopper, TimeNs now) {
  Asked asked;
  if (stopper == nullptr) return asked;
  try {
    asked.state = stopper->step(now);
    if (asked.state != StopState::Confirmed) asked.trouble = stopper->trouble();
  } catch (const std::exception& e) {
    asked.trouble = e.what();  // out of memory, no more threads: the next step tries again
  }
  return asked;
}

/// Closes its link, which may take a while, without the lock.
void close_link(std::unique_ptr<Stopper>& stopper, std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  stopper.reset();
  lock.lock();
}

}  // namespace

WatchedRobot::WatchedRobot(const GuardianContext& context, const StopMessages& robot)
    : context_(context), claimed_(robot), robot_(robot) {}

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
  trace_.begin(robot);
  confirmed_ = false;
  ++order_;
  const std::string address = address_key(robot);
  address_due_ = !address.empty() && !locks_.has(address);
  write_lock_files();
  wake_.notify_all();
}

void WatchedRobot::release() {
  const std::lock_guard lock(mutex_);
  released_ = true;
  stopping_ = false;
  ++order_;
  write_lock_files();
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
  if (cause == StopCause::HubGone) write_lock_files();
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
  if (busy_) return;  // the thread does it, once its link is closed
  locks_.free_all();
  left_.free_all();
}

void WatchedRobot::lend(const std::vector<std::string>& keys, pid_t guardian) {
  const std::lock_guard lock(mutex_);
  if (!stopping_ || quit_) return;
  lent_keys_ = keys;
  lent_to_ = guardian;
  lent_until_ns_ = monotonic_ns() + kLentAtLeast;
  wake_.notify_all();
}

bool WatchedRobot::has_one_of(const std::vector<std::string>& keys) const {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(keys, [this](const std::string& key) { return locks_.has(key); });
}

WatchedRobot::View WatchedRobot::view() const {
  const std::lock_guard lock(mutex_);
  const bool given_up = released_ || claim_ == Claim::Refused;
  const bool ours = watched_ && !released_ && !quit_ && handed_over_.empty();
  return {ours, !busy_, given_up, confirmed_, line_lost_, handed_over_, state_, trouble_, robot_.robot, robot_.link};
}

void WatchedRobot::write_lock_files() const {
  const bool left = stopping_ && cause_ == StopCause::HubGone;
  const LockState state = released_   ? LockState::Rests
                          : left      ? LockState::Left
                          : !watched_ ? LockState::Claimed
                                      : LockState::Driven;
  const LockHolder holder{robot_, context_.hub, ::getpid(), state};
  locks_.write(holder);
  left_.write(holder);
}

// --- the thread ---

void WatchedRobot::run() {
  std::unique_lock lock(mutex_);
  while (!quit_) {
    if (claim_ == Claim::Due) {
      lock.unlock();
      take_locks();
      lock.lock();
    } else if (std::exchange(address_due_, false)) {
      take_address_lock();
    } else if (stopping_ && obeyed_ != order_) {
      stop_robot(lock);
    } else {
      wake_.wait(lock);
    }
  }
  locks_.free_all();
  left_.free_all();
}

void WatchedRobot::take_locks() {
  const std::string refused = try_to_lock();
  {
    const std::lock_guard lock(mutex_);
    claim_ = refused.empty() ? Claim::Held : Claim::Refused;
    if (claim_ == Claim::Refused) locks_.free_all();
    write_lock_files();
  }
  context_.say_to_hub({Word::Claimed, claimed_, refused});
}

/// That a robot is reached over two links shows only now, when two hubs drive it already.
void WatchedRobot::take_address_lock() {
  std::optional<LockHolder> holder;
  const auto taken = locks_.add(context_.folder, address_key(robot_), holder);
  write_lock_files();
  if (!taken.ok() || taken.value() || !holder || holder->state == LockState::Left) return;
  context_.say_to_hub({Word::Warning,
                       {},
                       "robot '" + robot_.robot + "' on " + robot_.link + " has the address of '" +
                           holder->robot.robot + "' on " + holder->robot.link + ", which process " +
                           std::to_string(holder->hub) + " drives: is it one robot with two hubs? End one of them"});
}

/// @returns why it was refused; "" when it was not.
std::string WatchedRobot::try_to_lock() {
  if (std::ranges::find(context_.types, claimed_.kind, &StopperType::kind) == context_.types.end()) {
    return "no guardian knows how to stop a robot of the kind '" + claimed_.kind + "'";
  }
  const std::vector<std::string> keys = lock_keys(claimed_);
  const TimeNs begin = monotonic_ns();
  bool asked = false;
  std::optional<LockHolder> holder;  // the last one that was seen: who lets go removes his file
  for (;;) {
    std::unique_lock lock(mutex_);
    const auto taken = locks_.change_to(context_.folder, keys, holder);
    if (!taken.ok()) return taken.error().message;
    if (taken.value()) {
      // What its last guardian knew, who was killed, is better than nothing until the hub has found the robot.
      const bool inherits = holder && !asked && robot_.body.empty() && holder->robot.kind == robot_.kind;
      if (inherits) robot_.body = holder->robot.body;
      watched_ = watched_ || (inherits && !robot_.body.empty());
      return {};
    }
    if (quit_) return "given up";
    lock.unlock();
    const bool left = holder && holder->state == LockState::Left;
    if (left && !asked) ask_to_lend(context_.folder, holder->guardian, keys);
    asked = asked || left;
    if (monotonic_ns() - begin >= (asked ? kLetGoWithin : kHubMayBeDying))
      return refusal(holder ? &*holder : nullptr, asked);
    sleep_for(kTryLockEvery);
  }
}

std::string WatchedRobot::refusal(const LockHolder* holder, bool asked) const {
  const std::string who = "robot '" + claimed_.robot + "' on " + claimed_.link;
  if (holder == nullptr) return who + " is driven by another program";
  if (holder->guardian == ::getpid())
    return "robots '" + holder->robot.robot + "' and '" + claimed_.robot + "' have the same link, " + claimed_.link;
  if (asked && holder->state == LockState::Left) {
    return who + " is still being stopped by process " + std::to_string(holder->guardian) +
           ", which does not let go of it; end that one with: kill " + std::to_string(holder->guardian);
  }
  return who + " is driven by process " + std::to_string(holder->hub) +
         (holder->robot.robot != claimed_.robot ? ", as '" + holder->robot.robot + "'" : "") +
         "; end that one first, a robot has one hub";
}

/// Whether somebody has asked for the line, and may be taking it.
bool WatchedRobot::lent(TimeNs now) {
  if (lent_to_ == 0) return false;
  locks_.free(lent_keys_);
  const bool over = now >= lent_until_ns_ || (::kill(lent_to_, 0) != 0 && errno == ESRCH);
  if (over) lent_to_ = 0;
  return !over;
}

/// @returns false, for its caller.
bool WatchedRobot::give_up_line(const std::string& why) {
  state_ = StopState::Unreachable;
  line_lost_ = !why.empty();
  trouble_ = why;
  return false;
}

/// Whether what is sent on the robot's link, as written, may go to whom that leads to now. Not to a robot that a living
/// hub drives: if that is another one, the stop is not meant for it; if it is ours, that hub has stopped it first.
bool WatchedRobot::line_is_ours() {
  StopMessages robot;
  {
    const std::lock_guard lock(mutex_);
    robot = robot_;
    if (lent(monotonic_ns())) return give_up_line("");
  }
  const std::vector<std::string> keys = lock_keys(robot);
  const std::lock_guard lock(mutex_);
  trace_.look();
  std::optional<LockHolder> holder;
  const auto taken = locks_.change_to(context_.folder, keys, holder);
  if (!taken.ok()) return true;  // no lock can be had: to stop it counts for more
  if (taken.value()) {
    line_lost_ = false;
    write_lock_files();
    return true;
  }
  const SameRobot same = holder ? trace_.same_as(holder->robot) : SameRobot::Unknown;
  const std::string whose =
      holder ? "process " + std::to_string(holder->hub) + ", which drives it as '" + holder->robot.robot + "'"
             : "another program";
  if (same == SameRobot::Yes && holder->state == LockState::Driven) {
    handed_over_ = whose;
    return give_up_line("");
  }
  return give_up_line(same == SameRobot::No
                          ? "its link leads to another robot now, of " + whose
                          : "its link is held by " + whose + ", and nobody knows whether it is the same robot");
}

std::unique_ptr<Stopper> WatchedRobot::make_stopper() const {
  const auto type = std::ranges::find(context_.types, robot_.kind, &StopperType::kind);
  return type == context_.types.end() ? nullptr : type->make(robot_, cause_);
}

/// Until the robot has confirmed, or was handed over, or another order came.
void WatchedRobot::stop_robot(std::unique_lock<std::mutex>& lock) {
  const std::uint64_t order = order_;
  busy_ = true;
  if (cause_ == StopCause::HubGone) {
    std::optional<LockHolder> nobody;
    (void)left_.change_to(context_.folder, {left_key(robot_, ::getpid())}, nobody);
    write_lock_files();
  }
  std::unique_ptr<Stopper> stopper;
  std::optional<std::string> opened_at;  // the device that the stopper's link led to
  bool reached = true;                   // at first there is no time to lose
  while (order == order_) {
    const TimeNs begin = monotonic_ns();
    if (cause_ == StopCause::HubGone && (!reached || lent_to_ != 0)) {
      if (lent_to_ != 0) close_link(stopper, lock);
      const std::string told = trouble_;
      lock.unlock();
      const bool ours = line_is_ours();
      lock.lock();
      if (order != order_) break;
      if (!handed_over_.empty()) {
        obeyed_ = order;
        break;
      }
      if (!ours) {
        reached = false;
        if (trouble_ != told) context_.wake();
        wake_.wait_for(lock, std::chrono::nanoseconds(kUnreachablePause), [&] { return order != order_; });
        continue;
      }
    }
    trace_.look();
    if (stopper && trace_.leads_to() != opened_at) {  // it holds a line that is not this robot's any more
      close_link(stopper, lock);
      if (order != order_) break;
    }
    if (!stopper) {
      opened_at = trace_.leads_to();
      stopper = make_stopper();
    }
    lock.unlock();
    auto [state, trouble] = ask(stopper.get(), begin);
    const TimeNs end = monotonic_ns();
    lock.lock();
    if (order != order_) break;
    reached = state != StopState::Unreachable;
    trace_.tried(reached, end);
    if (state == StopState::Confirmed) {
      trace_.look();
      const bool heard_there = trace_.leads_to() == opened_at;  // else that was somebody else
      if (heard_there && trace_.proved()) {
        confirmed_ = true;
        state_ = state;
        trouble_.clear();
        obeyed_ = order;
        break;
      }
      // Whoever it was rests; ours may come back. To be asked again, the line has to be opened anew.
      state = StopState::Unreachable;
      trouble = "a robot at its link rests, but the line was broken meanwhile: it may be another one";
      reached = !heard_there;  // then ours is looked for at once
      close_link(stopper, lock);
      if (order != order_) break;
    }
    const bool told = state == state_ && trouble == trouble_;
    state_ = state;
    trouble_ = trouble;
    if (!told) context_.wake();
    const TimeNs pause = (state == StopState::Unreachable ? kUnreachablePause : kShortestStep) - (end - begin);
    if (pause > 0) wake_.wait_for(lock, std::chrono::nanoseconds(pause), [&] { return order != order_; });
  }
  close_link(stopper, lock);
  busy_ = false;
  context_.wake();
}

}  // namespace tandem::bridges::guardian
