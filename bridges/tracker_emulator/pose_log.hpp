// True poses of an emulated robot, read from its log while that is written.
#pragma once
#include <deque>
#include <fstream>
#include <optional>
#include <string>

#include "hal/time.hpp"

namespace tandem::bridges::tracker_emulator {

struct TruePose {
  hal::TimeNs at_ns = 0;  ///< CLOCK_MONOTONIC
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
};

/// Follows a log that an emulator is writing, or has not yet begun.
class PoseLog {
 public:
  explicit PoseLog(std::string path) : path_(std::move(path)) {}

  /// Takes the lines that have come since.
  void follow();
  /// The pose at that time, between two that were told; before the first: nothing; after the last: that one.
  std::optional<TruePose> at(hal::TimeNs time_ns) const;
  /// When the pose was first told that is not the first one.
  std::optional<hal::TimeNs> first_moved_ns() const noexcept { return first_moved_ns_; }

 private:
  void take(const std::string& line);

  std::string path_;
  std::ifstream file_;
  std::string line_;  // as far as it has been written
  std::deque<TruePose> poses_;
  std::optional<TruePose> first_;
  std::optional<hal::TimeNs> first_moved_ns_;
};

}  // namespace tandem::bridges::tracker_emulator
