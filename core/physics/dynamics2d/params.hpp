// Parameters of <dynamics2d>.
#pragma once
#include <cstdint>
#include <memory>

#include "core/scenario/element.hpp"

namespace tandem::core::box2d {

inline constexpr std::int64_t kMostSubSteps = 1000;  // a tick

/// Chipmunk's, which ARGoS 3 is built on. Box2D finds neighbours in a tree and needs none.
struct SpatialHash {
  double cell_size_m = 0.1;
  std::int64_t cell_num = 1000;

  void describe(hal::ParamVisitor& v) {
    v.number("cell_size", cell_size_m, hal::unit::m, {0.0, 1e6}, "Without effect.");
    v.integer("cell_num", cell_num, {0, 1e9}, "Without effect.");
  }
};

/// Parameters, by ARGoS 3's names where it has them.
struct Params {
  std::int64_t iterations = 0;
  std::int64_t velocity_iterations = 8;
  std::int64_t position_iterations = 3;
  double box_linear_friction = 1.49;  // per kg, as all four [ARGoS]
  double box_angular_friction = -1.0;
  double cylinder_linear_friction = 1.49;
  double cylinder_angular_friction = -1.0;
  double friction = 0.1;
  double elevation_m = 0.0;
  SpatialHash spatial_hash;

  void describe(hal::ParamVisitor& v) {
    v.integer(
        "iterations", iterations, {0, static_cast<double>(kMostSubSteps)},
        "Sub-steps a tick. 0: as few as keep every hop below half a body's radius, and 25 ms at most while bodies "
        "are held together.");
    v.integer("velocity_iterations", velocity_iterations, {1, 1000}, "Box2D's passes over velocities, a sub-step.");
    v.integer("position_iterations", position_iterations, {1, 1000}, "Box2D's passes over overlaps, a sub-step.");
    v.number("box_linear_friction", box_linear_friction, hal::unit::none, {0.0, 1e6},
             "Force in N that a kg of a movable box resists sliding on the ground with.");
    v.number("box_angular_friction", box_angular_friction, hal::unit::none, {-1.0, 1e6},
             "Torque in N m that a kg of a movable box resists turning on the ground with. Negative: what follows from "
             "box_linear_friction when its weight is spread evenly.");
    v.number("cylinder_linear_friction", cylinder_linear_friction, hal::unit::none, {0.0, 1e6},
             "As box_linear_friction, of a cylinder.");
    v.number("cylinder_angular_friction", cylinder_angular_friction, hal::unit::none, {-1.0, 1e6},
             "As box_angular_friction, of a cylinder.");
    v.number("friction", friction, hal::unit::none, {0.0, 10.0}, "Coulomb's coefficient between bodies that touch.");
    v.number("elevation", elevation_m, hal::unit::m, {-1e6, 1e6},
             "Height of the plane; read for ARGoS 3's files, without effect on results.");
    v.group("spatial_hash", spatial_hash, "Read for ARGoS 3's files.");
  }
};

/// Of an engine's element: its own attributes and children; problems are reported with their lines.
std::shared_ptr<const Params> read_params(const Element& options, Problems& problems);

}  // namespace tandem::core::box2d
