// A gripper: two claws that open inside another robot's ring, or an object's, and so hold it.
#pragma once
#include <cmath>
#include <numbers>
#include <string>

#include "hal/port.hpp"

namespace tandem::hal {

/// The claws. They look where the turret does.
struct GripperPart {
  static constexpr std::string_view kName = "gripper";
  static constexpr std::string_view kDoc = "Two claws that hold what they open inside of.";
  double reach_m = 0.0;   ///< beyond the body's rim
  double height_m = 0.0;  ///< above the ground
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("reach", reach_m, unit::m, {1e-9, 1e4}, "Beyond the body's rim.");
    v.number("height", height_m, unit::m, kNotNegative, "Of the claws above the ground.");
    v.text("source", source, "Where these figures come from.");
  }
  void appear(const RobotKind& kind, Appearance& look) const {
    const double r = kind.body.radius_m, h = kind.body.height_m, half_m = 0.16 * r;
    const double low_m = height_m > 0.0 ? height_m - 0.08 * h : 0.3 * h;
    constexpr double kNothing = 0xFFFF'FFFFU;  // is held: the number of no joint
    look.links.push_back({.name = "gripper",
                          .shape = "fork",
                          .low_m = {0.72 * r, -half_m, low_m},
                          .high_m = {r + reach_m, half_m, low_m + 0.15 * h},
                          .on = "turret",
                          .color = "#ffffff",
                          .held = {"gripper", "joint", 0, true, kNothing}});
  }
};

/// Command of the claws: how far to open. 0: they are together and hold nothing. Safe value: 0.
struct GripperDrive : Command {
  static constexpr std::string_view kName = "gripper";
  static constexpr std::string_view kDoc = "How far the gripper's claws are to open; open ones hold.";
  static constexpr double kMost_rad = 0.5 * std::numbers::pi;    ///< to either side
  static constexpr double kHolds_rad = 0.25 * std::numbers::pi;  ///< claws at least this far apart hold

  double aperture_rad = 0.0;  ///< -pi/2 to pi/2: the sign tells which claw opens upwards

  void lock() noexcept { aperture_rad = kMost_rad; }
  void unlock() noexcept { aperture_rad = 0.0; }
  bool locks() const noexcept { return std::fabs(aperture_rad) >= kHolds_rad; }
  using LimitedBy = GripperPart;
  /// Apertures beyond what the claws reach are clamped; one that is not finite becomes the safe one, which lets go.
  Limited limit(const GripperPart&) noexcept {
    if (std::fabs(aperture_rad) <= kMost_rad) return kPassed;
    if (!std::isfinite(aperture_rad)) {
      *this = {};
      return kNotFinite;
    }
    aperture_rad = std::clamp(aperture_rad, -kMost_rad, kMost_rad);
    return kClamped;
  }
  void describe(FieldList& f) const {
    f.add("aperture", aperture_rad, unit::rad, Frame::None, Fusion::Real, "0 lets go, from 45 degrees on holds");
  }
};

/// State of the gripper.
struct Gripper : Reading {
  static constexpr std::string_view kName = "gripper";
  static constexpr std::string_view kDoc = "How far the gripper's claws are open, and whether they hold something.";

  float aperture_rad = 0.0F;
  bool holding = false;
  bool busy = false;  ///< it tries what it holds, and obeys nothing meanwhile

  void describe(FieldList& f) const {
    f.add("aperture", aperture_rad, unit::rad, Frame::None, Fusion::Real, "0 together, 90 degrees wide open");
    f.add("holding", holding, unit::none, Frame::None, Fusion::Real, "something is held");
    f.add("busy", busy, unit::none, Frame::None, Fusion::Real, "tries its grip");
  }
};

}  // namespace tandem::hal
