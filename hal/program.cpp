#include "hal/program.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <poll.h>
#include <spawn.h>
#include <sstream>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace tandem::hal {
namespace {

constexpr int kPatience_ms = 60'000;
constexpr std::size_t kLastWords_bytes = 2'000;

void close_now(int& fd) noexcept {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

/// A file in memory; closed at the end.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("program", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (fd_ >= 0) close(fd_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  bool good() const { return fd_ >= 0; }
  int fd() const { return fd_; }

  bool fill(std::string_view text) const {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t n = write(fd_, text.data() + done, text.size() - done);
      if (n < 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return lseek(fd_, 0, SEEK_SET) == 0;
  }
  std::string text() const {
    std::string all;
    char buffer[65536];
    for (ssize_t n = 0; (n = pread(fd_, buffer, sizeof buffer, static_cast<off_t>(all.size()))) > 0;)
      all.append(buffer, static_cast<std::size_t>(n));
    return all;
  }
  std::string first_bytes() const {
    char buffer[kLastWords_bytes];
    const ssize_t n = pread(fd_, buffer, sizeof buffer, 0);
    return n > 0 ? std::string(buffer, static_cast<std::size_t>(n)) : std::string();
  }

 private:
  int fd_;
};

}  // namespace

std::string find_program(std::string_view name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (std::filesystem::path(folder.empty() ? "." : folder) / name).string();
    std::error_code error;
    if (::access(file.c_str(), X_OK) == 0 && !std::filesystem::is_directory(file, error)) return file;
  }
  return {};
}

Result<ProgramEnd> run_program(const std::string& path, const std::vector<std::string>& arguments,
                               std::string_view input) {
  const std::string name = std::filesystem::path(path).filename().string();
  const MemoryFile in, out, errors;
  if (!in.good() || !out.good() || !errors.good() || !in.fill(input)) return Error{"no memory to run " + name};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.fd(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.fd(), STDERR_FILENO);
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), name);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int failed = posix_spawn(&pid, path.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return Error{name + " cannot be started: " + std::strerror(failed)};
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return ProgramEnd{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), out.text(), errors.first_bytes()};
}

Result<std::unique_ptr<Program>> Program::start(const std::string& path, const std::vector<std::string>& arguments) {
  return start(path, arguments, false);
}

Result<std::unique_ptr<Program>> Program::start_source(const std::string& path,
                                                       const std::vector<std::string>& arguments) {
  return start(path, arguments, true);
}

Result<std::unique_ptr<Program>> Program::start(const std::string& path, const std::vector<std::string>& arguments,
                                                bool heard) {
  std::unique_ptr<Program> program(new Program());
  program->heard_ = heard;
  program->name_ = std::filesystem::path(path).filename().string();
  const auto failed = [&](int error) { return Error{program->name_ + " cannot be started: " + std::strerror(error)}; };
  int pipe[2] = {-1, -1};
  program->errors_ = memfd_create("errors", MFD_CLOEXEC);
  if (program->errors_ < 0 || ::pipe2(pipe, O_CLOEXEC) != 0) return failed(errno);
  const int ours = pipe[heard ? 0 : 1], its = pipe[heard ? 1 : 0];
  program->pipe_ = ours;
  // Large steps, and a feeder that can give up.
  (void)::fcntl(ours, F_SETPIPE_SZ, 1 << 20);
  (void)::fcntl(ours, F_SETFL, O_NONBLOCK);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (heard)
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&actions, its, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, heard ? its : program->errors_, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, program->errors_, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words = arguments;
  words.insert(words.begin(), program->name_);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int error = posix_spawn(&program->pid_, path.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  ::close(its);
  if (error != 0) {
    program->pid_ = -1;
    return failed(error);
  }
  return program;
}

Program::~Program() {
  close_now(pipe_);
  if (pid_ > 0) {
    ::kill(pid_, SIGTERM);
    (void)wait();
  }
  close_now(errors_);
}

int Program::wait() noexcept {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

/// `what`, and the last line that it said.
Error Program::over(std::string_view what) {
  std::string said(kLastWords_bytes, '\0');
  const off_t size = ::lseek(errors_, 0, SEEK_END);
  const off_t from = size > static_cast<off_t>(said.size()) ? size - static_cast<off_t>(said.size()) : 0;
  const ssize_t n = ::pread(errors_, said.data(), said.size(), from);
  said.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  while (!said.empty() && (said.back() == '\n' || said.back() == '\r')) said.pop_back();
  if (const std::size_t line = said.rfind('\n'); line != std::string::npos) said.erase(0, line + 1);
  return Error{name_ + " " + std::string(what) + (said.empty() ? "" : ": " + said)};
}

Status Program::feed(std::string_view data) {
  while (!data.empty() && pipe_ >= 0) {
    const ssize_t n = ::write(pipe_, data.data(), data.size());
    if (n >= 0) {
      data.remove_prefix(static_cast<std::size_t>(n));
      continue;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN) {
      const Status ended = finish();
      return ended.ok() ? over("ended too early") : ended.error();
    }
    pollfd ready{pipe_, POLLOUT, 0};
    if (::poll(&ready, 1, kPatience_ms) != 0) continue;
    close_now(pipe_);
    ::kill(pid_, SIGKILL);
    (void)wait();
    return over("took nothing for a minute");
  }
  return {};
}

Status Program::finish() {
  close_now(pipe_);
  if (pid_ <= 0) return {};
  const int status = wait();
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFSIGNALED(status)) return over("was ended by a signal (" + std::string(strsignal(WTERMSIG(status))) + ")");
  return over("gave up");
}

}  // namespace tandem::hal
