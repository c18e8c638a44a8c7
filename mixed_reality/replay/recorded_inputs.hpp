// Reads real robots' effects on a recorded run, tick by tick.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/record/record_reader.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"
#include "mixed_reality/twin/twin_entity.hpp"

namespace tandem::mixed_reality {

/// What the record says of one tick.
struct RecordedTick {
  std::vector<core::RecordRows> inputs;  ///< a table for each kind of row
  std::string checks;                    ///< as core::RecordBlock::Checks; empty: none
};

class RecordedInputs {
 public:
  /// Goes through the whole record once. Errors: it cannot be read; it has no inputs of real robots.
  static hal::Result<RecordedInputs> open(const std::string& path);

  /// Robots that took part at the start, by id; also those that were left out then.
  const std::vector<std::string>& robots() const noexcept { return robots_; }
  /// Ticks whose inputs are there: from 0 up to this.
  hal::Tick ticks() const noexcept { return ticks_; }
  /// Why there are no more: "the run ended", "the record was cut: …", "… is damaged".
  const std::string& end() const noexcept { return end_; }
  const hal::Json& start() const noexcept { return reader_.start(); }

  /// What the record says of this tick, or, at first, of -1: before the run. Ticks may only rise. Nothing: its inputs
  /// are not there.
  const RecordedTick* read(hal::Tick tick);

 private:
  explicit RecordedInputs(core::RecordReader reader) : reader_(std::move(reader)) {}

  core::RecordReader reader_;
  std::optional<core::RecordEntry> ahead_;
  hal::Tick at_ = -2;
  RecordedTick now_;
  std::vector<std::string> robots_;
  hal::Tick ticks_ = 0;
  std::string end_;
};

/// Writes recorded rows into those of an entity.
class InputWriter {
 public:
  explicit InputWriter(TwinEntity& entity, std::string id) : entity_(entity), id_(std::move(id)) {}

  /// Of the rows, those of this robot. Error: they are of another form than those of this program.
  hal::Status write(const core::RecordRows& rows);
  /// Sensors that the entity's controller reads, and that no row was ever there for.
  std::vector<std::string> missing() const;

 private:
  struct Copy {
    std::size_t field = 0, offset = 0, bytes = 0;  // of the record's row; in the row in memory, at most
  };
  struct Plan {
    const void* stream = nullptr;  // for which it was made
    const void* members = nullptr;
    std::optional<std::size_t> row;  // nothing: the robot is not among the members, or has no such sensor
    void* to = nullptr;
    const hal::RowType* type = nullptr;
    std::vector<Copy> copies;
  };
  hal::Status make(const core::RecordRows& rows, Plan& plan) const;

  TwinEntity& entity_;
  std::string id_;
  std::map<std::string, Plan, std::less<>> plans_;  // by the rows' title
};

}  // namespace tandem::mixed_reality
