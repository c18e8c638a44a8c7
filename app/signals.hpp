// Ctrl-C, SIGTERM and Ctrl-Z as flags that others look at.
#pragma once
#include <atomic>

namespace tandem::app {

/// From here on SIGINT and SIGTERM set the flag instead of ending the process. A second one still only sets it.
const std::atomic<bool>& catch_signals();

/// Set by Ctrl-Z (SIGTSTP) from `catch_suspend` on, instead of suspending the process; whoever looks at it does that.
std::atomic<bool>& suspend_asked() noexcept;
void catch_suspend();

/// Sets the flag as a signal would.
void request_stop() noexcept;

}  // namespace tandem::app
