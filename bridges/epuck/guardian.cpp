#include "bridges/epuck/guardian.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

namespace tandem::bridges::epuck {
namespace {

speed_t speed_of(unsigned baud) {
  switch (baud) {
    case 9600:
      return B9600;
    case 19200:
      return B19200;
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    case 230400:
      return B230400;
    default:
      return B115200;
  }
}

/// Whatever the firmware was reading, this ends it and stops the wheels: zeros end a binary packet, CR ends a line,
/// then the line `D,0,0` and the binary form of the same, and `S`. A half-received line may be obeyed first; the stops
/// follow it.
constexpr std::array<unsigned char, 62> stop_bytes() {
  std::array<unsigned char, 62> bytes{};  // 40 zeros first
  constexpr char kLine[] = "\rD,0,0\r";
  std::size_t at = 40;
  for (std::size_t i = 0; i + 1 < sizeof kLine; ++i) bytes[at++] = static_cast<unsigned char>(kLine[i]);
  bytes[at] = 0xBC;  // binary D, both speeds 0, end of packet
  at += 6;
  bytes[at++] = 'S';
  bytes[at++] = '\r';
  return bytes;
}

void wait_until(timespec& at, long milliseconds) {
  at.tv_nsec += milliseconds * 1'000'000;
  at.tv_sec += at.tv_nsec / 1'000'000'000;
  at.tv_nsec %= 1'000'000'000;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) == EINTR) {
  }
}

/// Says stop several times over the next two seconds: the first words may fall on a busy firmware.
void stop_robot(const std::string& device, unsigned baud) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  int said = 0;
  for (int attempt = 0; attempt < 20 && said < 4; ++attempt) {
    const int fd = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd >= 0) {
      termios settings{};
      if (tcgetattr(fd, &settings) == 0) {
        cfmakeraw(&settings);
        settings.c_cflag |= CREAD | CLOCAL;
        cfsetispeed(&settings, speed_of(baud));
        cfsetospeed(&settings, speed_of(baud));
        (void)tcsetattr(fd, TCSANOW, &settings);
      }
      constexpr auto kStop = stop_bytes();
      if (write(fd, kStop.data(), kStop.size()) == static_cast<ssize_t>(kStop.size())) {
        ++said;
        // Draining may hang on a dead line; what is buffered gets this long to leave.
        wait_until(now, 100);
      }
      close(fd);
    }
    wait_until(now, 100);
  }
}

[[noreturn]] void guard(int pipe) {
  // Ctrl-C goes to the whole group; the guardian outlives it until the hub has ended.
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) signal(s, SIG_IGN);
  setsid();
  prctl(PR_SET_NAME, "tandem-guard");
  std::map<std::string, unsigned> watched;
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t n = read(pipe, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(n));
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
      const std::string line = text.substr(0, end);
      const std::size_t space = line.find(' ');
      if (space == std::string::npos) continue;
      const std::string device = line.substr(space + 1);
      if (line[0] == '+')
        watched[device] = static_cast<unsigned>(std::strtoul(line.c_str() + 1, nullptr, 10));
      else
        watched.erase(device);
    }
  }
  for (const auto& [device, baud] : watched) stop_robot(device, baud);
  _exit(0);
}

}  // namespace

hal::Result<Guardian> Guardian::start() {
  std::array<int, 2> ends{};
  const auto failed = [] {
    return hal::Error{std::string("no guardian process can be made (") + std::strerror(errno) +
                      "): an e-puck would drive on if this program were killed"};
  };
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return failed();
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return failed();
  }
  if (child == 0) {
    close(ends[1]);
    guard(ends[0]);
  }
  close(ends[0]);
  return Guardian(ends[1], child);
}

Guardian::Guardian(Guardian&& other) noexcept : pipe_(other.pipe_), child_(other.child_) {
  other.pipe_ = -1;
  other.child_ = -1;
}

Guardian::~Guardian() {
  if (pipe_ < 0) return;
  close(pipe_);  // robots that were not released are now stopped
  waitpid(child_, nullptr, 0);
}

void Guardian::watch(const std::string& device, unsigned baud) {
  say('+', baud, device);
}
void Guardian::release(const std::string& device) {
  say('-', 0, device);
}

void Guardian::say(char what, unsigned baud, const std::string& device) {
  std::error_code error;
  const std::string line = what + std::to_string(baud) + " " + std::filesystem::absolute(device, error).string() + "\n";
  (void)!write(pipe_, line.data(), line.size());  // shorter than PIPE_BUF: whole or not at all
}

}  // namespace tandem::bridges::epuck
