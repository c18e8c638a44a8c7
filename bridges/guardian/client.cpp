#include "bridges/guardian/client.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <new>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "bridges/guardian/packet.hpp"
#include "bridges/guardian/process.hpp"
#include "bridges/guardian/shared_page.hpp"
#include "bridges/guardian/stopped_process.hpp"
#include "hal/boottime.hpp"
#include "hal/monotonic.hpp"

namespace tandem::bridges::guardian {
namespace {

using hal::TimeNs;

constexpr TimeNs kHandBackWithin = hal::kNsPerSecond;  // after a freeze, whether all have confirmed or not
constexpr TimeNs kSleepWithin = 300 * hal::kNsPerMs;   // Ctrl-Z
constexpr auto kClaimWithin = std::chrono::seconds(10);

using hal::monotonic_ns;

}  // namespace

class GuardianClient::Heart {
 public:
  Heart(std::vector<StopperType> types, const GuardianOptions& options, SharedPage& page, int socket, pid_t process)
      : types_(std::move(types)),
        options_(options),
        page_(page),
        socket_(socket),
        process_(process),
        guardian_pulse_(options.limits),
        own_(options.limits) {
    // Signals are for the other threads: their waits are to be interrupted.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] { run(); });
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~Heart() { end(0); }

  std::vector<hal::Status> claim_each(std::span<const StopMessages> robots);
  void watch(const StopMessages& robot);
  void release(const std::string& robot);
  std::vector<UnstoppedRobot> end(TimeNs timeout_ns);
  std::vector<std::string> take_news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
  }

  SendPermit permit() const noexcept {
    const TimeNs oldest_ns = options_.limits.beat_ns + options_.limits.asleep_ns;
    return SendPermit(page_.turn, {&page_.hub_beat_ms, static_cast<std::uint32_t>(oldest_ns / hal::kNsPerMs)});
  }
  Freezes freezes() const noexcept { return {freezes_.load(), last_freeze_ns_.load()}; }
  bool guards() const noexcept { return lives_.load() && !guardian_frozen_.load(); }
  pid_t process() const noexcept { return process_; }

 private:
  struct Robot {
    StopMessages messages;
    bool claimed = false, watched = false;
    bool rests = false;  // the guardian has seen it
    std::string answer;  // to the claim; or what is known of it
    bool answered = false;
  };

  void run();
  void beat();
  void woke_up(TimeNs slept_ns);
  void look_at_guardian();
  void look_at_turn();
  void count_freeze(TimeNs lasted_ns, const std::string& what);
  void sleep_as_asked();
  void take_from_guardian(bool readable);
  void obey(const Packet& packet);
  void say(const Packet& packet);
  void flush();
  bool all_rest() const;

  std::vector<StopperType> types_;  // the guardian has its own copy
  GuardianOptions options_;
  SharedPage& page_;
  int socket_;
  pid_t process_;

  std::mutex mutex_;  // guards everything below but the atomics
  std::condition_variable changed_;
  std::deque<std::string> unsent_;
  std::map<std::string, Robot> robots_;
  std::vector<std::string> news_;
  bool ended_ = false, quit_ = false;
  bool declared_ = false;  // it was noticed that we were declared dead
  TimeNs beat_ns_ = 0, back_ns_ = 0;
  TimeNs asleep_since_ns_ = 0;  // 0: we are not, or nobody knew
  bool taking_back_ = false;
  std::atomic<std::uint64_t> freezes_{0};
  std::atomic<TimeNs> last_freeze_ns_{0};
  std::atomic<bool> lives_{true};  // the guardian
  std::atomic<bool> guardian_frozen_{false};
  Pulse guardian_pulse_;
  OwnPulse own_;
  std::vector<char> buffer_ = std::vector<char>(kLongestPacket);
  std::thread thread_;
};

// --- the thread ---

void GuardianClient::Heart::run() {
  beat_ns_ = monotonic_ns();
  for (;;) {
    page_.beats.fetch_add(1, std::memory_order_relaxed);
    pollfd p{lives_.load() ? socket_ : -1, POLLIN, 0};
    ::poll(&p, 1, static_cast<int>(options_.limits.beat_ns / hal::kNsPerMs));
    const std::lock_guard lock(mutex_);
    if (quit_) return;
    take_from_guardian(p.revents != 0);
    if (!ended_) beat();
    flush();
  }
}

void GuardianClient::Heart::beat() {
  const TimeNs slept_ns = own_.slept(hal::boottime_ns());
  look_at_guardian();
  look_at_turn();
  if (slept_ns > 0) woke_up(slept_ns);
  beat_ns_ = monotonic_ns();
  if (options_.suspend_asked != nullptr && options_.suspend_asked->exchange(false)) {
    asleep_since_ns_ = beat_ns_;
    say({Word::Suspend, {}, ""});
    for (auto& [id, robot] : robots_) robot.rests = false;
  }
  if (asleep_since_ns_ != 0) sleep_as_asked();
  page_.hub_beat_ms.store(hal::boottime_ms(), std::memory_order_release);  // last: until here nothing was written
}

void GuardianClient::Heart::count_freeze(TimeNs lasted_ns, const std::string& what) {
  last_freeze_ns_ = lasted_ns;
  ++freezes_;
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "this program was frozen for %.1f s", hal::to_seconds(lasted_ns));
  news_.emplace_back(text.data() + what);
}

/// We were frozen, and our guardian has not noticed: so was it, or it is gone.
void GuardianClient::Heart::woke_up(TimeNs slept_ns) {
  guardian_pulse_.forget();
  if (declared_) return;
  page_.withdraw_links();
  count_freeze(slept_ns,
               ", and its guardian process did not notice: real robots may have gone on with their last command; they "
               "are stopped now");
}

/// A guardian that is frozen guards nobody; what it was doing is for us to go on with.
void GuardianClient::Heart::look_at_guardian() {
  // Before its beats: one that wakes up right now takes a new turn after its beat, and keeps that.
  const std::uint32_t turn = page_.turn.load(std::memory_order_acquire);
  const std::uint32_t beats = page_.guardian_beats.load(std::memory_order_acquire);
  const bool frozen = lives_ && guardian_pulse_.frozen(beats, monotonic_ns(), [this] { return is_stopped(process_); });
  if (frozen && !guardian_frozen_.exchange(true)) {
    news_.emplace_back(
        "the guardian process is frozen, and nobody would stop real robots if this program were killed: they are "
        "stopped");
  } else if (!frozen && guardian_frozen_.exchange(false)) {
    news_.emplace_back("the guardian process is awake again");
  }
  if (lives_ && !frozen) return;
  page_.give_turn(turn);
  declared_ = false;
}

/// Whether it is the guardian's turn, and what then.
void GuardianClient::Heart::look_at_turn() {
  const bool theirs = page_.turn.load(std::memory_order_acquire) % 2 == 1;
  const TimeNs now = monotonic_ns();
  if (theirs && !declared_ && asleep_since_ns_ == 0) {
    declared_ = true;
    back_ns_ = now;
    taking_back_ = false;
    if (now - beat_ns_ >= options_.limits.stopped_ns) {
      count_freeze(now - beat_ns_, ": its guardian process has stopped all real robots");
    } else {
      ++freezes_;  // the guardian's own, of which it tells itself
    }
    say({Word::Back, {}, ""});
  } else if (declared_ && !taking_back_ && now - back_ns_ >= kHandBackWithin) {
    taking_back_ = true;
    say({Word::TakeBack, {}, ""});
  }
}

/// Ctrl-Z: waits for the guardian to have stopped all robots, or as long as a person may have to, and then sleeps.
void GuardianClient::Heart::sleep_as_asked() {
  const bool theirs = page_.turn.load(std::memory_order_acquire) % 2 == 1;
  if (!(theirs && all_rest()) && monotonic_ns() - asleep_since_ns_ < kSleepWithin) return;
  flush();
  beat_ns_ = asleep_since_ns_;
  asleep_since_ns_ = 0;
  ::pthread_kill(::pthread_self(), SIGSTOP);  // to this thread: nothing is done before it works
  if (!theirs) return;                        // there is no guardian to hand back
  (void)own_.slept(hal::boottime_ns());       // that is known
  look_at_turn();
}

bool GuardianClient::Heart::all_rest() const {
  return std::ranges::all_of(robots_, [](const auto& row) { return !row.second.watched || row.second.rests; });
}

void GuardianClient::Heart::take_from_guardian(bool readable) {
  while (readable && lives_) {
    const ssize_t n = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (n > 0) {
      if (const auto packet = decode({buffer_.data(), static_cast<std::size_t>(n)})) obey(*packet);
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return;
    if (!ended_) look_at_turn();  // it may have stopped robots before it died
    lives_ = false;
    page_.give_turn(page_.turn.load(std::memory_order_acquire));
    declared_ = false;
    if (!ended_) {
      news_.emplace_back(
          "the guardian process is gone, and nobody would stop real robots if this program were killed: they are "
          "stopped, and "
          "do not drive any more in this run");
    }
    changed_.notify_all();
  }
}

void GuardianClient::Heart::obey(const Packet& packet) {
  const auto found = robots_.find(packet.robot.robot);
  switch (packet.word) {
    case Word::Claimed:
      if (found == robots_.end()) break;
      found->second.answered = true;
      found->second.answer = packet.text;
      break;
    case Word::Rests:
    case Word::Moves:
      if (found == robots_.end()) break;
      found->second.rests = packet.word == Word::Rests;
      found->second.watched = true;  // where it was taken over, the guardian knew earlier than we
      found->second.answer = packet.text;
      break;
    case Word::HandedBack:
      declared_ = false;
      break;
    case Word::Warning:
      news_.push_back(packet.text);
      break;
    default:
      break;
  }
  changed_.notify_all();
}

void GuardianClient::Heart::say(const Packet& packet) {
  unsent_.push_back(encode(packet));
  flush();
}

/// What the socket does not take now is sent with a later beat: a guardian that is busy must not hold up the loop.
void GuardianClient::Heart::flush() {
  for (; !unsent_.empty() && lives_; unsent_.pop_front()) {
    const std::string& bytes = unsent_.front();
    if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0 && errno == EAGAIN) return;
  }
}

// --- the hub's other threads ---

std::vector<hal::Status> GuardianClient::Heart::claim_each(std::span<const StopMessages> robots) {
  std::unique_lock lock(mutex_);
  for (const StopMessages& messages : robots) {
    Robot& robot = robots_[messages.robot];
    robot = {};
    robot.messages = messages;
    say({Word::Claim, messages, ""});
  }
  const auto answered = [&] {
    return !lives_ || std::ranges::all_of(robots, [&](const auto& m) { return robots_[m.robot].answered; });
  };
  const bool in_time = changed_.wait_for(lock, kClaimWithin, answered);
  std::vector<hal::Status> all;
  for (const StopMessages& messages : robots) {
    Robot& robot = robots_[messages.robot];
    robot.claimed = robot.answered && robot.answer.empty();
    if (!robot.answered)
      robot.answer = in_time ? "the guardian process has ended" : "the guardian process does not answer";
    all.push_back(robot.claimed ? hal::Status() : hal::Error{robot.answer});
  }
  return all;
}

void GuardianClient::Heart::watch(const StopMessages& messages) {
  const std::lock_guard lock(mutex_);
  const auto found = robots_.find(messages.robot);
  if (found == robots_.end() || !found->second.claimed) return;
  Robot& robot = found->second;
  if (robot.watched && robot.messages == messages) return;
  robot.watched = true;
  robot.messages = messages;
  say({Word::Watch, messages, ""});
}

void GuardianClient::Heart::release(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = robots_.find(id);
  if (found == robots_.end()) return;
  found->second.watched = false;
  Packet packet{Word::Release, {}, ""};
  packet.robot.robot = id;
  say(packet);
}

std::vector<UnstoppedRobot> GuardianClient::Heart::end(TimeNs timeout_ns) {
  std::vector<UnstoppedRobot> unstopped;
  {
    std::unique_lock lock(mutex_);
    if (ended_) return unstopped;
    for (auto& [id, robot] : robots_) robot.rests = false;
    say({Word::End, {}, ""});
    ended_ = true;
    page_.hub_beat_ms = 0;
    const auto done = [this] { return !lives_ || all_rest(); };
    changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), done);
    for (const auto& [id, robot] : robots_) {
      if (robot.watched && !robot.rests) unstopped.push_back({id, robot.messages.link, robot.answer});
    }
    const bool leaves = unstopped.empty();
    if (leaves) changed_.wait_for(lock, std::chrono::seconds(1), [this] { return !lives_; });
    quit_ = true;
  }
  thread_.join();
  ::close(socket_);
  ::waitpid(process_, nullptr, lives_ ? WNOHANG : 0);
  return unstopped;
}

// --- the outside ---

hal::Result<std::unique_ptr<GuardianClient>> GuardianClient::start(std::vector<StopperType> types,
                                                                   const GuardianOptions& options) {
  const auto failed = [] {
    return hal::Error{std::string("no guardian process can be made (") + std::strerror(errno) +
                      "): real robots would go on moving if this program were killed"};
  };
  void* memory = ::mmap(nullptr, sizeof(SharedPage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return failed();
  auto* page = new (memory) SharedPage;  // never unmapped: permits refer to it
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) return failed();
  const pid_t hub = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    return failed();
  }
  if (child == 0) guard({types, page, ends[1], hub, options.limits});
  ::prctl(PR_SET_PTRACER, child, 0, 0, 0);  // it may end our connections while we are frozen
  ::close(ends[1]);
  return std::unique_ptr<GuardianClient>(
      new GuardianClient(std::make_unique<Heart>(std::move(types), options, *page, ends[0], child)));
}

GuardianClient::GuardianClient(std::unique_ptr<Heart> heart) : heart_(std::move(heart)) {}
GuardianClient::~GuardianClient() = default;

hal::Status GuardianClient::claim(std::span<const StopMessages> robots) {
  const std::vector<hal::Status> all = claim_each(robots);
  const auto refused = std::ranges::find_if(all, [](const hal::Status& one) { return !one.ok(); });
  return refused == all.end() ? hal::Status() : *refused;
}
std::vector<hal::Status> GuardianClient::claim_each(std::span<const StopMessages> robots) {
  return heart_->claim_each(robots);
}
void GuardianClient::watch(const StopMessages& robot) {
  heart_->watch(robot);
}
void GuardianClient::release(const std::string& robot) {
  heart_->release(robot);
}
SendPermit GuardianClient::permit() const noexcept {
  return heart_->permit();
}
Freezes GuardianClient::freezes() const noexcept {
  return heart_->freezes();
}
bool GuardianClient::guards() const noexcept {
  return heart_->guards();
}
pid_t GuardianClient::process() const noexcept {
  return heart_->process();
}
std::vector<std::string> GuardianClient::take_news() {
  return heart_->take_news();
}
std::vector<UnstoppedRobot> GuardianClient::end(TimeNs timeout_ns) {
  return heart_->end(timeout_ns);
}

}  // namespace tandem::bridges::guardian
