// Ctrl-C, a closed terminal, SIGTERM and their kin, and Ctrl-Z, as flags that others look at.
#pragma once
#include <atomic>

namespace tandem::app {

/// From here on SIGINT, SIGTERM, SIGHUP (the terminal was closed), SIGQUIT, SIGXCPU (no processor time is left) and
/// SIGALRM set the flag instead of ending the process. A second one still only sets it. SIGHUP stays ignored under
/// nohup.
const std::atomic<bool>& catch_signals();

/// Set by Ctrl-Z (SIGTSTP) from `catch_suspend` on, instead of suspending the process; its reader does that.
std::atomic<bool>& suspend_asked() noexcept;
void catch_suspend();

/// Has Ctrl-Z take the screen away before it suspends the process, where nothing else catches it.
void catch_suspend_of_screen();
/// Set when the process goes on after a suspension, from that call on.
std::atomic<bool>& continued() noexcept;

/// Exit code of a run that a signal ended: 128 and its number, 130 after SIGINT, 143 after SIGTERM; 0: none came.
int interrupted_code() noexcept;

/// Set by SIGUSR1 from `catch_rearm` on: a person re-arms the real robots that wait for it.
std::atomic<bool>& rearm_asked() noexcept;
/// The first thing that a program does: without it the signal ends the process, however early it comes.
void catch_rearm();

/// Sets the flag as a signal would.
void request_stop() noexcept;

}  // namespace tandem::app
