// Cameras whose images are reduced to blobs: the lit LEDs and lamps that are in sight.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "hal/device/leds.hpp"
#include "hal/elementary.hpp"
#include "hal/port.hpp"

namespace tandem::hal {

/// Half angles of view that a lens may have.
inline constexpr Range kLensAngles_rad{0.1 * unit::deg.to_si, 89.0 * unit::deg.to_si};

/// A camera on the axis that looks all around and down.
struct OmniCameraPart {
  static constexpr std::string_view kName = "omnidirectional_camera";
  static constexpr std::string_view kDoc = "A camera on the axis that looks all around and down.";
  double height_m = 0.0;
  double aperture_rad = 0.0;  ///< from straight down to the farthest that it sees on the ground
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("height", height_m, unit::m, {1e-9, 1e4}, "Above the ground.");
    v.number("aperture", aperture_rad, unit::deg, kNotNegative,
             "From straight down to the farthest that it sees on the ground.");
    v.text("source", source, "Where these figures come from.");
  }
  void attributes(ParamVisitor& v) {
    v.number("omnidirectional_camera_aperture", aperture_rad, unit::deg, kLensAngles_rad,
             "From straight down to the farthest that the omnidirectional camera sees on the ground.");
  }
  /// A clear tube on the body, which carries a mirror.
  void appear(const RobotKind& kind, Appearance& look) const {
    const double r = kind.body.radius_m, foot_m = 0.9 * std::min(height_m, kind.body.height_m);
    const double mirror_m = height_m - 0.12 * r;
    look.links.push_back(round_piece("cylinder", "#cfdfe6", 0.0, 0.0, 0.27 * r, foot_m, mirror_m));
    look.links.push_back(round_piece("cylinder", "#30353c", 0.0, 0.0, 0.34 * r, mirror_m, height_m + 0.12 * r));
  }
};

/// Blobs seen by a camera that looks all around, nearest first; the farthest are dropped when there are more than
/// `kBlobs`. A robot's own LEDs are not among them.
template <std::size_t kBlobs>
struct BlobsAround : Reading {
  static constexpr std::string_view kDoc = "Coloured blobs all around, with distance and bearing.";
  static constexpr std::size_t kCapacity = kBlobs;

  std::uint32_t count = 0;
  std::uint32_t dropped = 0;                   ///< seen beyond the capacity
  std::array<float, kCapacity> distance_m{};   ///< along the ground, from the camera's axis
  std::array<float, kCapacity> bearing_rad{};  ///< counter-clockwise from forward
  std::array<std::uint8_t, 3 * kCapacity> rgb{};

  Rgb color(std::size_t i) const noexcept { return {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}; }

  /// Inserts in order of distance, after those that are equally far; drops the farthest when full.
  void insert(float distance, float bearing, Rgb c) noexcept {
    if (count == kCapacity) {
      ++dropped;
      if (distance >= distance_m[kCapacity - 1]) return;
    } else {
      ++count;
    }
    std::size_t at = count - 1;
    for (; at > 0 && distance_m[at - 1] > distance; --at) {
      distance_m[at] = distance_m[at - 1];
      bearing_rad[at] = bearing_rad[at - 1];
      set_color(at, color(at - 1));
    }
    distance_m[at] = distance;
    bearing_rad[at] = bearing;
    set_color(at, c);
  }
  /// Adds the blobs of `other` that are not there: about the same colour within kSamePlace_m is the same light.
  void merge(const BlobsAround& other) noexcept {
    const BlobsAround own = *this;
    for (std::size_t i = 0; i < other.count; ++i) {
      if (!own.has(other, i)) insert(other.distance_m[i], other.bearing_rad[i], other.color(i));
    }
    dropped += other.dropped;
  }
  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Union, "blobs seen");
    f.add("dropped", dropped, unit::none, Frame::None, Fusion::Union, "blobs beyond the capacity");
    f.add("distance", distance_m, unit::m, Frame::Body, Fusion::Union, "along the ground").used_by = "count";
    f.add("bearing", bearing_rad, unit::rad, Frame::Body, Fusion::Union, "counter-clockwise from forward").used_by =
        "count";
    f.add("rgb", rgb, unit::none, Frame::None, Fusion::Union, "r, g, b of each blob, 0 to 255").used_by = "count";
  }

 private:
  static constexpr float kSamePlace_m = 0.02F;  // LEDs of a ring are farther apart

  bool has(const BlobsAround& other, std::size_t i) const noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      const float x_m = distance_m[k] * static_cast<float>(hal::cos(static_cast<double>(bearing_rad[k])));
      const float y_m = distance_m[k] * static_cast<float>(hal::sin(static_cast<double>(bearing_rad[k])));
      const float dx_m =
          other.distance_m[i] * static_cast<float>(hal::cos(static_cast<double>(other.bearing_rad[i]))) - x_m;
      const float dy_m =
          other.distance_m[i] * static_cast<float>(hal::sin(static_cast<double>(other.bearing_rad[i]))) - y_m;
      if (dx_m * dx_m + dy_m * dy_m < kSamePlace_m * kSamePlace_m && alike(color(k), other.color(i))) return true;
    }
    return false;
  }
  void set_color(std::size_t i, Rgb c) noexcept {
    rgb[3 * i] = c.r;
    rgb[3 * i + 1] = c.g;
    rgb[3 * i + 2] = c.b;
  }
};

struct OmnidirectionalCamera : BlobsAround<64> {
  static constexpr std::string_view kName = "omnidirectional_camera";
};

/// The same with more room.
struct OmnidirectionalCameraMany : BlobsAround<512> {
  static constexpr std::string_view kName = "omnidirectional_camera_many";
  static constexpr std::string_view kGrows = OmnidirectionalCamera::kName;
};

/// Pose and optics of a camera with a lens.
struct CameraMount {
  double x_m = 0.0;
  double z_m = 0.0;
  double tilt_rad = 0.0;  ///< of its axis above straight ahead: pi/2 looks up, -pi/2 down
  void describe(ParamVisitor& v) {
    v.number("x", x_m, unit::m, kAny, "Forward of the axis.");
    v.number("z", z_m, unit::m, kAny, "Above the ground.");
    v.number("tilt", tilt_rad, unit::deg, kAny, "Of its axis above straight ahead.");
  }
};

/// A camera with a lens.
struct CameraPart {
  static constexpr std::string_view kName = "perspective_camera";
  static constexpr std::string_view kDoc = "A camera with a lens.";
  CameraMount usual = {}, front = {};  ///< where it sits by default, and where as a front camera
  bool in_front = false;               ///< which of the two
  double aperture_rad = 0.0;           ///< from its axis to a corner of the image
  double focal_length_m = 0.0;
  double range_m = 0.0;  ///< up to which it makes out LEDs
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  /// Begin of the attributes that change it for one robot: "camera" gives camera_front, camera_range, …
  std::string attributes_begin = "camera";
  std::string source = {};

  const CameraMount& mount() const noexcept { return in_front ? front : usual; }
  void describe(ParamVisitor& v) {
    v.number("aperture", aperture_rad, unit::deg, {1e-9, 1.6}, "From its axis to a corner of the image.");
    v.number("focal_length", focal_length_m, unit::m, kNotNegative, "Of its lens.");
    v.number("range", range_m, unit::m, kNotNegative, "Up to which it makes out LEDs.");
    v.integer("width", width_px, {1, 65535}, "Pixels of the image from left to right.");
    v.integer("height", height_px, {1, 65535}, "Pixels of the image from top to bottom.");
    v.group("usual", usual, "Where it sits unless told otherwise.");
    v.group("front", front, "Where it sits as a front camera.");
    v.text("attributes", attributes_begin, "Begin of a robot's attributes that change it: with camera, camera_front.");
    v.text("source", source, "Where these figures come from.");
  }
  void attributes(ParamVisitor& v) {
    v.flag(attributes_begin + "_front", in_front, "The camera looks ahead; otherwise as its kind's does.");
    v.number(attributes_begin + "_aperture", aperture_rad, unit::deg, kLensAngles_rad,
             "From the camera's axis to a corner of its image.");
    v.number(attributes_begin + "_focal_length", focal_length_m, unit::m, {1e-6, 10.0},
             "Of its lens; its image is as large as the aperture then needs, so that pixels do not depend on it.");
    v.number(attributes_begin + "_range", range_m, unit::m, {1e-6, 1e6}, "Up to which it makes out LEDs.");
  }
  /// A dark ball.
  void appear(const RobotKind& kind, Appearance& look) const {
    const double lens_m = 0.09 * kind.body.radius_m;
    look.links.push_back(
        round_piece("ball", "#14171b", mount().x_m, 0.0, lens_m, mount().z_m - lens_m, mount().z_m + lens_m));
  }
};

/// Blobs seen by a camera with a lens, in pixels from the upper left corner of its image: x to the right, y downwards.
/// The nearest first; the farthest are dropped when there are more than `kBlobs`. A robot's own LEDs are not among
/// them.
template <std::size_t kBlobs>
struct BlobsInImage : Reading {
  static constexpr std::string_view kDoc = "Coloured blobs in an image, in pixels.";
  static constexpr std::size_t kCapacity = kBlobs;

  std::uint32_t count = 0;
  std::uint32_t dropped = 0;    ///< seen beyond the capacity
  std::uint32_t width_px = 0;   ///< of the image
  std::uint32_t height_px = 0;  ///< of the image
  std::array<float, kCapacity> x_px{};
  std::array<float, kCapacity> y_px{};
  std::array<std::uint8_t, 3 * kCapacity> rgb{};

  Rgb color(std::size_t i) const noexcept { return {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}; }

  /// Adds one behind those that are there; counts it as dropped when full.
  void append(float x, float y, Rgb c) noexcept {
    if (count == kCapacity) {
      ++dropped;
      return;
    }
    x_px[count] = x;
    y_px[count] = y;
    rgb[3 * count] = c.r;
    rgb[3 * count + 1] = c.g;
    rgb[3 * count + 2] = c.b;
    ++count;
  }
  /// Adds the blobs of `other`, whose image has as many pixels, that are not there: about the same colour within
  /// kSamePlace_px is the same light.
  void merge(const BlobsInImage& other) noexcept {
    const BlobsInImage own = *this;
    for (std::size_t i = 0; i < other.count; ++i) {
      if (!own.has(other, i)) append(other.x_px[i], other.y_px[i], other.color(i));
    }
    dropped += other.dropped;
  }
  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Union, "blobs seen");
    f.add("dropped", dropped, unit::none, Frame::None, Fusion::Union, "blobs beyond the capacity");
    f.add("width", width_px, unit::none, Frame::None, Fusion::Real, "pixels of the image from left to right");
    f.add("height", height_px, unit::none, Frame::None, Fusion::Real, "pixels of the image from top to bottom");
    f.add("x", x_px, unit::none, Frame::Sensor, Fusion::Union, "pixels from the left").used_by = "count";
    f.add("y", y_px, unit::none, Frame::Sensor, Fusion::Union, "pixels from the top").used_by = "count";
    f.add("rgb", rgb, unit::none, Frame::None, Fusion::Union, "r, g, b of each blob, 0 to 255").used_by = "count";
  }

 private:
  static constexpr float kSamePlace_px = 4.0F;

  bool has(const BlobsInImage& other, std::size_t i) const noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      const bool near =
          std::fabs(x_px[k] - other.x_px[i]) < kSamePlace_px && std::fabs(y_px[k] - other.y_px[i]) < kSamePlace_px;
      if (near && alike(color(k), other.color(i))) return true;
    }
    return false;
  }
};

struct PerspectiveCamera : BlobsInImage<64> {
  static constexpr std::string_view kName = "perspective_camera";
};

/// The same with more room.
struct PerspectiveCameraMany : BlobsInImage<512> {
  static constexpr std::string_view kName = "perspective_camera_many";
  static constexpr std::string_view kGrows = PerspectiveCamera::kName;
};

}  // namespace tandem::hal
