#include "core/view/layers/segments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tandem::core {
namespace {

constexpr int kCorners = 24;  // of a circle: 1 - cos(pi / 24) is 0.9 %

}  // namespace

std::vector<Segment> segments_of(const Sketch& sketch) {
  std::vector<Segment> segments;
  for (const Sketch::Shape& shape : sketch.shapes()) {
    const hal::Rgb c = shape.pen.color;
    const auto a = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(shape.pen.opacity, 0.0, 1.0)));
    const auto add = [&](const Sketch::Point& p, const Sketch::Point& q) {
      segments.push_back({static_cast<float>(p.x_m), static_cast<float>(p.y_m), static_cast<float>(p.z_m),
                          static_cast<float>(q.x_m), static_cast<float>(q.y_m), static_cast<float>(q.z_m), c.r, c.g,
                          c.b, a});
    };
    const std::vector<Sketch::Point>& points = shape.points;
    switch (shape.kind) {
      case Sketch::Shape::Kind::Line:
      case Sketch::Shape::Kind::Polygon:
        for (std::size_t i = 1; i < points.size(); ++i) add(points[i - 1], points[i]);
        if (shape.kind == Sketch::Shape::Kind::Polygon && points.size() > 2) add(points.back(), points.front());
        break;
      case Sketch::Shape::Kind::Circle: {
        const Sketch::Point& center = points.front();
        const auto corner = [&](int i) -> Sketch::Point {
          const double angle_rad = 2.0 * std::numbers::pi * (i % kCorners) / kCorners;
          return {center.x_m + shape.radius_m * std::cos(angle_rad), center.y_m + shape.radius_m * std::sin(angle_rad),
                  center.z_m};
        };
        for (int i = 0; i < kCorners; ++i) add(corner(i), corner(i + 1));
        break;
      }
      case Sketch::Shape::Kind::Text:
        break;
    }
  }
  return segments;
}

std::vector<PlacedText> texts_of(const Sketch& sketch) {
  std::vector<PlacedText> texts;
  for (const Sketch::Shape& shape : sketch.shapes()) {
    if (shape.kind == Sketch::Shape::Kind::Text) texts.push_back({shape.points.front(), shape.text, shape.pen.color});
  }
  return texts;
}

}  // namespace tandem::core
