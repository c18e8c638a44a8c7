// Lights that a robot shows.
#pragma once
#include <array>
#include <cstdint>

#include "hal/port.hpp"

namespace tandem::hal {

/// 8 bits a channel. A robot whose LEDs have one colour lights them when any channel is above half.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

/// Whether both may be one light, as a camera shows its colour and as it was set.
constexpr bool alike(Rgb a, Rgb b) noexcept {
  constexpr int kMost = 64;
  const auto near = [](int one, int other) { return one - other < kMost && other - one < kMost; };
  return near(a.r, b.r) && near(a.g, b.g) && near(a.b, b.b);
}

inline constexpr Rgb kBlack{0, 0, 0};
inline constexpr Rgb kRed{255, 0, 0};
inline constexpr Rgb kGreen{0, 255, 0};
inline constexpr Rgb kBlue{0, 0, 255};
inline constexpr Rgb kWhite{255, 255, 255};

/// The ring of LEDs on the rim, in the order of the data sheet; a beacon on top, where a robot has one, is the last.
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

/// The upper of an eye-bot's two rings, which is seen from the side; `leds` is the lower one, seen from beneath. Safe
/// value: all off.
struct UpperRingLeds : RingLeds {
  static constexpr std::string_view kName = "upper_leds";
  static constexpr std::string_view kDoc = "Colours of the upper LED ring.";
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

/// The green light inside an e-puck's translucent body. Safe value: off.
struct BodyLed : Command {
  static constexpr std::string_view kName = "body_led";
  static constexpr std::string_view kDoc = "The light inside the body.";
  static constexpr bool kAnyValueIsSafe = true;
  bool on = false;
  void describe(FieldList& f) const { f.add("on", on, unit::none, Frame::None, Fusion::Real, "lit"); }
};

/// The bright red light at an e-puck's front. Safe value: off.
struct FrontLed : Command {
  static constexpr std::string_view kName = "front_led";
  static constexpr std::string_view kDoc = "The bright light at the front.";
  static constexpr bool kAnyValueIsSafe = true;
  bool on = false;
  void describe(FieldList& f) const { f.add("on", on, unit::none, Frame::None, Fusion::Real, "lit"); }
};

}  // namespace tandem::hal
