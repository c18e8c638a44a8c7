// Rays of distance scanners: all that were measured in the last tick, from the robot's axis.
#include "hal/device/distance_scanner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/view/layers/readings.hpp"
#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

class ScannerRays final : public Layer {
 public:
  static constexpr std::array<std::string_view, 1> kSensors = {hal::DistanceScanner::kName};
  void draw(const LayerView& now, Sketch& out) override {
    for_each_reading<hal::DistanceScanner, hal::ScannerPart>(
        now, [&out](RobotId, const Pose& pose, const hal::ScannerPart& part, const hal::DistanceScanner& port,
                    double opacity) {
          const std::size_t samples = std::min<std::size_t>(port.samples, hal::DistanceScanner::kSamples);
          for (std::size_t head = 0; head < hal::DistanceScanner::kHeads; ++head) {
            for (std::size_t i = 0; i < samples; ++i) {
              const auto length_m = static_cast<double>(port.distance(head, i));
              const auto angle_rad = static_cast<double>(port.angle(head, i));
              out.line(point_of(pose, {0.0, 0.0, part.height_m}),
                       point_of(pose, {length_m * std::cos(angle_rad), length_m * std::sin(angle_rad), part.height_m}),
                       ray_pen(!port.sees_nothing(head, i), ink::kPurple, opacity));
            }
          }
        });
  }
};

}  // namespace

LayerType distance_scanner_layer() {
  return layer_type<ScannerRays>("distance_scanner", "Rays of distance scanners, as long as their readings.");
}

}  // namespace tandem::core
