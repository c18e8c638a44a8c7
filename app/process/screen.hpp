// A terminal as a whole screen: lines that are drawn over and over, and keys as they are pressed.
//
// A few escape sequences of ECMA-48 that every terminal of the last decades knows (docs/decisions/own-escape-codes.md).
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::app {

enum class LineLook : std::uint8_t { Plain, Bold, Faint, Bad, Title };

struct ScreenLine {
  std::string text;  ///< printable
  LineLook look = LineLook::Plain;
};

/// At most `columns` characters of `text`; "…" at the end where there were more.
std::string cut_to(std::string_view text, std::size_t columns);
/// Characters of `text`, which is UTF-8.
std::size_t width_of(std::string_view text) noexcept;

/// Draws on standard error. One at a time, used by one thread; `leave_screen_now` (app/process/terminal.hpp) may take
/// it away at any time, and `come_back` puts it up again.
class Screen {
 public:
  struct Size {
    std::size_t columns = 80, lines = 24;
  };

  /// Whether standard error is a terminal that can be drawn on.
  static bool possible() noexcept;

  Screen();
  ~Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  /// Puts the screen up again after a suspension. @returns false when this process is not in the foreground of its
  /// terminal: to be tried again.
  bool come_back();
  Size size() const noexcept;
  bool has_keys() const noexcept { return has_keys_; }
  /// Draws what has changed. What does not fit is cut; nothing while the screen is taken away.
  void show(std::span<const ScreenLine> lines);
  /// Keys pressed until now, waiting up to so many milliseconds for the first; as bytes.
  std::string keys(int timeout_ms);

 private:
  bool has_keys_ = false, colors_ = true;
  Size drawn_size_;
  std::vector<std::string> drawn_;
};

}  // namespace tandem::app
