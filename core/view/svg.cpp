#include <algorithm>
#include <cmath>

#include "core/view/drawing.hpp"
#include "core/view/svg_floor.hpp"
#include "core/view/svg_legend.hpp"
#include "core/view/svg_robots.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kFullDetailRobots = 20'000;
constexpr double kMargin_px = 28.0;
constexpr double kLine_px = 30.0;   // of the legend
constexpr double kLetter_px = 7.4;  // mean width in the font used

constexpr double kAxisLine_px = 42.0;   // beneath the frame
constexpr double kAxisWidth_px = 62.0;  // at its left
constexpr std::ptrdiff_t kMostHeights = 100;
constexpr std::string_view kInk = "#22272e";
constexpr std::string_view kFaintInk = "#68707b";
constexpr std::string_view kWallEdge = "#3f4751";
constexpr std::string_view kMovableEdge = "#7d5a2b";

using Area = PictureLook::Area;

class Page {
 public:
  Page(const Drawing& drawing, const PictureLook& look)
      : d_(drawing), look_(look), shown_(look.region.value_or(drawing.arena())) {
    const double width_m = shown_.max_x_m - shown_.min_x_m;
    const double depth_m = shown_.max_y_m - shown_.min_y_m;
    px_per_m_ = look.size_px / std::max(width_m, depth_m);
    arena_w_px_ = width_m * px_per_m_;
    arena_h_px_ = depth_m * px_per_m_;
    head_px_ = look.title ? 52.0 : kMargin_px;
    if (look.axes) axis_px_ = kAxisLine_px;
    const double beside_px = look.axes ? kAxisWidth_px : 0.0;
    width_px_ = std::max(arena_w_px_ + beside_px, 420.0) + 2.0 * kMargin_px;
    left_px_ = beside_px + 0.5 * (width_px_ - beside_px - arena_w_px_);
    if (look.legend) lay_out_legend();
  }

  double height_px() const {
    if (look_.height_px > 0) return look_.height_px;
    if (!look_.legend) return bottom_px() + (look_.axes ? 6.0 : kMargin_px);
    return bottom_px() + 52.0 + kLine_px * static_cast<double>(legend_lines_) + 8.0;
  }

  std::string draw() {
    header();
    definitions();
    svg_ << "<g transform=\"translate(" << left_px_ - shown_.min_x_m * px_per_m_ << " "
         << head_px_ + shown_.max_y_m * px_per_m_ << ") scale(" << px_per_m_ << " " << -px_per_m_ << ")\">\n";
    svg_ << "<g clip-path=\"url(#arena)\">\n";
    arena();
    svg_ << floor_picture(d_, look_);
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
    heights();
    if (look_.legend) {
      scale_bar();
      legend();
    }
    svg_ << "</svg>\n";
    return svg_.take();
  }

 private:
  bool full_detail() const { return d_.robots.size() <= kFullDetailRobots; }
  double px(double pixels) const { return pixels / px_per_m_; }  // as metres
  double x_px(double x_m) const { return left_px_ + (x_m - shown_.min_x_m) * px_per_m_; }
  double y_px(double y_m) const { return head_px_ + (shown_.max_y_m - y_m) * px_per_m_; }
  double bottom_px() const { return head_px_ + arena_h_px_ + axis_px_; }
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
    if (!look_.title) return;
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

  void arena() {
    svg_ << "<rect x=\"" << d_.min_x_m << "\" y=\"" << d_.min_y_m << "\" width=\"" << d_.max_x_m - d_.min_x_m
         << "\" height=\"" << d_.max_y_m - d_.min_y_m << "\" fill=\"#f5f4f0\"/>\n";
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

  void objects(bool movable, std::string_view name, std::string_view fill, std::string_view edge) {
    if (!any_objects(d_, movable)) return;
    svg_ << "<g class=\"" << name << "\" fill=\"" << fill << "\" stroke=\"" << edge << "\" stroke-width=\"" << px(1.0)
         << "\">\n";
    for (const Object::Kind kind : {Object::Kind::Box, Object::Kind::Cylinder}) {
      for (const Object& o : d_.objects) {
        if (o.movable != movable || o.kind != kind) continue;
        if (kind == Object::Kind::Cylinder) {
          svg_ << "<circle cx=\"" << o.x_m << "\" cy=\"" << o.y_m << "\" r=\"" << o.radius_m << "\"/>\n";
          continue;
        }
        svg_ << "<rect x=\"" << -o.half_x_m << "\" y=\"" << -o.half_y_m << "\" width=\"" << 2.0 * o.half_x_m
             << "\" height=\"" << 2.0 * o.half_y_m << "\" transform=\"translate(" << o.x_m << " " << o.y_m
             << ") rotate(" << degrees(std::atan2(o.sin_h, o.cos_h)) << ")\"/>\n";
      }
    }
    svg_ << "</g>\n";
  }

  void lights() {
    for (const LightSource& light : d_.lights) {
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
    if (!full_detail()) {
      svg_ << robot_dots(d_);
      return;
    }
    svg_ << "<g class=\"robots\">\n";
    for (const Drawing::Robot& robot : d_.robots) {
      if (shows(robot)) svg_ << robot_body(d_, robot);
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
      if (!full_detail()) svg_ << robot_body(d_, r);
      const double ring_m = d_.kinds[r.kind].radius_m + px(4.0);
      svg_ << "<circle class=\"real\" cx=\"" << r.x_m << "\" cy=\"" << r.y_m << "\" r=\"" << ring_m
           << "\" fill=\"none\" stroke=\"" << (real.state.empty() ? kRealColor : kTroubleColor) << "\" stroke-width=\""
           << px(2.5) << "\"";
      if (!real.state.empty()) svg_ << " stroke-dasharray=\"" << px(5.0) << " " << px(4.0) << "\"";
      svg_ << "/>\n";
    }
  }

  void frame() {
    svg_ << "<rect x=\"" << left_px_ << "\" y=\"" << head_px_ << "\" width=\"" << arena_w_px_ << "\" height=\""
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
    const double bottom = head_px_ + arena_h_px_;
    svg_ << "<g class=\"axes\" stroke-width=\"1\">\n";
    each(shown_.min_x_m, shown_.max_x_m, [&](double x_m, const std::string& number) {
      svg_ << "<path stroke=\"" << kInk << "\" d=\"M" << x_px(x_m) << " " << bottom << "v6\"/>\n";
      text(x_px(x_m), bottom + 19.0, 12.0, kInk, " text-anchor=\"middle\"", number);
    });
    each(shown_.min_y_m, shown_.max_y_m, [&](double y_m, const std::string& number) {
      svg_ << "<path stroke=\"" << kInk << "\" d=\"M" << left_px_ << " " << y_px(y_m) << "h-6\"/>\n";
      text(left_px_ - 10.0, y_px(y_m) + 4.5, 12.0, kInk, " text-anchor=\"end\"", number);
    });
    text(left_px_ + 0.5 * arena_w_px_, bottom + 37.0, 12.0, kInk, " text-anchor=\"middle\"", "x in m");
    Svg turned;
    turned << " text-anchor=\"middle\" transform=\"rotate(-90 " << left_px_ - 46.0 << " "
           << head_px_ + 0.5 * arena_h_px_ << ")\"";
    text(left_px_ - 46.0, head_px_ + 0.5 * arena_h_px_, 12.0, kInk, turned.take(), "y in m");
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

  /// Beside robots that are in the air, unless they are too many.
  void heights() {
    const auto flies = [this](const Drawing::Robot& r) { return r.z_m > kInTheAir_m && shows(r); };
    if (std::count_if(d_.robots.begin(), d_.robots.end(), flies) > kMostHeights) return;
    for (const Drawing::Robot& r : d_.robots) {
      if (!flies(r)) continue;
      text(x_px(r.x_m), y_px(r.y_m) + d_.kinds[r.kind].radius_m * px_per_m_ + 12.0, 10.0, kFaintInk,
           " class=\"height\" text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"2\" paint-order=\"stroke\"",
           height_text(r.z_m));
    }
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
    for (LegendEntry& entry : legend_of(d_, look_, full_detail(), [this](const Drawing::Robot& r) { return shows(r); }))
      add_entry(std::move(entry));
  }
  void add_entry(LegendEntry entry) {
    entries_.push_back(std::move(entry));
    const double width = 26.0 + kLetter_px * static_cast<double>(entries_.back().text.size()) + 22.0;
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
  double axis_px_ = 0.0, head_px_ = 0.0;
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

}  // namespace tandem::core
