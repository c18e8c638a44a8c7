// A layer with a panel: marks robots that stand close to another one, and tells how many do.
#include <algorithm>
#include <limits>
#include <string>

#include "core/view/layers/layer.hpp"
#include "hal/elementary.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

constexpr double kClose_m = 0.1;  // between axes

double nearest_m(const core::Space& space, core::RobotId robot) {
  const core::Pose here = space.pose(robot);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    if (space.robot(i) == robot) continue;
    const core::Pose there = space.pose(space.robot(i));
    nearest = std::min(nearest, hal::hypot(there.x_m - here.x_m, there.y_m - here.y_m));
  }
  return nearest;
}

class Crowd final : public core::Layer {
 public:
  void draw(const core::LayerView& now, core::Sketch& out) override {
    for (const core::RobotId robot : now.robots) {
      if (nearest_m(now.space, robot) > kClose_m) continue;
      out.circle(core::center_of(now.space.pose(robot)), 0.5 * kClose_m, {core::ink::kRed});
    }
  }

  void panel(const core::LayerView& now, core::Panel& out) override {
    std::size_t close = 0;
    double sum_m = 0.0;
    for (const core::RobotId robot : now.robots) {
      const double distance_m = nearest_m(now.space, robot);
      close += distance_m <= kClose_m ? 1 : 0;
      sum_m += distance_m;
    }
    out.row("close to another one", std::to_string(close) + " of " + std::to_string(now.robots.size()));
    if (!now.robots.empty()) out.row("mean distance", sum_m / static_cast<double>(now.robots.size()), hal::unit::cm);
  }
};

void register_all(hal::Registrar& registrar) {
  static const core::LayerType type = core::layer_type<Crowd>("crowd", "Robots that stand close to another one.");
  registrar.add(type);
}

}  // namespace

TANDEM_PLUGIN(register_all)
