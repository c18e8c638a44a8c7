// Messages on a terminal.
#pragma once
#include <string>
#include <string_view>

namespace tandem::app {

/// `text` as a terminal may get it, whoever wrote it: control characters but tabs and line ends become \x1b and the
/// like, and so do bytes that are no UTF-8.
std::string printable(std::string_view text);

/// Prints a line on standard error, over a progress bar that may stand there. Escapes as `printable`.
void say(std::string_view text);

/// Says "error: …". @returns `code`, for the caller to return.
int complain(int code, std::string_view message);

}  // namespace tandem::app
