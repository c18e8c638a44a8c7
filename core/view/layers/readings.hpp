// Sensors of a robot as layers need them: what its controller reads, and the part that says how the sensor is built.
#pragma once
#include "core/view/layers/layer.hpp"
#include "hal/port.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// Calls `draw(robot, pose, part, port, opacity)` for those of the robots asked for whose controller took this sensor
/// and has a reading. Readings that are not fresh are to be drawn fainter.
template <class Port, class Part, class Draw>
void for_each_reading(const LayerView& now, Draw&& draw) {
  for (const RobotId robot : now.robots) {
    const auto* const port = now.space.port<Port>(robot);
    if (port == nullptr || port->validity == hal::Validity::Absent) continue;
    const auto* const part = now.space.kind(robot).template part<Part>();
    if (part != nullptr)
      draw(robot, now.space.pose(robot), *part, *port, port->validity == hal::Validity::Fresh ? 1.0 : 0.4);
  }
}

/// The pen of a ray: one that meets something, or one that goes as far as it can.
inline Sketch::Pen ray_pen(bool meets, hal::Rgb color, double opacity) {
  return {meets ? color : ink::kSky, 0.0, false, meets ? opacity : 0.3 * opacity};
}

}  // namespace tandem::core
