// Failures of first motions of real robots, kept beside their locks until one succeeds.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/stop_messages.hpp"
#include "hal/result.hpp"
#include "mixed_reality/desk/preflight.hpp"

namespace tandem::app {

/// A first motion of one robot that failed.
struct FailedMotion {
  std::string robot;               ///< its id then
  std::int64_t unix_s = 0;         ///< when
  std::vector<std::string> found;  ///< for people
};

/// In the folder of the locks.
class MotionMemory {
 public:
  /// Error: there is no such folder.
  static hal::Result<MotionMemory> open();

  hal::Status keep(const bridges::StopMessages& robot, const FailedMotion& failed) const;
  void forget(const bridges::StopMessages& robot) const;
  std::optional<FailedMotion> recall(const bridges::StopMessages& robot) const;

 private:
  explicit MotionMemory(std::string folder) : folder_(std::move(folder)) {}
  std::string file_of(const bridges::StopMessages& robot) const;
  std::string folder_;
};

/// Keeps what first motions found wrong with these robots, and forgets it where all is right now. Error: it could not
/// be written.
hal::Status keep_motions(std::span<const bridges::StopMessages> robots, const mixed_reality::PreflightRows& rows);

/// Error: a first motion of one of them failed, and none was right since; says what was found, when, and what to do.
hal::Status check_motions(std::span<const bridges::StopMessages> robots);

}  // namespace tandem::app
