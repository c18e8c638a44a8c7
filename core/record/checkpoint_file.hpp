// Checkpoint file: the state of a run between two ticks, to go on from in another process.
//
// A block file (core/record/block_file.hpp) of three kinds of blocks: a beginning of JSON, the state in parts, an end.
#pragma once
#include <cstdint>
#include <string>

#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

struct Checkpoint {
  hal::Json about;  ///< experiment, settings, seed, program and files, as a record's beginning
  hal::Tick tick = 0;
  std::uint64_t fingerprint = 0;
  bool touched = false;      ///< people changed something by hand before it
  std::string state;         ///< of World::save; empty: it has none
  std::string why_no_state;  ///< for people
};

/// Writes the file beside its place, has the disk take it, and puts it there: whatever ends the process, the file is
/// whole, the new one or the one before. Error: what, where, why; the one before is there still.
hal::Status write_checkpoint(const std::string& path, const Checkpoint& checkpoint);

/// Error: no checkpoint, damaged or cut, or of a processor with another order of bytes.
hal::Result<Checkpoint> read_checkpoint(const std::string& path);

}  // namespace tandem::core
