// Light sensors: a stroke outwards from each, as long as its reading.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/view/layers/readings.hpp"
#include "core/view/layers/types.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::core {
namespace {

class LightLevels final : public Layer {
 public:
  static constexpr std::array<std::string_view, 1> kSensors = {hal::Light::kName};
  void draw(const LayerView& now, Sketch& out) override {
    for_each_reading<hal::Light, hal::LightPart>(
        now, [&](RobotId robot, const Pose& pose, const hal::LightPart& part, const hal::Light& port, double opacity) {
          const double longest_m = 2.0 * now.space.kind(robot).body.radius_m;
          const std::size_t count = std::min<std::size_t>(port.count, part.mounts.size());
          for (std::size_t i = 0; i < count; ++i) {
            if (!(port.level[i] > 0.0F)) continue;
            const hal::Mount& m = part.mounts[i];
            const double length_m = longest_m * static_cast<double>(port.level[i]);
            const Sketch::Point end{m.x_m + length_m * std::cos(m.bearing_rad),
                                    m.y_m + length_m * std::sin(m.bearing_rad), m.z_m};
            out.line(point_of(pose, {m.x_m, m.y_m, m.z_m}), point_of(pose, end), {ink::kOrange, 0.0, false, opacity});
          }
        });
  }
};

}  // namespace

LayerType light_layer() {
  return layer_type<LightLevels>("light",
                                 "Readings of light sensors as strokes; one as wide as the robot is saturated.");
}

}  // namespace tandem::core
