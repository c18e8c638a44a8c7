// Has eye-bots hover and land when the hub is killed.
//
//   hub  ----pipe---->  guardian (a child process that does nothing else)
//   watch               remembers the robot, and in whose name it is to be spoken to
//   release             the robot was left properly: forgets it
//   end of the pipe     the hub is gone: goes on in its name until all robots that are left have landed
//
// A robot also hovers by itself 2 s after its hub fell silent, and lands after 10 s. The guardian does it at once, and
// where that is what the robot was to do.
#pragma once
#include <string>

#include "bridges/eyebot/bridge.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::eyebot {

/// Owns the child. Make it before any other thread exists. Destroyed in the hub, it lands what was not released and
/// ends.
class Guardian {
 public:
  /// Error: no process can be made; the message says what then happens to robots of a killed hub.
  static hal::Result<Guardian> start();
  Guardian(Guardian&& other) noexcept;
  Guardian& operator=(Guardian&&) = delete;
  Guardian(const Guardian&) = delete;
  ~Guardian();

  /// From now on the robot is to be brought down when this process dies.
  void watch(const LastWords& words);
  /// The robot is nobody's any more.
  void release(const LastWords& words);

 private:
  Guardian(int pipe, int child) : pipe_(pipe), child_(child) {}
  void say(const std::string& line);

  int pipe_ = -1;
  int child_ = -1;
};

}  // namespace tandem::bridges::eyebot
