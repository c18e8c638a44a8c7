// Readings of ARGoS 3's ring sensors, which controllers of ARGoS and its errors count in: between 0, nothing in range,
// and 1.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "hal/elementary.hpp"

namespace tandem::hal {

/// Reading of an infrared sensor by the distance to the body it sees: that of the generic `proximity`, of foot-bot and
/// eye-bot, of the e-puck.
enum class ArgosProximity : std::uint8_t { Generic, Footbot, Epuck };

/// By the name of the sensor in a file.
constexpr ArgosProximity argos_proximity(std::string_view written) noexcept {
  if (written.starts_with("epuck_")) return ArgosProximity::Epuck;
  return written == "proximity" ? ArgosProximity::Generic : ArgosProximity::Footbot;
}

/// Whether a light sensor, by its name in a file, reads less with distance as foot-bot's and eye-bot's do.
constexpr bool argos_light_fades(std::string_view written) noexcept {
  return written == "footbot_light" || written == "eyebot_light";
}

namespace argos_curves {
// The formulas of ARGoS 3: exp(-d); 1 up to kContact_m and then kScale / (d + kOffset_m); and a parabola that was
// fitted to e-pucks, up to 5 cm.
inline constexpr double kContact_m = 0.009889556, kScale = 0.0100527, kOffset_m = 0.000163144;
inline constexpr double kSquare = 298.701, kLinear = 36.8961, kConstant = 1.08212, kEnd_m = 0.05;
}  // namespace argos_curves

/// Of something in range, from 0 to 1.
inline double argos_reading(ArgosProximity curve, double distance_m) noexcept {
  using namespace argos_curves;
  switch (curve) {
    case ArgosProximity::Generic:
      return hal::exp(-distance_m);
    case ArgosProximity::Footbot:
      return distance_m < kContact_m ? 1.0 : kScale / (distance_m + kOffset_m);
    case ArgosProximity::Epuck:
      break;
  }
  if (distance_m > kEnd_m) return 0.0;
  return std::clamp((kSquare * distance_m - kLinear) * distance_m + kConstant, 0.0, 1.0);
}

/// The distance with that reading, which is above 0 and at most 1; the farthest of several. It may lie beyond the range
/// of the sensor.
inline double argos_distance_m(ArgosProximity curve, double reading) noexcept {
  using namespace argos_curves;
  switch (curve) {
    case ArgosProximity::Generic:
      return -hal::log(reading);
    case ArgosProximity::Footbot:
      return kScale / reading - kOffset_m;
    case ArgosProximity::Epuck:
      break;
  }
  return (kLinear - std::sqrt(kLinear * kLinear - 4.0 * kSquare * (kConstant - reading))) / (2.0 * kSquare);
}

}  // namespace tandem::hal
