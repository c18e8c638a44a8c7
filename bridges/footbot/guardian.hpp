// Stops foot-bots when the hub is killed: their modules keep the last speed for ever.
//
//   hub  ----pipe---->  guardian (a child process that does nothing else)
//   watch               remembers the link, and the messages that have the robot rest
//   release             the robot was stopped properly: forgets it
//   end of the pipe     the hub is gone: opens every link that is left and says them, several times
#pragma once
#include <string>
#include <vector>

#include "bridges/footbot/wiring.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::footbot {

/// Owns the child. Make it before any other thread exists. Destroyed in the hub, it stops what was not released and
/// ends.
class Guardian {
 public:
  /// Error: no process can be made; the message says that a killed hub would then leave robots driving.
  static hal::Result<Guardian> start();
  Guardian(Guardian&& other) noexcept;
  Guardian& operator=(Guardian&&) = delete;
  Guardian(const Guardian&) = delete;
  ~Guardian();

  /// From now on the robot on `link` (a LINK text) is to be told `words` when this process dies. Replaces what was to
  /// be said there. Relative device paths are meant from the current folder.
  void watch(const std::string& link, const std::vector<LastWords>& words);
  /// The robot on `link` rests and is nobody's any more.
  void release(const std::string& link);

 private:
  Guardian(int pipe, int child) : pipe_(pipe), child_(child) {}
  void say(const std::string& lines);

  int pipe_ = -1;
  int child_ = -1;
};

}  // namespace tandem::bridges::footbot
