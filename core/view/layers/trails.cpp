// Trails: where robots were in the last 20 seconds since the layer was switched on.
#include "core/view/trails.hpp"

#include <optional>
#include <vector>

#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

constexpr double kTrail_s = 20.0;

class TrailLines final : public Layer {
 public:
  void note(const LayerView& now) override {
    if (!trails_) trails_.emplace(kTrail_s, now.ticks_per_second);
    if (!trails_->wants(now.tick)) return;
    std::vector<Trails::Place> places;
    places.reserve(now.robots.size());
    for (const RobotId robot : now.robots) {
      const Pose pose = now.space.pose(robot);
      places.push_back({Trails::number_of(robot), pose.x_m, pose.y_m, pose.z_m});
    }
    trails_->note(now.tick, std::move(places));
  }

  void draw(const LayerView& now, Sketch& out) override {
    if (!trails_) return;
    std::vector<std::uint64_t> who;
    for (const RobotId robot : now.robots) who.push_back(Trails::number_of(robot));
    Drawing drawing;
    trails_->add_to(drawing, who, now.tick);
    for (const Drawing::Trail& trail : drawing.trails) {
      points_.clear();
      for (std::size_t i = 0; i < trail.count; ++i) {
        const Drawing::Point& p = drawing.trail_points[trail.first + i];
        points_.push_back({p.x_m, p.y_m, p.z_m});
      }
      points_.push_back(center_of(now.space.pose(now.robots[trail.robot])));
      out.path(points_, {ink::kBlue, 0.0, false, 0.6});
    }
  }

 private:
  std::optional<Trails> trails_;
  std::vector<Sketch::Point> points_;
};

}  // namespace

LayerType trails_layer() {
  return layer_type<TrailLines>("trails", "Where robots were in the last 20 s.");
}

}  // namespace tandem::core
