// Emergency exit of a process that cannot go on: names the plug-in, saves the records.
#pragma once
#include <string_view>

namespace tandem::app {

/// From here on a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGABRT), an uncaught exception and a
/// plug-in that calls `exit` or `_exit` end the process with exit code 3 and a message that names the plug-in whose
/// code it was, its robot and the tick. Not in processes that are forked off it. Once, at the start of the program.
void catch_crashes() noexcept;

/// Saves what there is when the process must end at once.
class EmergencySaver {
 public:
  virtual ~EmergencySaver() = default;
  /// May run in a signal handler: neither allocates nor locks.
  virtual void save(std::string_view failure) const noexcept = 0;
};

/// `end_now` lets this one save. It must live until another one, or null, is named.
void save_in_emergency(const EmergencySaver* saver) noexcept;

/// Says `message`, saves, and ends the process with exit code 3. May be called from signal handlers and by any thread.
[[noreturn]] void end_now(std::string_view message) noexcept;

/// Writes all of `text`, in a signal handler if need be. @returns whether that worked.
bool write_now(int descriptor, std::string_view text) noexcept;

}  // namespace tandem::app
