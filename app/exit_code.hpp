// Exit codes of the program.
#pragma once

namespace tandem::app {

enum ExitCode : int { kDone = 0, kBadInput = 1, kWrongUsage = 2, kFailedRunning = 3, kDifferent = 4 };

}  // namespace tandem::app
