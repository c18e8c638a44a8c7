#include "mixed_reality/tracking/motion_trail.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/angle.hpp"
#include "mixed_reality/tracking/odometry.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kKept = 0.8;  // of the places that are compared, the rest are taken for outliers

/// One place by both sources.
struct Pair {
  double x_m, y_m;            // as it is seen
  double from_x_m, from_y_m;  // as it was reckoned
  double turn_rad;            // between both headings
  double off2 = 0.0;
};
using Pairs = std::array<Pair, MotionTrail::kMost>;

/// Turns and shifts the first `count` to fit, and notes how far off all of `all` are then.
void fit(Pairs& pairs, std::size_t count, std::size_t all, bool faces) noexcept {
  double x = 0.0, y = 0.0, from_x = 0.0, from_y = 0.0, cos_sum = 0.0, sin_sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Pair& p = pairs[i];
    x += p.x_m;
    y += p.y_m;
    from_x += p.from_x_m;
    from_y += p.from_y_m;
    cos_sum += std::cos(p.turn_rad);
    sin_sum += std::sin(p.turn_rad);
  }
  const double n = static_cast<double>(count);
  x /= n, y /= n, from_x /= n, from_y /= n;
  if (!faces) {  // the turn with the least squares [Arun 1987, for the plane]
    cos_sum = sin_sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Pair& p = pairs[i];
      const double a = p.from_x_m - from_x, b = p.from_y_m - from_y, c = p.x_m - x, d = p.y_m - y;
      cos_sum += a * c + b * d;
      sin_sum += a * d - b * c;
    }
  }
  const double turn_rad = cos_sum == 0.0 && sin_sum == 0.0 ? 0.0 : std::atan2(sin_sum, cos_sum);
  const double cos_t = std::cos(turn_rad), sin_t = std::sin(turn_rad);
  for (std::size_t i = 0; i < all; ++i) {
    Pair& p = pairs[i];
    const double a = p.from_x_m - from_x, b = p.from_y_m - from_y;
    const double off_x = p.x_m - x - (cos_t * a - sin_t * b), off_y = p.y_m - y - (sin_t * a + cos_t * b);
    const double off_rad = faces ? hal::wrapped(p.turn_rad - turn_rad) : 0.0;
    p.off2 = off_x * off_x + off_y * off_y + kLever_m * kLever_m * off_rad * off_rad;
  }
}

}  // namespace

void MotionTrail::add(const Point& point) noexcept {
  if (count_ > 0 && point.at_ns <= newest().at_ns) return;
  if (count_ == kMost) {
    first_ = (first_ + 1) % kMost;
    --count_;
  }
  points_[(first_ + count_++) % kMost] = point;
}

std::optional<MotionTrail::Point> MotionTrail::at(hal::TimeNs time_ns) const noexcept {
  if (count_ == 0 || time_ns < (*this)[0].at_ns || time_ns > newest().at_ns) return {};
  std::size_t low = 0, high = count_ - 1;  // the time lies between them
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    ((*this)[middle].at_ns <= time_ns ? low : high) = middle;
  }
  const Point &a = (*this)[low], &b = (*this)[high];
  if (b.at_ns == a.at_ns) return a;
  const double part = hal::to_seconds(time_ns - a.at_ns) / hal::to_seconds(b.at_ns - a.at_ns);
  Point between = a;
  between.at_ns = time_ns;
  between.x_m += part * (b.x_m - a.x_m);
  between.y_m += part * (b.y_m - a.y_m);
  between.way_m += part * (b.way_m - a.way_m);
  if (a.heading_rad && b.heading_rad) between.heading_rad = *a.heading_rad + part * (*b.heading_rad - *a.heading_rad);
  return between;
}

void ReckonedTrail::roll(hal::TimeNs at_ns, double left_m, double right_m, double wheel_base_m) noexcept {
  pose_ = rolled(pose_, left_m, right_m, wheel_base_m);
  heading_rad_ += (right_m - left_m) / wheel_base_m;
  way_m_ += 0.5 * (std::fabs(left_m) + std::fabs(right_m));
  trail_.add({at_ns, pose_.x_m, pose_.y_m, heading_rad_, way_m_});
}

void ReckonedTrail::clear() noexcept {
  *this = {};
}

namespace {

std::optional<double> without_outliers_m(Pairs& pairs, std::size_t count, bool faces) noexcept {
  if (count < kFewest) return {};
  fit(pairs, count, count, faces);
  const auto kept = std::max(kFewest, static_cast<std::size_t>(std::ceil(kKept * static_cast<double>(count))));
  const auto by_off = [](const Pair& a, const Pair& b) { return a.off2 < b.off2; };
  std::sort(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count), by_off);
  if (kept < count) fit(pairs, kept, kept, faces);
  double sum = 0.0;
  for (std::size_t i = 0; i < kept; ++i) sum += pairs[i].off2;
  return std::sqrt(sum / static_cast<double>(kept));
}

/// With `place_of(time)`, where it is by the other source.
template <class PlaceOf>
std::optional<double> apart_from(const MotionTrail& seen, const MotionSpan& span, const PlaceOf& place_of) noexcept {
  Pairs pairs;
  std::size_t count = 0;
  bool faces = true;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const MotionTrail::Point& place = seen[i];
    if (place.at_ns < span.from_ns || place.at_ns > span.to_ns) continue;
    const std::optional<MotionTrail::Point> from = place_of(place.at_ns);
    if (!from) continue;
    faces = faces && place.heading_rad && from->heading_rad;
    const double turn_rad = faces ? *place.heading_rad - *from->heading_rad : 0.0;
    pairs[count++] = {place.x_m, place.y_m, from->x_m, from->y_m, turn_rad};
  }
  return without_outliers_m(pairs, count, faces);
}

}  // namespace

std::optional<double> apart_m(const MotionTrail& reckoned, const MotionTrail& seen, const MotionSpan& span,
                              hal::TimeNs later_ns) noexcept {
  return apart_from(seen, span, [&](hal::TimeNs at_ns) { return reckoned.at(at_ns - later_ns); });
}

std::optional<double> apart_from_rest_m(const MotionTrail& seen, const MotionSpan& span) noexcept {
  return apart_from(seen, span, [](hal::TimeNs at_ns) {
    return std::optional(MotionTrail::Point{at_ns, 0.0, 0.0, 0.0, 0.0});
  });
}

std::optional<BestDelay> best_delay(const MotionTrail& reckoned, const MotionTrail& seen, const MotionSpan& span,
                                    hal::TimeNs least_ns, hal::TimeNs most_ns, hal::TimeNs step_ns) noexcept {
  std::optional<BestDelay> best;
  for (hal::TimeNs later_ns = least_ns; later_ns <= most_ns; later_ns += step_ns) {
    const auto apart = apart_m(reckoned, seen, span, later_ns);
    if (apart && (!best || *apart < best->apart_m)) best = {later_ns, *apart};
  }
  return best;
}

}  // namespace tandem::mixed_reality
