#include "app/live/watch_map.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "core/space/stores.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"

namespace tandem::app {
namespace {

constexpr std::size_t kFewestLines = 4, kFewestColumns = 8;  // without the frame
constexpr std::size_t kAround = 3;                           // lines: the frame's, and the legend below
constexpr double kLineHeight = 2.0;                          // of a character, in widths

/// Its places are characters.
class Map {
 public:
  /// Columns and lines for what is inside the frame.
  Map(const core::SpaceStores& s, std::size_t columns, std::size_t lines)
      : min_x_m_(s.min_x_m),
        max_y_m_(s.max_y_m),
        width_m_(s.max_x_m - s.min_x_m),
        height_m_(s.max_y_m - s.min_y_m),
        step_m_(
            std::max(width_m_ / static_cast<double>(columns), height_m_ / kLineHeight / static_cast<double>(lines))) {
    const auto fitting = [](double wanted, std::size_t most) {
      return std::clamp<std::size_t>(static_cast<std::size_t>(std::lround(wanted)), 1, most);
    };
    columns_ = fitting(width_m_ / step_m_, columns);
    lines_.assign(fitting(height_m_ / step_m_ / kLineHeight, lines), std::string(columns_, ' '));
    robots_.assign(columns_ * lines_.size(), 0);
  }

  void add(const core::Object& object) {
    const double reach_m = object.reach_m() + kLineHeight * step_m_;
    const double along_x_m = std::fabs(object.cos_h), along_y_m = std::fabs(object.sin_h);
    const bool round = object.kind == core::Object::Kind::Cylinder;
    // What is thinner than a character has the width of one.
    const double x_m =
        std::max(round ? object.radius_m : object.half_x_m, 0.5 * step_m_ * (along_x_m + kLineHeight * along_y_m));
    const double y_m =
        std::max(round ? object.radius_m : object.half_y_m, 0.5 * step_m_ * (along_y_m + kLineHeight * along_x_m));
    for (std::size_t line = line_of(object.y_m + reach_m); line <= line_of(object.y_m - reach_m); ++line) {
      for (std::size_t column = column_of(object.x_m - reach_m); column <= column_of(object.x_m + reach_m); ++column) {
        const double dx = min_x_m_ + (static_cast<double>(column) + 0.5) * cell_x_m() - object.x_m;
        const double dy = max_y_m_ - (static_cast<double>(line) + 0.5) * cell_y_m() - object.y_m;
        const double own_x = object.cos_h * dx + object.sin_h * dy, own_y = object.cos_h * dy - object.sin_h * dx;
        const bool inside = round ? own_x * own_x / (x_m * x_m) + own_y * own_y / (y_m * y_m) <= 1.0
                                  : std::fabs(own_x) <= x_m && std::fabs(own_y) <= y_m;
        if (inside) put(line, column, object.movable ? 'o' : '#');
      }
    }
  }

  void add_robot(const core::Pose& pose, bool real, bool stopped) {
    if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m)) return;
    const std::size_t line = line_of(pose.y_m), column = column_of(pose.x_m);
    const std::size_t there = ++robots_[line * columns_ + column];
    const auto quarter = static_cast<std::size_t>(std::lround(pose.heading_rad() / (0.5 * std::numbers::pi)) + 4) % 4;
    const char alone = stopped ? 'x' : ">^<v"[quarter];
    char& sign = lines_[line][column];
    if (real || (there > 1 && sign == '@'))
      put(line, column, '@');
    else
      put(line, column, there == 1 ? alone : there <= 9 ? static_cast<char>('0' + there) : '*');
  }

  std::vector<std::string> framed(std::size_t columns) const {
    const auto edge = [this](const std::string& text) {
      return "+" + text + std::string(columns_ - std::min(columns_, width_of(text)), '-') + "+";
    };
    const std::string size = "- " + hal::rounded(width_m_) + " x " + hal::rounded(height_m_) + " m ";
    std::vector<std::string> all{edge(size.size() <= columns_ ? size : "")};
    for (const std::string& line : lines_) all.push_back("|" + line + "|");
    all.push_back(edge(""));
    std::string below;
    for (const std::string& sign : legend()) {
      if (width_of(below) + width_of(sign) + 4 > columns) break;
      below += (below.empty() ? " " : "   ") + sign;
    }
    all.push_back(std::move(below));
    return all;
  }

 private:
  double cell_x_m() const noexcept { return width_m_ / static_cast<double>(columns_); }
  double cell_y_m() const noexcept { return height_m_ / static_cast<double>(lines_.size()); }
  static std::size_t cell(double at, std::size_t count) noexcept {
    return static_cast<std::size_t>(std::clamp(std::floor(at), 0.0, static_cast<double>(count - 1)));
  }
  std::size_t column_of(double x_m) const noexcept { return cell((x_m - min_x_m_) / cell_x_m(), columns_); }
  std::size_t line_of(double y_m) const noexcept { return cell((max_y_m_ - y_m) / cell_y_m(), lines_.size()); }
  void put(std::size_t line, std::size_t column, char sign) { lines_[line][column] = sign; }

  /// Of the signs that are there.
  std::vector<std::string> legend() const {
    const auto any = [this](std::string_view signs) {
      return std::ranges::any_of(lines_, [&](const std::string& l) { return l.find_first_of(signs) != l.npos; });
    };
    std::vector<std::string> all;
    for (const auto& [signs, text] :
         {std::pair(">^<v", "> ^ < v  robots"), std::pair("23456789*", "2 … 9 *  several"), std::pair("@", "@  real"),
          std::pair("x", "x  stopped"), std::pair("#", "#  fixed"), std::pair("o", "o  movable")}) {
      if (any(signs)) all.emplace_back(text);
    }
    return all;
  }

  double min_x_m_, max_y_m_, width_m_, height_m_, step_m_;
  std::size_t columns_ = 0;
  std::vector<std::string> lines_;
  std::vector<std::size_t> robots_;  // by place
};

}  // namespace

std::vector<std::string> arena_map(const core::Space& space, Screen::Size room) {
  if (room.lines < kFewestLines + kAround || room.columns < kFewestColumns + 2) return {};
  const core::SpaceStores& stores = space.stores();
  const double width_m = stores.max_x_m - stores.min_x_m, height_m = stores.max_y_m - stores.min_y_m;
  if (!(width_m > 0.0) || !(height_m > 0.0) || !std::isfinite(width_m + height_m)) return {};
  Map map(stores, room.columns - 2, room.lines - kAround);
  for (const core::Object& object : space.objects()) {
    if (object.alive && std::isfinite(object.x_m + object.y_m)) map.add(object);
  }
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::RobotId robot = space.robot(i);
    map.add_robot(space.pose(robot), space.external(robot), space.halted(robot));
  }
  return map.framed(room.columns);
}

}  // namespace tandem::app
