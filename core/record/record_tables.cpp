#include "core/record/record_tables.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/record/pattern.hpp"
#include "core/record/record_reader.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::core {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBufferValues = std::size_t{1} << 20;

/// One field, over all ticks and entities.
struct DataSet {
  std::string path, unit, doc;
  TableType type = TableType::F64;
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
std::string group_of(const RecordStream& stream) {
  std::string path = stream.of == "robot" ? "" : "/" + in_path(stream.of);
  if (stream.set != "pose") path += "/" + in_path(stream.set);
  return path + "/" + in_path(stream.name);
}

/// What has a float's precision at most stays small.
TableType type_of(const RecordField& field) {
  const bool small = field.scalar == hal::Scalar::F32 || field.scalar == hal::Scalar::U8 ||
                     field.scalar == hal::Scalar::U16 || field.scalar == hal::Scalar::Bool;
  return small && field.scale == 1.0 ? TableType::F32 : TableType::F64;
}

bool wanted(const TableChoice& choice, const RecordEntry& entry) {
  return entry.rows && choice.wants(entry.tick) &&
         (choice.stream.empty() || choice.stream == entry.rows->stream().title());
}

/// Once through the record: which groups and data sets there are, and how large. Error: an asked table or field is not
/// there.
hal::Result<Tables> tables_of(const TableChoice& choice, RecordReader& reader) {
  Tables tables;
  std::vector<std::string> titles, names;
  const auto learn = [](std::vector<std::string>& all, const std::string& text) {
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  };
  while (const auto entry = reader.next()) {
    choice.looked_at(reader, entry->tick);
    if (!entry->rows) continue;
    const RecordRows& rows = *entry->rows;
    const std::string title = rows.stream().title();
    learn(titles, title);
    if (!wanted(choice, *entry)) continue;
    Table& table = tables[title];
    table.path = group_of(rows.stream());
    for (const std::string& id : rows.members().ids) {
      if (choice.wants(id) && table.columns.emplace(id, table.ids.size()).second) table.ids.push_back(id);
    }
    for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
      const RecordField& field = rows.stream().fields[f];
      learn(names, field.name);
      if (!choice.fields.empty() &&
          std::find(choice.fields.begin(), choice.fields.end(), field.name) == choice.fields.end())
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
    return hal::Error{"record '" + choice.record + "' has no " + what + " '" + name + "'; it has " +
                      (list.empty() ? "none" : list) + hal::did_you_mean(name, known)};
  };
  if (!choice.stream.empty() && std::find(titles.begin(), titles.end(), choice.stream) == titles.end())
    return missing("table", choice.stream, titles);
  for (const std::string& field : choice.fields) {
    if (std::find(names.begin(), names.end(), field) == names.end()) return missing("field", field, names);
  }
  return tables;
}

hal::Status make_sets(TableSink& file, Tables& tables) {
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
    for (const auto& [name, type] : {std::pair{"/tick", TableType::I64}, std::pair{"/time", TableType::F64}}) {
      if (const hal::Status added = file.add(table.path + name, type, {}); !added.ok()) return added;
    }
    if (const hal::Status told = file.describe(table.path + "/time", "unit", "s"); !told.ok()) return told;
    if (const hal::Status told = file.add_texts(table.path + "/ids", table.ids); !told.ok()) return told;
  }
  return {};
}

hal::Status flush(TableSink& file, Table& table) {
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
void take(Table& table, hal::Tick tick, double time_s, const RecordRows& rows) {
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

hal::Status write_events(TableSink& file, const std::vector<RecordEvent>& events) {
  std::vector<double> ticks;
  std::vector<std::string> kinds, texts;
  for (const RecordEvent& event : events) {
    ticks.push_back(static_cast<double>(event.tick));
    kinds.push_back(hal::text_of(event.json, "kind"));
    texts.push_back(hal::text_of(event.json, "text", hal::to_text(event.json)));
  }
  hal::Status done = file.add("/events/tick", TableType::I64, {});
  if (done.ok()) done = file.append("/events/tick", ticks.data(), ticks.size());
  if (done.ok()) done = file.add_texts("/events/kind", kinds);
  if (done.ok()) done = file.add_texts("/events/text", texts);
  return done;
}

}  // namespace

void TableChoice::looked_at(const RecordReader& reader, std::int64_t tick) const {
  if (at_tick) at_tick(tick, reader.ticks().empty() ? 0 : reader.ticks().back());
}

bool TableChoice::wants(std::int64_t tick) const {
  return tick >= from.value_or(0) && tick <= until.value_or(tick) && (tick - from.value_or(0)) % every == 0;
}

bool TableChoice::wants(const std::string& id) const {
  return entities.empty() || std::any_of(entities.begin(), entities.end(),
                                         [&id](const std::string& pattern) { return fits_pattern(id, pattern); });
}

struct RecordTables::Impl {
  TableChoice choice;
  Tables tables;
  RecordReader reader;
};

RecordTables::RecordTables(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RecordTables::RecordTables(RecordTables&&) noexcept = default;
RecordTables& RecordTables::operator=(RecordTables&&) noexcept = default;
RecordTables::~RecordTables() = default;

hal::Result<RecordTables> RecordTables::open(const TableChoice& choice) {
  auto first = RecordReader::open(choice.record);
  if (!first.ok()) return first.error();
  auto found = tables_of(choice, first.value());
  if (!found.ok()) return found.error();
  auto again = RecordReader::open(choice.record);
  if (!again.ok()) return again.error();
  return RecordTables(std::make_unique<Impl>(Impl{choice, std::move(found).value(), std::move(again).value()}));
}

std::vector<std::string> RecordTables::damage() const {
  return impl_->reader.damage();
}

hal::Status RecordTables::write(TableSink& sink) {
  Tables& tables = impl_->tables;
  RecordReader& reader = impl_->reader;
  if (const hal::Status sets = make_sets(sink, tables); !sets.ok()) return sets;
  const hal::Json& start = reader.start();
  const double per_second = hal::number_of(start, "ticks_per_second", 10.0);
  for (const auto& [key, value] : start.items()) {
    if (const hal::Status told =
            sink.describe("/", key, value.is_string() ? value.get<std::string>() : hal::to_text(value));
        !told.ok())
      return told;
  }
  while (const auto entry = reader.next()) {
    impl_->choice.looked_at(reader, entry->tick);
    if (!wanted(impl_->choice, *entry)) continue;
    Table& table = tables.at(entry->rows->stream().title());
    const bool next = table.ticks.empty() || table.ticks.back() != static_cast<double>(entry->tick);
    if (next && table.ticks.size() * std::max<std::size_t>(1, table.tick_values) >= kBufferValues) {
      if (const hal::Status flushed = flush(sink, table); !flushed.ok()) return flushed;
    }
    take(table, entry->tick, static_cast<double>(entry->tick + 1) / per_second, *entry->rows);  // at the tick's end
  }
  for (auto& [title, table] : tables) {
    if (const hal::Status flushed = flush(sink, table); !flushed.ok()) return flushed;
  }
  return write_events(sink, reader.events());
}

}  // namespace tandem::core
