// What reached a space from outside in a tick: rows of plain data by robot, for writing them down.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/space/ids.hpp"
#include "hal/port.hpp"

namespace tandem::core {

/// One row: it changes from tick to tick, and stays where it is.
struct InputRow {
  RobotId robot;  ///< not valid: the row is of the run as a whole
  const hal::RowType* type = nullptr;
  const void* row = nullptr;
  /// Only "input" has an effect in the space. "sent": a command as it went to the real robot; "seen": where it was
  /// measured to be; "time": clocks.
  std::string_view set = "input";
};

/// All inputs of a run. Together with the seed, the settings and what operators did they determine every tick.
struct SpaceInputs {
  std::vector<InputRow> rows;
  std::uint64_t version = 0;  ///< rises when rows come, go or move
};

}  // namespace tandem::core
