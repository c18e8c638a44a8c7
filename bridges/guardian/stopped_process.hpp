// Asks the system whether it has stopped a process.
#pragma once
#include <sys/types.h>

namespace tandem::bridges::guardian {

/// By SIGSTOP, or a debugger. False where it cannot be known. Allocates nothing.
bool is_stopped(pid_t process) noexcept;

}  // namespace tandem::bridges::guardian
