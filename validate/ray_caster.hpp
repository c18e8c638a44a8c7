// A ray caster of its own for comparisons: solids on a floor, level rays, and lines of sight in space. Nothing of the
// simulator's is in it.
#pragma once
#include <array>
#include <vector>

namespace tandem::validate {

struct SolidBox {
  double x_m = 0.0, y_m = 0.0;
  double angle_rad = 0.0;
  double size_x_m = 0.0, size_y_m = 0.0;
  double low_m = 0.0, high_m = 0.0;
};

struct SolidCylinder {
  double x_m = 0.0, y_m = 0.0;
  double radius_m = 0.0;
  double low_m = 0.0, high_m = 0.0;
  std::size_t owner = 0;  ///< number of the robot that it is the body of, from 1 on; 0: none
};

struct Solids {
  std::vector<SolidBox> boxes;
  std::vector<SolidCylinder> cylinders;
};

/// Distance along a level ray from (x, y) at height z to the first solid; at most `range_m`. Bodies of the robots `a`
/// and `b` are passed through.
double cast(const Solids& solids, double x_m, double y_m, double z_m, double direction_rad, double range_m,
            std::size_t a = 0, std::size_t b = 0);

/// Whether a solid is on the line from one point to another. Bodies of the robots `a` and `b` are passed
/// through.
bool blocked(const Solids& solids, const std::array<double, 3>& from, const std::array<double, 3>& to,
             std::size_t a = 0, std::size_t b = 0);

}  // namespace tandem::validate
