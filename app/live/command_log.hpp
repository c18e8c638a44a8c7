// Audit of commands: author, time, address and result, as entries of the run's log file.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "core/live/live_run.hpp"
#include "hal/json/json.hpp"

namespace tandem::app {

/// "tick 120: 'anna' (operator, 192.168.1.7): arm ep0", and "refused: why" behind it.
std::string command_text(hal::Tick tick, const hal::Json& command, const hal::Json& answer);

/// May be used from any thread. Questions are not kept.
class CommandLog {
 public:
  /// `keep` takes an entry, on any thread; `live` and what `keep` uses outlive all replies.
  CommandLog(std::function<void(std::string_view)> keep, const core::LiveRun& live)
      : keep_(std::move(keep)), live_(live) {}

  /// Keeps a command that was answered.
  void note(const hal::Json& command, const hal::Json& answer) const;
  /// A reply that keeps the command with its answer, and then does as `reply`, which may be empty.
  core::LiveReply noting(const hal::Json& command, core::LiveReply reply) const;

 private:
  std::function<void(std::string_view)> keep_;
  const core::LiveRun& live_;
};

}  // namespace tandem::app
