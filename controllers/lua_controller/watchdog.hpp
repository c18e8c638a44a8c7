// Looks after scripts that do not come to an end. One thread for all interpreters of the process, while there are any.
#pragma once

namespace tandem::controllers::lua {

class Interpreter;

/// From now on its calls are looked at, ten times a second. Until `unwatch`.
void watch(Interpreter& interpreter);
void unwatch(Interpreter& interpreter) noexcept;

/// The signal by which a thread that runs a script learns that it is to count instructions.
int watchdog_signal() noexcept;

}  // namespace tandem::controllers::lua
