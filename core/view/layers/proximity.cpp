// Rays of proximity sensors: from the sensor to what it sees, or faint to the end of its range.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/view/layers/readings.hpp"
#include "core/view/layers/types.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::core {
namespace {

class ProximityRays final : public Layer {
 public:
  static constexpr std::array<std::string_view, 1> kSensors = {hal::Proximity::kName};
  void draw(const LayerView& now, Sketch& out) override {
    for_each_reading<hal::Proximity, hal::ProximityPart>(
        now,
        [&out](RobotId, const Pose& pose, const hal::ProximityPart& part, const hal::Proximity& port, double opacity) {
          const std::size_t count = std::min<std::size_t>(port.count, part.mounts.size());
          for (std::size_t i = 0; i < count; ++i) {
            const hal::Mount& m = part.mounts[i];
            const auto length_m = static_cast<double>(port.distance_m[i]);
            const Sketch::Point end{m.x_m + length_m * std::cos(m.bearing_rad),
                                    m.y_m + length_m * std::sin(m.bearing_rad), m.z_m};
            out.line(point_of(pose, {m.x_m, m.y_m, m.z_m}), point_of(pose, end),
                     ray_pen(port.distance_m[i] < port.range_m, ink::kRed, opacity));
          }
        });
  }
};

}  // namespace

LayerType proximity_layer() {
  return layer_type<ProximityRays>("proximity", "Rays of proximity sensors, as long as their readings.");
}

}  // namespace tandem::core
