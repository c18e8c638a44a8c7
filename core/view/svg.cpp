#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "core/view/drawing.hpp"
#include "hal/markup.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kFullDetailRobots = 20'000;
constexpr double kTinyRobot_px = 2.0;
constexpr std::size_t kDotsPerPath = 2'000;  // viewers slow down on longer ones
constexpr int kFloorCells = 240;             // along the longer side
constexpr int kFloorShades = 24;
constexpr double kMargin_px = 28.0;
constexpr double kHeader_px = 52.0;
constexpr double kLine_px = 30.0;   // of the legend
constexpr double kLetter_px = 7.4;  // mean width in the font used

constexpr double kAxisLine_px = 24.0;   // beneath the frame
constexpr double kAxisWidth_px = 46.0;  // at its left
constexpr std::array<BodyColors, 5> kBodyColors = {{{"#b9dcae", "#3c6e33"},
                                                    {"#aecbe8", "#2c5a8c"},
                                                    {"#d9c3e6", "#6b4587"},
                                                    {"#f0d9a8", "#8a6414"},
                                                    {"#b8dfdd", "#2b6d6a"}}};
constexpr std::string_view kInk = "#22272e";
constexpr std::string_view kFaintInk = "#68707b";
constexpr std::string_view kRealColor = "#e8590c";
constexpr std::string_view kTroubleColor = "#c92a2a";
constexpr std::string_view kWallColor = "#59626e";
constexpr std::string_view kWallEdge = "#3f4751";
constexpr std::string_view kMovableColor = "#d8b384";
constexpr std::string_view kMovableEdge = "#7d5a2b";
constexpr std::string_view kBorderColor = "#3b5bdb";

/// Text of an SVG document, appended to piece by piece. Numbers get at most four decimals.
class Svg {
 public:
  Svg& operator<<(std::string_view text) {
    out_ += text;
    return *this;
  }
  Svg& operator<<(double value) {
    const double rounded = std::round(value * 1e4) / 1e4;
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, rounded == 0.0 ? 0.0 : rounded).ptr;
    out_.append(digits, end);
    return *this;
  }
  Svg& operator<<(std::size_t value) {
    out_ += std::to_string(value);
    return *this;
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Without control characters.
std::string escaped(std::string_view text) {
  std::string kept(text);
  std::erase_if(kept, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return hal::escaped_markup(kept);
}

std::string hex(hal::Rgb c) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out = "#";
  for (const std::uint8_t v : {c.r, c.g, c.b}) {
    out += kDigits[v >> 4];
    out += kDigits[v & 15U];
  }
  return out;
}

/// "10,000"
std::string grouped(std::size_t n) {
  std::string digits = std::to_string(n);
  for (std::ptrdiff_t i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
    digits.insert(static_cast<std::size_t>(i), ",");
  return digits;
}

double degrees(double rad) {
  return rad * 180.0 / std::numbers::pi;
}

using Area = PictureLook::Area;

Area arena_of(const Drawing& d) {
  return {d.min_x_m, d.min_y_m, d.max_x_m, d.max_y_m};
}

/// The squares that a floor is drawn by.
struct FloorGrid {
  FloorGrid(const Drawing& d, const PictureLook& look) {
    const Area arena = arena_of(d);
    const Area shown = look.region.value_or(arena);
    x_m = std::max(arena.min_x_m, shown.min_x_m);
    y_m = std::max(arena.min_y_m, shown.min_y_m);
    const double width_m = std::min(arena.max_x_m, shown.max_x_m) - x_m;
    const double depth_m = std::min(arena.max_y_m, shown.max_y_m) - y_m;
    cell_m = std::max(width_m, depth_m) / kFloorCells;
    columns = std::max(1, static_cast<int>(std::ceil(width_m / cell_m - 1e-9)));
    lines = std::max(1, static_cast<int>(std::ceil(depth_m / cell_m - 1e-9)));
  }
  double middle_x_m(int column) const { return x_m + (column + 0.5) * cell_m; }
  double middle_y_m(int line) const { return y_m + (line + 0.5) * cell_m; }

  double x_m = 0.0, y_m = 0.0, cell_m = 1.0;
  int columns = 1, lines = 1;
};

/// One entry of the legend: a symbol of at most 18 px around its place, and a text.
struct LegendEntry {
  std::string symbol;
  std::string text;
  double width_px() const { return 26.0 + kLetter_px * static_cast<double>(text.size()) + 22.0; }
};

class Page {
 public:
  Page(const Drawing& drawing, const PictureLook& look)
      : d_(drawing), look_(look), shown_(look.region.value_or(arena_of(drawing))) {
    const double width_m = shown_.max_x_m - shown_.min_x_m;
    const double depth_m = shown_.max_y_m - shown_.min_y_m;
    px_per_m_ = look.size_px / std::max(width_m, depth_m);
    arena_w_px_ = width_m * px_per_m_;
    arena_h_px_ = depth_m * px_per_m_;
    if (look.axes) axis_px_ = kAxisLine_px;
    const double beside_px = look.axes ? kAxisWidth_px : 0.0;
    width_px_ = std::max(arena_w_px_ + beside_px, 420.0) + 2.0 * kMargin_px;
    left_px_ = beside_px + 0.5 * (width_px_ - beside_px - arena_w_px_);
    lay_out_legend();
  }

  double height_px() const {
    if (look_.height_px > 0) return look_.height_px;
    return bottom_px() + 52.0 + kLine_px * static_cast<double>(legend_lines_) + 8.0;
  }

  std::string draw() {
    header();
    definitions();
    svg_ << "<g transform=\"translate(" << left_px_ - shown_.min_x_m * px_per_m_ << " "
         << kHeader_px + shown_.max_y_m * px_per_m_ << ") scale(" << px_per_m_ << " " << -px_per_m_ << ")\">\n";
    svg_ << "<g clip-path=\"url(#arena)\">\n";
    arena();
    floor();
    borders();
    areas();
    lights();
    trails();
    objects();
    robots();
    sketch();
    svg_ << "</g>\n";
    real_robots();
    svg_ << "</g>\n";
    frame();
    axes();
    ids();
    area_labels();
    labels();
    sketch_texts();
    scale_bar();
    legend();
    svg_ << "</svg>\n";
    return svg_.take();
  }

 private:
  bool full_detail() const { return d_.robots.size() <= kFullDetailRobots; }
  double px(double pixels) const { return pixels / px_per_m_; }  // as metres
  double x_px(double x_m) const { return left_px_ + (x_m - shown_.min_x_m) * px_per_m_; }
  double y_px(double y_m) const { return kHeader_px + (shown_.max_y_m - y_m) * px_per_m_; }
  double bottom_px() const { return kHeader_px + arena_h_px_ + axis_px_; }
  bool shows(double x_m, double y_m, double around_m) const {
    return !look_.region || (x_m + around_m >= shown_.min_x_m && x_m - around_m <= shown_.max_x_m &&
                             y_m + around_m >= shown_.min_y_m && y_m - around_m <= shown_.max_y_m);
  }
  bool shows(const Drawing::Robot& r) const { return shows(r.x_m, r.y_m, d_.kinds[r.kind].radius_m); }

  void text(double x, double y, double size, std::string_view color, std::string_view more, std::string_view content) {
    svg_ << "<text x=\"" << x << "\" y=\"" << y << "\" font-size=\"" << size << "\" fill=\"" << color << "\"" << more
         << ">" << escaped(content) << "</text>\n";
  }

  void header() {
    svg_ << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\""
         << std::ceil(width_px_) << "\" height=\"" << std::ceil(height_px()) << "\" viewBox=\"0 0 "
         << std::ceil(width_px_) << " " << std::ceil(height_px())
         << "\" font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\">\n";
    svg_ << "<title>" << escaped(d_.title) << "</title>\n";
    svg_ << "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
    const double fitting =
        (width_px_ - 2.0 * kMargin_px) / (0.58 * std::max<double>(1.0, static_cast<double>(d_.title.size())));
    text(left_text_px(), 33.0, std::clamp(fitting, 9.0, 18.0), kInk, " font-weight=\"600\"", d_.title);
  }
  double left_text_px() const { return std::min(left_px_, kMargin_px); }

  void definitions() {
    svg_ << "<defs>\n<clipPath id=\"arena\"><rect x=\"" << shown_.min_x_m << "\" y=\"" << shown_.min_y_m
         << "\" width=\"" << shown_.max_x_m - shown_.min_x_m << "\" height=\"" << shown_.max_y_m - shown_.min_y_m
         << "\"/></clipPath>\n";
    for (std::size_t k = 0; k < d_.kinds.size(); ++k) {
      svg_ << "<g id=\"kind" << k << "\">" << robot_symbol(k, d_.kinds[k].radius_m, d_.kinds[k].radius_m * px_per_m_)
           << "</g>\n";
    }
    svg_ << "</defs>\n";
  }

  /// A disc whose wedge points forward, at the origin; a plain dark one where the wedge would be too small to see.
  static std::string robot_symbol(std::size_t kind, double radius, double radius_px) {
    const BodyColors& c = body_colors(kind);
    Svg s;
    if (radius_px < kTinyRobot_px) {
      s << "<circle r=\"" << radius << "\" fill=\"" << c.edge << "\"/>";
      return s.take();
    }
    s << "<circle r=\"" << 0.94 * radius << "\" fill=\"" << c.fill << "\" stroke=\"" << c.edge << "\" stroke-width=\""
      << 0.12 * radius << "\"/><path d=\"M" << 0.88 * radius << " 0L" << -0.38 * radius << " " << 0.5 * radius << "L"
      << -0.12 * radius << " 0L" << -0.38 * radius << " " << -0.5 * radius << "Z\" fill=\"" << c.edge << "\"/>";
    return s.take();
  }

  void arena() {
    svg_ << "<rect x=\"" << d_.min_x_m << "\" y=\"" << d_.min_y_m << "\" width=\"" << d_.max_x_m - d_.min_x_m
         << "\" height=\"" << d_.max_y_m - d_.min_y_m << "\" fill=\"#f5f4f0\"/>\n";
  }

  // The floor as runs of equal shade, one path a shade.
  void floor() {
    if (!d_.floor) return;
    const FloorGrid grid(d_, look_);
    std::map<int, Svg> paths;
    for (int line = 0; line < grid.lines; ++line) {
      const double y_m = grid.y_m + line * grid.cell_m;
      const auto shade = [&](int column) {
        const double level = std::clamp(d_.floor(grid.middle_x_m(column), grid.middle_y_m(line)), 0.0, 1.0);
        return static_cast<int>(std::lround(level * kFloorShades));
      };
      for (int begin = 0; begin < grid.columns;) {
        const int level = shade(begin);
        int end = begin + 1;
        while (end < grid.columns && shade(end) == level) ++end;
        const double length_m = (end - begin) * grid.cell_m;
        paths[level] << "M" << grid.x_m + begin * grid.cell_m << " " << y_m << "h" << length_m << "v" << grid.cell_m
                     << "h" << -length_m << "z";
        begin = end;
      }
    }
    svg_ << "<g class=\"floor\" shape-rendering=\"crispEdges\">\n";
    for (auto& [level, path] : paths) {
      const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * level / kFloorShades));
      svg_ << "<path fill=\"" << hex({grey, grey, grey}) << "\" d=\"" << path.take() << "\"/>\n";
    }
    svg_ << "</g>\n";
  }

  /// Where robots were, in the colours of their kinds.
  void trails() {
    if (d_.trails.empty()) return;
    svg_ << "<g class=\"trails\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" stroke-width=\""
         << px(1.4) << "\" stroke-opacity=\"0.55\">\n";
    for (const Drawing::Trail& trail : d_.trails) {
      if (trail.count == 0) continue;
      const Drawing::Robot& r = d_.robots[trail.robot];
      svg_ << "<polyline stroke=\"" << body_colors(r.kind).edge << "\" points=\"";
      for (std::size_t i = 0; i < trail.count; ++i) {
        const Drawing::Point& p = d_.trail_points[trail.first + i];
        svg_ << p.x_m << "," << p.y_m << " ";
      }
      svg_ << r.x_m << "," << r.y_m << "\"/>\n";
    }
    svg_ << "</g>\n";
  }

  /// Walls of regions as lines, gates dashed.
  void borders() {
    if (d_.borders.empty()) return;
    svg_ << "<g class=\"borders\" stroke=\"" << kBorderColor << "\" stroke-width=\"" << px(1.5) << "\">\n";
    for (const Drawing::Border& b : d_.borders) {
      svg_ << "<line x1=\"" << b.ax_m << "\" y1=\"" << b.ay_m << "\" x2=\"" << b.bx_m << "\" y2=\"" << b.by_m << "\"";
      if (!b.wall) svg_ << " stroke-dasharray=\"" << px(6.0) << " " << px(5.0) << "\" stroke-opacity=\"0.6\"";
      svg_ << "/>\n";
    }
    svg_ << "</g>\n";
  }

  void areas() {
    if (d_.areas.empty()) return;
    svg_ << "<g class=\"areas\" stroke-linejoin=\"round\" stroke-width=\"" << px(1.5) << "\">\n";
    for (const Drawing::Area& area : d_.areas) {
      svg_ << "<polygon points=\"";
      for (const Drawing::Point& p : area.corners) svg_ << p.x_m << "," << p.y_m << " ";
      svg_ << "\" stroke=\"" << area.color() << "\" fill=\"";
      if (area.kind == Drawing::Area::Kind::Fence) {
        svg_ << "none\"/>\n";
      } else {
        svg_ << area.color() << "\" fill-opacity=\"0.12\"/>\n";
      }
    }
    svg_ << "</g>\n";
  }

  /// Beside the first corner.
  void area_labels() {
    for (const Drawing::Area& area : d_.areas) {
      if (area.corners.empty() || !shows(area.corners.front().x_m, area.corners.front().y_m, 0.0)) continue;
      text(x_px(area.corners.front().x_m) + 5.0, y_px(area.corners.front().y_m) - 6.0, 13.0, area.color(),
           " stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"", area.label());
    }
  }

  void objects() {
    objects(false, "objects", kWallColor, kWallEdge);
    objects(true, "movables", kMovableColor, kMovableEdge);
  }

  bool any_objects(bool movable) const {
    const auto is = [movable](const auto& object) { return object.movable == movable; };
    return std::any_of(d_.boxes.begin(), d_.boxes.end(), is) ||
           std::any_of(d_.cylinders.begin(), d_.cylinders.end(), is);
  }

  void objects(bool movable, std::string_view name, std::string_view fill, std::string_view edge) {
    if (!any_objects(movable)) return;
    svg_ << "<g class=\"" << name << "\" fill=\"" << fill << "\" stroke=\"" << edge << "\" stroke-width=\"" << px(1.0)
         << "\">\n";
    for (const Drawing::Box& b : d_.boxes) {
      if (b.movable != movable) continue;
      svg_ << "<rect x=\"" << -b.half_x_m << "\" y=\"" << -b.half_y_m << "\" width=\"" << 2.0 * b.half_x_m
           << "\" height=\"" << 2.0 * b.half_y_m << "\" transform=\"translate(" << b.x_m << " " << b.y_m << ") rotate("
           << degrees(b.heading_rad) << ")\"/>\n";
    }
    for (const Drawing::Cylinder& c : d_.cylinders) {
      if (c.movable != movable) continue;
      svg_ << "<circle cx=\"" << c.x_m << "\" cy=\"" << c.y_m << "\" r=\"" << c.radius_m << "\"/>\n";
    }
    svg_ << "</g>\n";
  }

  void lights() {
    for (const Drawing::Light& light : d_.lights) {
      const std::string color = hex(light.color);
      for (const auto& [radius_px, opacity] : {std::pair{30.0, 0.12}, {19.0, 0.2}, {10.0, 0.45}}) {
        svg_ << "<circle cx=\"" << light.x_m << "\" cy=\"" << light.y_m << "\" r=\"" << px(radius_px) << "\" fill=\""
             << color << "\" fill-opacity=\"" << opacity << "\"/>\n";
      }
      svg_ << "<circle class=\"light\" cx=\"" << light.x_m << "\" cy=\"" << light.y_m << "\" r=\"" << px(4.5)
           << "\" fill=\"" << color << "\" stroke=\"#7a5c00\" stroke-width=\"" << px(1.2) << "\"/>\n";
    }
  }

  void robots() {
    if (d_.robots.empty()) return;
    if (!full_detail()) return dots();
    svg_ << "<g class=\"robots\">\n";
    for (const Drawing::Robot& robot : d_.robots) {
      if (shows(robot)) body(robot);
    }
    svg_ << "</g>\n";
  }

  void body(const Drawing::Robot& r) {
    const Drawing::Kind& kind = d_.kinds[r.kind];
    Svg place;
    place << "translate(" << r.x_m << " " << r.y_m << ") rotate(" << degrees(r.heading_rad) << ")";
    const std::string transform = place.take();
    if (r.lights == 0 && !r.halted && kind.gripper_reach_m == 0.0) {
      svg_ << "<use href=\"#kind" << std::size_t{r.kind} << "\" transform=\"" << transform << "\"/>\n";
      return;
    }
    svg_ << "<g transform=\"" << transform << "\"><use href=\"#kind" << std::size_t{r.kind} << "\"/>";
    const bool turret = kind.gripper_reach_m > 0.0 || (kind.leds_on_turret && r.turret_rad != 0.0);
    if (turret) svg_ << "<g class=\"turret\" transform=\"rotate(" << degrees(r.turret_rad) << ")\">";
    if (kind.gripper_reach_m > 0.0) svg_ << gripper(kind, r.kind, r.holding);
    for (std::uint32_t i = 0; i < r.lights; ++i) {
      const Drawing::LitLed& lit = d_.lit[r.first_light + i];
      const Drawing::Kind::Led& led = kind.leds[lit.led];
      svg_ << "<circle class=\"led\" cx=\"" << led.x_m << "\" cy=\"" << led.y_m << "\" r=\"" << 0.24 * kind.radius_m
           << "\" fill=\"" << hex(lit.color) << "\" stroke=\"" << hex(lit.color)
           << "\" stroke-opacity=\"0.3\" stroke-width=\"" << 0.26 * kind.radius_m << "\"/>";
    }
    if (turret) svg_ << "</g>";
    if (r.halted) svg_ << halted_mark(kind.radius_m);
    svg_ << "</g>\n";
  }

  /// An arm beyond the rim along x; filled while it holds something.
  static std::string gripper(const Drawing::Kind& kind, std::size_t number, bool holding) {
    const double from = 0.72 * kind.radius_m;
    const double half = 0.16 * kind.radius_m;
    const std::string_view edge = body_colors(number).edge;
    Svg s;
    s << "<rect class=\"gripper\" x=\"" << from << "\" y=\"" << -half << "\" width=\""
      << kind.radius_m + kind.gripper_reach_m - from << "\" height=\"" << 2.0 * half << "\" fill=\""
      << (holding ? edge : std::string_view("#ffffff")) << "\" stroke=\"" << edge << "\" stroke-width=\""
      << 0.08 * kind.radius_m << "\"/>";
    return s.take();
  }

  static std::string halted_mark(double radius) {
    const double h = 0.62 * radius;
    Svg s;
    s << "<path class=\"halted\" d=\"M" << -h << " " << -h << "L" << h << " " << h << "M" << -h << " " << h << "L" << h
      << " " << -h << "\" stroke=\"" << kTroubleColor << "\" stroke-width=\"" << 0.24 * radius
      << "\" stroke-linecap=\"round\"/>";
    return s.take();
  }

  // Thousands of discs in one path: a line of no length with round ends each.
  void dots() {
    std::map<std::pair<std::uint32_t, std::string>, std::vector<std::size_t>> colors;
    for (std::size_t i = 0; i < d_.robots.size(); ++i) {
      const Drawing::Robot& r = d_.robots[i];
      colors[{r.kind, r.lights > 0 ? hex(d_.lit[r.first_light].color) : std::string(body_colors(r.kind).edge)}]
          .push_back(i);
    }
    svg_ << "<g class=\"dots\" fill=\"none\" stroke-linecap=\"round\">\n";
    for (const auto& [key, members] : colors) {
      for (std::size_t begin = 0; begin < members.size(); begin += kDotsPerPath) {
        svg_ << "<path stroke=\"" << key.second << "\" stroke-width=\"" << 2.0 * d_.kinds[key.first].radius_m
             << "\" d=\"";
        const std::size_t end = std::min(members.size(), begin + kDotsPerPath);
        for (std::size_t i = begin; i < end; ++i)
          svg_ << "M" << d_.robots[members[i]].x_m << " " << d_.robots[members[i]].y_m << "h.0001";
        svg_ << "\"/>\n";
      }
    }
    svg_ << "</g>\n";
  }

  /// What hooks and layers drew, but its texts.
  void sketch() {
    if (d_.shapes.empty()) return;
    svg_ << "<g class=\"sketch\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n";
    for (const Sketch::Shape& shape : d_.shapes) {
      const std::string color = hex(shape.pen.color);
      Svg look;
      look << "\" stroke=\"" << color << "\" stroke-width=\"" << (shape.pen.width_m > 0.0 ? shape.pen.width_m : px(1.5))
           << "\"";
      const double opacity = std::clamp(shape.pen.opacity, 0.0, 1.0);
      if (opacity < 1.0) look << " stroke-opacity=\"" << opacity << "\"";
      if (shape.pen.filled && shape.kind != Sketch::Shape::Kind::Line)
        look << " fill=\"" << color << "\" fill-opacity=\"" << 0.35 * opacity << "\"";
      look << "/>\n";
      switch (shape.kind) {
        case Sketch::Shape::Kind::Line:
          svg_ << "<polyline points=\"" << points_of(shape) << look.take();
          break;
        case Sketch::Shape::Kind::Polygon:
          svg_ << "<polygon points=\"" << points_of(shape) << look.take();
          break;
        case Sketch::Shape::Kind::Circle:
          svg_ << "<circle cx=\"" << shape.points.front().x_m << "\" cy=\"" << shape.points.front().y_m << "\" r=\""
               << shape.radius_m << look.take();
          break;
        case Sketch::Shape::Kind::Text:
          break;
      }
    }
    svg_ << "</g>\n";
  }

  static std::string points_of(const Sketch::Shape& shape) {
    Svg points;
    for (const Sketch::Point& p : shape.points) points << p.x_m << "," << p.y_m << " ";
    return points.take();
  }

  /// Texts stand upright whatever the drawing's directions.
  void sketch_texts() {
    for (const Sketch::Shape& shape : d_.shapes) {
      if (shape.kind != Sketch::Shape::Kind::Text) continue;
      if (!shows(shape.points.front().x_m, shape.points.front().y_m, 0.0)) continue;
      text(x_px(shape.points.front().x_m), y_px(shape.points.front().y_m), 13.0, hex(shape.pen.color),
           " class=\"sketch\" stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"", shape.text);
    }
  }

  void real_robots() {
    for (const Drawing::RealRobot& real : d_.real) {
      const Drawing::Robot& r = d_.robots[real.robot];
      if (!shows(r)) continue;
      if (!full_detail()) body(r);
      const double ring_m = d_.kinds[r.kind].radius_m + px(4.0);
      svg_ << "<circle class=\"real\" cx=\"" << r.x_m << "\" cy=\"" << r.y_m << "\" r=\"" << ring_m
           << "\" fill=\"none\" stroke=\"" << (real.state.empty() ? kRealColor : kTroubleColor) << "\" stroke-width=\""
           << px(2.5) << "\"";
      if (!real.state.empty()) svg_ << " stroke-dasharray=\"" << px(5.0) << " " << px(4.0) << "\"";
      svg_ << "/>\n";
    }
  }

  void frame() {
    svg_ << "<rect x=\"" << left_px_ << "\" y=\"" << kHeader_px << "\" width=\"" << arena_w_px_ << "\" height=\""
         << arena_h_px_ << "\" fill=\"none\" stroke=\"" << kInk << "\" stroke-width=\"1\"/>\n";
  }

  /// Round coordinates in metres, at the left of the frame and beneath it.
  void axes() {
    if (!look_.axes) return;
    const double step_m =
        round_length(0.25 * std::max(shown_.max_x_m - shown_.min_x_m, shown_.max_y_m - shown_.min_y_m));
    const auto each = [step_m](double from_m, double to_m, const auto& mark) {
      const double slack_m = 1e-9 * (to_m - from_m);
      for (double i = std::ceil((from_m - slack_m) / step_m); i * step_m <= to_m + slack_m; ++i)
        mark(i * step_m, hal::format_number(std::round(i * step_m * 1e9) / 1e9 + 0.0));
    };
    const double bottom = kHeader_px + arena_h_px_;
    svg_ << "<g class=\"axes\" stroke-width=\"1\">\n";
    each(shown_.min_x_m, shown_.max_x_m, [&](double x_m, const std::string& number) {
      svg_ << "<path stroke=\"" << kInk << "\" d=\"M" << x_px(x_m) << " " << bottom << "v6\"/>\n";
      text(x_px(x_m), bottom + 19.0, 12.0, kInk, " text-anchor=\"middle\"", number);
    });
    each(shown_.min_y_m, shown_.max_y_m, [&](double y_m, const std::string& number) {
      svg_ << "<path stroke=\"" << kInk << "\" d=\"M" << left_px_ << " " << y_px(y_m) << "h-6\"/>\n";
      text(left_px_ - 10.0, y_px(y_m) + 4.5, 12.0, kInk, " text-anchor=\"end\"", number);
    });
    const std::string halo = " stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"";
    text(left_px_ + arena_w_px_ - 6.0, bottom - 7.0, 12.0, kInk, " text-anchor=\"end\"" + halo, "x in m");
    text(left_px_ + 6.0, kHeader_px + 16.0, 12.0, kInk, halo, "y in m");
    svg_ << "</g>\n";
  }

  /// Of robots that have no other label.
  void ids() {
    if (d_.ids.size() != d_.robots.size()) return;
    std::vector<bool> labelled(d_.robots.size(), false);
    for (const Drawing::RealRobot& real : d_.real) labelled[real.robot] = true;
    svg_ << "<g class=\"ids\">\n";
    for (std::size_t i = 0; i < d_.robots.size(); ++i) {
      const Drawing::Robot& r = d_.robots[i];
      if (labelled[i] || !shows(r.x_m, r.y_m, 0.0)) continue;
      text(x_px(r.x_m), y_px(r.y_m) - d_.kinds[r.kind].radius_m * px_per_m_ - 3.0, 10.0, kInk,
           " text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"2\" paint-order=\"stroke\"", d_.ids[i]);
    }
    svg_ << "</g>\n";
  }

  void labels() {
    for (const Drawing::RealRobot& real : d_.real) {
      const Drawing::Robot& r = d_.robots[real.robot];
      if (!shows(r)) continue;
      const std::string label = real.state.empty() ? real.id : real.id + ": " + real.state;
      const double aside_px = d_.kinds[r.kind].radius_m * px_per_m_ + 9.0;
      const bool at_right = x_px(r.x_m) + aside_px + kLetter_px * static_cast<double>(label.size()) < width_px_;
      text(x_px(r.x_m) + (at_right ? aside_px : -aside_px), y_px(r.y_m) + 4.5, 13.0,
           real.state.empty() ? kRealColor : kTroubleColor,
           std::string(at_right ? "" : " text-anchor=\"end\"") +
               " font-weight=\"700\" stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"",
           label);
    }
  }

  void scale_bar() {
    const double length_m = round_length(0.25 * (shown_.max_x_m - shown_.min_x_m));
    const double y = bottom_px() + 26.0;
    const double x0 = left_text_px() + 0.5, x1 = x0 + length_m * px_per_m_;
    svg_ << "<path class=\"scale\" d=\"M" << x0 << " " << y - 5.0 << "v10M" << x0 << " " << y << "H" << x1 << "M" << x1
         << " " << y - 5.0 << "v10\" stroke=\"" << kInk << "\" stroke-width=\"1.6\" fill=\"none\"/>\n";
    text(x1 + 9.0, y + 4.5, 13.0, kInk, "", length_text(length_m));
    const std::string arena =
        length_text(shown_.max_x_m - shown_.min_x_m) + " × " + length_text(shown_.max_y_m - shown_.min_y_m);
    text(width_px_ - left_text_px(), y + 4.5, 13.0, kFaintInk, " text-anchor=\"end\"", arena);
  }

  void lay_out_legend() {
    std::vector<std::size_t> count(d_.kinds.size(), 0);
    std::size_t halted = 0;
    for (const Drawing::Robot& r : d_.robots) {
      if (!shows(r)) continue;
      ++count[r.kind];
      halted += r.halted ? 1 : 0;
    }
    for (std::size_t k = 0; k < d_.kinds.size(); ++k) {
      if (count[k] > 0)
        add_entry(full_detail() ? robot_symbol(k, 8.0, std::max(8.0, kTinyRobot_px)) : dot_symbol(k),
                  grouped(count[k]) + " × " + d_.kinds[k].name);
    }
    if (!d_.real.empty()) {
      std::size_t troubled = 0;
      for (const Drawing::RealRobot& real : d_.real) troubled += real.state.empty() ? 0 : 1;
      add_entry(ring_symbol(kRealColor, ""), grouped(d_.real.size()) + " real");
      if (troubled > 0)
        add_entry(ring_symbol(kTroubleColor, " stroke-dasharray=\"4 3\""), grouped(troubled) + " real in trouble");
    }
    if (halted > 0) add_entry(halted_mark(9.0), grouped(halted) + " stopped");
    if (!d_.lights.empty()) {
      add_entry("<circle r=\"5\" fill=\"" + hex(d_.lights.front().color) + "\" stroke=\"#7a5c00\"/>",
                grouped(d_.lights.size()) + " × light");
    }
    const std::string block = "<rect x=\"-8\" y=\"-6\" width=\"16\" height=\"12\" fill=\"";
    if (any_objects(false)) add_entry(block + std::string(kWallColor) + "\"/>", "obstacle");
    if (any_objects(true)) add_entry(block + std::string(kMovableColor) + "\"/>", "movable");
    const auto is_wall = [](const Drawing::Border& b) { return b.wall; };
    const std::string line = "<line x1=\"-9\" x2=\"9\" stroke=\"" + std::string(kBorderColor) + "\" stroke-width=\"2\"";
    if (std::any_of(d_.borders.begin(), d_.borders.end(), is_wall)) add_entry(line + "/>", "wall of a region");
    if (!std::all_of(d_.borders.begin(), d_.borders.end(), is_wall))
      add_entry(line + " stroke-dasharray=\"5 4\"/>", "gate of a region");
  }
  static std::string dot_symbol(std::size_t kind) {
    return "<circle r=\"4\" fill=\"" + std::string(body_colors(kind).edge) + "\"/>";
  }
  static std::string ring_symbol(std::string_view color, std::string_view more) {
    return "<circle r=\"7.5\" fill=\"none\" stroke=\"" + std::string(color) + "\" stroke-width=\"2.5\"" +
           std::string(more) + "/>";
  }
  void add_entry(std::string symbol, std::string words) {
    entries_.push_back({std::move(symbol), std::move(words)});
    const double width = entries_.back().width_px();
    if (legend_lines_ == 0 || legend_x_px_ + width > width_px_ - left_text_px()) {
      ++legend_lines_;
      legend_x_px_ = left_text_px();
    }
    places_.push_back({legend_x_px_, legend_lines_ - 1});
    legend_x_px_ += width;
  }

  void legend() {
    svg_ << "<g class=\"legend\">\n";
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const double y = bottom_px() + 62.0 + kLine_px * static_cast<double>(places_[i].line);
      svg_ << "<g transform=\"translate(" << places_[i].x_px + 9.0 << " " << y << ")\">" << entries_[i].symbol
           << "</g>\n";
      text(places_[i].x_px + 25.0, y + 4.5, 13.0, kInk, "", entries_[i].text);
    }
    svg_ << "</g>\n";
  }

  struct LegendPlace {
    double x_px = 0.0;
    std::size_t line = 0;
  };

  const Drawing& d_;
  const PictureLook& look_;
  Area shown_;
  Svg svg_;
  double axis_px_ = 0.0;
  double px_per_m_ = 1.0;
  double arena_w_px_ = 0.0, arena_h_px_ = 0.0;
  double width_px_ = 0.0, left_px_ = 0.0;
  std::vector<LegendEntry> entries_;
  std::vector<LegendPlace> places_;
  std::size_t legend_lines_ = 0;
  double legend_x_px_ = 0.0;
};

}  // namespace

std::string Drawing::Area::label() const {
  return max_speed_m_s > 0.0 ? id + ": " + hal::format_number(max_speed_m_s) + " m/s" : id;
}

std::string_view Drawing::Area::color() const {
  constexpr std::array<std::string_view, 3> kByKind = {"#009e73", "#d55e00", "#e69f00"};
  return kByKind[static_cast<std::size_t>(kind)];
}

const BodyColors& body_colors(std::size_t kind) {
  return kBodyColors[kind % kBodyColors.size()];
}

double round_length(double limit_m) {
  const double power = std::pow(10.0, std::floor(std::log10(limit_m)));
  // The logarithm of a power of ten may come out a little too large or small.
  for (const double digit : {10.0, 5.0, 2.0, 1.0}) {
    if (digit * power <= limit_m * (1.0 + 1e-9)) return digit * power;
  }
  return 0.5 * power;
}

std::string length_text(double length_m) {
  const auto in = [length_m](double per_m, std::string_view unit) {
    return hal::format_number(std::round(length_m * per_m * 100.0) / 100.0) + " " + std::string(unit);
  };
  if (length_m >= 0.9999) return in(1.0, "m");
  return length_m >= 0.009999 ? in(100.0, "cm") : in(1000.0, "mm");
}

std::string to_svg(const Drawing& drawing, const PictureLook& look) {
  return Page(drawing, look).draw();
}

int svg_height_px(const Drawing& drawing, const PictureLook& look) {
  return static_cast<int>(std::ceil(Page(drawing, look).height_px()));
}

void keep_floor(Drawing& drawing, const PictureLook& look) {
  if (!drawing.floor) return;
  const FloorGrid grid(drawing, look);
  std::vector<float> levels;
  for (int line = 0; line < grid.lines; ++line) {
    for (int column = 0; column < grid.columns; ++column)
      levels.push_back(static_cast<float>(drawing.floor(grid.middle_x_m(column), grid.middle_y_m(line))));
  }
  drawing.floor = [grid, levels = std::make_shared<const std::vector<float>>(std::move(levels))](double x_m,
                                                                                                 double y_m) {
    const auto place = [](double at, int most) { return std::clamp(static_cast<int>(std::floor(at)), 0, most - 1); };
    const int column = place((x_m - grid.x_m) / grid.cell_m, grid.columns);
    const int line = place((y_m - grid.y_m) / grid.cell_m, grid.lines);
    return static_cast<double>((*levels)[static_cast<std::size_t>(line * grid.columns + column)]);
  };
}

}  // namespace tandem::core
