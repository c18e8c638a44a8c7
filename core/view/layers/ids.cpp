// Ids of robots as texts above them.
#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

class Ids final : public Layer {
 public:
  void draw(const LayerView& now, Sketch& out) override {
    for (const RobotId robot : now.robots) {
      Sketch::Point at = center_of(now.space.pose(robot));
      at.z_m += now.space.kind(robot).body.height_m;
      out.text(at, now.space.robot_name(robot), {{34, 39, 46}});
    }
  }
};

}  // namespace

LayerType ids_layer() {
  return layer_type<Ids>("ids", "The ids of robots.");
}

}  // namespace tandem::core
