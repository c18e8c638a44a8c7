// Lights that a robot shows.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/appearance.hpp"
#include "hal/port.hpp"
#include "hal/rgb.hpp"

namespace tandem::hal {

/// The ring of LEDs on the rim, in the order of the part's mounts; a beacon on top, where a robot has one, is the last.
/// Safe value: all off.
struct RingLeds : Command {
  static constexpr std::string_view kName = "leds";
  static constexpr std::string_view kDoc = "Colours of the LED ring.";
  static constexpr bool kAnyValueIsSafe = true;
  static constexpr std::size_t kCapacity = 16;

  std::array<std::uint8_t, 3 * kCapacity> rgb{};  ///< r, g, b of LED 0, then of LED 1, …

  Rgb color(std::size_t i) const noexcept { return {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}; }
  void set(std::size_t i, Rgb c) noexcept {
    rgb[3 * i] = c.r;
    rgb[3 * i + 1] = c.g;
    rgb[3 * i + 2] = c.b;
  }
  void set_all(Rgb c) noexcept {
    for (std::size_t i = 0; i < kCapacity; ++i) set(i, c);
  }
  void describe(FieldList& f) const {
    f.add("rgb", rgb, unit::none, Frame::Body, Fusion::Real, "r, g, b of each LED, 0 to 255");
  }
};

/// From which elevations, seen from the LED, a group of LEDs is seen.
struct LightSpread {
  double sin_lowest = -1.0;  ///< sine of the lowest: -1 is straight beneath
  double sin_highest = 1.0;  ///< … of the highest
  bool past_body = false;    ///< its own robot's body hides none of them
  void describe(ParamVisitor& v) {
    v.number("sin_lowest", sin_lowest, unit::none, {-1.0, 1.0},
             "Sine of the lowest elevation from which they are seen; -1 is straight beneath.");
    v.number("sin_highest", sin_highest, unit::none, {-1.0, 1.0}, "Sine of the highest.");
    v.flag("past_body", past_body, "The robot's own body hides none of them.");
  }
};

/// The ring of LEDs.
struct LedsPart {
  static constexpr std::string_view kName = "leds";
  static constexpr std::string_view kDoc = "The ring of LEDs.";
  bool on_turret = false;  ///< they turn with the turret
  bool beacon = false;     ///< the last of them stands on top
  LightSpread spread = {};
  std::vector<Mount> mounts = {};
  std::string source = {};

  /// Number of the one that shows best what the robot does: the beacon, else the last.
  std::size_t beacon_led() const noexcept { return mounts.empty() ? 0 : mounts.size() - 1; }
  void describe(ParamVisitor& v) {
    v.flag("on_turret", on_turret, "They turn with the turret.");
    v.flag("beacon", beacon, "The last of them stands on top.");
    v.group("spread", spread, "From where they are seen.");
    v.list("mount", mounts, "An LED, in the order of the commands.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const { return mounts_flaw(mounts, RingLeds::kCapacity); }
  void appear(const RobotKind&, Appearance& look) const {
    for (std::size_t i = 0; i < mounts.size(); ++i)
      look.lamps.push_back({{mounts[i].x_m, mounts[i].y_m, mounts[i].z_m},
                            on_turret ? "turret" : "",
                            Driver{"actuator leds", "rgb", static_cast<std::int64_t>(3 * i)}});
  }
};

/// The upper of an eye-bot's two rings, which is seen from the side; `leds` is the lower one, seen from beneath. Safe
/// value: all off.
struct UpperRingLeds : RingLeds {
  static constexpr std::string_view kName = "upper_leds";
  static constexpr std::string_view kDoc = "Colours of the upper LED ring.";
};

/// The upper of two rings of LEDs.
struct UpperLedsPart {
  static constexpr std::string_view kName = "upper_leds";
  static constexpr std::string_view kDoc = "The upper of two rings of LEDs.";
  LightSpread spread = {};
  std::vector<Mount> mounts = {};
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.group("spread", spread, "From where they are seen.");
    v.list("mount", mounts, "An LED, in the order of the commands.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const { return mounts_flaw(mounts, UpperRingLeds::kCapacity); }
  void appear(const RobotKind&, Appearance& look) const {
    for (std::size_t i = 0; i < mounts.size(); ++i)
      look.lamps.push_back({{mounts[i].x_m, mounts[i].y_m, mounts[i].z_m},
                            "",
                            Driver{"actuator upper_leds", "rgb", static_cast<std::int64_t>(3 * i)}});
  }
};

/// The light beside an eye-bot's camera. Safe value: off.
struct CameraLed : Command {
  static constexpr std::string_view kName = "camera_led";
  static constexpr std::string_view kDoc = "Colour of the light beside the camera.";
  static constexpr bool kAnyValueIsSafe = true;

  std::array<std::uint8_t, 3> rgb{};

  void set(Rgb c) noexcept { rgb = {c.r, c.g, c.b}; }
  void describe(FieldList& f) const { f.add("rgb", rgb, unit::none, Frame::None, Fusion::Real, "r, g, b, 0 to 255"); }
};

/// A light beside the camera, seen as the ring of LEDs is.
struct CameraLedPart {
  static constexpr std::string_view kName = "camera_led";
  static constexpr std::string_view kDoc = "A light beside the camera, seen as the ring of LEDs is.";
  std::string source = {};
  void describe(ParamVisitor& v) { v.text("source", source, "How this is known."); }
};

/// The green light inside an e-puck's translucent body. Safe value: off.
struct BodyLed : Command {
  static constexpr std::string_view kName = "body_led";
  static constexpr std::string_view kDoc = "The light inside the body.";
  static constexpr bool kAnyValueIsSafe = true;
  bool on = false;
  void describe(FieldList& f) const { f.add("on", on, unit::none, Frame::None, Fusion::Real, "lit"); }
};

/// A light inside a translucent body.
struct BodyLedPart : MountedLamp {
  static constexpr std::string_view kName = "body_led";
  static constexpr std::string_view kDoc = "A light inside the translucent body.";
  void appear(const RobotKind&, Appearance& look) const {
    look.lamps.push_back({{mount.x_m, mount.y_m, mount.z_m}, "", Driver{"actuator body_led", "on"}, "#3ddc5a"});
  }
};

/// The bright red light at an e-puck's front. Safe value: off.
struct FrontLed : Command {
  static constexpr std::string_view kName = "front_led";
  static constexpr std::string_view kDoc = "The bright light at the front.";
  static constexpr bool kAnyValueIsSafe = true;
  bool on = false;
  void describe(FieldList& f) const { f.add("on", on, unit::none, Frame::None, Fusion::Real, "lit"); }
};

/// A bright light at the front.
struct FrontLedPart : MountedLamp {
  static constexpr std::string_view kName = "front_led";
  static constexpr std::string_view kDoc = "A bright light at the front.";
  void appear(const RobotKind&, Appearance& look) const {
    look.lamps.push_back({{mount.x_m, mount.y_m, mount.z_m}, "", Driver{"actuator front_led", "on"}, "#ff3b1f"});
  }
};

}  // namespace tandem::hal
