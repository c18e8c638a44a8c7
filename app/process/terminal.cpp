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

/// Bytes of the UTF-8 character at the beginning of `text` [RFC 3629]; 0: it is none, or a control character.
std::size_t character_at(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first == '\n' || first == '\t') return 1;
  if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  const std::uint8_t second = byte(1);
  if (first == 0xC2 && second < 0xA0) return 0;                                        // C1 control characters
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;  // too long; half of a pair
  if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;  // too long; beyond Unicode
  return length;
}

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

std::string printable(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_at(text);
    if (length > 0) {
      out += text.substr(0, length);
    } else {
      const auto byte = static_cast<std::uint8_t>(text.front());
      out += "\\x";
      out += kHex[byte >> 4U];
      out += kHex[byte & 15U];
    }
    text.remove_prefix(length > 0 ? length : 1);
  }
  return out;
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
