// Shapes and texts that hooks and layers draw into pictures and views.
#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/device/leds.hpp"

namespace tandem::core {

/// Drawings for people, which robots do not see. In metres, in W. Those of hooks last until the next step
/// begins.
class Sketch {
 public:
  struct Point {
    double x_m = 0.0, y_m = 0.0;
    double z_m = 0.0;  ///< above the ground; pictures from above do not show it
  };
  struct Pen {
    hal::Rgb color{230, 73, 128};
    double width_m = 0.0;  ///< of lines; 0: thin, whatever the picture's size
    bool filled = false;   ///< of polygons and circles
    double opacity = 1.0;  ///< 0 invisible to 1
  };
  struct Shape {
    enum class Kind : std::uint8_t { Line, Polygon, Circle, Text };
    Kind kind = Kind::Line;
    std::vector<Point> points;  ///< of a line or polygon; else one, the centre or where the text begins
    double radius_m = 0.0;      ///< of a circle
    std::string text;
    Pen pen;

    void remember(auto& archive) { archive(kind, points, radius_m, text, pen); }
  };

  void line(Point from, Point to) { line(from, to, Pen()); }
  void line(Point from, Point to, const Pen& pen) { add({Shape::Kind::Line, {from, to}, 0.0, {}, pen}); }
  /// Through all points in turn.
  void path(std::span<const Point> points, const Pen& pen) {
    add({Shape::Kind::Line, {points.begin(), points.end()}, 0.0, {}, pen});
  }
  void polygon(std::span<const Point> corners, const Pen& pen) {
    add({Shape::Kind::Polygon, {corners.begin(), corners.end()}, 0.0, {}, pen});
  }
  /// Level, at the height of its centre.
  void circle(Point center, double radius_m) { circle(center, radius_m, Pen()); }
  void circle(Point center, double radius_m, const Pen& pen) {
    add({Shape::Kind::Circle, {center}, radius_m, {}, pen});
  }
  void text(Point at, std::string_view text) { this->text(at, text, Pen()); }
  void text(Point at, std::string_view text, const Pen& pen) {
    add({Shape::Kind::Text, {at}, 0.0, std::string(text), pen});
  }

  void add(const Sketch& other) { shapes_.insert(shapes_.end(), other.shapes_.begin(), other.shapes_.end()); }

  const std::vector<Shape>& shapes() const noexcept { return shapes_; }
  void clear() noexcept { shapes_.clear(); }
  void remember(auto& archive) { archive(shapes_); }

 private:
  /// What lies nowhere is not kept.
  void add(Shape shape) {
    bool finite = std::isfinite(shape.radius_m) && std::isfinite(shape.pen.width_m) && std::isfinite(shape.pen.opacity);
    for (const Point& p : shape.points)
      finite = finite && std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.z_m);
    if (finite && !shape.points.empty()) shapes_.push_back(std::move(shape));
  }
  std::vector<Shape> shapes_;
};

}  // namespace tandem::core
