#include "app/process/terminal.hpp"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <utility>

namespace tandem::app {
namespace {

std::mutex say_lock;
std::function<void(std::string_view)> say_to;  // empty: printed

/// What stands below all that is said. Guarded by `say_lock`.
struct Below {
  std::vector<std::string> lines;
  std::string last;
  std::size_t drawn = 0;  // lines

  void erase() {
    if (drawn > 0) std::fputs("\r\033[K", stderr);
    for (std::size_t i = 1; i < drawn; ++i) std::fputs("\033[A\033[K", stderr);
    drawn = 0;
  }
  void draw() {
    for (const std::string& line : lines)
      std::fprintf(stderr, "%s%s", drawn++ > 0 ? "\n" : "", printable(line).c_str());
    if (!last.empty()) std::fprintf(stderr, "%s%s", drawn++ > 0 ? "\n" : "", last.c_str());
    std::fflush(stderr);
  }
};
Below below;

std::atomic<bool> screen_up{false};
bool screen_has_keys = false;
termios keys_before;

}  // namespace

SayElsewhere::SayElsewhere(std::function<void(std::string_view)> take) {
  const std::lock_guard hold(say_lock);
  below.erase();
  below = {};
  say_to = std::move(take);
}

SayElsewhere::~SayElsewhere() {
  const std::lock_guard hold(say_lock);
  say_to = nullptr;
}

bool says_elsewhere() {
  const std::lock_guard hold(say_lock);
  return say_to != nullptr;
}

void note_screen(bool keys) noexcept {
  screen_has_keys = keys && tcgetattr(STDIN_FILENO, &keys_before) == 0;
  screen_up.store(true, std::memory_order_release);
}

bool screen_stands() noexcept {
  return screen_up.load(std::memory_order_acquire);
}

void leave_screen_now() noexcept {
  if (!screen_up.exchange(false)) return;
  const int error = errno;
  constexpr std::string_view kLeave = "\033[0m\033[?25h\033[?1049l";  // plain, cursor, the screen from before
  (void)!write(STDERR_FILENO, kLeave.data(), kLeave.size());
  if (screen_has_keys) (void)tcsetattr(STDIN_FILENO, TCSANOW, &keys_before);
  errno = error;
}

std::string shell_word(const std::string& text) {
  static constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=-+,:@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

void say(std::string_view text) {
  const std::lock_guard hold(say_lock);
  if (say_to) return say_to(text);
  below.erase();
  std::fprintf(stderr, "%s%s\n", isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "", printable(text).c_str());
  below.draw();
}

std::size_t terminal_columns() noexcept {
  winsize size{};
  if (isatty(STDERR_FILENO) == 0) return 0;
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

void stand_below(const std::vector<std::string>& lines) {
  const std::lock_guard hold(say_lock);
  if (say_to || lines == below.lines || isatty(STDERR_FILENO) == 0) return;
  below.erase();
  below.lines = lines;
  below.draw();
}

void stand_last(const std::string& line) {
  const std::lock_guard hold(say_lock);
  if (say_to || isatty(STDERR_FILENO) == 0) return;
  below.erase();
  below.last = line;
  below.draw();
}

int complain(int code, std::string_view message) {
  say("error: " + std::string(message));
  return code;
}

int told(const hal::Status& status, int code) {
  return status.ok() ? kDone : complain(code, status.error().message);
}

}  // namespace tandem::app
