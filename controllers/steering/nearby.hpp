// Evaluates a robot's rings of sensors: the nearest thing, the push away from what is near, the way to the light.
// Vectors are in the body frame (x forward, y left), bearings counter-clockwise from forward.
#pragma once
#include <span>

#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot_kind.hpp"
#include "hal/vector2.hpp"

namespace tandem::controllers {

/// Something that neighbouring proximity sensors see.
struct Thing {
  bool seen = false;
  double bearing_rad = 0.0;  ///< of its middle, counter-clockwise from forward
  double gap_m = 0.0;        ///< from the nearest sensor
  double breadth_m = 0.0;    ///< between the outermost points that are seen of it
};

/// Whether a message came from within `range_m` and within `within_rad` of a bearing.
bool robot_near(const hal::RangeAndBearing& heard, double bearing_rad, double within_rad, double range_m) noexcept;

/// The nearest thing that is no robot: robots are known by their messages. `mounts` are the proximity sensors'.
Thing nearest_thing(const hal::Proximity& proximity, std::span<const hal::Mount> mounts,
                    const hal::RangeAndBearing& heard) noexcept;

/// Mean of what all sensors see that look more than `from_rad` away from straight ahead, as a vector away from it: each
/// sensor counts 0 with nothing in range and 1 at contact.
hal::Vector2 push_away(const hal::Proximity& proximity, std::span<const hal::Mount> mounts,
                       double from_rad = 0.0) noexcept;

/// Sum of the light that each sensor sees, along the sensor. `mounts` are the light sensors'.
hal::Vector2 to_light(const hal::Light& light, std::span<const hal::Mount> mounts) noexcept;

/// Mean reflectance that the sensors see; 1 where there are none.
double mean_reflectance(const hal::Ground& ground) noexcept;

}  // namespace tandem::controllers
