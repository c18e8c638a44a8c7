#include "hal/input_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tandem::hal {
namespace {

Error failed(std::string_view what, const std::string& path, const std::string& why) {
  return Error{what.empty() ? why : std::string(what) + " '" + path + "': " + why};
}

std::string kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "this is a folder";
  if (S_ISFIFO(mode)) return "this is a pipe";
  if (S_ISSOCK(mode)) return "this is a socket";
  return "this is a device";
}

std::string reason(int error) {
  return error == ENOENT ? "there is no such file" : std::strerror(error);
}

/// Closes at the end.
struct Descriptor {
  explicit Descriptor(int fd) : number(fd) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

}  // namespace

Result<int> open_input_file(const std::string& path, std::string_view what) {
  struct stat info {};
  // Looked at before it is opened: opening alone has a device act, and both may change in between.
  if (::stat(path.c_str(), &info) != 0) return failed(what, path, reason(errno));
  const auto refused = [&] { return failed(what, path, kind_of(info.st_mode) + "; give the path of a file"); };
  if (!S_ISREG(info.st_mode)) return refused();
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return failed(what, path, reason(errno));
  if (::fstat(fd, &info) == 0 && S_ISREG(info.st_mode)) return fd;
  ::close(fd);
  return refused();
}

Status check_input_file(const std::string& path, std::string_view what) {
  const auto opened = open_input_file(path, what);
  if (!opened.ok()) return opened.error();
  ::close(opened.value());
  return {};
}

Result<std::string> read_whole_file(const std::string& path, std::string_view what, std::size_t most_bytes) {
  const auto opened = open_input_file(path, what);
  if (!opened.ok()) return opened.error();
  const Descriptor file(opened.value());
  constexpr std::size_t kStep = std::size_t{64} << 10;
  struct stat info {};
  std::string bytes;
  if (::fstat(file.number, &info) == 0 && std::cmp_less_equal(info.st_size, most_bytes))
    bytes.reserve(static_cast<std::size_t>(info.st_size) + kStep);
  for (;;) {  // files of /proc say that they have no bytes, and others grow
    const std::size_t before = bytes.size();
    bytes.resize(before + kStep);
    const ssize_t got = ::read(file.number, bytes.data() + before, kStep);
    const int error = errno;
    bytes.resize(before + static_cast<std::size_t>(got > 0 ? got : 0));
    if (got < 0 && error == EINTR) continue;
    if (got < 0) return failed(what, path, "it cannot be read: " + reason(error));
    if (bytes.size() > most_bytes)
      return failed(what, path, "it is larger than " + std::to_string(most_bytes >> 20U) + " MiB");
    if (got == 0) return bytes;
  }
}

}  // namespace tandem::hal
