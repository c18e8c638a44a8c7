// Sensors that sit in a ring around the body: infrared proximity, ambient light, ground reflectance.
// Which sensor looks where is in the part of the robot (`robot.part<ProximityPart>().mounts`), in the same order.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/port.hpp"

namespace tandem::hal {

/// Infrared range to the nearest obstacle along each sensor's axis, measured from the sensor.
struct Proximity : Reading {
  static constexpr std::string_view kName = "proximity";
  static constexpr std::string_view kDoc = "Infrared distance to the nearest obstacle, one value a sensor.";
  static constexpr std::size_t kCapacity = 24;  // the foot-bot's and eye-bot's number

  std::uint32_t count = 0;
  float range_m = 0.0F;  ///< how far the sensors see; a sensor that sees nothing reads this, or more with noise
  std::array<float, kCapacity> distance_m{};

  /// 0 with nothing in range, 1 at contact, linear between.
  float closeness(std::size_t i) const noexcept {
    return range_m > 0.0F ? std::max(0.0F, 1.0F - distance_m[i] / range_m) : 0.0F;
  }

  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Real, "number of sensors");
    f.add("range", range_m, unit::m, Frame::None, Fusion::Real, "distance that means nothing seen");
    f.add("distance", distance_m, unit::m, Frame::Sensor, Fusion::Nearer, "distance to the nearest obstacle").used_by =
        "count";
  }
};

/// Response of an infrared sensor to white paper at a distance.
struct InfraredResponse {
  double distance_m = 0.0;
  double counts = 0.0;
  void describe(ParamVisitor& v) {
    v.number("distance", distance_m, unit::m, kNotNegative, "From the sensor.");
    v.number("counts", counts, unit::none, kNotNegative, "What it then reports, without ambient light.");
  }
};

/// The ring of infrared proximity sensors. `response` is strictly falling, nearest first; straight between its points.
/// Empty: it is not known, or the robot tells distances itself.
struct ProximityPart {
  static constexpr std::string_view kName = "proximity";
  static constexpr std::string_view kDoc = "Infrared proximity sensors.";
  double range_m = 0.0;  ///< from the sensor
  std::vector<Mount> mounts = {};
  std::vector<InfraredResponse> response = {};
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("range", range_m, unit::m, {1e-9, 1e4}, "How far they see, from the sensor.");
    v.list("response", response, "A point of the sensors' response, the nearest first.");
    v.list("mount", mounts, "A sensor, in the order of the readings.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const {
    for (std::size_t i = 1; i < response.size(); ++i) {
      if (!(response[i].distance_m > response[i - 1].distance_m && response[i].counts < response[i - 1].counts))
        return "has a response whose point " + std::to_string(i) +
               " is not farther, with fewer counts, than the one before; give the nearest first";
    }
    return mounts_flaw(mounts, Proximity::kCapacity);
  }
  /// A dark bead each.
  void appear(const RobotKind& kind, Appearance& look) const {
    const double bead_m = std::clamp(0.05 * kind.body.radius_m, 0.001, 0.006);
    for (const Mount& m : mounts)
      look.links.push_back(round_piece("ball", "#121417", m.x_m, m.y_m, bead_m, m.z_m - bead_m, m.z_m + bead_m));
  }
};

/// Ambient light at each sensor: 0 dark, 1 saturated.
struct Light : Reading {
  static constexpr std::string_view kName = "light";
  static constexpr std::string_view kDoc = "Ambient light, one value a sensor, 0 dark to 1 saturated.";
  static constexpr std::size_t kCapacity = 24;

  std::uint32_t count = 0;
  std::array<float, kCapacity> level{};

  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Real, "number of sensors");
    f.add("level", level, unit::none, Frame::Sensor, Fusion::Larger, "0 dark to 1 saturated").used_by = "count";
  }
};

/// Sensors of ambient light.
struct LightPart : MountedSensors<Light::kCapacity> {
  static constexpr std::string_view kName = "light";
  static constexpr std::string_view kDoc = "Sensors of ambient light.";
};

/// Reflectance of the floor beneath each sensor: 0 black, 1 white.
struct Ground : Reading {
  static constexpr std::string_view kName = "ground";
  static constexpr std::string_view kDoc = "Reflectance of the floor, one value a sensor, 0 black to 1 white.";
  static constexpr std::size_t kCapacity = 8;

  std::uint32_t count = 0;
  std::array<float, kCapacity> reflectance{};

  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Virtual, "number of sensors");
    f.add("reflectance", reflectance, unit::none, Frame::None, Fusion::Virtual, "0 black to 1 white").used_by = "count";
  }
};

/// Sensors that look at the floor.
struct GroundPart : MountedSensors<Ground::kCapacity> {
  static constexpr std::string_view kName = "ground";
  static constexpr std::string_view kDoc = "Sensors that look at the floor.";
};

/// The foot-bot's sensors around its base, which see the floor beside the tracks.
struct BaseGround : Ground {
  static constexpr std::string_view kName = "base_ground";
  static constexpr std::string_view kDoc = "Reflectance of the floor beneath the rim of the base, 0 black to 1 white.";
};

/// Sensors around the base that look at the floor.
struct BaseGroundPart : MountedSensors<Ground::kCapacity> {
  static constexpr std::string_view kName = "base_ground";
  static constexpr std::string_view kDoc = "Sensors around the base that look at the floor.";
};

/// The foot-bot's sensors between its tracks.
struct MotorGround : Ground {
  static constexpr std::string_view kName = "motor_ground";
  static constexpr std::string_view kDoc = "Reflectance of the floor between the tracks, 0 black to 1 white.";
};

/// Sensors between the tracks that look at the floor.
struct MotorGroundPart : MountedSensors<Ground::kCapacity> {
  static constexpr std::string_view kName = "motor_ground";
  static constexpr std::string_view kDoc = "Sensors between the tracks that look at the floor.";
};

}  // namespace tandem::hal
