// A report of the validation on A4 sheets: text, tables and figures from top to bottom, as SVG.
#include <algorithm>
#include <fmt/format.h>

#include "hal/markup.hpp"
#include "validate/page.hpp"

namespace tandem::validate {
namespace {

// A sheet is A4 at 96 pixels an inch.
constexpr double kWidth_px = 794.0, kHeight_px = 1123.0, kMargin_px = 48.0;
constexpr double kInside_px = kWidth_px - 2.0 * kMargin_px;
constexpr double kFont_px = 9.0, kCell_px = 8.3, kLine_px = 11.5;
constexpr double kBetween_px = 10.0, kPadding_px = 2.5;  // of columns; above and below a row
constexpr double kFigure_px = 340.0;                     // width of a figure, two a line

constexpr const char* kBlack = "#1a1a1a";

/// Width of a letter in parts of the font's size, somewhat more than DejaVu Sans has.
double width_em(char letter) {
  const std::string_view narrow = " .,:;'|!()[]/-ijltfrI", wide = "mwMW%@";
  if ((static_cast<unsigned char>(letter) & 0xC0U) == 0x80U) return 0.0;  // within a letter of several bytes
  if (narrow.find(letter) != std::string_view::npos) return 0.4;
  if (wide.find(letter) != std::string_view::npos) return 0.98;
  return letter >= 'A' && letter <= 'Z' ? 0.72 : 0.63;
}

double width_px(std::string_view text, double size_px, bool bold = false) {
  double sum = 0.0;
  for (const char letter : text) sum += width_em(letter);
  return sum * size_px * (bold ? 1.12 : 1.0);
}

/// Lines no wider than `most_px`, broken at blanks where there are any, but for one behind a colon.
std::vector<std::string> wrapped(const std::string& text, double most_px, double size_px, bool bold = false) {
  std::vector<std::string> lines;
  std::string line;
  std::size_t blank = std::string::npos;  // the last one in the line
  for (const char letter : text) {
    const bool begins = (static_cast<unsigned char>(letter) & 0xC0U) != 0x80U;
    if (begins && !line.empty() && width_px(line + letter, size_px, bold) > most_px) {
      const std::size_t at = letter == ' ' && !line.ends_with(':') ? line.size() : blank;
      lines.push_back(line.substr(0, at));
      line = at < line.size() ? line.substr(at + 1) : "";
      blank = std::string::npos;
      if (letter == ' ' && line.empty()) continue;
    }
    if (letter == ' ' && !line.ends_with(':')) blank = line.size();
    line += letter;
  }
  lines.push_back(line);
  return lines;
}

/// A row of a table, broken into lines.
struct Cells {
  std::vector<std::vector<std::string>> columns;
  bool bold = false;
  const char* color = kBlack;

  double height_px() const {
    std::size_t lines = 1;
    for (const auto& column : columns) lines = std::max(lines, column.size());
    return kLine_px * static_cast<double>(lines) + 2.0 * kPadding_px;
  }
};

/// Fills sheets from the top, and begins another where one is full.
class Sheets {
 public:
  void text(const std::string& words, double size_px, bool bold = false) {
    for (const std::string& line : wrapped(words, kInside_px, size_px, bold)) {
      room(size_px * 1.4);
      put(kMargin_px, line, size_px, bold, kBlack);
      y_ += size_px * 1.4;
    }
    y_ += 3.0;
  }

  /// What follows begins on the same sheet as far as `height_px`, with `above_px` before it unless the sheet is new.
  void keep_together(double above_px, double height_px) {
    room(above_px + height_px);
    if (y_ > kMargin_px) y_ += above_px;
  }

  void table(const Table& table) {
    std::vector<std::vector<std::string>> cells = {table.columns};
    cells.front().insert(cells.front().end(), {"contract", ""});
    for (const Row& row : table.rows) {
      cells.push_back(row.cells);
      cells.back().resize(table.columns.size());
      cells.back().insert(cells.back().end(), {row.contract, word_of(row.verdict)});
    }
    const std::vector<double> widths = widths_of(cells);
    const Cells head = broken(cells.front(), widths, true, kBlack);
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const Verdict verdict = table.rows[i].verdict;
      const bool bad = verdict == Verdict::NotMet || verdict == Verdict::NotMade;
      const Cells row = broken(cells[i + 1], widths, false, bad ? "#a40000" : kBlack);
      if (i == 0 || y_ + row.height_px() > kBottom_px) {
        room(head.height_px() + row.height_px());
        put(head, widths, "#888");
      }
      put(row, widths, "#ddd");
    }
    y_ += 8.0;
  }

  void figures(const std::vector<std::string>& svgs, const std::vector<Figure>& about) {
    for (std::size_t i = 0; i < svgs.size(); i += 2) {
      std::vector<std::vector<std::string>> captions;
      std::size_t lines = 0;
      for (std::size_t k = i; k < std::min(i + 2, svgs.size()); ++k) {
        captions.push_back(wrapped(about[k].caption, kFigure_px, kFont_px));
        lines = std::max(lines, captions.back().size());
      }
      const double caption_px = kLine_px * static_cast<double>(lines) + 10.0;
      room(kFigure_px * 0.75 + caption_px);
      for (std::size_t k = 0; k < captions.size(); ++k)
        figure(kMargin_px + static_cast<double>(k) * (kFigure_px + 16.0), svgs[i + k], captions[k]);
      y_ += kFigure_px * 0.75 + caption_px;
    }
  }

  std::vector<std::string> all() {
    end();
    return std::move(sheets_);
  }

 private:
  static constexpr double kBottom_px = kHeight_px - kMargin_px;

  void room(double height_px) {
    if (y_ + height_px > kBottom_px && y_ > kMargin_px) end();
  }
  void end() {
    const std::string number = fmt::format("{}", sheets_.size() + 1);
    y_ = kHeight_px - 0.6 * kMargin_px;
    put(kWidth_px - kMargin_px - width_px(number, kFont_px), number, kFont_px, false, "#666");
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
  /// A row of a table with a line beneath it.
  void put(const Cells& row, const std::vector<double>& widths, const char* rule) {
    const double top = y_;
    double x = kMargin_px;
    for (std::size_t i = 0; i < row.columns.size(); ++i) {
      y_ = top + kPadding_px;
      for (const std::string& line : row.columns[i]) {
        put(x, line, kCell_px, row.bold, row.color);
        y_ += kLine_px;
      }
      x += widths[i] + kBetween_px;
    }
    y_ = top + row.height_px();
    body_ += fmt::format("<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{}\" stroke-width=\"0.6\"/>\n",
                         kMargin_px, y_, kWidth_px - kMargin_px, y_, rule);
  }
  /// At the height that is reached, which stays.
  void figure(double x, const std::string& svg, const std::vector<std::string>& caption) {
    const double top = y_;
    body_ +=
        fmt::format("<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/svg+xml;base64,{}\"/>\n", x,
                    y_, kFigure_px, kFigure_px * 0.75, hal::base64(svg));
    y_ += kFigure_px * 0.75 + 2.0;
    for (const std::string& line : caption) {
      put(x, line, kFont_px, false, "#444");
      y_ += kLine_px;
    }
    y_ = top;
  }

  /// Of each column: all that it needs, or less where they do not fit side by side: the widest give way.
  static std::vector<double> widths_of(const std::vector<std::vector<std::string>>& cells) {
    std::vector<double> widths(cells.front().size(), 0.0);
    for (std::size_t row = 0; row < cells.size(); ++row)
      for (std::size_t i = 0; i < widths.size(); ++i)
        widths[i] = std::max(widths[i], width_px(cells[row][i], kCell_px, row == 0) + 1.0);
    double sum = kBetween_px * static_cast<double>(widths.size() - 1);
    for (const double width : widths) sum += width;
    for (; sum > kInside_px; sum -= 1.0) *std::max_element(widths.begin(), widths.end()) -= 1.0;
    return widths;
  }

  static Cells broken(const std::vector<std::string>& cells, const std::vector<double>& widths, bool bold,
                      const char* color) {
    Cells row{{}, bold, color};
    for (std::size_t i = 0; i < widths.size(); ++i) row.columns.push_back(wrapped(cells[i], widths[i], kCell_px, bold));
    return row;
  }

  std::vector<std::string> sheets_;
  std::string body_;
  double y_ = kMargin_px;
};

}  // namespace

std::vector<std::string> sheets_of(const Report& report, const std::vector<std::vector<std::string>>& figures) {
  constexpr double kTableBegins_px = 100.0, kPartBegins_px = 190.0;  // titles stay with what they are the titles of
  Sheets sheets;
  sheets.text("Validation of Tandem", 22.0, true);
  sheets.text(summary_of(report), 11.0, true);
  for (const auto& [name, value] : report.about) sheets.text(name + ": " + value, kFont_px);
  for (std::size_t i = 0; i < report.parts.size(); ++i) {
    const Part& part = report.parts[i];
    sheets.keep_together(14.0, kPartBegins_px);
    sheets.text(part.title, 15.0, true);
    sheets.text(part.text, 10.0);
    for (const Table& table : part.tables) {
      sheets.keep_together(5.0, kTableBegins_px);
      sheets.text(table.title, 11.0, true);
      if (!table.text.empty()) sheets.text(table.text, kFont_px);
      sheets.table(table);
    }
    sheets.figures(figures[i], part.figures);
  }
  return sheets.all();
}

}  // namespace tandem::validate
