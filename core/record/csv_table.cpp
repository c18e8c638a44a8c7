#include "core/record/csv_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/record/csv.hpp"

namespace tandem::core {
namespace {

void append_number(std::string& out, double value, int decimals, hal::Scalar scalar = hal::Scalar::F64) {
  if (!std::isfinite(value)) return;
  char digits[400];  // the longest double with 9 decimals has 319 characters
  char* const last = digits + sizeof digits;
  char* end = digits;
  if (decimals >= 0)
    end = std::to_chars(digits, last, value, std::chars_format::fixed, decimals).ptr;
  else if (scalar == hal::Scalar::F32)
    end = std::to_chars(digits, last, static_cast<float>(value)).ptr;
  else if (scalar == hal::Scalar::F64)
    end = std::to_chars(digits, last, value).ptr;
  else
    end = std::to_chars(digits, last, static_cast<std::int64_t>(value)).ptr;
  out.append(digits, end);
}

}  // namespace

std::string column_title(const RecordField& field) {
  return column_title(field.name, field.unit);
}

void CsvTable::note(const RecordRows& rows) {
  for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
    const RecordField& field = rows.stream().fields[f];
    auto column =
        std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.field == field.name; });
    if (column == columns_.end()) {
      const int decimals =
          field.scale == 1.0 || !(field.scale > 1e-300)
              ? -1
              : std::clamp(static_cast<int>(std::ceil(-std::log10(field.scale) - 1e-9)), 0, most_decimals_);
      columns_.push_back({column_title(field), field.name, 0, decimals, field.scalar});
      column = columns_.end() - 1;
    }
    if (!field.used_by) {
      column->values = std::max(column->values, field.count);
      continue;
    }
    for (std::size_t row = 0; row < rows.size(); ++row) column->values = std::max(column->values, rows.used(f, row));
  }
}

std::string CsvTable::header() const {
  std::string line = "tick,time_s,id";
  for (const Column& column : columns_) {
    for (std::size_t i = 0; i < column.values; ++i) {
      line += ',' + column.title;
      if (column.values > 1) line += '[' + std::to_string(i) + ']';
    }
  }
  return line + '\n';
}

void CsvTable::append(hal::Tick tick, const RecordRows& rows, const std::function<bool(const std::string& id)>& wanted,
                      std::string& out) const {
  std::vector<std::size_t> fields;  // of each column; there.size(): it has none
  const std::vector<RecordField>& there = rows.stream().fields;
  for (const Column& column : columns_) {
    const auto found = std::find_if(there.begin(), there.end(), [&](const auto& f) { return f.name == column.field; });
    fields.push_back(static_cast<std::size_t>(found - there.begin()));
  }
  std::string begin = std::to_string(tick) + ',';
  append_number(begin, hal::to_seconds(hal::time_of_tick(tick + 1, ticks_per_second_)), -1);  // the tick's end
  begin += ',';
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string& id = rows.members().ids[row];
    if (wanted && !wanted(id)) continue;
    out += begin;
    out += csv_cell(id);
    for (std::size_t c = 0; c < fields.size(); ++c) {
      const Column& column = columns_[c];
      const std::size_t used = fields[c] < there.size() ? rows.used(fields[c], row) : 0;
      for (std::size_t i = 0; i < column.values; ++i) {
        out += ',';
        if (i < used) append_number(out, rows.value(fields[c], row, i), column.decimals, column.scalar);
      }
    }
    out += '\n';
  }
}

}  // namespace tandem::core
