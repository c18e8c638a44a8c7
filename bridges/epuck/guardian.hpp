// Stops e-pucks when the hub is killed. The stock firmware has no watchdog: wheels keep their last speed for ever.
//
//   hub  ----pipe---->  guardian (a child process that does nothing else)
//   "+/dev/rfcomm0"     remembers the device
//   "-/dev/rfcomm0"     the robot behind it was stopped properly: forgets it
//   end of the pipe     the hub is gone: opens every device that is left and says stop
#pragma once
#include <string>

#include "hal/result.hpp"

namespace tandem::bridges::epuck {

/// Owns the child. Make it before any other thread exists. Destroyed in the hub, it lets the child end.
class Guardian {
 public:
  /// Error: no process can be made; the message says that a killed hub would then leave robots driving.
  static hal::Result<Guardian> start();
  Guardian(Guardian&& other) noexcept;
  Guardian& operator=(Guardian&&) = delete;
  Guardian(const Guardian&) = delete;
  ~Guardian();

  /// From now on the robot on `device` (an absolute path, or one relative to the current folder) is to be stopped when
  /// this process dies. `baud` as the link is opened with.
  void watch(const std::string& device, unsigned baud);
  /// The robot on `device` stands still and is nobody's any more.
  void release(const std::string& device);

 private:
  Guardian(int pipe, int child) : pipe_(pipe), child_(child) {}
  void say(char what, unsigned baud, const std::string& device);

  int pipe_ = -1;
  int child_ = -1;
};

}  // namespace tandem::bridges::epuck
