#include "study/sweep/worker.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tandem::study {
namespace {

constexpr std::size_t kKept_bytes = 4'000;  // of what a run printed
constexpr double kShort_s = 0.5;
constexpr char kNextRun = '\0';  // in the words of a worker: what follows is its next run's

void close_now(int& fd) noexcept {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

bool send_all(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::send(fd, data, size, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

/// False: the other end is closed.
bool receive_all(int fd, char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = ::recv(fd, data, size, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

[[noreturn]] void work(int fd, const Worker::Make& make, bool one_run) {
  for (;;) {
    std::int64_t run = 0;
    if (!receive_all(fd, reinterpret_cast<char*>(&run), sizeof run)) _exit(0);
    while (::write(STDERR_FILENO, &kNextRun, 1) < 0 && errno == EINTR) {
    }
    const std::string message = message_of(run, make(run));
    if (!send_all(fd, message.data(), message.size())) _exit(0);
    if (one_run) _exit(0);
  }
}

std::string name_of_signal(int signal) {
  const char* const name = sigabbrev_np(signal);
  return name != nullptr ? "SIG" + std::string(name) : "signal " + std::to_string(signal);
}

}  // namespace

hal::Result<std::unique_ptr<Worker>> Worker::start(const Make& make, const std::function<void()>& in_child,
                                                   bool one_run) {
  std::unique_ptr<Worker> worker(new Worker);
  int ends[2] = {-1, -1}, pipe[2] = {-1, -1};
  const auto failed = [&](const char* what) {
    const int error = errno;
    for (int* fd : {&ends[0], &ends[1], &pipe[0], &pipe[1]}) close_now(*fd);
    return hal::Error{std::string("no worker can be started: ") + what + ": " + std::strerror(error)};
  };
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0 || pipe2(pipe, O_CLOEXEC) != 0)
    return failed("no pipe");
  std::fflush(nullptr);  // what is in buffers is the parent's to write
  const pid_t parent = getpid();
  worker->pid_ = fork();
  if (worker->pid_ < 0) return failed("no process");
  if (worker->pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
    for (const int signal : {SIGINT, SIGHUP, SIGQUIT}) std::signal(signal, SIG_IGN);  // for the parent
    for (const int signal : {SIGTERM, SIGXCPU, SIGALRM}) std::signal(signal, SIG_DFL);
    if (in_child) in_child();
    const int nothing = ::open("/dev/null", O_RDWR);
    if (nothing >= 0) {
      dup2(nothing, STDIN_FILENO);
      dup2(nothing, STDOUT_FILENO);
    }
    dup2(pipe[1], STDERR_FILENO);
    close_now(ends[0]);
    close_now(pipe[0]);
    close_now(pipe[1]);
    work(ends[1], make, one_run);
  }
  close_now(ends[1]);
  close_now(pipe[1]);
  worker->results_ = ends[0];
  worker->words_ = pipe[0];
  worker->one_run_ = one_run;
  (void)fcntl(worker->words_, F_SETFL, O_NONBLOCK);
  return worker;
}

Worker::~Worker() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  close_now(results_);
  close_now(words_);
}

bool Worker::give(std::int64_t run, double now_s) {
  if (!send_all(results_, reinterpret_cast<const char*>(&run), sizeof run)) return false;
  if (given_.empty()) since_s_ = now_s;
  given_.push_back(run);
  used_ = true;
  return true;
}

bool Worker::receive(std::vector<ToldOutcome>& told, double now_s) {
  char buffer[65536];
  const ssize_t n = ::recv(results_, buffer, sizeof buffer, MSG_DONTWAIT);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return true;
  if (n <= 0) return false;
  received_.append(buffer, static_cast<std::size_t>(n));
  while (auto message = take_message(received_)) {
    if (!given_.empty()) given_.pop_front();
    short_runs_ = now_s - since_s_ < kShort_s;
    since_s_ = now_s;
    told.push_back(std::move(*message));
  }
  return true;
}

void Worker::listen() {
  char buffer[4096];
  for (;;) {
    const ssize_t n = ::read(words_, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) close_now(words_);
    if (n <= 0) return;
    said_.append(buffer, static_cast<std::size_t>(n));
    // Words and outcomes come by two ways: only the words themselves tell which run they are of.
    if (const std::size_t last = said_.rfind(kNextRun); last != std::string::npos) said_.erase(0, last + 1);
    if (said_.size() > kKept_bytes) said_.erase(0, said_.size() - kKept_bytes);
  }
}

std::string Worker::end() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  if (words_ >= 0) listen();
  std::string said = std::exchange(said_, {});
  while (!said.empty() && (said.back() == '\n' || said.back() == ' ')) said.pop_back();
  if (!said.empty()) return said.starts_with("error: ") ? said.substr(7) : said;
  if (WIFSIGNALED(status)) {
    return "its process was ended by " + name_of_signal(WTERMSIG(status)) +
           (WTERMSIG(status) == SIGKILL ? "; is there memory enough?" : "");
  }
  return "its process ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace tandem::study
