// Contact points of upright bodies: discs and rectangles seen from above, between two heights.
#pragma once
#include <array>
#include <cstddef>

namespace tandem::core {

/// An upright cylinder or box in W; or any body that leans, of which the bounds alone are meant.
struct Prism {
  bool round = true;
  bool upright = true;
  double x_m = 0.0, y_m = 0.0;
  double cos_h = 1.0, sin_h = 0.0;          ///< heading of a box
  double half_x_m = 0.0, half_y_m = 0.0;    ///< of a box
  double radius_m = 0.0;                    ///< of a cylinder
  double low_m = 0.0, high_m = 0.0;         ///< heights of its base and top
  double reach_x_m = 0.0, reach_y_m = 0.0;  ///< half the extent of what it covers, seen from above
};

/// One point of contact between a body a and a body b.
struct Touch {
  std::array<double, 3> p_m{};     ///< in W
  std::array<double, 3> normal{};  ///< unit vector in W from b to a
  double depth_m = 0.0;            ///< negative: the gap
};

inline constexpr std::size_t kMostTouches = 8;
using Touches = std::array<Touch, kMostTouches>;

/// Contact of two upright things of which one is round.
struct TouchQuery {
  double near_m = 0.0;         ///< wider gaps are none
  bool beside = false;         ///< they stand on the same floor: neither is ever on top of the other
  bool line = false;           ///< side by side they touch along a line (two points), not in a point
  double direction_rad = 0.0;  ///< in which `a` is to give way when both have the same axis
};

/// Number of entries of `touches` filled in. At least one of `a`, `b` must be round, and both upright.
std::size_t find_touches(const Prism& a, const Prism& b, const TouchQuery& query, Touches& touches) noexcept;

}  // namespace tandem::core
