#include "bridges/guardian/process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <malloc.h>
#include <map>
#include <memory>
#include <mutex>
#include <poll.h>
#include <pthread.h>
#include <set>
#include <sstream>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <unistd.h>
#include <vector>

#include "bridges/guardian/stopped_process.hpp"
#include "bridges/guardian/watched_robot.hpp"
#include "hal/boottime.hpp"
#include "hal/monotonic.hpp"

namespace tandem::bridges::guardian {
namespace {

using hal::TimeNs;

constexpr TimeNs kSayAfter = hal::kNsPerSecond;  // that a robot has not stopped
constexpr int kLookEvery_ms = 20;
#ifdef __SANITIZE_THREAD__
constexpr std::size_t kStack = 8 * 1024 * 1024;  // its own variables lie on a thread's stack too
#else
constexpr std::size_t kStack = 512 * 1024;
#endif

using hal::monotonic_ns;

/// -1 where the kernel has none (before Linux 5.3): then the parent's number alone tells of the death, a little later.
int open_pidfd(pid_t process) noexcept {
#ifdef SYS_pidfd_open
  return static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
#else
  return static_cast<int>(::syscall(434, process, 0));
#endif
}

/// Closes everything but the standard descriptors and `kept`.
void close_others(int kept) noexcept {
  const auto close_from_to = [](unsigned first, unsigned last) {
    if (first > last || ::close_range(first, last, 0) == 0) return;
    const long limit = std::min<long>(::sysconf(_SC_OPEN_MAX), 65536);
    for (long fd = first; fd <= std::min<long>(last, limit); ++fd) ::close(static_cast<int>(fd));
  };
  const auto k = static_cast<unsigned>(kept);
  if (k > 3) close_from_to(3, k - 1);
  close_from_to(std::max(k + 1, 3U), ~0U);
}

/// What there is now, and what will be used later; the latter not where it is limited, since then threads and memory
/// for them would be refused when robots are to be stopped.
bool lock_memory() noexcept {
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  ::pthread_attr_setstacksize(&attributes, kStack);
  ::pthread_setattr_default_np(&attributes);  // also for threads of libraries
  ::pthread_attr_destroy(&attributes);
  ::mallopt(M_ARENA_MAX, 1);  // an arena a thread would be locked memory for nothing
  if (::mlockall(MCL_CURRENT) != 0) return false;
  rlimit limit{};
  const bool unlimited =
      ::geteuid() == 0 || (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
  if (unlimited) ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT);
  return true;
}

class Process {
 public:
  explicit Process(const Inheritance& inheritance)
      : in_(inheritance), pulse_(inheritance.limits), own_(inheritance.limits) {}

  [[noreturn]] void run();

 private:
  enum class Hub : std::uint8_t { Alive, Frozen, Back, Ended, Gone };

  void settle_in();
  void open_takeover_socket();
  void beat();
  void woke_up(TimeNs slept_ns);
  void look_at_hub();
  void look_at_robots();
  void take_from_hub();
  void obey(const Packet& packet);
  void claim(const StopMessages& robot);
  void take_signals();
  void take_takeovers();
  void stop_all(StopCause cause);
  void hand_back();
  void hub_is_gone();
  void tell(const std::string& line) const;
  void tell_of_unstopped();
  [[noreturn]] void leave();

  Inheritance in_;
  Pulse pulse_;  // the hub's
  OwnPulse own_;
  GuardianContext context_;
  std::map<std::string, std::unique_ptr<WatchedRobot>> robots_;
  std::mutex say_mutex_;
  int pidfd_ = -1, signals_ = -1, wake_ = -1, takeover_ = -1;
  Hub hub_ = Hub::Alive;
  bool handing_back_ = false;
  TimeNs stopped_ns_ = 0;  // when the stop was begun
  bool told_ = false;
  std::map<std::string, std::string> told_hub_;  // of each robot
  std::set<std::string> handed_over_;            // of which it was told
  std::map<std::string, std::string> lost_;      // of which it was told that somebody else has their lines, and who
  std::vector<char> buffer_ = std::vector<char>(kLongestPacket);
};

void Process::settle_in() {
  sigset_t all;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, nullptr);  // Ctrl-C, hang-ups and Ctrl-Z are the hub's affair
  ::setsid();
  ::prctl(PR_SET_NAME, "tandem-guard");
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nothing, 0);
  ::dup2(nothing, 1);
  close_others(in_.socket);
  if (::chdir("/") != 0) {  // only so that no folder is held
  }
  signals_ = ::signalfd(-1, &all, SFD_CLOEXEC | SFD_NONBLOCK);
  wake_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  pidfd_ = open_pidfd(in_.hub);
  const bool locked = lock_memory();
  const int why = errno;

  context_.types = in_.types;
  context_.hub = in_.hub;
  context_.say_to_hub = [this](const Packet& packet) {
    const std::string bytes = encode(packet);
    const std::lock_guard lock(say_mutex_);
    ::send(in_.socket, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  };
  context_.wake = [this] {
    const std::uint64_t one = 1;
    (void)!::write(wake_, &one, sizeof one);
  };
  if (!locked) {
    context_.say_to_hub({Word::Warning,
                         {},
                         std::string("the guardian process cannot lock its memory (") + std::strerror(why) +
                             "): on a machine that swaps it may stop robots late; see `ulimit -l`"});
  }
}

[[noreturn]] void Process::run() {
  settle_in();
  for (;;) {
    beat();
    std::array<pollfd, 5> fds = {{{in_.socket, POLLIN, 0},
                                  {hub_ == Hub::Gone ? -1 : pidfd_, POLLIN, 0},
                                  {signals_, POLLIN, 0},
                                  {wake_, POLLIN, 0},
                                  {takeover_, POLLIN, 0}}};
    ::poll(fds.data(), fds.size(), kLookEvery_ms);
    const bool dead = (fds[1].revents & POLLIN) != 0 || ::getppid() != in_.hub;
    if (dead || fds[0].revents != 0) take_from_hub();  // what it said last counts
    if (dead) hub_is_gone();
    if (fds[2].revents != 0) take_signals();
    if (fds[3].revents != 0) {
      std::uint64_t count = 0;
      (void)!::read(wake_, &count, sizeof count);
    }
    if (fds[4].revents != 0) take_takeovers();
    look_at_hub();
    look_at_robots();
  }
}

// --- the hub ---

void Process::beat() {
  in_.page->guardian_beats.fetch_add(1, std::memory_order_release);
  if (const TimeNs slept_ns = own_.slept(hal::boottime_ns()); slept_ns > 0) woke_up(slept_ns);
}

/// The hub may have been frozen as well, and have gone on before us; or it has stopped the robots for our sake. Either
/// way nothing is known of the time in between.
void Process::woke_up(TimeNs slept_ns) {
  pulse_.forget();
  if (hub_ != Hub::Alive && hub_ != Hub::Back) return;  // they are being stopped
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(),
                "the guardian process was frozen for %.1f s; awake again it stops all real robots once more",
                hal::to_seconds(slept_ns));
  context_.say_to_hub({Word::Warning, {}, text.data()});
  const bool handing_back = handing_back_;
  if (hub_ == Hub::Alive) hub_ = Hub::Frozen;  // as far as we know
  stop_all(StopCause::HubFrozen);
  handing_back_ = handing_back;
}

void Process::stop_all(StopCause cause) {
  in_.page->take_turn();
  for (const auto& [id, robot] : robots_) robot->stop(cause);
  told_hub_.clear();
  stopped_ns_ = monotonic_ns();
  handing_back_ = false;
}

void Process::look_at_hub() {
  if (hub_ != Hub::Alive) return;
  const std::uint32_t beats = in_.page->beats.load(std::memory_order_relaxed);
  if (!pulse_.frozen(beats, monotonic_ns(), [this] { return is_stopped(in_.hub); })) return;
  hub_ = Hub::Frozen;
  stop_all(StopCause::HubFrozen);
}

void Process::hub_is_gone() {
  if (hub_ == Hub::Gone) return;
  const bool stopping = hub_ == Hub::Ended;  // already, as robots of nobody
  hub_ = Hub::Gone;
  if (!stopping) stop_all(StopCause::HubGone);
}

void Process::take_from_hub() {
  for (;;) {
    const ssize_t n = ::recv(in_.socket, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (n > 0) {
      if (const auto packet = decode({buffer_.data(), static_cast<std::size_t>(n)})) obey(*packet);
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) return;
    // Nobody holds the other end any more; it may be a moment before the process is gone as well.
    ::close(in_.socket);
    in_.socket = -1;
    if (hub_ != Hub::Ended) hub_is_gone();
    return;
  }
}

void Process::obey(const Packet& packet) {
  const auto found = robots_.find(packet.robot.robot);
  switch (packet.word) {
    case Word::Claim:
      claim(packet.robot);
      break;
    case Word::Watch:
      if (found == robots_.end()) break;
      found->second->watch(packet.robot);
      if (hub_ == Hub::Frozen || hub_ == Hub::Back) found->second->stop(StopCause::HubFrozen);  // as all others are
      break;
    case Word::Release:
      if (found != robots_.end()) found->second->release();
      break;
    case Word::Suspend:
      hub_ = Hub::Frozen;
      stop_all(StopCause::HubFrozen);
      break;
    case Word::Back:
      hub_ = Hub::Back;
      stop_all(StopCause::HubFrozen);
      break;
    case Word::TakeBack:
      handing_back_ = hub_ == Hub::Back;
      for (const auto& [id, robot] : robots_) robot->hold();
      break;
    case Word::End:
      hub_ = Hub::Ended;
      stop_all(StopCause::HubGone);
      break;
    default:
      break;
  }
}

void Process::claim(const StopMessages& robot) {
  if (robots_.empty()) open_takeover_socket();
  const std::string key = written_key(robot);
  const auto has_link = [&](const WatchedRobot& one) {
    return written_key(one.claimed()) == key || one.has_one_of({key});
  };
  std::erase_if(robots_, [&](const auto& one) {  // nobody drives it, so its locks and its name are free again
    const auto& [id, before] = one;
    const WatchedRobot::View view = before->view();
    return (id == robot.robot || has_link(*before)) && view.given_up && view.idle;
  });
  told_hub_.erase(robot.robot);
  for (const auto& [id, other] : robots_) {
    if (id != robot.robot && !has_link(*other)) continue;
    context_.say_to_hub({Word::Claimed, robot,
                         id == robot.robot
                             ? "robot '" + id + "' is claimed already"
                             : "robots '" + id + "' and '" + robot.robot + "' have the same link, " + robot.link});
    return;
  }
  auto watched = std::make_unique<WatchedRobot>(context_, robot);
  if (const hal::Status started = watched->start(); !started.ok()) {
    context_.say_to_hub({Word::Claimed, robot, started.error().message});
    return;
  }
  robots_[robot.robot] = std::move(watched);
}

void Process::hand_back() {
  handing_back_ = false;
  hub_ = Hub::Alive;
  for (const auto& [id, robot] : robots_) robot->hold();  // nothing begins to stop them anew
  pulse_.forget();
  in_.page->give_turn(in_.page->turn.load(std::memory_order_relaxed));
  context_.say_to_hub({Word::HandedBack, {}, ""});
}

// --- the robots ---

void Process::look_at_robots() {
  if (hub_ == Hub::Alive) return;
  bool all = true, idle = true;
  for (const auto& [id, robot] : robots_) {
    const WatchedRobot::View view = robot->view();
    idle = idle && view.idle;
    if (!view.handed_over.empty() && handed_over_.insert(id).second)
      tell("'" + id + "' on " + view.link + " was handed over to " + view.handed_over);
    if (!view.to_be_stopped) continue;
    if (!view.line_lost) lost_.erase(id);
    if (view.line_lost && std::exchange(lost_[id], view.trouble) != view.trouble)
      tell("'" + id + "' on " + view.link + " has not confirmed its stop: " + view.trouble);
    all = all && view.confirmed;
    StopMessages about;
    about.robot = id;
    Packet news{view.confirmed ? Word::Rests : Word::Moves, about, view.confirmed ? "" : view.trouble};
    std::string& told = told_hub_[id];
    std::string bytes = encode(news);
    if (bytes == told) continue;
    context_.say_to_hub(news);
    told = std::move(bytes);
  }
  if (hub_ == Hub::Back && (all || handing_back_) && idle) {
    hand_back();
    return;
  }
  if (hub_ != Hub::Gone && hub_ != Hub::Ended) return;
  if (all && idle) leave();
  if (!told_ && monotonic_ns() - stopped_ns_ >= kSayAfter) tell_of_unstopped();
}

void Process::tell(const std::string& line) const {
  const std::string text = "tandem: " + line + "\n";
  (void)!::write(STDERR_FILENO, text.data(), text.size());
}

void Process::tell_of_unstopped() {
  told_ = true;
  std::string names;
  for (const auto& [id, robot] : robots_) {
    const WatchedRobot::View view = robot->view();
    if (!view.to_be_stopped || view.confirmed) continue;
    names += (names.empty() ? "'" : "; '") + id + "' on " + view.link +
             (view.trouble.empty() ? "" : " (" + view.trouble + ")");
  }
  const std::string self = std::to_string(::getpid());
  tell("not stopped yet: " + names + "; process " + self + " goes on trying, until it is ended with: kill " + self);
  // Whoever reads a pipe to its end must not wait for robots.
  struct stat info {};
  if (::fstat(STDERR_FILENO, &info) == 0 && (S_ISFIFO(info.st_mode) || S_ISSOCK(info.st_mode)))
    ::dup2(0, STDERR_FILENO);
}

void Process::leave() {
  if (told_ && handed_over_.empty()) tell("all robots have confirmed their stop");
  if (told_ && !handed_over_.empty() && handed_over_.size() < robots_.size())
    tell("all others have confirmed their stop");
  for (const auto& [id, robot] : robots_) robot->let_go();
  if (takeover_ >= 0) ::unlink(takeover_socket(context_.folder, ::getpid()).c_str());
  ::_exit(0);
}

// --- other processes ---

void Process::take_signals() {
  signalfd_siginfo info{};
  while (::read(signals_, &info, sizeof info) == sizeof info) {
    // Before people were told they cannot mean it: a service manager ends all that a dead service has left.
    if (info.ssi_signo != SIGTERM || !told_) continue;
    tell_of_unstopped();
    tell("process " + std::to_string(::getpid()) + " was told to end: see to these robots by hand");
    told_ = false;
    leave();
  }
}

void Process::open_takeover_socket() {
  auto folder = lock_folder();
  if (!folder.ok()) {
    context_.say_to_hub({Word::Warning, {}, folder.error().message});
    return;
  }
  context_.folder = std::move(folder).value();
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = takeover_socket(context_.folder, ::getpid());
  if (path.size() >= sizeof address.sun_path) return;
  std::strcpy(address.sun_path, path.c_str());
  ::unlink(path.c_str());  // of a process that had the same number
  takeover_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (takeover_ >= 0) ::bind(takeover_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

/// Another hub's guardian asks for a line: its number, and the locks that it needs, a line each.
void Process::take_takeovers() {
  for (;;) {
    const ssize_t n = ::recv(takeover_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (n < 0) return;
    if (hub_ != Hub::Gone && hub_ != Hub::Ended) continue;
    std::istringstream in(std::string(buffer_.data(), static_cast<std::size_t>(n)));
    pid_t guardian = 0;
    std::vector<std::string> keys;
    in >> guardian;
    for (std::string key; in >> key;) keys.push_back(key);
    for (const auto& [id, robot] : robots_) {
      if (guardian > 0 && robot->has_one_of(keys)) robot->lend(keys, guardian);
    }
  }
}

}  // namespace

[[noreturn]] void guard(const Inheritance& inheritance) {
  static Process* process = nullptr;  // never destroyed: threads use it until the end
  process = new Process(inheritance);
  process->run();
}

}  // namespace tandem::bridges::guardian
