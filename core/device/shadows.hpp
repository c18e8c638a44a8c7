// Directions around a point that nearer discs block: for lines of sight to many at once.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tandem::core {

/// A union of arcs, kept as disjoint intervals in rising order. In a crowd it soon is the whole circle, and then
/// nothing farther need be looked at. Directions are measured by a number that rises with the angle but costs no arc
/// tangent. Allocates only while it grows beyond what it ever held.
class Shadows {
 public:
  void clear() noexcept { arcs_.clear(); }
  void reserve(std::size_t arcs) { arcs_.reserve(arcs); }

  /// Rises with the angle of (x, y) from -2 at -pi to 2 at pi; 0 for (0, 0).
  static double direction(double x, double y) noexcept {
    const double length = std::fabs(x) + std::fabs(y);
    return length > 0.0 ? std::copysign(1.0 - x / length, y) : 0.0;
  }

  /// A disc with its centre at (x, y), seen from (0, 0): all directions between the tangents. Where the point lies in
  /// the disc, half of all.
  void add(double x, double y, double radius_m) {
    const double distance2 = x * x + y * y;
    const double sine = distance2 > radius_m * radius_m ? radius_m / std::sqrt(distance2) : 1.0;
    const double cosine = std::sqrt(1.0 - sine * sine);
    const double low = direction(cosine * x + sine * y, cosine * y - sine * x);
    const double high = direction(cosine * x - sine * y, cosine * y + sine * x);
    if (low <= high) {
      join(low, high);
    } else {  // across straight back
      join(low, kMost);
      join(-kMost, high);
    }
  }

  /// `at` is a direction().
  bool covers(double at) const noexcept {
    const auto after =
        std::upper_bound(arcs_.begin(), arcs_.end(), at, [](double d, const Arc& arc) { return d < arc.low; });
    return after != arcs_.begin() && at <= std::prev(after)->high;
  }

  bool full() const noexcept { return arcs_.size() == 1 && arcs_[0].low <= -kMost && arcs_[0].high >= kMost; }

 private:
  static constexpr double kMost = 2.0;
  struct Arc {
    double low, high;
  };

  void join(double low, double high) {
    const auto first =
        std::lower_bound(arcs_.begin(), arcs_.end(), low, [](const Arc& arc, double d) { return arc.high < d; });
    auto past = first;
    for (; past != arcs_.end() && past->low <= high; ++past) {
      low = std::min(low, past->low);
      high = std::max(high, past->high);
    }
    if (first == past) {
      arcs_.insert(first, {low, high});
    } else {
      *first = {low, high};
      arcs_.erase(std::next(first), past);
    }
  }

  std::vector<Arc> arcs_;
};

}  // namespace tandem::core
