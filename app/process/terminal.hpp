// Messages on a terminal.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "hal/printable.hpp"

namespace tandem::app {

using hal::printable;

/// `text` as one word of a shell, for commands that people may type.
std::string shell_word(const std::string& text);

/// Prints a line on standard error, over a progress bar that may stand there. Escapes as `printable`.
void say(std::string_view text);

/// While one lives, `say` hands its lines to `take` instead of printing them. `take` may be called on any thread.
class SayElsewhere {
 public:
  explicit SayElsewhere(std::function<void(std::string_view)> take);
  ~SayElsewhere();
  SayElsewhere(const SayElsewhere&) = delete;
  SayElsewhere& operator=(const SayElsewhere&) = delete;
};

/// Whether one lives.
bool says_elsewhere();

/// Puts the terminal back as it was before `note_screen`, once: what was on it is there again, keys are shown. For
/// signal handlers, too.
void leave_screen_now() noexcept;
/// Whether a screen stands (app/process/screen.hpp).
bool screen_stands() noexcept;
/// For app/process/screen.cpp alone: a screen stands from now on. `keys`: the terminal of standard input is to be put
/// back, too, as it is now.
void note_screen(bool keys) noexcept;

/// Says "error: …". @returns `code`, for the caller to return.
int complain(int code, std::string_view message);

}  // namespace tandem::app
