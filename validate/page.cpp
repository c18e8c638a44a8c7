#include "validate/page.hpp"

#include <fmt/format.h>

#include "hal/markup.hpp"

namespace tandem::validate {
namespace {

const char* word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Met:
      return "met";
    case Verdict::NotMet:
      return "not met";
    case Verdict::NotMade:
      return "not made";
    case Verdict::Told:
      break;
  }
  return "";
}

const char* class_of(Verdict verdict) {
  if (verdict == Verdict::Met) return "met";
  return verdict == Verdict::Told ? "" : "bad";
}

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#1a1a1a}"
    "table{border-collapse:collapse;margin:.6em 0 1.6em;width:100%}th,td{text-align:left;vertical-align:top;"
    "padding:.25em .6em;border-bottom:1px solid #ddd;white-space:pre-wrap}th{font-weight:600;border-bottom:2px solid "
    "#888}td.met{color:#00622c}td.bad{color:#a40000;font-weight:600}figure{display:inline-block;margin:.5em;max-width:"
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

namespace {

// A sheet is A4 at 96 pixels an inch.
constexpr double kWidth_px = 794.0, kHeight_px = 1123.0, kMargin_px = 48.0;
constexpr double kLine_px = 12.5, kFont_px = 9.0;
constexpr double kCharacter_px = 4.9;  // of the font, in the mean
constexpr double kFigure_px = 340.0;   // width of a figure, two a line

/// Lines of at most `most` characters, broken at blanks where there are any.
std::vector<std::string> wrapped(const std::string& text, std::size_t most) {
  std::vector<std::string> lines;
  std::string rest = text;
  while (rest.size() > most) {
    std::size_t at = rest.rfind(' ', most);
    if (at == std::string::npos || at == 0) at = most;
    while (at < rest.size() && (static_cast<unsigned char>(rest[at]) & 0xC0U) == 0x80U) ++at;  // not within a letter
    lines.push_back(rest.substr(0, at));
    rest.erase(0, rest[at] == ' ' ? at + 1 : at);
  }
  lines.push_back(rest);
  return lines;
}

/// Fills sheets from the top, and begins another where one is full.
class Sheets {
 public:
  void text(const std::string& words, double size_px, bool bold = false) {
    const auto most = static_cast<std::size_t>((kWidth_px - 2 * kMargin_px) / (kCharacter_px * size_px / kFont_px));
    for (const std::string& line : wrapped(words, most)) {
      room(size_px * 1.4);
      put(kMargin_px, line, size_px, bold, "#1a1a1a");
      y_ += size_px * 1.4;
    }
    y_ += 3.0;
  }

  void table(const Table& table) {
    std::vector<std::vector<std::string>> cells = {table.columns};
    cells.front().insert(cells.front().end(), {"contract", ""});
    for (const Row& row : table.rows) {
      cells.push_back(row.cells);
      cells.back().insert(cells.back().end(), {row.contract, word_of(row.verdict)});
    }
    const std::vector<std::size_t> widths = widths_of(cells);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool bad = i > 0 && std::string(class_of(table.rows[i - 1].verdict)) == "bad";
      line(cells[i], widths, i == 0, bad ? "#a40000" : "#1a1a1a");
    }
    y_ += 8.0;
  }

  void figures(const std::vector<std::string>& svgs, const std::vector<Figure>& about) {
    constexpr double kRoom_px = kFigure_px * 0.75 + 24.0;
    for (std::size_t i = 0; i < svgs.size(); ++i) {
      if (i % 2 == 0) room(kRoom_px);
      const double x = kMargin_px + static_cast<double>(i % 2) * (kFigure_px + 16.0);
      body_ +=
          fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/svg+xml;base64,{}\"/>\n",
                      x, y_, kFigure_px, kFigure_px * 0.75, base64(svgs[i]));
      const double top = y_;
      y_ += kFigure_px * 0.75 + 10.0;
      put(x, about[i].caption, kFont_px, false, "#444");
      y_ = i % 2 == 1 || i + 1 == svgs.size() ? top + kRoom_px : top;
    }
  }

  std::vector<std::string> all() {
    end();
    return std::move(sheets_);
  }

 private:
  void room(double height_px) {
    if (y_ + height_px > kHeight_px - kMargin_px) end();
  }
  void end() {
    sheets_.push_back(
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
                    "font-family=\"DejaVu Sans,Arial,sans-serif\">{2}</svg>",
                    kWidth_px, kHeight_px, body_));
    body_.clear();
    y_ = kMargin_px;
  }
  void put(double x, const std::string& words, double size_px, bool bold, const char* color) {
    body_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\"{} fill=\"{}\">{}</text>\n", x, y_ + size_px, size_px,
                         bold ? " font-weight=\"bold\"" : "", color, hal::escaped_markup(words));
  }

  /// Characters of each column: all that it needs, or its share of what there is.
  static std::vector<std::size_t> widths_of(const std::vector<std::vector<std::string>>& cells) {
    std::vector<std::size_t> widths(cells.front().size(), 4);
    for (const auto& row : cells)
      for (std::size_t i = 0; i < std::min(row.size(), widths.size()); ++i)
        widths[i] = std::max(widths[i], row[i].size() + 2);
    const auto most = static_cast<std::size_t>((kWidth_px - 2 * kMargin_px) / kCharacter_px);
    std::size_t sum = 0;
    for (const std::size_t w : widths) sum += w;
    while (sum > most) {
      std::size_t& widest = *std::max_element(widths.begin(), widths.end());
      --widest, --sum;
    }
    return widths;
  }

  void line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths, bool bold,
            const char* color) {
    std::vector<std::vector<std::string>> columns;
    std::size_t lines = 1;
    for (std::size_t i = 0; i < std::min(cells.size(), widths.size()); ++i) {
      columns.push_back(wrapped(cells[i], widths[i] > 2 ? widths[i] - 2 : 1));
      lines = std::max(lines, columns.back().size());
    }
    room(kLine_px * static_cast<double>(lines));
    for (std::size_t n = 0; n < lines; ++n) {
      double x = kMargin_px;
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (n < columns[i].size()) put(x, columns[i][n], kFont_px * 0.92, bold, color);
        x += kCharacter_px * static_cast<double>(widths[i]);
      }
      y_ += kLine_px;
    }
  }

  static std::string base64(const std::string& bytes) {
    constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t three = 0;
      for (std::size_t k = 0; k < 3; ++k)
        three = (three << 8U) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
      for (std::size_t k = 0; k < 4; ++k)
        out += i + k > bytes.size() ? '=' : kLetters[(three >> (18U - 6U * static_cast<unsigned>(k))) & 63U];
    }
    return out;
  }

  std::vector<std::string> sheets_;
  std::string body_;
  double y_ = kMargin_px;
};

}  // namespace

std::vector<std::string> sheets_of(const Report& report, const std::vector<std::vector<std::string>>& figures) {
  Sheets sheets;
  sheets.text("Validation of Tandem", 22.0, true);
  sheets.text(summary_of(report), 11.0, true);
  for (const auto& [name, value] : report.about) sheets.text(name + ": " + value, kFont_px);
  for (std::size_t i = 0; i < report.parts.size(); ++i) {
    const Part& part = report.parts[i];
    sheets.text(part.title, 15.0, true);
    sheets.text(part.text, 10.0);
    for (const Table& table : part.tables) {
      sheets.text(table.title, 11.0, true);
      if (!table.text.empty()) sheets.text(table.text, kFont_px);
      sheets.table(table);
    }
    sheets.figures(figures[i], part.figures);
  }
  return sheets.all();
}

}  // namespace tandem::validate
