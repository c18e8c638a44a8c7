// Counts the work of a call of a script exactly: the same call has the same count in every run, on any thread.
//
// Lua's virtual machine looks for a reason to stop wherever a loop goes on, a function is called or has returned, or a
// slow instruction is done. That look is led here (limits.cpp), and is one step. Library functions whose time grows
// with their arguments add steps of their own, and so does memory.
#pragma once
#include <cstdint>

namespace tandem::controllers::lua {

/// Steps of one call. A value; the interpreter and its memory share it.
struct Steps {
  enum class Over : std::uint8_t { No, Steps, Memory };

  std::int64_t left = kUnlimited;     ///< until the next look at the limits
  std::int64_t granted = kUnlimited;  ///< what `left` was
  std::int64_t spent = 0;             ///< before that was granted
  std::int64_t most = kUnlimited;
  Over over = Over::No;

  static constexpr std::int64_t kUnlimited = std::int64_t{1} << 62;

  void begin(std::int64_t most_steps) noexcept {
    left = granted = most = most_steps;
    spent = 0;
    over = Over::No;
  }
  std::int64_t done() const noexcept { return spent + granted - left; }
  /// Has the next look find something, without a change of the count.
  void interrupt() noexcept {
    spent = done();
    left = granted = 0;
  }
  /// After a look.
  void go_on() noexcept {
    spent = done();
    if (over == Over::No && spent >= most) over = Over::Steps;
    left = granted = over == Over::No ? most - spent : 0;
  }
};

}  // namespace tandem::controllers::lua
