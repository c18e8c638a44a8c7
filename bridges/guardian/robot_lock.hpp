// One hub a robot: a lock file for each robot that is driven, held by the guardian of its hub.
//
// The kernel frees the lock when its holder dies, whatever the file says: there are no stale locks. The file tells who
// holds it, and how the robot is stopped, so that whoever takes over knows.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <sys/types.h>

#include "bridges/stop_messages.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::guardian {

/// Contents of a lock file.
struct LockHolder {
  StopMessages robot;
  pid_t hub = 0;
  pid_t guardian = 0;
  bool left = false;  ///< the hub is gone, and the guardian is still stopping the robot
};

/// $XDG_RUNTIME_DIR/tandem, or /tmp/tandem-UID; made when it is not there. Error: it cannot be made, or belongs to
/// somebody else.
hal::Result<std::string> lock_folder();

/// Names the robot among all that can be reached from this machine: its link, and its name on a shared one. Two paths
/// to one device give one key, one address in two networks gives two.
std::string lock_key(const StopMessages& robot);

/// A held lock. Movable.
class RobotLock {
 public:
  /// Nothing when somebody else holds it; `holder` is then what his file says, as far as it can be read. Else `holder`
  /// is what the last holder left behind when he was killed. Error: the file cannot be made.
  static hal::Result<std::optional<RobotLock>> take(const std::string& folder, const std::string& key,
                                                    std::optional<LockHolder>& holder);
  RobotLock(RobotLock&& other) noexcept;
  RobotLock& operator=(RobotLock&& other) noexcept;
  RobotLock(const RobotLock&) = delete;
  /// Frees it and removes the file.
  ~RobotLock();

  /// Replaces what the file says.
  void write(const LockHolder& holder) const;

 private:
  RobotLock(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
  std::string path_;
  int descriptor_ = -1;
};

/// Where a guardian listens for whoever wants to take over a robot from it.
std::string takeover_socket(const std::string& folder, pid_t guardian);

}  // namespace tandem::bridges::guardian
