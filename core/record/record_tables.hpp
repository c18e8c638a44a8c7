// The tables of a record, for export.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/record/table_sink.hpp"
#include "hal/result.hpp"

namespace tandem::core {

class RecordReader;

/// What of a record is wanted.
struct TableChoice {
  std::string record;
  std::string stream;                       ///< which of its tables; empty: all
  std::vector<std::string> fields;          ///< only these; empty: all
  std::vector<std::string> entities;        ///< ids, or patterns with '*'; empty: all
  std::optional<std::int64_t> from, until;  ///< ticks, both included
  std::int64_t every = 1;                   ///< of the ticks that are there
  /// Called with each tick that is looked at, and the last that has poses. May be empty.
  std::function<void(std::int64_t tick, std::int64_t last)> at_tick;

  bool wants(std::int64_t tick) const;
  bool wants(const std::string& id) const;
  /// Calls `at_tick`, if there is one.
  void looked_at(const RecordReader& reader, std::int64_t tick) const;
};

/// A group each: "pose" is /pose, "sensor proximity" is /sensor/proximity. In it `tick`, `time` (s, of the tick's end),
/// `ids`, and a data set for each field: ticks x ids, or ticks x ids x values where a field has several; NaN where
/// there is no value. Beside each `unit` and `doc`; /events has tick, kind and text of what happened; beside / is what
/// the record says of its run. Looks through the record twice; `damage`: what was left out, a line each. Errors: as
/// RecordReader::open; a table or field that it does not have; those of the sink.
class RecordTables {
 public:
  static hal::Result<RecordTables> open(const TableChoice& choice);
  RecordTables(RecordTables&&) noexcept;
  RecordTables& operator=(RecordTables&&) noexcept;
  ~RecordTables();

  hal::Status write(TableSink& sink);
  std::vector<std::string> damage() const;

 private:
  struct Impl;
  explicit RecordTables(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::core
