// Who hears whom by range-and-bearing: a line from the hearer half-way to where it hears the sender. Where both hear
// each other, the halves are a whole line.
#include "hal/device/range_and_bearing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/view/layers/readings.hpp"
#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

template <class Port>
void draw_links(const LayerView& now, Sketch& out) {
  for_each_reading<Port, hal::RangeAndBearingPart>(
      now, [&out](RobotId, const Pose& pose, const hal::RangeAndBearingPart& part, const Port& port, double opacity) {
        const std::size_t count = std::min<std::size_t>(port.count, Port::kCapacity);
        for (std::size_t i = 0; i < count; ++i) {
          const double half_m = 0.5 * static_cast<double>(port.range_m[i]);
          const auto bearing_rad = static_cast<double>(port.bearing_rad[i]);
          const auto elevation_rad = static_cast<double>(port.elevation_rad[i]);
          const double flat_m = half_m * std::cos(elevation_rad);
          out.line(point_of(pose, {0.0, 0.0, part.height_m}),
                   point_of(pose, {flat_m * std::cos(bearing_rad), flat_m * std::sin(bearing_rad),
                                   part.height_m + half_m * std::sin(elevation_rad)}),
                   {ink::kGreen, 0.0, false, 0.8 * opacity});
        }
      });
}

class Links final : public Layer {
 public:
  static constexpr std::array kSensors = {hal::RangeAndBearing::kName, hal::RangeAndBearingMany::kName};
  void draw(const LayerView& now, Sketch& out) override {
    draw_links<hal::RangeAndBearing>(now, out);
    draw_links<hal::RangeAndBearingMany>(now, out);
  }
};

}  // namespace

LayerType range_and_bearing_layer() {
  return layer_type<Links>("range_and_bearing", "Who hears whom: half a line from each hearer towards the sender.");
}

}  // namespace tandem::core
