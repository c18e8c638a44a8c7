// The live list of real robots on a terminal: those that may move, wait for a person, are not reached. Never cut.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/run/roll_call.hpp"

namespace tandem::app {

/// One line a group; the urgent ones first. Lines are broken at `columns` (0: never).
std::vector<std::string> roll_lines(const std::vector<core::RollRow>& rows, std::size_t columns);

/// Where there is no terminal to draw on: tells the list when what is urgent in it changes, at most once in `kEvery_s`,
/// and later less often; the last state is always reported.
class RollTeller {
 public:
  static constexpr double kEvery_s = 1.0, kLater_s = 10.0;
  static constexpr int kOften = 20;  ///< times; then every kLater_s

  /// @returns what is to be said now; mostly nothing.
  std::vector<std::string> look(const std::vector<core::RollRow>& rows, double now_s);

 private:
  std::vector<std::string> told_;
  double told_s_ = -1e9;
  int times_ = 0;
};

}  // namespace tandem::app
