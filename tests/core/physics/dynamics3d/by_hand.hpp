// Solvers of dynamics3d by hand.
#pragma once
#include "core/physics/dynamics3d/dynamics3d.hpp"
#include "tests/core/physics/solvers_by_hand.hpp"

namespace tandem::core {

inline constexpr double kGravity_m_s2 = 9.81;
inline constexpr double kSubStep_s = 0.02;  // what the engine chooses for ticks of 0.1 s

inline Element child(const std::string& name, const std::vector<Element::Attribute>& attributes) {
  Element element;
  element.name = name;
  element.file = "f";
  element.line = 4;
  element.attributes = attributes;
  return element;
}

struct ByHand : SolversByHand {
  explicit ByHand(const std::vector<Element::Attribute>& options = {}, const std::vector<Element>& children = {},
                  double half_m = 20.0)
      : SolversByHand(dynamics3d_type(), options, half_m, children) {}

  /// Returns its number; its base is at `z_m`.
  std::size_t block(double x_m, double y_m, double z_m, double size_x_m, double size_y_m, double height_m,
                    double mass_kg, double heading_rad = 0.0) {
    return raise(box(x_m, y_m, size_x_m, size_y_m, mass_kg, heading_rad), z_m, height_m);
  }
  std::size_t can(double x_m, double y_m, double z_m, double radius_m, double height_m, double mass_kg) {
    return raise(cylinder(x_m, y_m, radius_m, mass_kg), z_m, height_m);
  }
  double z_m(std::size_t i = 0) { return object_motion(i).z_m; }
  /// Cosine of the angle between the object's axis and the vertical.
  double upright(std::size_t i = 0) {
    const auto& q = object_motion(i).q_WB;
    return 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]);
  }

 private:
  std::size_t raise(std::size_t i, double z_m, double height_m) {
    Object& o = object(i);
    o.z_low_m = z_m;
    o.z_high_m = z_m + height_m;
    Motion& m = object_motion(i);
    m.z_m = z_m;
    const double half_rad = 0.5 * std::atan2(o.sin_h, o.cos_h);
    m.q_WB = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
    return i;
  }
};

}  // namespace tandem::core
