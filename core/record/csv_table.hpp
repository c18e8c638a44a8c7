// A table of rows of a record as comma-separated values [RFC 4180].
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/record/record_reader.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Name and unit of a field: "x_m", "speed_m_s", "charge".
std::string column_title(const RecordField& field);

/// Lines "tick,time_s,id,…", with a column for each value of each field: as many as the rows that were noted have. The
/// time is that of the tick's end, which the row shows. What a row does not have, or is no number, is empty.
class CsvTable {
 public:
  /// Fixed-point fields have as many decimals as their scale asks for, but not more than `most_decimals`.
  explicit CsvTable(std::int64_t ticks_per_second, int most_decimals = 9)
      : ticks_per_second_(ticks_per_second), most_decimals_(most_decimals) {}

  /// Makes columns for what these rows have.
  void note(const RecordRows& rows);
  std::string header() const;
  /// Appends a line for each row whose id is wanted; null: all.
  void append(hal::Tick tick, const RecordRows& rows, const std::function<bool(const std::string& id)>& wanted,
              std::string& out) const;

 private:
  struct Column {
    std::string title, field;
    std::size_t values = 0;
    int decimals = -1;  // -1: the shortest text that reads back as the same
    hal::Scalar scalar = hal::Scalar::F64;
  };
  std::int64_t ticks_per_second_;
  int most_decimals_;
  std::vector<Column> columns_;
};

}  // namespace tandem::core
