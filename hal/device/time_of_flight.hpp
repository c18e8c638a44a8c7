// Time-of-flight sensor: distance to the nearest obstacle in a cone, by the time that light takes there and back.
#pragma once
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// Distance from the sensor to the nearest obstacle in its cone.
struct TimeOfFlight : Reading {
  static constexpr std::string_view kName = "time_of_flight";
  static constexpr std::string_view kDoc = "Distance to the nearest obstacle in a cone ahead, by the time of light.";

  float range_m = 0.0F;     ///< how far it sees; with nothing nearer it reads this
  float distance_m = 0.0F;  ///< from the sensor

  bool sees_nothing() const noexcept { return distance_m >= range_m; }

  void describe(FieldList& f) const {
    f.add("range", range_m, unit::m, Frame::None, Fusion::Real, "distance that means nothing seen");
    f.add("distance", distance_m, unit::m, Frame::Sensor, Fusion::Nearer, "distance to the nearest obstacle");
  }
};

/// A time-of-flight sensor.
struct TimeOfFlightPart {
  static constexpr std::string_view kName = "time_of_flight";
  static constexpr std::string_view kDoc = "A sensor that measures a distance by the time of light.";
  Mount mount = {};
  double range_m = 0.0;   ///< from the sensor
  double cone_rad = 0.0;  ///< from one side of what it sees to the other; 0: a line
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.group("mount", mount, "Where it sits and looks.");
    v.number("range", range_m, unit::m, {1e-9, 1e4}, "How far it sees, from the sensor.");
    v.number("cone", cone_rad, unit::deg, {0.0, 3.0}, "Angle from one side of its cone to the other.");
    v.text("source", source, "Where these figures come from.");
  }
  /// A dark bead.
  void appear(const RobotKind& kind, Appearance& look) const {
    const double bead_m = 0.08 * kind.body.radius_m;
    look.links.push_back(
        round_piece("ball", "#121417", mount.x_m, mount.y_m, bead_m, mount.z_m - bead_m, mount.z_m + bead_m));
  }
};

}  // namespace tandem::hal
