#include "validate/page.hpp"

#include <fmt/format.h>

#include "hal/markup.hpp"

namespace tandem::validate {

const char* word_of(Verdict verdict) {
  static constexpr const char* kWords[] = {"", "met", "not met", "not made"};
  return kWords[static_cast<std::size_t>(verdict)];
}

namespace {

const char* class_of(Verdict verdict) {
  if (verdict == Verdict::Met) return "met";
  return verdict == Verdict::Told ? "" : "bad";
}

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#1a1a1a}"
    "table{border-collapse:collapse;margin:.6em 0 1.6em;width:100%}th,td{text-align:left;vertical-align:top;"
    "padding:.25em .6em;border-bottom:1px solid #ddd;white-space:pre-wrap}th{font-weight:600;border-bottom:2px solid "
    "#888}td.met,td.bad{white-space:nowrap}td.met{color:#00622c}td.bad{color:#a40000;font-weight:600}figure{display:"
    "inline-block;margin:.5em;max-width:"
    "32em}img{width:100%}figcaption{font-size:.9em;color:#444}";

std::string table_html(const Table& table) {
  std::string out = fmt::format("<h3>{}</h3>\n", hal::escaped_markup(table.title));
  if (!table.text.empty()) out += fmt::format("<p>{}</p>\n", hal::escaped_markup(table.text));
  out += "<table><tr>";
  for (const std::string& column : table.columns) out += fmt::format("<th>{}</th>", hal::escaped_markup(column));
  out += "<th>contract</th><th></th></tr>\n";
  for (const Row& row : table.rows) {
    out += "<tr>";
    for (const std::string& cell : row.cells) out += fmt::format("<td>{}</td>", hal::escaped_markup(cell));
    out += fmt::format("<td>{}</td><td class=\"{}\">{}</td></tr>\n", hal::escaped_markup(row.contract),
                       class_of(row.verdict), word_of(row.verdict));
  }
  return out + "</table>\n";
}

}  // namespace

Count count(const Report& report) {
  Count all;
  for (const Part& part : report.parts)
    for (const Table& table : part.tables)
      for (const Row& row : table.rows) {
        all.met += row.verdict == Verdict::Met ? 1 : 0;
        all.not_met += row.verdict == Verdict::NotMet ? 1 : 0;
        all.not_made += row.verdict == Verdict::NotMade ? 1 : 0;
        all.told += row.verdict == Verdict::Told ? 1 : 0;
      }
  return all;
}

std::string summary_of(const Report& report) {
  const Count all = count(report);
  return fmt::format("{} contracts met, {} not met, {} rows not made; {} rows are told without a contract.", all.met,
                     all.not_met, all.not_made, all.told);
}

std::string page_of(const Report& report) {
  std::string out = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Validation</title><style>{}</style>\n<h1>Validation of Tandem</h1>\n"
      "<p><b>{}</b></p>\n<table>",
      kStyle, summary_of(report));
  for (const auto& [name, value] : report.about)
    out += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", hal::escaped_markup(name), hal::escaped_markup(value));
  out += "</table>\n";
  for (const Part& part : report.parts) {
    out += fmt::format("<h2>{}</h2>\n<p>{} It took {:.0f} s.</p>\n", hal::escaped_markup(part.title),
                       hal::escaped_markup(part.text), part.seconds);
    for (const Table& table : part.tables) out += table_html(table);
    for (const Figure& figure : part.figures)
      out += fmt::format("<figure><img src=\"figures/{0}.svg\" alt=\"{1}\"><figcaption>{1}</figcaption></figure>\n",
                         hal::escaped_markup(figure.name), hal::escaped_markup(figure.caption));
  }
  return out + "</html>\n";
}

hal::Json json_of(const Report& report) {
  hal::Json json;
  for (const auto& [name, value] : report.about) json["about"][name] = value;
  const Count all = count(report);
  json["count"] = {{"met", all.met}, {"not_met", all.not_met}, {"not_made", all.not_made}, {"told", all.told}};
  json["parts"] = hal::Json::array();
  for (const Part& part : report.parts) {
    hal::Json tables = hal::Json::array();
    for (const Table& table : part.tables) {
      hal::Json rows = hal::Json::array();
      for (const Row& row : table.rows)
        rows.push_back({{"cells", row.cells}, {"contract", row.contract}, {"verdict", word_of(row.verdict)}});
      tables.push_back({{"title", table.title}, {"columns", table.columns}, {"rows", rows}});
    }
    json["parts"].push_back({{"title", part.title}, {"seconds", part.seconds}, {"tables", tables}});
  }
  return json;
}

}  // namespace tandem::validate
