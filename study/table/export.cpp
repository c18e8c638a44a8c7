// Tables of studies as comma-separated values.
#include <filesystem>

#include "core/record/csv.hpp"
#include "hal/output_file.hpp"
#include "study/table/database.hpp"
#include "study/table/table.hpp"

namespace tandem::study {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;

hal::Status write_rows(Database& database, const std::string& query, const std::string& path) {
  auto file = hal::OutputFile::open(path, "table");
  if (!file.ok()) return file.error();
  Statement rows(database, query);
  std::string text;
  bool named = false;
  const auto name_columns = [&] {
    for (int i = 0; i < rows.columns(); ++i) text += (i > 0 ? "," : "") + core::csv_cell(rows.name(i));
    text += '\n';
    named = true;
  };
  while (rows.step()) {
    if (!named) name_columns();
    for (int i = 0; i < rows.columns(); ++i) text += (i > 0 ? "," : "") + core::csv_cell(rows.text(i));
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
  if (const hal::Status written = write_rows(database, "SELECT * FROM results ORDER BY run", path); !written.ok())
    return written.error();
  if (Statement any(database, "SELECT 1 FROM samples LIMIT 1"); !any.step()) return files;
  files.push_back(std::filesystem::path(path).replace_extension(".samples.csv").string());
  const hal::Status written =
      write_rows(database, "SELECT run,measure,tick,time_s,value FROM samples ORDER BY run,measure,tick", files.back());
  if (!written.ok()) return written.error();
  return files;
}

}  // namespace tandem::study
