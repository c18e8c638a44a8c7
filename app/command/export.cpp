#include "app/command/export.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <map>

#include "app/command/command.hpp"
#include "app/experiment/plugins.hpp"
#include "app/outputs/report.hpp"
#include "app/outputs/state_dump.hpp"
#include "app/process/progress.hpp"
#include "app/process/terminal.hpp"
#include "core/record/csv_table.hpp"
#include "core/record/record_reader.hpp"
#include "core/record/record_source.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

std::int64_t ticks_per_second(const hal::Json& start) {
  return std::llround(std::clamp(hal::number_of(start, "ticks_per_second", 10.0), 1.0, 1e6));
}

hal::Error no_such_table(const ExportOptions& options, const std::string& title,
                         const std::vector<std::string>& tables) {
  std::string list;
  for (const std::string& table : tables) list += (list.empty() ? "'" : ", '") + table + "'";
  return hal::Error{"record '" + options.record + "' has no table '" + title + "'; it has " +
                    (list.empty() ? "none" : list) + hal::did_you_mean(title, tables)};
}

/// The columns of the table. Error: there is none of that name.
hal::Result<core::CsvTable> columns_of(const ExportOptions& options, const std::string& title,
                                       core::RecordReader& reader) {
  core::CsvTable table(ticks_per_second(reader.start()));
  std::vector<std::string> tables;
  while (const auto entry = reader.next()) {
    options.looked_at(reader, entry->tick);
    if (!entry->rows) continue;
    if (const std::string here = entry->rows->stream().title();
        std::find(tables.begin(), tables.end(), here) == tables.end())
      tables.push_back(here);
    if (entry->rows->stream().title() == title && options.wants(entry->tick)) table.note(*entry->rows);
  }
  if (std::find(tables.begin(), tables.end(), title) != tables.end()) return table;
  return no_such_table(options, title, tables);
}

hal::Status write_csv(const ExportOptions& options) {
  const std::string title = options.stream.empty() ? "pose" : options.stream;
  auto first = core::RecordReader::open(options.record);
  if (!first.ok()) return first.error();
  const auto table = columns_of(options, title, first.value());
  if (!table.ok()) return table.error();
  auto again = core::RecordReader::open(options.record);
  if (!again.ok()) return again.error();
  auto file = hal::OutputFile::open(options.csv, "table");
  if (!file.ok()) return file.error();
  const auto wanted = [&options](const std::string& id) { return options.wants(id); };
  std::string out = table.value().header();
  while (const auto entry = again.value().next()) {
    options.looked_at(again.value(), entry->tick);
    if (!entry->rows || entry->rows->stream().title() != title || !options.wants(entry->tick)) continue;
    table.value().append(entry->tick, *entry->rows, wanted, out);
    if (out.size() < kBufferBytes) continue;
    if (const hal::Status written = file.value().write(out); !written.ok()) return written;
    out.clear();
  }
  if (const hal::Status written = file.value().write(out); !written.ok()) return written;
  for (const std::string& line : again.value().damage()) say("record '" + options.record + "': " + line);
  return file.value().commit();
}

hal::Status write_report(const ExportOptions& options) {
  auto reader = core::RecordReader::open(options.record);
  if (!reader.ok()) return reader.error();
  while (const auto entry = reader.value().next()) {
    options.looked_at(reader.value(), entry->tick);
    if (entry->type == core::RecordBlock::End)
      return hal::write_whole_file(options.report, "report", hal::to_text(entry->json) + "\n");
  }
  return hal::Error{"record '" + options.record + "' has no end: the run was killed, or the disk was full"};
}

/// What the record says of the state, as a run's dump has all of it.
hal::Status write_dump(const ExportOptions& options) {
  auto reader = core::RecordReader::open(options.record);
  if (!reader.ok()) return reader.error();
  const auto known = kinds_of_settings(hal::text_of(reader.value().start(), "settings"), options.record);
  auto opened = core::RecordSource::open(options.record, &known->catalog);
  if (!opened.ok()) return opened.error();
  core::RecordSource& record = opened.value();
  auto dump = StateDump::open(options.dump, 1);
  if (!dump.ok()) return dump.error();
  const auto state = [&record] { return core::StateView{record.space().stores(), record.seed(), record.ticks_done()}; };
  std::optional<hal::Tick> last;
  do {
    if (options.at_tick) options.at_tick(record.ticks_done() - 1, record.moments().ticks().back());
    if (!options.wants(record.ticks_done() - 1)) continue;
    last = record.ticks_done();
    if (const hal::Status written = dump.value().tick_done(state()); !written.ok()) return written;
  } while (record.next());
  if (!last) return hal::Error{"record '" + options.record + "' has no such ticks"};
  record.go_to(*last);
  return dump.value().close(state());
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
    options.looked_at(reader, entry->tick);
    events += entry->type == core::RecordBlock::Event ? 1 : 0;
    fingerprints += entry->type == core::RecordBlock::Fingerprint ? 1 : 0;
    if (entry->type == core::RecordBlock::End) end = hal::text_of(entry->json, "ended", "?");
    if (!entry->rows || entry->tick < 0) continue;
    Table& table = tables[entry->rows->stream().title()];
    if (table.ticks == 0) {
      table.first = entry->tick;
      for (const core::RecordField& field : entry->rows->stream().fields)
        table.fields += (table.fields.empty() ? "" : ", ") + core::column_title(field);
    }
    if (table.ticks == 0 || entry->tick != table.last) ++table.ticks;
    table.last = entry->tick;
    table.members = std::max(table.members, entry->rows->size());
  }
  const hal::Json& start = reader.start();
  std::vector<std::pair<std::string, std::string>> rows = {
      {"experiment",
       fmt::format("{}, seed {:.0f}", hal::text_of(start, "experiment", "?"), hal::number_of(start, "seed"))}};
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

void ExportOptions::describe(hal::CommandLine& line) {
  line.footer("A file that stands in the place of one that is written is kept as FILE.bak.");
  line.word("record", record, "The record; that of a run that was killed is FILE.part").required().file();
  line.option("--csv", csv, "Write comma-separated values of one table to this file ('-': standard output)").file();
  line.option("--hdf5", hdf5, "Write the tables as data sets to this file, for h5py, Matlab, …").file();
  line.option("--report", report, "Write what its run said at the end, as `tandem run --report` ('-': standard output)")
      .file();
  line.option("--dump", dump, "Write every value that it has of the state as CSV, as `tandem run --dump` writes all")
      .file();
  line.option("--table", stream, "Which table, as the record names it; default: in CSV 'pose', in HDF5 all");
  line.option("--fields", fields, "Of HDF5: only these fields, separated by commas").separated();
  line.option("--entities", entities, "Only of these, separated by commas; '*' stands for any text").separated();
  line.option("--from", from, "First tick");
  line.option("--until", until, "Last tick");
  line.option("--every", every, "Only every so manyth tick").positive();
}

namespace {

hal::Status write_all(const ExportOptions& options) {
  if (options.csv.empty() && options.hdf5.empty() && options.report.empty() && options.dump.empty())
    return print_contents(options);
  hal::Status done;
  if (!options.csv.empty()) done = write_csv(options);
  if (done.ok() && !options.hdf5.empty()) done = write_hdf5(options);
  if (done.ok() && !options.report.empty()) done = write_report(options);
  if (done.ok() && !options.dump.empty()) done = write_dump(options);
  return done;
}

/// Says how far each way through the record is.
hal::Status write_with_progress(ExportOptions options) {
  std::optional<Progress> progress;
  std::int64_t before = 0;
  options.at_tick = [&](std::int64_t tick, std::int64_t last) {
    if (!progress || tick < before) progress.emplace(std::max<std::int64_t>(1, last), 1, "export", "ticks");
    progress->step(before = tick);
  };
  return write_all(options);
}

int export_record(const ExportOptions& options) {
  if (const hal::Status apart = check_apart(
          {{"table", options.csv}, {"HDF5 file", options.hdf5}, {"report", options.report}, {"dump", options.dump}},
          {{"record", options.record}});
      !apart.ok())
    return complain(kBadInput, apart.error().message);
  hal::Status done;
  for (const std::string* path : {&options.csv, &options.hdf5, &options.report, &options.dump}) {
    if (done.ok()) done = keep_old(*path);
  }
  if (!done.ok()) return complain(kFailedRunning, done.error().message);
  done = write_with_progress(options);
  return done.ok() ? kDone : complain(kBadInput, done.error().message);
}

}  // namespace

constinit const hal::CommandType export_command = hal::command_type<ExportOptions, export_record>(
    "export", "Say what a record of `tandem run --record` holds, or make a table of it.", hal::command_group::kStudy);

}  // namespace tandem::app
