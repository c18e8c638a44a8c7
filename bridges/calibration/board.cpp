#include "bridges/calibration/board.hpp"

#include <cmath>

#include "bridges/apriltag/family.hpp"
#include "hal/input_file.hpp"
#include "hal/json/json.hpp"
#include "hal/output_file.hpp"
#include "hal/unit.hpp"

namespace tandem::bridges::calibration {
namespace {

constexpr double kPaperWidth_m = 0.297, kPaperHeight_m = 0.21;  // A4, lying
constexpr double kMargin_m = 0.008;                             // that printers leave white
constexpr double kFoot_m = 0.02;                                // for the text and the line beneath
constexpr double kCheck_m = 0.1;                                // length of the line

std::string mm(double m) {
  return hal::format_number(std::round(m * 1e7) / 1e4);
}

double along(std::size_t count, const Board& board) noexcept {
  return static_cast<double>(count) * (board.size_m + board.gap_m) - board.gap_m;
}

}  // namespace

double Board::width_m() const noexcept {
  return along(columns, *this);
}
double Board::height_m() const noexcept {
  return along(rows, *this);
}

std::optional<std::array<hal::Vector2, 4>> Board::corners_m(std::size_t tag) const noexcept {
  if (tag < first || tag - first >= columns * rows) return {};
  const auto column = static_cast<double>((tag - first) % columns), row = static_cast<double>((tag - first) / columns);
  const double left = column * (size_m + gap_m) - 0.5 * width_m();
  const double top = 0.5 * height_m() - row * (size_m + gap_m);
  return std::array<hal::Vector2, 4>{hal::Vector2{left, top - size_m}, hal::Vector2{left + size_m, top - size_m},
                                     hal::Vector2{left + size_m, top}, hal::Vector2{left, top}};
}

hal::Status check_board(const Board& board) {
  const auto tags = apriltag::count_of_tags(board.family);
  if (!tags.ok()) return tags.error();
  if (board.columns < 2 || board.rows < 2 || board.columns > 100 || board.rows > 100)
    return hal::Error{"a board has 2 to 100 lines and columns"};
  if (board.first + board.columns * board.rows > tags.value())
    return hal::Error{"a board of " + std::to_string(board.columns * board.rows) + " tags from " +
                      std::to_string(board.first) + " on needs more than the " + std::to_string(tags.value()) + " of " +
                      board.family};
  const auto pattern = apriltag::pattern(board.family, board.first);
  const auto cells = static_cast<double>(pattern.value().size_cells);
  if (!(board.size_m > 0.0) || !(board.gap_m >= 2.0 * board.size_m / cells))
    return hal::Error{"between tags of " + mm(board.size_m) + " mm there must be " + mm(2.0 * board.size_m / cells) +
                      " mm of white"};
  const double edge_m = 2.0 * (kMargin_m + board.size_m / cells);
  if (board.width_m() + edge_m > kPaperWidth_m || board.height_m() + edge_m + kFoot_m > kPaperHeight_m)
    return hal::Error{"a board of " + mm(board.width_m()) + " x " + mm(board.height_m()) +
                      " mm is too large for A4; smaller or fewer tags fit"};
  return {};
}

hal::Result<std::string> board_svg(const Board& board) {
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + mm(kPaperWidth_m) + "mm\" height=\"" +
                    mm(kPaperHeight_m) + "mm\" viewBox=\"0 0 " + mm(kPaperWidth_m) + " " + mm(kPaperHeight_m) +
                    "\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<g shape-rendering=\"crispEdges\">\n";
  const auto box = [&](double x_m, double y_m, double width_m, double height_m) {
    svg += "<rect x=\"" + mm(x_m) + "\" y=\"" + mm(y_m) + "\" width=\"" + mm(width_m) + "\" height=\"" + mm(height_m) +
           "\"/>\n";
  };
  const double middle_x_m = 0.5 * kPaperWidth_m, middle_y_m = 0.5 * (kPaperHeight_m - kFoot_m);
  for (std::size_t i = 0; i < board.columns * board.rows; ++i) {
    const auto pattern = apriltag::pattern(board.family, board.first + i);
    if (!pattern.ok()) return pattern.error();
    const auto& p = pattern.value();
    const double cell_m = board.size_m / static_cast<double>(p.size_cells);
    const double edge_m = 0.5 * static_cast<double>(p.cells - p.size_cells) * cell_m;
    const auto corners = board.corners_m(board.first + i);
    const double left_m = middle_x_m + (*corners)[3].x() - edge_m, top_m = middle_y_m - (*corners)[3].y() - edge_m;
    for (std::size_t row = 0; row < p.cells; ++row) {
      for (std::size_t column = 0; column < p.cells;) {
        std::size_t end = column;
        while (end < p.cells && p.white[row * p.cells + end] == 0) ++end;
        if (end > column)
          box(left_m + static_cast<double>(column) * cell_m, top_m + static_cast<double>(row) * cell_m,
              static_cast<double>(end - column) * cell_m, cell_m);
        column = end + 1;
      }
    }
  }
  const double line_x_m = kMargin_m + 0.004, line_y_m = kPaperHeight_m - 0.012;
  box(line_x_m, line_y_m, kCheck_m, 0.0004);
  box(line_x_m - 0.0002, line_y_m - 0.002, 0.0004, 0.004);
  box(line_x_m + kCheck_m - 0.0002, line_y_m - 0.002, 0.0004, 0.004);
  svg += "</g>\n<g font-family=\"sans-serif\" font-size=\"3\">\n<text x=\"" + mm(line_x_m + kCheck_m + 0.004) +
         "\" y=\"" + mm(line_y_m + 0.001) + "\">This line must be " + mm(kCheck_m) +
         " mm long: print at 100 %. Glue the page onto something flat.</text>\n<text x=\"" + mm(line_x_m) + "\" y=\"" +
         mm(line_y_m + 0.006) + "\">Tandem: " + std::to_string(board.columns) + " x " + std::to_string(board.rows) +
         " tags of " + board.family + " from " + std::to_string(board.first) + " on, " + mm(board.size_m) + " mm, " +
         mm(board.gap_m) + " mm apart</text>\n</g>\n</svg>\n";
  return svg;
}

hal::Result<Board> read_board(const std::string& path) {
  const auto text = hal::read_whole_file(path, "the board's file");
  if (!text.ok()) return hal::Error{text.error().message + "; `tandem calibrate board` makes it"};
  const auto parsed = hal::parse_json_object(text.value());
  if (!parsed.ok()) return hal::Error{"the board's file '" + path + "': " + parsed.error().message};
  Board board;
  try {
    const hal::Json& json = parsed.value();
    board.family = json.at("family").get<std::string>();
    board.columns = json.at("columns").get<std::size_t>();
    board.rows = json.at("rows").get<std::size_t>();
    board.size_m = json.at("size_m").get<double>();
    board.gap_m = json.at("gap_m").get<double>();
    board.first = json.at("first").get<std::size_t>();
  } catch (const hal::JsonError&) {
    return hal::Error{"'" + path + "' is no file of a board"};
  }
  const auto tags = apriltag::count_of_tags(board.family);
  const bool sound = tags.ok() && board.columns >= 2 && board.rows >= 2 && board.columns <= 100 && board.rows <= 100 &&
                     board.first + board.columns * board.rows <= tags.value() && board.size_m > 0.0 &&
                     board.size_m < 10.0 && board.gap_m > 0.0 && board.gap_m < 10.0;
  if (!sound) return hal::Error{"'" + path + "' is of a board that there cannot be"};
  return board;
}

hal::Status write_board(const std::string& path, const Board& board) {
  const hal::Json json{{"family", board.family}, {"columns", board.columns}, {"rows", board.rows},
                       {"size_m", board.size_m}, {"gap_m", board.gap_m},     {"first", board.first}};
  return hal::write_whole_file(path, "board", hal::to_text(json, 2) + "\n");
}

}  // namespace tandem::bridges::calibration
