// Velocities: an arrow from each robot to where it would be in a second.
#include <cmath>

#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

constexpr double kAhead_s = 1.0;
constexpr double kLeast_m = 1e-3;  // shorter arrows are not seen
constexpr double kHead = 0.2;      // of the arrow

class Velocities final : public Layer {
 public:
  void draw(const LayerView& now, Sketch& out) override {
    for (const RobotId robot : now.robots) {
      const Velocity v = now.space.velocity(robot);
      const Pose pose = now.space.pose(robot);
      const double x_m = kAhead_s * v.v_m_s[0];
      const double y_m = kAhead_s * v.v_m_s[1];
      const double z_m = kAhead_s * v.v_m_s[2];
      if (std::hypot(x_m, y_m, z_m) < kLeast_m) continue;
      Sketch::Point from = center_of(pose);
      from.z_m += now.space.kind(robot).body.height_m;
      const Sketch::Point to{from.x_m + x_m, from.y_m + y_m, from.z_m + z_m};
      const Sketch::Pen pen{ink::kBlue};
      out.line(from, to, pen);
      if (std::hypot(x_m, y_m) < kLeast_m) continue;
      for (const double side : {0.5, -0.5}) {
        const Sketch::Point barb{to.x_m - kHead * (x_m + side * y_m), to.y_m - kHead * (y_m - side * x_m), to.z_m};
        out.line(to, barb, pen);
      }
    }
  }
};

}  // namespace

LayerType velocity_layer() {
  return layer_type<Velocities>("velocity", "Arrows to where robots would be in 1 s.");
}

}  // namespace tandem::core
