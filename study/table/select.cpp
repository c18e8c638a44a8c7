#include "study/table/select.hpp"

#include <algorithm>
#include <cmath>

#include "hal/element.hpp"
#include "study/table/database.hpp"

namespace tandem::study {
namespace {

hal::Result<std::unique_ptr<Database>> open_table(const std::string& path) {
  auto database = Database::open(path, Database::Use::Read);
  if (!database.ok()) return database.error();
  const bool table = (*database)->has("runs") && (*database)->has("measures");
  if (const hal::Status read = (*database)->status(); !read.ok()) return read.error();
  if (!table) return hal::Error{"'" + path + "' is no table of a study; `tandem sweep` writes them"};
  return database;
}

std::vector<std::string> texts(Database& database, const std::string& query) {
  std::vector<std::string> all;
  Statement rows(database, query);
  while (rows.step()) all.push_back(rows.text(0));
  return all;
}

TableContents contents(Database& d) {
  TableContents c;
  const std::vector<std::string> names = texts(d, "SELECT name FROM pragma_table_info('runs')");
  if (names.size() >= 10) c.columns.assign(names.begin() + 1, names.end() - 7);
  for (const std::string& name : c.columns) {
    if (name == "seed") continue;
    Statement several(d, "SELECT count(DISTINCT " + quoted(name) + ") FROM runs");
    if (several.step() && several.integer(0) > 1) c.varied.push_back(name);
  }
  c.measures = texts(d, "SELECT measure FROM measures UNION SELECT measure FROM samples ORDER BY 1");
  Statement any(d, "SELECT 1 FROM samples LIMIT 1");
  c.samples = any.step();
  Statement done(d, "SELECT sum(state='done'), sum(state<>'done') FROM runs");
  if (done.step() && !done.is_null(0)) {
    c.done = done.integer(0);
    c.failed = done.integer(1);
  }
  return c;
}

hal::Status check_name(const char* what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return {};
  return hal::Error{std::string("the table has no ") + what + " '" + name +
                    "'; it has: " + (known.empty() ? "none" : hal::listed(known)) + hal::did_you_mean(name, known)};
}

std::string column_of(const std::string& name) {
  return name.empty() ? "''" : "runs." + quoted(name);
}

hal::Status check_names(const Selection& s, const TableContents& there, const std::string& over_column) {
  if (const hal::Status known = check_name("measure", s.measure, there.measures); !known.ok()) return known;
  std::vector<std::string> columns = {s.by, s.panel, over_column};
  for (const auto& [column, value] : s.where) columns.push_back(column);
  for (const std::string& column : columns) {
    if (column.empty()) continue;
    if (const hal::Status known = check_name("column", column, there.columns); !known.ok()) return known;
  }
  return {};
}

/// The rest of a query's condition.
std::string and_where(const Selection& s) {
  std::string condition;
  for (const auto& [name, value] : s.where) condition += " AND " + column_of(name) + "=?";
  return condition;
}

void bind_where(Statement& rows, const Selection& s) {
  for (const auto& [name, value] : s.where) rows.bind_setting(value);
}

hal::Error nothing_there(Database& d, const Selection& s, const std::string& measures) {
  constexpr std::size_t kNamed = 20;
  for (const auto& [name, value] : s.where) {
    Statement any(d, "SELECT 1 FROM runs WHERE " + column_of(name) + "=? LIMIT 1");
    any.bind_setting(value);
    if (any.step()) continue;
    std::vector<std::string> values =
        texts(d, "SELECT DISTINCT " + column_of(name) + " FROM runs ORDER BY 1 LIMIT " + std::to_string(kNamed + 1));
    if (values.size() > kNamed) values.back() = "…";
    return {"no run has '" + value + "' in the column '" + name + "'; it has: " + hal::listed(values)};
  }
  return {"no run that is done has " + measures + (s.where.empty() ? "" : " and the values of --where")};
}

/// What runs of different groups must have in common to be a pair: every column but those that the group decides, as
/// the others of a paired list.
std::string pair_expression(Database& d, const Selection& s, const TableContents& there) {
  std::string all = "''";
  for (const std::string& name : there.columns) {
    if (name == s.by) continue;
    if (!s.by.empty()) {
      Statement free(
          d, "SELECT 1 FROM runs GROUP BY " + quoted(s.by) + " HAVING count(DISTINCT " + quoted(name) + ")>1 LIMIT 1");
      if (!free.step()) continue;
    }
    all += "||char(31)||" + column_of(name);
  }
  return all;
}

}  // namespace

hal::Result<TableContents> contents_of(const std::string& table) {
  auto database = open_table(table);
  if (!database.ok()) return database.error();
  TableContents c = contents(**database);
  if (const hal::Status read = (*database)->status(); !read.ok()) return read.error();
  return c;
}

hal::Result<std::vector<Observation>> select(const std::string& table, const Selection& s) {
  auto database = open_table(table);
  if (!database.ok()) return database.error();
  Database& d = **database;
  const TableContents there = contents(d);
  const bool over_time = s.over == kOverTime;
  if (const hal::Status known = check_names(s, there, over_time ? "" : s.over); !known.ok()) return known.error();
  if (over_time && !there.samples)
    return hal::Error{"the table has no samples over time; <measures every=\"…\"/> in the study asks for them"};
  std::string query = "SELECT " + column_of(s.panel) + "," + column_of(s.by) + ",";
  query += over_time ? "m.time_s" : column_of(s.over);
  query += ", m.value, runs.run, " + (s.pairs ? pair_expression(d, s, there) : "''") + " FROM runs JOIN ";
  query += over_time ? "samples" : "measures";
  query += " m ON m.run=runs.run WHERE runs.state='done' AND m.measure=? AND m.value IS NOT NULL" + and_where(s);
  Statement rows(d, query + " ORDER BY 1,2,3,runs.run");
  rows.bind(std::string_view(s.measure));
  bind_where(rows, s);
  std::vector<Observation> all;
  while (rows.step()) {
    all.push_back({rows.text(0), rows.text(1), rows.text(2), rows.number(3), rows.integer(4),
                   s.pairs ? rows.text(5) : std::string()});
  }
  if (const hal::Status read = d.status(); !read.ok()) return read.error();
  if (all.empty()) return nothing_there(d, s, "the measure '" + s.measure + "'");
  return all;
}

hal::Result<std::vector<Way>> select_ways(const std::string& table, const Selection& s) {
  auto database = open_table(table);
  if (!database.ok()) return database.error();
  Database& d = **database;
  const TableContents there = contents(d);
  if (const hal::Status known = check_names(s, there, ""); !known.ok()) return known.error();
  if (const hal::Status known = check_name("measure", s.over, there.measures); !known.ok()) return known.error();
  std::vector<Way> all;
  for (const bool samples : {true, false}) {
    if (samples ? !there.samples : !all.empty()) continue;
    const std::string from = samples ? "samples" : "measures";
    Statement rows(d, "SELECT " + column_of(s.panel) + "," + column_of(s.by) +
                          ", runs.run, x.value, y.value FROM runs JOIN " + from + " y ON y.run=runs.run JOIN " + from +
                          " x ON x.run=runs.run" + (samples ? " AND x.tick=y.tick" : "") +
                          " WHERE runs.state='done' AND y.measure=? AND x.measure=? AND y.value IS NOT NULL AND "
                          "x.value IS NOT NULL" +
                          and_where(s) + " ORDER BY 1,2,runs.run" + (samples ? ",y.tick" : ""));
    rows.bind(std::string_view(s.measure)).bind(std::string_view(s.over));
    bind_where(rows, s);
    while (rows.step()) {
      if (all.empty() || all.back().run != rows.integer(2))
        all.push_back({rows.text(0), rows.text(1), rows.integer(2), {}});
      all.back().places.emplace_back(rows.number(3), rows.number(4));
    }
  }
  if (const hal::Status read = d.status(); !read.ok()) return read.error();
  if (all.empty()) return nothing_there(d, s, "the measures '" + s.measure + "' and '" + s.over + "'");
  return all;
}

}  // namespace tandem::study
