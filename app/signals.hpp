// Ctrl-C and SIGTERM as a flag that loops look at.
#pragma once
#include <atomic>

namespace tandem::app {

/// From here on SIGINT and SIGTERM set the flag instead of ending the process. A second one still only sets it.
const std::atomic<bool>& catch_signals();

/// Sets the flag as a signal would.
void request_stop() noexcept;

}  // namespace tandem::app
