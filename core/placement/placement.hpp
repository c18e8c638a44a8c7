// Start places: expands `<distribute>` into places without overlap.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/vector.hpp"

namespace tandem::core {

/// One robot's start. `number` is appended to the item's id; -1: nothing.
struct PlacedRobot {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_rad = 0.0;
  std::uint32_t item = 0;  ///< of Scenario::robots
  std::int64_t number = -1;
};

struct PlacedObject {
  Vec3 p_W{};
  double yaw_rad = 0.0;
  hal::Quaternion q_WB{1.0, 0.0, 0.0, 0.0};  ///< what is distributed stands upright
  std::uint32_t item = 0;                    ///< of Scenario::objects
  std::int64_t number = -1;
};

struct PlacedLight {
  Vec3 p_W{};
  std::uint32_t item = 0;  ///< of Scenario::lights
  std::int64_t number = -1;
};

/// In the order of the file; a distributed item's entities in the order of their numbers.
struct Placements {
  std::vector<PlacedRobot> robots;
  std::vector<PlacedObject> objects;
  std::vector<PlacedLight> lights;
};

/// Size of a kind of robot, for overlap.
struct BodySize {
  double radius_m = -1.0;  ///< negative: the kind is unknown (reported elsewhere)
  double height_m = 0.0;
  bool flies = false;
};
using SizeOf = std::function<BodySize(const std::string& kind)>;

/// Places what has a place of its own first, then draws places for what is distributed, in the order of the file: a
/// pure function of the scenario and the seed. Bodies never overlap one another nor boxes and
/// cylinders; only things that cannot move may overlap among themselves where the file says so. Yaws come out in (-pi,
/// pi]. Problems, each with its line: two placed things that overlap, a robot outside the arena, and `max_trials` draws
/// without a free place (says how many were placed, and what is in the way).
Placements place(const Scenario& scenario, std::uint64_t seed, const SizeOf& size_of, Problems& problems);

}  // namespace tandem::core
