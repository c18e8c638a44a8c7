// Messages on a terminal.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/exit_code.hpp"
#include "hal/printable.hpp"
#include "hal/result.hpp"

namespace tandem::app {

using hal::printable;

/// `text` as one word of a shell, for commands that people may type.
std::string shell_word(const std::string& text);

/// Prints a line on standard error, above what stands below. Escapes as `printable`.
void say(std::string_view text);

/// Columns of the terminal that standard error is; 0: it is none.
std::size_t terminal_columns() noexcept;
/// Lines that stay below all that is said, on a terminal only: a progress bar, and above it others. Each replaces its
/// own; empty: they are taken away. None may be longer than the terminal is wide.
void stand_below(const std::vector<std::string>& lines);
void stand_last(const std::string& line);

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
/// The same of an error; kDone where there is none.
int told(const hal::Status& status, int code = kBadInput);

}  // namespace tandem::app
