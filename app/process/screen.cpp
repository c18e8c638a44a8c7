#include "app/process/screen.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "app/process/emergency.hpp"
#include "app/process/terminal.hpp"

namespace tandem::app {
namespace {

bool in_foreground() noexcept {
  return tcgetpgrp(STDERR_FILENO) == getpgrp();
}

std::string_view begin_of(LineLook look, bool colors) noexcept {
  static constexpr std::string_view kBegins[] = {"", "\033[1m", "\033[2m", "\033[31m", "\033[7m"};
  if (look == LineLook::Bad && !colors) look = LineLook::Bold;
  return kBegins[static_cast<std::size_t>(look)];
}

bool begins_character(char c) noexcept {
  return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
}

}  // namespace

std::size_t width_of(std::string_view text) noexcept {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), &begins_character));
}

std::string cut_to(std::string_view text, std::size_t columns) {
  if (width_of(text) <= columns) return std::string(text);
  if (columns == 0) return {};
  std::size_t at = 0;
  for (std::size_t seen = 0; at < text.size(); ++at) {
    if (begins_character(text[at]) && ++seen == columns) break;
  }
  return std::string(text.substr(0, at)) + "…";
}

bool Screen::possible() noexcept {
  const char* const kind = std::getenv("TERM");  // NOLINT(concurrency-mt-unsafe)
  return isatty(STDERR_FILENO) != 0 && kind != nullptr && *kind != '\0' && std::string_view(kind) != "dumb" &&
         in_foreground();
}

Screen::Screen() {
  const char* const plain = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe)
  colors_ = plain == nullptr || *plain == '\0';
  has_keys_ = isatty(STDIN_FILENO) != 0;
  (void)come_back();
}

Screen::~Screen() {
  leave_screen_now();
}

bool Screen::come_back() {
  if (!in_foreground()) return false;
  if (!screen_stands()) note_screen(has_keys_);
  if (has_keys_) {
    termios keys{};
    if (tcgetattr(STDIN_FILENO, &keys) == 0) {
      keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C and Ctrl-Z stay signals
      keys.c_cc[VQUIT] = _POSIX_VDISABLE;                     // Ctrl-\ would leave the terminal as it is
      keys.c_cc[VMIN] = 0;
      keys.c_cc[VTIME] = 0;
      (void)tcsetattr(STDIN_FILENO, TCSANOW, &keys);
    }
  }
  (void)write_now(STDERR_FILENO, "\033[?1049h\033[?25l\033[2J");  // another screen, no cursor, clear
  drawn_.clear();
  return true;
}

Screen::Size Screen::size() const noexcept {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) return {};
  return {size.ws_col, size.ws_row};
}

void Screen::show(std::span<const ScreenLine> lines) {
  const Size now = size();
  std::string out;
  if (now.columns != drawn_size_.columns || now.lines != drawn_size_.lines) {
    out = "\033[2J";
    drawn_.clear();
    drawn_size_ = now;
  }
  drawn_.resize(now.lines);
  for (std::size_t i = 0; i < now.lines; ++i) {
    std::string line;
    if (i < lines.size()) {
      std::string text = cut_to(lines[i].text, now.columns);
      if (lines[i].look == LineLook::Title) text.append(now.columns - width_of(text), ' ');
      const std::string_view begin = begin_of(lines[i].look, colors_);
      line = std::string(begin) + text + (begin.empty() ? "" : "\033[0m");
    }
    if (line == drawn_[i]) continue;
    out += "\033[" + std::to_string(i + 1) + ";1H" + line;
    if (i >= lines.size() || width_of(lines[i].text) < now.columns) out += "\033[K";
    drawn_[i] = std::move(line);
  }
  if (!out.empty() && screen_stands()) (void)write_now(STDERR_FILENO, out);
}

std::string Screen::keys(int timeout_ms) {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (!has_keys_ || !screen_stands()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return {};
  }
  std::string all;
  if (poll(&input, 1, timeout_ms) <= 0) return all;
  if ((input.revents & POLLIN) == 0) {  // the terminal is gone
    has_keys_ = false;
    return all;
  }
  std::array<char, 64> some{};
  const ssize_t n = read(STDIN_FILENO, some.data(), some.size());
  if (n > 0) all.assign(some.data(), static_cast<std::size_t>(n));
  return all;
}

}  // namespace tandem::app
