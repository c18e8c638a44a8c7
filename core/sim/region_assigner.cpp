#include "core/sim/region_assigner.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr double kInside_m = 1e-6;  // how far inside its outline a body is put back

struct Where {
  double x_m, y_m, z_m;
  bool flies;
};

Where where_is(const SpaceStores& s, BodyKey body) noexcept {
  const std::size_t i = body.index();
  if (body.is_object()) return {s.objects[i].x_m, s.objects[i].y_m, s.objects[i].z_low_m, false};
  const RobotEntity& e = s.robots[s.bodies.entity[i]];
  const hal::RobotKind* kind = s.groups[s.blocks[e.block].group].kind;
  const double z_m = s.bodies.motion.empty() ? 0.0 : s.bodies.motion[i].z_m;
  return {s.bodies.x_m[i], s.bodies.y_m[i], z_m, kind != nullptr && kind->flies()};
}

double radius_of(const SpaceStores& s, BodyKey body) noexcept {
  return body.is_object() ? s.objects[body.index()].reach_m() : static_cast<double>(s.bodies.radius_m[body.index()]);
}

std::uint16_t& region_of(SpaceStores& s, BodyKey body) noexcept {
  return body.is_object() ? s.object_region[body.index()] : s.bodies.region[body.index()];
}

/// The side of the outline that (x, y), which lies outside, is nearest to.
std::size_t nearest_side(const Region& region, double x, double y, double& nearest_x, double& nearest_y) noexcept {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < region.sides.size(); ++i) {
    const RegionSide& a = region.sides[i];
    const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
    double nx = 0.0;
    double ny = 0.0;
    const double d = distance_to_segment(x, y, a.x_m, a.y_m, b.x_m, b.y_m, nx, ny);
    // A body that leaves past the common end of a wall and a gate left through the gate.
    if (d > least || (d == least && region.sides[best].wall <= a.wall)) continue;
    least = d;
    best = i;
    nearest_x = nx;
    nearest_y = ny;
  }
  return best;
}

}  // namespace

void RegionAssigner::build(SpaceStores& stores, double tick_s) {
  borders_ = false;
  lists_ = false;
  for (const Region& region : stores.regions) {
    borders_ = borders_ || !region.everywhere();
    lists_ = lists_ || region.listed;
  }
  stores.border_reach_m = -1.0;
  fit(stores, tick_s);
}

void RegionAssigner::fit(SpaceStores& stores, double tick_s) {
  double largest_m = 0.0;
  double robot_m = 0.0;
  double hop_m = 0.0;
  for (const RobotGroup& group : stores.groups) {
    if (group.kind == nullptr) continue;
    robot_m = std::max(robot_m, group.kind->body.radius_m);
    hop_m = std::max(hop_m, group.kind->top_speed_m_s() * tick_s);
  }
  largest_m = robot_m;
  for (const Object& o : stores.objects) {
    if (o.alive && o.movable) largest_m = std::max(largest_m, o.reach_m());
  }
  // A body counts for a region when it can touch one of the region's bodies within the tick, or touch a robot that
  // does: so that the doubles at the border meet what their originals meet.
  extra_reach_m_ = largest_m + 2.0 * robot_m + 2.0 * hop_m;
  if (stores.border_reach_m == largest_m + extra_reach_m_) return;
  stores.border_reach_m = largest_m + extra_reach_m_;
  ++stores.immovables_version;  // engines hold those near their borders
  map_.build(stores.regions, stores.min_x_m, stores.min_y_m, stores.max_x_m, stores.max_y_m,
             largest_m + extra_reach_m_);
}

std::uint16_t RegionAssigner::find(const SpaceStores& stores, BodyKey body) const noexcept {
  const Where at = where_is(stores, body);
  std::uint16_t second_best = kNoRegion;
  for (const std::uint16_t r : map_.near(at.x_m, at.y_m)) {
    const Region& region = stores.regions[r];
    if (body.is_object() && !region.forces) continue;
    if (at.flies && region.plane) continue;
    if (!region.contains(at.x_m, at.y_m) || !(region.plane || region.contains_height(at.z_m))) continue;
    if (region.air == at.flies) return r;
    if (second_best == kNoRegion) second_best = r;
  }
  return second_best;
}

void RegionAssigner::place(SpaceStores& stores, std::vector<BodyKey>& nowhere) {
  Bodies& b = stores.bodies;
  for (std::size_t row = 0; row < b.size(); ++row) {
    if ((b.flags[row] & kMoved) == 0) continue;
    b.flags[row] = static_cast<std::uint8_t>(b.flags[row] & ~kMoved);
    if ((b.flags[row] & kAlive) == 0) continue;
    const BodyKey body = BodyKey::robot(row);
    b.region[row] = find(stores, body);
    if (b.region[row] == kNoRegion) nowhere.push_back(body);
  }
  for (std::size_t i = 0; i < stores.objects.size(); ++i) {
    if (!stores.objects[i].alive || !stores.objects[i].movable || stores.object_region[i] != kNoRegion) continue;
    const BodyKey body = BodyKey::object(i);
    stores.object_region[i] = find(stores, body);
    if (stores.object_region[i] == kNoRegion) nowhere.push_back(body);
  }
  keep_joined_together(stores);
}

bool RegionAssigner::led_by_another(const SpaceStores& stores, BodyKey body) const noexcept {
  for (const Joint& joint : stores.joints) {
    if (joint.alive && (std::max(joint.a, joint.b) == body)) return true;
  }
  return false;
}

void RegionAssigner::keep_joined_together(SpaceStores& stores) {
  // Regions spread from the body that sorts first along the joints; as many rounds as the longest chain is long.
  bool changed = true;
  for (std::size_t round = 0; changed && round <= stores.joints.size(); ++round) {
    changed = false;
    for (const Joint& joint : stores.joints) {
      if (!joint.alive) continue;
      const std::uint16_t leading = region_of(stores, std::min(joint.a, joint.b));
      std::uint16_t& led = region_of(stores, std::max(joint.a, joint.b));
      changed = changed || led != leading;
      led = leading;
    }
  }
}

std::uint16_t RegionAssigner::behind(const SpaceStores& stores, const Region& from, const RegionSide& side, double x_m,
                                     double y_m, double z_m) const noexcept {
  const auto holds = [&](std::uint16_t r) {
    const Region& region = stores.regions[r];
    return region.contains(x_m, y_m) && (region.plane || region.contains_height(z_m));
  };
  if (side.gate != kNoRegion && holds(side.gate)) return side.gate;
  for (const std::uint16_t r : map_.near(x_m, y_m)) {
    if (&stores.regions[r] != &from && stores.regions[r].air == from.air && holds(r)) return r;
  }
  return kNoRegion;
}

void RegionAssigner::put_back(SpaceStores& stores, BodyKey body) noexcept {
  std::uint16_t& r = region_of(stores, body);
  const Where at = where_is(stores, body);
  if (r == kNoRegion) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < stores.regions.size(); ++i) {
      const Region& region = stores.regions[i];
      if ((body.is_object() && !region.forces) || (at.flies && region.plane)) continue;
      const double d = region.distance(at.x_m, at.y_m);
      if (d >= least) continue;
      least = d;
      r = static_cast<std::uint16_t>(i);
    }
  }
  if (r == kNoRegion || stores.regions[r].everywhere()) return;
  const Region& region = stores.regions[r];
  if (region.contains(at.x_m, at.y_m)) return;
  double x = at.x_m;
  double y = at.y_m;
  const std::size_t i = nearest_side(region, at.x_m, at.y_m, x, y);
  const RegionSide& a = region.sides[i];
  const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
  const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  x -= (b.y_m - a.y_m) / length * kInside_m;  // to the left of the side: inside
  y += (b.x_m - a.x_m) / length * kInside_m;
  if (body.is_object()) {
    stores.objects[body.index()].x_m = x;
    stores.objects[body.index()].y_m = y;
  } else {
    stores.bodies.x_m[body.index()] = x;
    stores.bodies.y_m[body.index()] = y;
  }
}

void RegionAssigner::cross(SpaceStores& stores, BodyKey body, std::vector<BodyKey>& left) {
  std::uint16_t& region = region_of(stores, body);
  if (region == kNoRegion) return;
  const Region& from = stores.regions[region];
  const Where at = where_is(stores, body);
  if (from.contains(at.x_m, at.y_m)) return;
  if (std::isnan(at.x_m) || std::isnan(at.y_m)) return;  // reported as what it is
  if (!stores.joints.empty() && led_by_another(stores, body)) return;
  double x = 0.0;
  double y = 0.0;
  const RegionSide& side = from.sides[nearest_side(from, at.x_m, at.y_m, x, y)];
  if (side.wall) {
    put_back(stores, body);
    return;
  }
  const std::uint16_t next = behind(stores, from, side, at.x_m, at.y_m, at.z_m);
  if (next == kNoRegion) {
    left.push_back(body);
  } else if (body.is_object() && !stores.regions[next].forces) {
    put_back(stores, body);  // behind the gate is an engine without masses
  } else {
    region = next;
  }
}

void RegionAssigner::find_border_rows(const SpaceStores& stores, ThreadPool& pool) {
  const Bodies& b = stores.bodies;
  near_border_.resize(b.size());
  pool.run(b.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      near_border_[row] = (b.flags[row] & kAlive) != 0 && b.region[row] != kNoRegion &&
                          !map_.deep_inside(b.region[row], b.x_m[row], b.y_m[row]);
    }
  });
}

void RegionAssigner::migrate(SpaceStores& stores, ThreadPool& pool, std::vector<BodyKey>& left) {
  if (!borders_) return;
  find_border_rows(stores, pool);
  for (std::size_t row = 0; row < near_border_.size(); ++row) {
    if (near_border_[row] != 0) cross(stores, BodyKey::robot(row), left);
  }
  for (std::size_t i = 0; i < stores.objects.size(); ++i) {
    if (stores.objects[i].alive && stores.objects[i].movable) cross(stores, BodyKey::object(i), left);
  }
  keep_joined_together(stores);
}

void RegionAssigner::list_body(SpaceStores& stores, BodyKey body) {
  const std::uint16_t own = region_of(stores, body);
  if (own == kNoRegion) return;
  if (stores.regions[own].listed) stores.regions[own].owned.push_back(body);
  if (!body.is_object() && borders_ && near_border_[body.index()] == 0) return;
  const Where at = where_is(stores, body);
  const double reach_m = radius_of(stores, body) + extra_reach_m_;
  for (const std::uint16_t r : map_.near(at.x_m, at.y_m)) {
    Region& region = stores.regions[r];
    if (r == own || !region.listed || region.air != stores.regions[own].air) continue;
    if (at.flies && region.plane) continue;  // it is above those who drive there
    if (region.distance(at.x_m, at.y_m) <= reach_m) region.mirrored.push_back(body);
  }
}

void RegionAssigner::list(SpaceStores& stores, ThreadPool& pool) {
  if (!lists_ || !(borders_ || stores.bodies_changed)) return;
  if (borders_) find_border_rows(stores, pool);
  for (Region& region : stores.regions) {
    region.owned.clear();
    region.mirrored.clear();
  }
  const Bodies& b = stores.bodies;
  for (std::size_t row = 0; row < b.size(); ++row) {
    if ((b.flags[row] & kAlive) == 0) continue;
    if (borders_ && near_border_[row] == 0) {
      if (b.region[row] != kNoRegion && stores.regions[b.region[row]].listed)
        stores.regions[b.region[row]].owned.push_back(BodyKey::robot(row));
    } else {
      list_body(stores, BodyKey::robot(row));
    }
  }
  for (std::size_t i = 0; i < stores.objects.size(); ++i) {
    if (stores.objects[i].alive && stores.objects[i].movable) list_body(stores, BodyKey::object(i));
  }
}

}  // namespace tandem::core
