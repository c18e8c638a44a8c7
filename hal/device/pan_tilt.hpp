// The head that an eye-bot's camera hangs in.
#pragma once
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// The head that a camera hangs in where it sits usually.
struct HeadPart {
  static constexpr std::string_view kName = "pan_tilt";
  static constexpr std::string_view kDoc = "The head that the camera hangs in.";
  double turn_rad_s = 0.0;    ///< fastest turn about either axis
  double max_tilt_rad = 0.0;  ///< from straight down, to either side
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("turn", turn_rad_s, unit::rad_s, {1e-9, 1e4}, "Fastest turn about either axis.");
    v.number("max_tilt", max_tilt_rad, unit::deg, kNotNegative, "From straight down, to either side.");
    v.text("source", source, "Where these figures come from.");
  }
};

/// Command of the camera's head and its laser. Safe value: straight down, laser off.
struct PanTiltDrive : Command {
  static constexpr std::string_view kName = "pan_tilt";
  static constexpr std::string_view kDoc = "Where the camera's head is to look.";

  double pan_rad = 0.0;   ///< counter-clockwise from forward
  double tilt_rad = 0.0;  ///< 0 straight down, pi/2 level, along the pan angle
  bool laser = false;

  using LimitedBy = HeadPart;
  /// Tilts are clamped to what the head reaches; angles that are not finite make it look straight down.
  Limited limit(const HeadPart& part) noexcept {
    const double most_rad = part.max_tilt_rad;
    if (!std::isfinite(pan_rad) || !std::isfinite(tilt_rad)) {
      *this = {};
      return kNotFinite;
    }
    if (std::fabs(tilt_rad) <= most_rad) return kPassed;
    tilt_rad = std::clamp(tilt_rad, -most_rad, most_rad);
    return kClamped;
  }
  void describe(FieldList& f) const {
    f.add("pan", pan_rad, unit::rad, Frame::Body, Fusion::Real, "counter-clockwise from forward");
    f.add("tilt", tilt_rad, unit::rad, Frame::Body, Fusion::Real, "0 straight down, pi/2 level");
    f.add("laser", laser, unit::none, Frame::None, Fusion::Real, "lit");
  }
};

/// Direction of the camera's head.
struct PanTiltEncoder : Reading {
  static constexpr std::string_view kName = "pan_tilt_encoder";
  static constexpr std::string_view kDoc = "Where the camera's head looks.";

  double pan_rad = 0.0;   ///< counter-clockwise from forward
  double tilt_rad = 0.0;  ///< 0 straight down, pi/2 level

  void describe(FieldList& f) const {
    f.add("pan", pan_rad, unit::rad, Frame::Body, Fusion::Real, "counter-clockwise from forward");
    f.add("tilt", tilt_rad, unit::rad, Frame::Body, Fusion::Real, "0 straight down, pi/2 level");
  }
};

}  // namespace tandem::hal
