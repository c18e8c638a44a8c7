#include "bench/gnuplot.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::bench {
namespace {

namespace fs = std::filesystem;

/// A file in memory; closed at the end.
class MemoryFile {
 public:
  MemoryFile() : fd_(memfd_create("gnuplot", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (fd_ >= 0) close(fd_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

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
  std::string text() const {
    std::string all;
    char buffer[65536];
    for (ssize_t n = 0; (n = pread(fd_, buffer, sizeof buffer, static_cast<off_t>(all.size()))) > 0;)
      all.append(buffer, static_cast<std::size_t>(n));
    return all;
  }
  std::string first_bytes() const {
    char buffer[2000];
    const ssize_t n = pread(fd_, buffer, sizeof buffer, 0);
    return n > 0 ? std::string(buffer, static_cast<std::size_t>(n)) : std::string();
  }

 private:
  int fd_;
};

/// Runs gnuplot without the user's settings: `script` in, the picture into `out`.
hal::Status run_gnuplot(const std::string& script, int out) {
  const MemoryFile in;
  const MemoryFile errors;
  if (!in.good() || !errors.good() || !in.fill(script)) return hal::Error{"no memory for gnuplot's script"};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
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

}  // namespace

hal::Result<PictureKind> picture_kind(const std::string& path) {
  const std::string ending = fs::path(path).extension();
  if (ending == ".svg") return PictureKind::Svg;
  if (ending == ".png") return PictureKind::Png;
  return hal::Error{"'" + path + "' must end in .svg or .png"};
}

hal::Status can_draw() {
  const MemoryFile nothing;
  return run_gnuplot("exit\n", nothing.fd());
}

hal::Status draw(const Figure& figure, hal::OutputFile& file) {
  const auto kind = picture_kind(file.path());
  if (!kind.ok()) return kind.error();
  const MemoryFile picture;
  if (!picture.good()) return hal::Error{"no memory for the figure"};
  if (const hal::Status drawn = run_gnuplot(gnuplot_script(figure, kind.value()), picture.fd()); !drawn.ok())
    return drawn;
  const hal::Status written = file.write(picture.text());
  return written.ok() ? file.commit() : written;
}

}  // namespace tandem::bench
