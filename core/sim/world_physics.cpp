// The physics phase of a step: engines, borders, bodies that leave.
#include <algorithm>
#include <cmath>

#include "core/sim/world_impl.hpp"
#include "core/space/attitude.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/rounded.hpp"

namespace tandem::core {
namespace {

constexpr double kContactReach_m = 0.03;  // beyond the bodies' rims: what contact resolution looks at

/// How far from a robot's axis its proximity sensors see, at most.
double seen_from_axis_m(const hal::RobotKind& kind) noexcept {
  const auto* const proximity = kind.part<hal::ProximityPart>();
  if (proximity == nullptr) return 0.0;
  double mount_m = 2.0 * kind.body.radius_m;
  for (const hal::Mount& mount : proximity->mounts) mount_m = std::max(mount_m, std::hypot(mount.x_m, mount.y_m));
  return mount_m + proximity->range_m;
}

}  // namespace

/// What leans is listed wherever its shadow at noon is.
void index_objects(SpaceStores& s, bool movable, double reach_m) {
  ObjectIndex& index = movable ? s.movable_index : s.static_index;
  const auto build = [&](const std::vector<Object>& objects) {
    index.build(objects, movable, s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
  };
  const auto any_leans = [&] {
    return std::any_of(s.objects.begin(), s.objects.end(),
                       [&](const Object& o) { return o.alive && o.movable == movable && leans(turn_of(s, o)); });
  };
  if (!anything_may_lean(s) || !any_leans()) return build(s.objects);
  std::vector<Object> shadows = s.objects;
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.alive || !leans(turn_of(s, o))) continue;
    const std::array<double, 3> half_m = half_extents(o, attitude_of(o, turn_of(s, o)));
    shadows[i].kind = Object::Kind::Box;
    shadows[i].cos_h = 1.0;
    shadows[i].sin_h = 0.0;
    shadows[i].half_x_m = half_m[0];
    shadows[i].half_y_m = half_m[1];
  }
  build(shadows);
}

double index_reach(const SpaceStores& stores, double tick_s) noexcept {
  double reach_m = 2.0 * kContactReach_m;
  for (const RobotGroup& group : stores.groups) {
    if (group.kind == nullptr) continue;
    const double touches_m = 2.0 * group.kind->body.radius_m + kContactReach_m;
    reach_m = std::max(reach_m, std::max(seen_from_axis_m(*group.kind), touches_m) + 0.01);
    if (group.kind->flies())  // where it may be at the end of the tick
      reach_m = std::max(reach_m, 2.0 * group.kind->body.radius_m + tick_s * group.kind->flight()->max_speed_m_s);
  }
  return reach_m;
}

void World::Impl::physics() {
  const PhysicsContext context{stores(), *pool, tick_s(), tick};
  for (const auto& coupling : couplings) coupling->before_physics(stores(), tick_s());
  settle_changes();
  assigner.list(stores(), *pool);
  stores().bodies_changed = false;
  for (const auto& engine : engines) engine->load(context);
  int most = 1;
  parts.resize(engines.size());
  for (std::size_t i = 0; i < engines.size(); ++i) {
    parts[i] = engines[i]->parts(context);
    most = std::max(most, parts[i]);
  }
  for (int part = 0; part < most && (part == 0 || state == RunState::Running); ++part) move_part(part);
  media.index(stores());
  for (const auto& coupling : couplings) coupling->after_physics(stores(), tick_s());
}

/// Engines that go in fewer parts have come to the tick's end before the others.
void World::Impl::move_part(int part) {
  for (std::size_t i = 0; i < engines.size(); ++i) {
    if (part < parts[i]) engines[i]->advance({stores(), *pool, tick_s() / parts[i], tick});
  }
  ++stores().poses_version;
  stores().touched.clear();
  stop_on_trouble();
  rebuild_index();
  find_stray_objects();
  assigner.migrate(stores(), *pool, strays);
  if (trouble.load(std::memory_order_relaxed) != 0 || !strays.empty()) {
    treat_escapes();
    rebuild_index();
    trouble.store(0, std::memory_order_relaxed);
    strays.clear();
  }
  if (part == 0) index_movables();
  for (const auto& engine : engines) engine->settle({stores(), *pool, tick_s(), tick});
}

/// What hooks, operators and real robots changed since the last step.
void World::Impl::settle_changes() {
  SpaceStores& s = stores();
  for (const BodyKey body : s.touched) {
    if (body.is_object() || (s.bodies.flags[body.index()] & kAlive) == 0) continue;
    const std::size_t row = body.index();
    if (!std::isfinite(s.bodies.cos_h[row] + s.bodies.sin_h[row] + s.base_m(row)))
      fail(name_of(body) + " was put where its heading or height is not a number" + at_tick());
  }
  if (s.bodies_changed) fit_to_bodies();
  if (indexed_version != s.immovables_version) {
    index_objects(s, false, reach_m);
    indexed_version = s.immovables_version;
  }
  if (s.bodies_changed) assigner.place(s, strays);
}

/// Robots came or went, or other objects: arrays by block, and how far indices and regions look.
void World::Impl::fit_to_bodies() {
  SpaceStores& s = stores();
  fit_ledgers();
  const double needed_m = index_reach(s, tick_s());
  if (needed_m != reach_m) {
    reach_m = needed_m;
    s.body_index.set_area(s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
    ++s.immovables_version;
  }
  assigner.fit(s, tick_s());
}

void World::Impl::fit_ledgers() {
  const std::size_t blocks = stores().blocks.size();
  if (faults.size() < blocks) {
    block_trouble.resize(blocks, 0);
    faults.resize(blocks);
    clamped.resize(blocks, 0);
    not_finite.resize(blocks, 0);
    excess.resize(blocks);
    said.resize(blocks);
  }
  excess_named.resize(stores().groups.size(), 0);
}

void World::Impl::stop_on_trouble() {
  for (const auto& engine : engines) engine->collect(troubles);
  for (const Trouble& t : troubles) fail(name_of(t.body) + " " + t.what + at_tick());
  troubles.clear();
}

void World::Impl::index_movables() {
  SpaceStores& s = stores();
  const bool any =
      std::any_of(s.objects.begin(), s.objects.end(), [](const Object& o) { return o.alive && o.movable; });
  if (any || !s.movable_index.empty()) index_objects(s, true, reach_m);
}

void World::Impl::rebuild_index() {
  SpaceStores& s = stores();
  Bodies& b = s.bodies;
  const auto spot = [&](std::size_t row) noexcept -> BodyIndex::Spot {
    const double x_m = b.x_m[row];
    const double y_m = b.y_m[row];
    const std::uint8_t flags = b.flags[row];
    if ((flags & kAlive) == 0) return {};
    const bool inside = x_m >= s.min_x_m && x_m <= s.max_x_m && y_m >= s.min_y_m && y_m <= s.max_y_m;
    if (!inside) {  // also when not a number
      b.flags[row] = static_cast<std::uint8_t>(flags | kEscaped);
      trouble.fetch_add(1, std::memory_order_relaxed);
    }
    return {x_m, y_m, true};
  };
  const auto fill = [&](std::size_t row) noexcept {
    const bool fixed = (b.flags[row] & kExternal) != 0 || (!all_in_rows && !moved_in_rows(row));
    return IndexEntry{b.x_m[row], b.y_m[row], b.radius_m[row],
                      static_cast<std::uint32_t>(row) | (fixed ? IndexEntry::kFixedFlag : 0U)};
  };
  s.body_index.rebuild(b.size(), s.living.size(), *pool, spot, fill);
}

void World::Impl::find_stray_objects() {
  const SpaceStores& s = stores();
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.alive || !o.movable) continue;
    if (!(o.x_m >= s.min_x_m && o.x_m <= s.max_x_m && o.y_m >= s.min_y_m && o.y_m <= s.max_y_m))
      strays.push_back(BodyKey::object(i));
  }
}

void World::Impl::treat_escapes() {
  Bodies& b = stores().bodies;
  for (std::size_t row = 0; row < b.size(); ++row) {
    if ((b.flags[row] & kEscaped) == 0) continue;
    b.flags[row] = static_cast<std::uint8_t>(b.flags[row] & ~kEscaped);
    strays.push_back(BodyKey::robot(row));
  }
  std::sort(strays.begin(), strays.end());
  strays.erase(std::unique(strays.begin(), strays.end()), strays.end());
  for (const BodyKey body : strays) treat_escape(body);
}

void World::Impl::treat_escape(BodyKey body) {
  SpaceStores& s = stores();
  double& x_m = body.is_object() ? s.objects[body.index()].x_m : s.bodies.x_m[body.index()];
  double& y_m = body.is_object() ? s.objects[body.index()].y_m : s.bodies.y_m[body.index()];
  if (std::isnan(x_m) || std::isnan(y_m)) {
    fail(name_of(body) + " has a position that is not a number" + at_tick());
    x_m = s.min_x_m;
    y_m = s.min_y_m;
    return;
  }
  ++incidents.bodies_escaped;
  const bool in_arena = x_m >= s.min_x_m && x_m <= s.max_x_m && y_m >= s.min_y_m && y_m <= s.max_y_m;
  const std::uint16_t region = body.is_object() ? s.object_region[body.index()] : s.bodies.region[body.index()];
  const std::string what = !in_arena             ? " left the arena"
                           : region == kNoRegion ? " was put where no engine has its region,"
                                                 : " left the region of engine '" + s.regions[region].name + "'";
  const auto where = [&] { return what + " at " + hal::place_text(x_m, y_m) + at_tick(); };
  switch (scenario.escape) {
    case EscapePolicy::Error:
      fail(name_of(body) + where() +
           (in_arena ? ". Give the region's side a wall or a gate, or choose escape=\"stop\" or escape=\"remove\" "
                       "on <arena>."
                     : ". Give the arena walls, or choose escape=\"stop\" or escape=\"remove\" on <arena>."));
      break;
    case EscapePolicy::Remove:
      incidents.note(number_of(body), name_of(body), where() + ": removed");
      if (body.is_object()) {
        space.remove_object(space.object(body.index()));
      } else {
        const std::uint32_t entity = s.bodies.entity[body.index()];
        space.remove_robot({entity, s.robots[entity].generation});
      }
      s.bodies_changed = true;
      return;
    case EscapePolicy::Stop:
      if (!incidents.note_again(number_of(body), what))
        incidents.note(number_of(body), name_of(body), where() + ": stopped at the edge");
      break;
  }
  x_m = std::clamp(x_m, s.min_x_m, s.max_x_m);
  y_m = std::clamp(y_m, s.min_y_m, s.max_y_m);
  RegionAssigner::put_back(s, body);
  Motion none;
  if (body.is_object()) {
    none.z_m = s.object_motion[body.index()].z_m;
    none.q_WB = s.object_motion[body.index()].q_WB;
    s.object_motion[body.index()] = none;
  } else if (!s.bodies.motion.empty()) {
    none.z_m = s.bodies.motion[body.index()].z_m;
    none.q_WB = s.bodies.motion[body.index()].q_WB;
    s.bodies.motion[body.index()] = none;
  }
}

}  // namespace tandem::core
