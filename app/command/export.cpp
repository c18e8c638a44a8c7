#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <map>

#include "app/command/command.hpp"
#include "app/report.hpp"
#include "app/terminal.hpp"
#include "core/record/csv.hpp"
#include "core/record/record_reader.hpp"
#include "core/record/trajectory.hpp"
#include "hal/element.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

/// A member of a record's JSON, which anybody may have written.
double number_of(const hal::Json& json, const char* key, double otherwise) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : otherwise;
}
std::string text_of(const hal::Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "?";
}

/// What of the table was asked for.
bool wanted(const ExportOptions& options, const core::RecordEntry& entry) {
  return entry.rows && entry.rows->stream().title() == options.stream && entry.tick >= options.from.value_or(0) &&
         entry.tick <= options.until.value_or(entry.tick) &&
         (entry.tick - options.from.value_or(0)) % options.every == 0;
}

bool wanted(const ExportOptions& options, const std::string& id) {
  return options.entities.empty() ||
         std::any_of(options.entities.begin(), options.entities.end(),
                     [&id](const std::string& pattern) { return core::fits_pattern(id, pattern); });
}

/// Columns of a table: fields by name, as many of each as any of its rows has.
struct CsvColumn {
  std::string title;
  std::string field;
  std::size_t values = 0;
  int decimals = -1;  ///< of fixed-point numbers; -1: the shortest text that reads back as the same
  hal::Scalar scalar = hal::Scalar::F64;
};

/// "x_m", "speed_m_s", "charge": with the unit, as everywhere.
std::string title_of(const core::RecordField& field) {
  std::string title = field.name;
  if (field.unit.empty() || field.unit == "%") return title;
  title += '_';
  for (const char c : field.unit) title += c == '/' ? '_' : c;
  return title;
}

void append_number(std::string& out, double value, int decimals, hal::Scalar scalar = hal::Scalar::F64) {
  if (!std::isfinite(value)) return;
  char digits[400];
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

/// The columns of the table, and which tables there are.
hal::Result<std::vector<CsvColumn>> columns_of(const ExportOptions& options, core::RecordReader& reader) {
  std::vector<CsvColumn> columns;
  std::vector<std::string> tables;
  while (const auto entry = reader.next()) {
    if (!entry->rows) continue;
    const core::RecordRows& rows = *entry->rows;
    if (const std::string title = rows.stream().title(); std::find(tables.begin(), tables.end(), title) == tables.end())
      tables.push_back(title);
    if (!wanted(options, *entry)) continue;
    for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
      const core::RecordField& field = rows.stream().fields[f];
      auto column =
          std::find_if(columns.begin(), columns.end(), [&](const CsvColumn& c) { return c.field == field.name; });
      if (column == columns.end()) {
        const int decimals = field.scale == 1.0 ? -1 : static_cast<int>(std::ceil(-std::log10(field.scale) - 1e-9));
        columns.push_back({title_of(field), field.name, 0, decimals, field.scalar});
        column = columns.end() - 1;
      }
      if (!field.used_by) {
        column->values = std::max(column->values, field.count);
        continue;
      }
      for (std::size_t row = 0; row < rows.size(); ++row) column->values = std::max(column->values, rows.used(f, row));
    }
  }
  if (std::find(tables.begin(), tables.end(), options.stream) != tables.end()) return columns;
  std::string list;
  for (const std::string& table : tables) list += (list.empty() ? "'" : ", '") + table + "'";
  return hal::Error{"record '" + options.record + "' has no table '" + options.stream + "'; it has " +
                    (list.empty() ? "none" : list) + hal::did_you_mean(options.stream, tables)};
}

hal::Status write_csv(const ExportOptions& options) {
  auto first = core::RecordReader::open(options.record);
  if (!first.ok()) return first.error();
  auto columns = columns_of(options, first.value());
  if (!columns.ok()) return columns.error();
  auto again = core::RecordReader::open(options.record);
  if (!again.ok()) return again.error();
  auto file = hal::OutputFile::open(options.csv, "table");
  if (!file.ok()) return file.error();

  const auto per_second = number_of(first.value().start(), "ticks_per_second", 10.0);
  std::string out = "tick,time_s,id";
  for (const CsvColumn& column : columns.value()) {
    for (std::size_t i = 0; i < column.values; ++i) {
      out += ',' + column.title;
      if (column.values > 1) out += '[' + std::to_string(i) + ']';
    }
  }
  out += '\n';
  while (const auto entry = again.value().next()) {
    if (!wanted(options, *entry)) continue;
    const core::RecordRows& rows = *entry->rows;
    std::vector<std::size_t> fields;  // of each column; fields.size(): it has none
    const auto& there = rows.stream().fields;
    for (const CsvColumn& column : columns.value()) {
      const auto found =
          std::find_if(there.begin(), there.end(), [&](const auto& f) { return f.name == column.field; });
      fields.push_back(static_cast<std::size_t>(found - there.begin()));
    }
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string& id = rows.members().ids[row];
      if (!wanted(options, id)) continue;
      out += std::to_string(entry->tick) + ',';
      append_number(out, static_cast<double>(entry->tick) / per_second, -1);
      out += ',' + core::csv_cell(id);
      for (std::size_t c = 0; c < fields.size(); ++c) {
        const CsvColumn& column = columns.value()[c];
        const std::size_t used = fields[c] < there.size() ? rows.used(fields[c], row) : 0;
        for (std::size_t i = 0; i < column.values; ++i) {
          out += ',';
          if (i < used) append_number(out, rows.value(fields[c], row, i), column.decimals, column.scalar);
        }
      }
      out += '\n';
    }
    if (out.size() < kBufferBytes) continue;
    if (const hal::Status written = file.value().write(out); !written.ok()) return written;
    out.clear();
  }
  if (const hal::Status written = file.value().write(out); !written.ok()) return written;
  for (const std::string& line : again.value().damage()) say("record '" + options.record + "': " + line);
  return file.value().commit();
}

hal::Status print_contents(const ExportOptions& options) {
  auto opened = core::RecordReader::open(options.record);
  if (!opened.ok()) return opened.error();
  core::RecordReader& reader = opened.value();
  struct Table {
    hal::Tick first = 0, last = 0;
    std::size_t ticks = 0, members = 0;
    std::string fields;
  };
  std::map<std::string, Table> tables;
  std::size_t events = 0, fingerprints = 0;
  std::string end;
  while (const auto entry = reader.next()) {
    events += entry->type == core::RecordBlock::Event ? 1 : 0;
    fingerprints += entry->type == core::RecordBlock::Fingerprint ? 1 : 0;
    if (entry->type == core::RecordBlock::End) end = text_of(entry->json, "ended");
    if (!entry->rows || entry->tick < 0) continue;
    Table& table = tables[entry->rows->stream().title()];
    if (table.ticks == 0) {
      table.first = entry->tick;
      for (const core::RecordField& field : entry->rows->stream().fields)
        table.fields += (table.fields.empty() ? "" : ", ") + title_of(field);
    }
    if (table.ticks == 0 || entry->tick != table.last) ++table.ticks;
    table.last = entry->tick;
    table.members = std::max(table.members, entry->rows->size());
  }
  const hal::Json& start = reader.start();
  std::vector<std::pair<std::string, std::string>> rows = {
      {"experiment", fmt::format("{}, seed {:.0f}", text_of(start, "experiment"), number_of(start, "seed", 0.0))}};
  for (const auto& [title, table] : tables) {
    rows.emplace_back("table", fmt::format("'{}': ticks {} to {}, {} of them, {} rows each; {}", title, table.first,
                                           table.last, table.ticks, table.members, table.fields));
  }
  rows.emplace_back("events", std::to_string(events));
  if (fingerprints > 0) rows.emplace_back("fingerprints", std::to_string(fingerprints));
  rows.emplace_back("end", reader.cut() ? "missing: the run was killed, or the disk was full" : end);
  for (const std::string& line : reader.damage()) rows.emplace_back("damaged", line);
  print_table(rows);
  return {};
}

}  // namespace

int export_record(const ExportOptions& options) {
  const hal::Status done = options.csv.empty() ? print_contents(options) : write_csv(options);
  return done.ok() ? kDone : complain(kBadInput, done.error().message);
}

}  // namespace tandem::app
