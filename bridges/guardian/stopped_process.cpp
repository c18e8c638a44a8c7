#include "bridges/guardian/stopped_process.hpp"

#include <array>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace tandem::bridges::guardian {

bool is_stopped(pid_t process) noexcept {
  std::array<char, 32> path{};
  std::snprintf(path.data(), path.size(), "/proc/%d/stat", static_cast<int>(process));
  const int fd = ::open(path.data(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return false;
  std::array<char, 512> text{};
  const ssize_t n = ::read(fd, text.data(), text.size() - 1);
  ::close(fd);
  if (n <= 0) return false;
  const char* end = std::strrchr(text.data(), ')');  // the name may hold anything
  return end != nullptr && end[1] == ' ' && (end[2] == 'T' || end[2] == 't');
}

}  // namespace tandem::bridges::guardian
