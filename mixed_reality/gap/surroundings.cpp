#include "mixed_reality/gap/surroundings.hpp"

#include <algorithm>
#include <cmath>

#include "core/device/ray_ring.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::mixed_reality {

using hal::number_of;

Surroundings::Surroundings(const RecordedRun& run, std::vector<double> radius_m)
    : run_(run), radius_m_(std::move(radius_m)) {
  for (const hal::Json& o : hal::list_of(run.scene, "objects")) {
    if (!o.is_object() || hal::flag_of(o, "movable")) continue;
    if (o.contains("radius")) {
      discs_.push_back({number_of(o, "x"), number_of(o, "y"), number_of(o, "radius")});
    } else {
      const double heading = number_of(o, "heading");
      boxes_.push_back({number_of(o, "x"), number_of(o, "y"), std::cos(heading), std::sin(heading),
                        0.5 * number_of(o, "size_x"), 0.5 * number_of(o, "size_y")});
    }
  }
}

std::vector<double> Surroundings::distances(std::size_t robot, std::size_t tick, const std::vector<hal::Mount>& mounts,
                                            double range_m, double turn_rad) const {
  const core::RayRing ring(mounts, range_m);
  alignas(32) std::array<float, core::RayRing::kCapacity> best{};
  best.fill(ring.range_m);
  const RobotTick& at = run_.robots[robot].ticks[tick];
  const double c = std::cos(at.heading_rad + turn_rad), s = std::sin(at.heading_rad + turn_rad);
  const auto in_body = [&](double x_m, double y_m, float& qx, float& qy) {
    const double wx = x_m - at.x_m, wy = y_m - at.y_m;
    qx = static_cast<float>(c * wx + s * wy);
    qy = static_cast<float>(c * wy - s * wx);
  };
  float qx = 0.0F, qy = 0.0F;
  const auto meet = [&](double x_m, double y_m, double radius_m) {
    in_body(x_m, y_m, qx, qy);
    if (std::hypot(qx, qy) > ring.reach_m + static_cast<float>(radius_m)) return;
    for (std::size_t g = 0; g < ring.registers; ++g)
      core::meet_disc(ring, g, qx, qy, static_cast<float>(radius_m), best.data() + g * core::RayRing::kLanes);
  };
  for (const Disc& disc : discs_) meet(disc.x_m, disc.y_m, disc.radius_m);
  for (std::size_t i = 0; i < run_.robots.size(); ++i) {
    if (i == robot || tick >= run_.robots[i].ticks.size() || !run_.robots[i].ticks[tick].posed) continue;
    meet(run_.robots[i].ticks[tick].x_m, run_.robots[i].ticks[tick].y_m, radius_m_[i]);
  }
  for (const Box& box : boxes_) {
    in_body(box.x_m, box.y_m, qx, qy);
    const auto ax = static_cast<float>(c * box.c + s * box.s), ay = static_cast<float>(c * box.s - s * box.c);
    for (std::size_t g = 0; g < ring.registers; ++g) {
      core::meet_box(ring, g, qx, qy, ax, ay, static_cast<float>(box.half_x_m), static_cast<float>(box.half_y_m),
                     best.data() + g * core::RayRing::kLanes);
    }
  }
  return {best.begin(), best.begin() + static_cast<std::ptrdiff_t>(std::min(mounts.size(), best.size()))};
}

}  // namespace tandem::mixed_reality
