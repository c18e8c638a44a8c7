// Files with every value of a state, at one moment or many: written of runs and of records, read to be compared.
#pragma once
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/space/state_values.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Lines "tick,who,what,field,value": the state after so many ticks, value by value as core::state_values gives them.
class StateDump {
 public:
  /// `every`: after how many ticks it is written; 0: at the end alone. Error: as hal::OutputFile.
  static hal::Result<StateDump> open(const std::string& path, std::int64_t every);

  /// To be called after each tick. Error: the disk is full; nothing is written any more.
  hal::Status tick_done(const core::StateView& state);
  /// Writes the last moment, where that is not there yet, and puts the file in its place. Error: also one of before.
  hal::Status close(const core::StateView& state);

 private:
  StateDump(hal::OutputFile file, std::int64_t every) : file_(std::move(file)), every_(every) {}
  hal::Status write(const core::StateView& state);

  hal::OutputFile file_;
  std::int64_t every_;
  hal::Tick written_ = -1;
  hal::Status state_;
};

/// The state at one moment.
struct DumpedState {
  hal::Tick tick = 0;
  std::vector<core::StateValue> values;
};

/// Reads such a file, moment by moment.
class StateDumpReader {
 public:
  static bool is_dump(const std::string& path);
  explicit StateDumpReader(const std::string& path);

  /// The next moment; nothing at the end. Error: a line that is none, with its number.
  hal::Result<std::optional<DumpedState>> next();

 private:
  hal::Status read_line();

  std::string path_;
  std::ifstream in_;
  std::size_t line_ = 0;
  std::optional<DumpedState> pending_;  // tick of the line that was read last, and its value
};

}  // namespace tandem::app
