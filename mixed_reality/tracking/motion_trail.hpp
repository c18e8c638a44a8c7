// Motions of one robot as different sources tell them, and how well two of them are one motion.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "core/space/pose.hpp"
#include "hal/time.hpp"

namespace tandem::mixed_reality {

/// The last places of one robot in a frame of the source's own. Allocates nothing.
class MotionTrail {
 public:
  static constexpr std::size_t kMost = 256;
  struct Point {
    hal::TimeNs at_ns = 0;
    double x_m = 0.0, y_m = 0.0;
    std::optional<double> heading_rad;  ///< nothing: the source sees a point
    double way_m = 0.0;                 ///< rolled until then; 0 for sources that do not roll
  };

  /// Points that are not later than the newest are left out.
  void add(const Point& point) noexcept;
  void clear() noexcept { count_ = 0; }
  std::size_t size() const noexcept { return count_; }
  /// The oldest first.
  const Point& operator[](std::size_t i) const noexcept { return points_[(first_ + i) % kMost]; }
  const Point& newest() const noexcept { return (*this)[count_ - 1]; }
  /// Between two points in proportion to time; nothing before the oldest and after the newest.
  std::optional<Point> at(hal::TimeNs time_ns) const noexcept;

 private:
  std::array<Point, kMost> points_;
  std::size_t first_ = 0, count_ = 0;
};

/// The motion that wheels make of it, from 0 with heading 0.
class ReckonedTrail {
 public:
  void roll(hal::TimeNs at_ns, double left_m, double right_m, double wheel_base_m) noexcept;
  void clear() noexcept;
  const MotionTrail& trail() const noexcept { return trail_; }

 private:
  MotionTrail trail_;
  core::Pose pose_ = core::Pose::at(0.0, 0.0, 0.0);
  double heading_rad_ = 0.0;  // unwrapped
  double way_m_ = 0.0;
};

struct MotionSpan {
  hal::TimeNs from_ns = 0, to_ns = 0;
};

/// Distance of `seen` from `reckoned` delayed by `later_ns`, root mean square over the places of `seen` in the span:
/// after `reckoned` was turned and shifted as fits best, by the headings where both tell them, and without the fifth of
/// places that fits worst. A heading that is off counts as kLever_m for each radian. Nothing: fewer than kFewest places
/// can be compared.
inline constexpr double kLever_m = 0.05;
inline constexpr std::size_t kFewest = 4;
std::optional<double> apart_m(const MotionTrail& reckoned, const MotionTrail& seen, const MotionSpan& span,
                              hal::TimeNs later_ns) noexcept;

/// The same from a robot that stands.
std::optional<double> apart_from_rest_m(const MotionTrail& seen, const MotionSpan& span) noexcept;

/// The delay with the smallest such distance.
struct BestDelay {
  hal::TimeNs later_ns = 0;
  double apart_m = 0.0;
};
/// Of those from `least_ns` to `most_ns` in steps of `step_ns`. Nothing: there is nothing to compare at any of them.
std::optional<BestDelay> best_delay(const MotionTrail& reckoned, const MotionTrail& seen, const MotionSpan& span,
                                    hal::TimeNs least_ns, hal::TimeNs most_ns, hal::TimeNs step_ns) noexcept;

}  // namespace tandem::mixed_reality
