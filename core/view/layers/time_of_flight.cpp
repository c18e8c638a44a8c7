// Cones of time-of-flight sensors, as long as their readings.
#include "hal/device/time_of_flight.hpp"

#include <array>
#include <cmath>
#include <vector>

#include "core/view/layers/readings.hpp"
#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

class TimeOfFlightCones final : public Layer {
 public:
  static constexpr std::array<std::string_view, 1> kSensors = {hal::TimeOfFlight::kName};
  void draw(const LayerView& now, Sketch& out) override {
    for_each_reading<hal::TimeOfFlight, hal::TimeOfFlightPart>(
        now, [&out](RobotId, const Pose& pose, const hal::TimeOfFlightPart& part, const hal::TimeOfFlight& port,
                    double opacity) {
          const hal::Mount& m = part.mount;
          const auto length_m = static_cast<double>(port.distance_m);
          std::vector<Sketch::Point> corners{point_of(pose, {m.x_m, m.y_m, m.z_m})};
          constexpr int kArc = 4;  // pieces
          for (int i = 0; i <= kArc; ++i) {
            const double bearing_rad = m.bearing_rad + part.cone_rad * (static_cast<double>(i) / kArc - 0.5);
            corners.push_back(point_of(
                pose, {m.x_m + length_m * std::cos(bearing_rad), m.y_m + length_m * std::sin(bearing_rad), m.z_m}));
            if (part.cone_rad == 0.0) break;
          }
          const Sketch::Pen pen = ray_pen(!port.sees_nothing(), ink::kOrange, opacity);
          if (corners.size() == 2)
            out.line(corners[0], corners[1], pen);
          else
            out.polygon(corners, pen);
        });
  }
};

}  // namespace

LayerType time_of_flight_layer() {
  return layer_type<TimeOfFlightCones>("time_of_flight", "Cones of time-of-flight sensors, as long as their readings.");
}

}  // namespace tandem::core
