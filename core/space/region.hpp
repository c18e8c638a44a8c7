// The part of the arena that one engine looks after: a right prism with walls and gates for sides.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/scenario/engine_traits.hpp"
#include "core/space/body_key.hpp"
#include "core/space/space.hpp"

namespace tandem::core {

inline constexpr std::uint16_t kNoRegion = 0xFFFF;

/// The side of a region's outline that starts at (x, y) and ends where the next one starts.
struct RegionSide {
  double x_m = 0.0;
  double y_m = 0.0;
  bool wall = false;               ///< bodies cannot pass; sensors do not see it
  std::uint16_t gate = kNoRegion;  ///< of a side that is no wall: where it leads; kNoRegion: to whatever lies behind
};

/// Region of one engine. Outlines are counter-clockwise; regions of engines for bodies of the same sort do
/// not overlap.
struct Region {
  std::string name;               ///< the engine's id in the file; of a part, with its column and line: "dyn2d[2,3]"
  std::size_t engine = 0;         ///< index into Scenario::engines
  bool air = false;               ///< of an engine made for flying bodies, in a run where these lie over others
  bool plane = true;              ///< bodies in it stay on the ground
  bool forces = false;            ///< its engine knows masses: it can hold movable objects
  JointKinds joints = 0;          ///< that its engine has
  double gravity_m_s2 = 9.81;     ///< that its engine pulls bodies down with
  bool listed = false;            ///< its engine wants `owned` and `mirrored`
  int line = 0;                   ///< of its engine in the file
  std::vector<RegionSide> sides;  ///< empty: the whole plane
  double bottom_m = -std::numeric_limits<double>::infinity();
  double top_m = std::numeric_limits<double>::infinity();
  double min_x_m = 0.0, min_y_m = 0.0, max_x_m = 0.0, max_y_m = 0.0;  ///< the rectangle around the outline

  /// The living bodies that this region's engine moves, and those near its border that others move, as of the start of
  /// the tick. In rising order. Neither holds immovable objects.
  std::vector<BodyKey> owned;
  std::vector<BodyKey> mirrored;

  bool everywhere() const noexcept { return sides.empty(); }
  /// A point on a shared border is in exactly one of two regions whose borders have the same end points.
  bool contains(double x_m, double y_m) const noexcept;
  bool contains_height(double z_m) const noexcept { return z_m >= bottom_m && z_m <= top_m; }
  /// From (x, y) to the outline, in m; 0 inside.
  double distance(double x_m, double y_m) const noexcept;
  /// Whether any part of an object seen from above lies within `margin_m` of the region.
  bool touches(const Object& object, double margin_m) const noexcept;
  /// Sets the rectangle, and turns the outline counter-clockwise. Call after filling in `sides`.
  void close() noexcept;
};

/// From (x, y) to the line segment a-b; `nearest_x, nearest_y` is the nearest point of it.
double distance_to_segment(double x_m, double y_m, double ax, double ay, double bx, double by, double& nearest_x,
                           double& nearest_y) noexcept;

}  // namespace tandem::core
