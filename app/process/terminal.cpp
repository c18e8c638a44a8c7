#include "app/process/terminal.hpp"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <termios.h>
#include <unistd.h>
#include <utility>

namespace tandem::app {
namespace {

std::mutex say_lock;
std::function<void(std::string_view)> say_to;  // empty: printed

std::atomic<bool> screen_up{false};
bool screen_has_keys = false;
termios keys_before;

}  // namespace

SayElsewhere::SayElsewhere(std::function<void(std::string_view)> take) {
  const std::lock_guard hold(say_lock);
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
  {
    const std::lock_guard hold(say_lock);
    if (say_to) return say_to(text);
  }
  std::fprintf(stderr, "%s%s\n", isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "", printable(text).c_str());
}

int complain(int code, std::string_view message) {
  say("error: " + std::string(message));
  return code;
}

}  // namespace tandem::app
