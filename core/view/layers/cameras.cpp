// What cameras see: how far they look, and a line to each blob in its colour.
#include "hal/device/cameras.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/space/mechanisms.hpp"
#include "core/view/layers/readings.hpp"
#include "core/view/layers/types.hpp"
#include "hal/device/pan_tilt.hpp"

namespace tandem::core {
namespace {

template <class Port>
void all_around(const LayerView& now, Sketch& out) {
  for_each_reading<Port, hal::OmniCameraPart>(
      now, [&out](RobotId, const Pose& pose, const hal::OmniCameraPart& part, const Port& port, double opacity) {
        const double reach_m = part.height_m * std::tan(part.aperture_rad);
        out.circle(center_of(pose), reach_m, {ink::kSky, 0.0, false, 0.3 * opacity});
        const std::size_t count = std::min<std::size_t>(port.count, Port::kCapacity);
        for (std::size_t i = 0; i < count; ++i) {
          const auto distance_m = static_cast<double>(port.distance_m[i]);
          const auto bearing_rad = static_cast<double>(port.bearing_rad[i]);
          out.line(point_of(pose, {0.0, 0.0, part.height_m}),
                   point_of(pose, {distance_m * std::cos(bearing_rad), distance_m * std::sin(bearing_rad), 0.0}),
                   {port.color(i), 0.0, false, opacity});
        }
      });
}

/// A camera with a lens as it looks now. Directions are unit vectors in the body frame.
class Lens {
 public:
  Lens(const hal::CameraPart& part, const HeadState* head, double lens_above_ground_m)
      : part_(part), above_ground_m_(lens_above_ground_m) {
    const double diagonal_px = std::hypot(static_cast<double>(part.width_px), static_cast<double>(part.height_px));
    tangent_per_px_ = std::tan(part.aperture_rad) / (0.5 * diagonal_px);
    if (head != nullptr && !part.in_front) {  // the head looks straight down at tilt 0
      pan_rad_ = head->pan_rad;
      sin_tilt_ = -std::cos(head->tilt_rad);
      cos_tilt_ = std::sin(head->tilt_rad);
    } else {
      sin_tilt_ = std::sin(part.mount().tilt_rad);
      cos_tilt_ = std::cos(part.mount().tilt_rad);
    }
  }

  Sketch::Point lens() const noexcept { return {part_.mount().x_m, 0.0, part_.mount().z_m}; }
  /// What a pixel shows, were there nothing but the ground: a point on it, or as far as the camera makes out LEDs.
  Sketch::Point end_of(double x_px, double y_px) const noexcept {
    const double left = tangent_per_px_ * (0.5 * static_cast<double>(part_.width_px) - x_px);
    const double up = tangent_per_px_ * (0.5 * static_cast<double>(part_.height_px) - y_px);
    const double length = std::sqrt(1.0 + left * left + up * up);
    const double ahead = (cos_tilt_ - sin_tilt_ * up) / length;
    const double aside = left / length;
    const double rise = (sin_tilt_ + cos_tilt_ * up) / length;
    const double far_m = rise < 0.0 ? std::min(part_.range_m, above_ground_m_ / -rise) : part_.range_m;
    const double c = std::cos(pan_rad_);
    const double s = std::sin(pan_rad_);
    const Sketch::Point from = lens();
    return {from.x_m + far_m * (c * ahead - s * aside), from.y_m + far_m * (s * ahead + c * aside),
            from.z_m + far_m * rise};
  }

 private:
  const hal::CameraPart& part_;
  double above_ground_m_;
  double tangent_per_px_ = 1.0;
  double pan_rad_ = 0.0, cos_tilt_ = 1.0, sin_tilt_ = 0.0;
};

template <class Port>
void through_lenses(const LayerView& now, Sketch& out) {
  for_each_reading<Port, hal::CameraPart>(now, [&](RobotId robot, const Pose& pose, const hal::CameraPart& part,
                                                   const Port& port, double opacity) {
    const bool in_head = now.space.kind(robot).part<hal::HeadPart>() != nullptr;
    const Lens lens(part, in_head ? now.space.state<HeadState>(robot) : nullptr, pose.z_m + part.mount().z_m);
    const Sketch::Point from = point_of(pose, lens.lens());
    const auto width = static_cast<double>(part.width_px);
    const auto height = static_cast<double>(part.height_px);
    const std::array corners = {point_of(pose, lens.end_of(0.0, 0.0)), point_of(pose, lens.end_of(width, 0.0)),
                                point_of(pose, lens.end_of(width, height)), point_of(pose, lens.end_of(0.0, height))};
    const Sketch::Pen faint{ink::kSky, 0.0, false, 0.3 * opacity};
    out.polygon(corners, faint);
    for (const Sketch::Point& corner : corners) out.line(from, corner, faint);
    const std::size_t count = std::min<std::size_t>(port.count, Port::kCapacity);
    for (std::size_t i = 0; i < count; ++i) {
      const auto end = lens.end_of(static_cast<double>(port.x_px[i]), static_cast<double>(port.y_px[i]));
      out.line(from, point_of(pose, end), {port.color(i), 0.0, false, opacity});
    }
  });
}

class CameraViews final : public Layer {
 public:
  static constexpr std::array kSensors = {hal::OmnidirectionalCamera::kName, hal::OmnidirectionalCameraMany::kName,
                                          hal::PerspectiveCamera::kName, hal::PerspectiveCameraMany::kName};
  void draw(const LayerView& now, Sketch& out) override {
    all_around<hal::OmnidirectionalCamera>(now, out);
    all_around<hal::OmnidirectionalCameraMany>(now, out);
    through_lenses<hal::PerspectiveCamera>(now, out);
    through_lenses<hal::PerspectiveCameraMany>(now, out);
  }
};

}  // namespace

LayerType cameras_layer() {
  return layer_type<CameraViews>("cameras", "What cameras see: how far they look, and lines to the blobs.");
}

}  // namespace tandem::core
