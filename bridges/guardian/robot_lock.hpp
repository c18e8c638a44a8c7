// One hub a robot: lock files for each robot that is driven, held by the guardian of its hub.
//
// A robot has several names: its link as written, the device that this leads to now, and, where the computer knows one,
// the address that no other robot has. Each is a lock, so that a robot is found by any of them, and a device that has
// become another robot's can be given up alone.
//
// The kernel frees a lock when its holder dies, whatever the file says: there are no stale locks. The file tells who
// holds it, and how the robot is stopped, for its successor; a file that is not held, and that says
// "driven", is what is left of a hub and a guardian that were killed together.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "bridges/stop_messages.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::guardian {

/// What a hub has done with a robot. Left: the hub is gone, and the guardian is still stopping the robot.
enum class LockState : std::uint8_t { Claimed, Driven, Rests, Left };

/// Contents of a lock file.
struct LockHolder {
  StopMessages robot;
  pid_t hub = 0;
  pid_t guardian = 0;
  LockState state = LockState::Claimed;

  friend bool operator==(const LockHolder&, const LockHolder&) = default;
};

/// $XDG_RUNTIME_DIR/tandem, or /tmp/tandem-UID; made when it is not there. Error: it cannot be made, or belongs to
/// somebody else.
hal::Result<std::string> lock_folder();

/// The first lock of a robot: its link as written, and its name where several share the link. One address in two
/// networks gives two; the rate of a serial line, and what does not name a network (LCM's ttl), are no part of it.
std::string written_key(const StopMessages& robot);
/// All locks of a robot by what is known now, `written_key` first. Asks for hosts' addresses, and so may take seconds.
/// "localhost", 127.0.0.1 and ::1 are one device.
std::vector<std::string> lock_keys(const StopMessages& robot);
/// The lock of a robot that has an address of its own; "": it has none, or none is known yet.
std::string address_key(const StopMessages& robot);
/// The lock of one robot in the care of one guardian alone: others never ask for it.
std::string left_key(const StopMessages& robot, pid_t guardian);

/// A held lock. Movable.
class RobotLock {
 public:
  /// Nothing when another holds it; `holder` is then what his file says, as far as it can be read. Else `holder`
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

/// The locks of one robot.
class RobotLocks {
 public:
  /// Frees those that are not in `keys`, and takes those that are, as far as they are free. @returns whether
  /// it has all; else `holder` has one of them. Error: a file cannot be made.
  hal::Result<bool> change_to(const std::string& folder, const std::vector<std::string>& keys,
                              std::optional<LockHolder>& holder);
  /// Takes one more, unless another holds it: that is `holder` then. Error: as above.
  hal::Result<bool> add(const std::string& folder, const std::string& key, std::optional<LockHolder>& holder);
  void free(const std::vector<std::string>& keys);
  void free_all() { held_.clear(); }
  bool has(const std::string& key) const { return held_.contains(key); }
  bool has_all(const std::vector<std::string>& keys) const;
  void write(const LockHolder& holder) const;

 private:
  std::map<std::string, RobotLock> held_;
};

/// A robot whose hub and guardian died together.
struct AbandonedRobot {
  LockHolder holder;
  std::int64_t seen_unix_s = 0;  ///< when its file was last written: then they lived
};

/// Robots in this folder that were driven and are not held; files that tell of none are removed.
std::vector<AbandonedRobot> find_abandoned(const std::string& folder);
/// Removes what those left behind that held this robot, as far as it is free now.
void forget_abandoned(const std::string& folder, const LockHolder& holder);

/// Address at which a guardian listens for programs that want to take over a robot from it.
std::string takeover_socket(const std::string& folder, pid_t guardian);

}  // namespace tandem::bridges::guardian
