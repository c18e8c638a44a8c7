// `tandem export --hdf5`: tables of a record as data sets.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "app/command/export.hpp"
#include "app/process/terminal.hpp"
#include "core/record/hdf5/hdf5_file.hpp"
#include "core/record/record_reader.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBufferValues = std::size_t{1} << 20;

/// One field, over all ticks and entities.
struct DataSet {
  std::string path, unit, doc;
  core::Hdf5Type type = core::Hdf5Type::F64;
  std::size_t width = 0;       ///< values of an entity
  std::vector<double> values;  ///< of the ticks that are not written yet
};

/// One table of the record: a group of the file.
struct Table {
  std::string path;
  std::map<std::string, std::size_t> columns;  ///< of entities, by id
  std::vector<std::string> ids;
  std::map<std::string, DataSet> fields;
  std::vector<double> ticks, times;  ///< that are not written yet
  std::size_t tick_values = 0;       ///< of all fields
};
using Tables = std::map<std::string, Table>;

std::string in_path(std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return name.empty() ? "_" : name;
}

/// "sensor proximity" is the group /sensor/proximity.
std::string group_of(const core::RecordStream& stream) {
  std::string path = stream.of == "robot" ? "" : "/" + in_path(stream.of);
  if (stream.set != "pose") path += "/" + in_path(stream.set);
  return path + "/" + in_path(stream.name);
}

/// What has a float's precision at most stays small.
core::Hdf5Type type_of(const core::RecordField& field) {
  const bool small = field.scalar == hal::Scalar::F32 || field.scalar == hal::Scalar::U8 ||
                     field.scalar == hal::Scalar::U16 || field.scalar == hal::Scalar::Bool;
  return small && field.scale == 1.0 ? core::Hdf5Type::F32 : core::Hdf5Type::F64;
}

bool wanted(const ExportOptions& options, const core::RecordEntry& entry) {
  return entry.rows && options.wants(entry.tick) &&
         (options.stream.empty() || options.stream == entry.rows->stream().title());
}

/// Once through the record: which groups and data sets there are, and how large. Error: an asked table or field is not
/// there.
hal::Result<Tables> tables_of(const ExportOptions& options, core::RecordReader& reader) {
  Tables tables;
  std::vector<std::string> titles, names;
  const auto learn = [](std::vector<std::string>& all, const std::string& text) {
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  };
  while (const auto entry = reader.next()) {
    if (!entry->rows) continue;
    const core::RecordRows& rows = *entry->rows;
    const std::string title = rows.stream().title();
    learn(titles, title);
    if (!wanted(options, *entry)) continue;
    Table& table = tables[title];
    table.path = group_of(rows.stream());
    for (const std::string& id : rows.members().ids) {
      if (options.wants(id) && table.columns.emplace(id, table.ids.size()).second) table.ids.push_back(id);
    }
    for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
      const core::RecordField& field = rows.stream().fields[f];
      learn(names, field.name);
      if (!options.fields.empty() &&
          std::find(options.fields.begin(), options.fields.end(), field.name) == options.fields.end())
        continue;
      DataSet& set = table.fields[field.name];
      const bool taken = field.name == "tick" || field.name == "time" || field.name == "ids";
      set.path = table.path + "/" + in_path(field.name) + (taken ? "_" : "");
      set.unit = field.unit;
      set.doc = field.doc;
      set.type = set.width == 0 ? type_of(field) : std::max(set.type, type_of(field));
      std::size_t width = field.used_by ? 1 : field.count;
      for (std::size_t row = 0; field.used_by && row < rows.size(); ++row) width = std::max(width, rows.used(f, row));
      set.width = std::max(set.width, width);
    }
  }
  const auto missing = [&](const char* what, const std::string& name, const std::vector<std::string>& known) {
    std::string list;
    for (const std::string& k : known) list += (list.empty() ? "'" : ", '") + k + "'";
    return hal::Error{"record '" + options.record + "' has no " + what + " '" + name + "'; it has " +
                      (list.empty() ? "none" : list) + hal::did_you_mean(name, known)};
  };
  if (!options.stream.empty() && std::find(titles.begin(), titles.end(), options.stream) == titles.end())
    return missing("table", options.stream, titles);
  for (const std::string& field : options.fields) {
    if (std::find(names.begin(), names.end(), field) == names.end()) return missing("field", field, names);
  }
  return tables;
}

hal::Status make_sets(core::Hdf5File& file, Tables& tables) {
  for (auto& [title, table] : tables) {
    for (auto& [name, set] : table.fields) {
      std::vector<std::size_t> row{table.ids.size()};
      if (set.width > 1) row.push_back(set.width);
      if (const hal::Status added = file.add(set.path, set.type, row); !added.ok()) return added;
      for (const auto& [key, text] : {std::pair{"unit", &set.unit}, std::pair{"doc", &set.doc}}) {
        if (const hal::Status described = file.describe(set.path, key, *text); !described.ok()) return described;
      }
      table.tick_values += table.ids.size() * set.width;
    }
    for (const auto& [name, type] :
         {std::pair{"/tick", core::Hdf5Type::I64}, std::pair{"/time", core::Hdf5Type::F64}}) {
      if (const hal::Status added = file.add(table.path + name, type, {}); !added.ok()) return added;
    }
    if (const hal::Status told = file.describe(table.path + "/time", "unit", "s"); !told.ok()) return told;
    if (const hal::Status told = file.add_texts(table.path + "/ids", table.ids); !told.ok()) return told;
  }
  return {};
}

hal::Status flush(core::Hdf5File& file, Table& table) {
  const std::size_t ticks = table.ticks.size();
  for (auto& [name, set] : table.fields) {
    if (const hal::Status done = file.append(set.path, set.values.data(), ticks); !done.ok()) return done;
    set.values.clear();
  }
  for (const auto& [name, values] : {std::pair{"/tick", &table.ticks}, std::pair{"/time", &table.times}}) {
    if (const hal::Status done = file.append(table.path + name, values->data(), ticks); !done.ok()) return done;
    values->clear();
  }
  return {};
}

/// Adds rows of one tick to what is to be written; those of one tick may come in several parts.
void take(Table& table, hal::Tick tick, double time_s, const core::RecordRows& rows) {
  if (table.ticks.empty() || table.ticks.back() != static_cast<double>(tick)) {
    table.ticks.push_back(static_cast<double>(tick));
    table.times.push_back(time_s);
    for (auto& [name, set] : table.fields) set.values.resize(set.values.size() + table.ids.size() * set.width, kNone);
  }
  for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
    const auto found = table.fields.find(rows.stream().fields[f].name);
    if (found == table.fields.end()) continue;
    DataSet& set = found->second;
    double* const out = set.values.data() + set.values.size() - table.ids.size() * set.width;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const auto column = table.columns.find(rows.members().ids[row]);
      if (column == table.columns.end()) continue;
      for (std::size_t i = 0; i < std::min(set.width, rows.used(f, row)); ++i)
        out[column->second * set.width + i] = rows.value(f, row, i);
    }
  }
}

hal::Status write_events(core::Hdf5File& file, const std::vector<core::RecordEvent>& events) {
  std::vector<double> ticks;
  std::vector<std::string> kinds, texts;
  for (const core::RecordEvent& event : events) {
    ticks.push_back(static_cast<double>(event.tick));
    kinds.push_back(hal::text_of(event.json, "kind"));
    texts.push_back(hal::text_of(event.json, "text", hal::to_text(event.json)));
  }
  hal::Status done = file.add("/events/tick", core::Hdf5Type::I64, {});
  if (done.ok()) done = file.append("/events/tick", ticks.data(), ticks.size());
  if (done.ok()) done = file.add_texts("/events/kind", kinds);
  if (done.ok()) done = file.add_texts("/events/text", texts);
  return done;
}

}  // namespace

hal::Status write_hdf5(const ExportOptions& options) {
  auto first = core::RecordReader::open(options.record);
  if (!first.ok()) return first.error();
  auto found = tables_of(options, first.value());
  if (!found.ok()) return found.error();
  Tables& tables = found.value();
  auto again = core::RecordReader::open(options.record);
  if (!again.ok()) return again.error();
  core::RecordReader& reader = again.value();
  auto output = hal::OutputFile::open(options.hdf5, "HDF5 file");
  if (!output.ok()) return output.error();
  if (output.value().part().empty())
    return hal::Error{"cannot write the HDF5 file '" + options.hdf5 + "': it must be a file, no device or pipe"};
  auto made = core::Hdf5File::create(output.value().part());
  if (!made.ok()) return made.error();
  core::Hdf5File& file = *made.value();
  if (const hal::Status sets = make_sets(file, tables); !sets.ok()) return sets;

  const hal::Json& start = reader.start();
  const double per_second = hal::number_of(start, "ticks_per_second", 10.0);
  for (const auto& [key, value] : start.items()) {
    if (const hal::Status told =
            file.describe("/", key, value.is_string() ? value.get<std::string>() : hal::to_text(value));
        !told.ok())
      return told;
  }
  while (const auto entry = reader.next()) {
    if (!wanted(options, *entry)) continue;
    Table& table = tables.at(entry->rows->stream().title());
    const bool next = table.ticks.empty() || table.ticks.back() != static_cast<double>(entry->tick);
    if (next && table.ticks.size() * std::max<std::size_t>(1, table.tick_values) >= kBufferValues) {
      if (const hal::Status flushed = flush(file, table); !flushed.ok()) return flushed;
    }
    take(table, entry->tick, static_cast<double>(entry->tick + 1) / per_second, *entry->rows);  // at the tick's end
  }
  for (auto& [title, table] : tables) {
    if (const hal::Status flushed = flush(file, table); !flushed.ok()) return flushed;
  }
  if (const hal::Status events = write_events(file, reader.events()); !events.ok()) return events;
  if (const hal::Status closed = file.close(); !closed.ok()) return closed;
  for (const std::string& line : reader.damage()) say("record '" + options.record + "': " + line);
  return output.value().commit();
}

}  // namespace tandem::app
