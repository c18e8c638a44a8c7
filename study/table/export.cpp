// Tables of studies as comma-separated values.
#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "core/record/csv.hpp"
#include "hal/output_file.hpp"
#include "hal/unit.hpp"
#include "study/table/database.hpp"
#include "study/table/table.hpp"
#include "study/values.hpp"

namespace tandem::study {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;

/// Units of columns whose every value is a number with the same one, by the columns' names.
using Units = std::map<std::string, std::string>;

/// Of what the study varies: the columns between the seed and the state.
Units units_of_settings(Database& database) {
  const auto is_unit = [](const std::string& text) {
    const auto all = hal::all_units();
    return std::any_of(all.begin(), all.end(), [&](const hal::Unit& unit) { return text == unit.symbol; });
  };
  Units units;
  Statement all(database, "SELECT * FROM runs LIMIT 0");
  for (int i = 3; i < all.columns() && all.name(i) != "state"; ++i) {
    std::set<std::string> found;
    for (Statement values(database, "SELECT DISTINCT " + quoted(all.name(i)) + " FROM runs"); values.step();) {
      const auto value = quantity_of(values.text(0));
      found.insert(value.ok() ? value.value().unit : std::string());
    }
    if (found.size() != 1 || found.begin()->empty()) continue;
    if (const std::string unit = found.begin()->substr(1); is_unit(unit)) units[all.name(i)] = unit;
  }
  return units;
}

hal::Status write_rows(Database& database, const std::string& query, const std::string& path, const Units& units = {}) {
  auto file = hal::OutputFile::open(path, "table");
  if (!file.ok()) return file.error();
  Statement rows(database, query);
  std::string text;
  bool named = false;
  std::vector<bool> has_unit;
  const auto name_columns = [&] {
    for (int i = 0; i < rows.columns(); ++i) {
      const auto unit = units.find(rows.name(i));
      has_unit.push_back(unit != units.end());
      const std::string title = has_unit.back() ? core::column_title(rows.name(i), unit->second) : rows.name(i);
      text += (i > 0 ? "," : "") + core::csv_cell(title);
    }
    text += '\n';
    named = true;
  };
  const auto cell = [&](int i) {
    const std::string value = rows.text(i);
    return has_unit[static_cast<std::size_t>(i)] ? hal::format_number(quantity_of(value).value().number) : value;
  };
  while (rows.step()) {
    if (!named) name_columns();
    for (int i = 0; i < rows.columns(); ++i) text += (i > 0 ? "," : "") + core::csv_cell(cell(i));
    text += '\n';
    if (text.size() < kPiece) continue;
    if (const hal::Status written = file->write(text); !written.ok()) return written;
    text.clear();
  }
  if (const hal::Status read = database.status(); !read.ok()) return read;
  if (!named) name_columns();
  const hal::Status written = file->write(text);
  return written.ok() ? file->commit() : written;
}

}  // namespace

hal::Result<std::vector<std::string>> export_csv(const std::string& table, const std::string& path) {
  auto opened = Database::open(table, Database::Use::Read);
  if (!opened.ok()) return opened.error();
  Database& database = **opened;
  std::vector<std::string> files{path};
  if (const hal::Status written =
          write_rows(database, "SELECT * FROM results ORDER BY run", path, units_of_settings(database));
      !written.ok())
    return written.error();
  if (Statement any(database, "SELECT 1 FROM samples LIMIT 1"); !any.step()) return files;
  files.push_back(std::filesystem::path(path).replace_extension(".samples.csv").string());
  const hal::Status written =
      write_rows(database, "SELECT run,measure,tick,time_s,value FROM samples ORDER BY run,measure,tick", files.back());
  if (!written.ok()) return written.error();
  return files;
}

}  // namespace tandem::study
