#include "app/bench/gnuplot.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::app {
namespace {

namespace fs = std::filesystem;

/// A file in memory, or one of the disk; closed at the end.
class File {
 public:
  static File in_memory() { return File(memfd_create("gnuplot", MFD_CLOEXEC)); }
  static File written(const std::string& path) {
    return File(open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  }
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool good() const { return fd_ >= 0; }
  int fd() const { return fd_; }

  bool fill(const std::string& text) const {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t n = write(fd_, text.data() + done, text.size() - done);
      if (n < 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return lseek(fd_, 0, SEEK_SET) == 0;
  }
  std::string first_bytes() const {
    char buffer[2000];
    const ssize_t n = pread(fd_, buffer, sizeof buffer, 0);
    return n > 0 ? std::string(buffer, static_cast<std::size_t>(n)) : std::string();
  }

 private:
  explicit File(int fd) : fd_(fd) {}
  int fd_;
};

/// Runs gnuplot without the user's settings: `script` in, the picture into `out`.
hal::Status run_gnuplot(const std::string& script, const File& out) {
  const File in = File::in_memory();
  const File errors = File::in_memory();
  if (!in.good() || !errors.good() || !in.fill(script)) return hal::Error{"no memory for gnuplot's script"};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.fd(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.fd(), STDERR_FILENO);
  char name[] = "gnuplot";
  char no_settings[] = "-d";
  char* const argv[] = {name, no_settings, nullptr};
  pid_t pid = -1;
  const int failed = posix_spawnp(&pid, name, &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT)
    return hal::Error{"figures are drawn by gnuplot, which is not installed: sudo apt-get install gnuplot-nox"};
  if (failed != 0) return hal::Error{std::string("gnuplot cannot be started: ") + std::strerror(failed)};
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  const std::string said = errors.first_bytes();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return hal::Error{"gnuplot gave up" + (said.empty() ? std::string() : ": " + said)};
  return {};
}

hal::Error cannot_write(const std::string& path) {
  return {"the figure '" + path + "' cannot be written: " + std::strerror(errno)};
}

}  // namespace

hal::Result<PictureKind> picture_kind(const std::string& path) {
  const std::string ending = fs::path(path).extension();
  if (ending == ".svg") return PictureKind::Svg;
  if (ending == ".png") return PictureKind::Png;
  return hal::Error{"'" + path + "' must end in .svg or .png"};
}

hal::Status can_draw(const std::string& path) {
  if (const auto kind = picture_kind(path); !kind.ok()) return kind.error();
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (access(folder.c_str(), W_OK) != 0) return cannot_write(path);
  return run_gnuplot("exit\n", File::in_memory());
}

hal::Status draw(const Figure& figure, const std::string& path) {
  const auto kind = picture_kind(path);
  if (!kind.ok()) return kind.error();
  const std::string part = path + ".part";
  hal::Status drawn;
  {
    const File out = File::written(part);
    if (!out.good()) return cannot_write(path);
    drawn = run_gnuplot(gnuplot_script(figure, kind.value()), out);
  }
  if (drawn.ok() && std::rename(part.c_str(), path.c_str()) != 0) drawn = cannot_write(path);
  if (!drawn.ok()) unlink(part.c_str());
  return drawn;
}

}  // namespace tandem::app
