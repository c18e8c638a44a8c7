#include "core/sim/world.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "core/device/device.hpp"
#include "core/placement/placement.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/gripping.hpp"
#include "core/sim/region_keeper.hpp"
#include "core/sim/robot_factory.hpp"
#include "core/sim/world_editor.hpp"
#include "core/space/stores.hpp"
#include "hal/check.hpp"
#include "hal/filter.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kIncidentsNamed = 20;
constexpr double kContactReach_m = 0.03;  // beyond the bodies' rims: what contact resolution looks at

/// Mixes a value into a hash; every bit of the value reaches every bit of the result [finaliser of Murmur3].
std::uint64_t mix(std::uint64_t hash, std::uint64_t value) noexcept {
  std::uint64_t x = hash ^ (value + 0x9E3779B97F4A7C15ULL + (hash << 6) + (hash >> 2));
  x = (x ^ (x >> 33)) * 0xFF51AFD7ED558CCDULL;
  x = (x ^ (x >> 33)) * 0xC4CEB9FE1A85EC53ULL;
  return x ^ (x >> 33);
}

std::uint64_t bits_of(double value) noexcept {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::uint64_t mix_motion(std::uint64_t hash, const Motion& m) noexcept {
  hash = mix(hash, bits_of(m.z_m));
  for (const double value : m.q_WB) hash = mix(hash, bits_of(value));
  for (const double value : m.v_m_s) hash = mix(hash, bits_of(value));
  for (const double value : m.w_rad_s) hash = mix(hash, bits_of(value));
  return hash;
}

std::uint64_t mix_mechanisms(std::uint64_t hash, const Bodies& b, std::size_t row) noexcept {
  if (!b.turrets.empty()) {
    const TurretState& t = b.turrets[row];
    hash = mix(hash, static_cast<std::uint64_t>(t.mode));
    for (const double value : {t.target, t.angle_rad, t.speed_rad_s}) hash = mix(hash, bits_of(value));
  }
  if (!b.grips.empty()) {
    const GripState& g = b.grips[row];
    hash = mix(mix(hash, g.holding() ? 1 : 0), g.grips);
    for (const double value : {g.aperture_rad, g.turn_rad}) hash = mix(hash, bits_of(value));
  }
  if (!b.scanners.empty()) {
    const ScannerState& s = b.scanners[row];
    hash = mix(mix(hash, static_cast<std::uint64_t>(s.mode)), bits_of(s.angle_rad));
  }
  if (!b.hidden_rolls.empty()) {
    const HiddenRoll& h = b.hidden_rolls[row];
    for (const double value : {h.left_m, h.right_m, h.left_m_s, h.right_m_s}) hash = mix(hash, bits_of(value));
  }
  return hash;
}

/// What stays as the file has it unless a hook changes it.
std::uint64_t mix_scenery(std::uint64_t hash, const SpaceStores& s) noexcept {
  hash = mix(hash, s.robots.size());  // decides what numbers the next robot draws
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.alive || o.movable) continue;
    hash = mix(hash, i);
    for (const double value :
         {o.x_m, o.y_m, o.cos_h, o.sin_h, o.half_x_m, o.half_y_m, o.radius_m, o.z_low_m, o.z_high_m})
      hash = mix(hash, bits_of(value));
  }
  for (const LightSource& light : s.lights) {
    if (!light.alive) continue;
    for (const double value : {light.x_m, light.y_m, light.z_m, light.intensity}) hash = mix(hash, bits_of(value));
  }
  for (const SoundSource& sound : s.sounds) {
    if (!sound.alive) continue;
    for (const double value : {sound.x_m, sound.y_m, sound.z_m, sound.level}) hash = mix(hash, bits_of(value));
  }
  return hash;
}

std::uint64_t seed_from_clock() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32 | device()) >> 11;  // exact as a double, easy to write in a file
}

/// How far from a point the indices must look for what a robot there could touch or see.
double index_reach(const SpaceStores& stores, double tick_s) noexcept {
  double reach_m = 2.0 * kContactReach_m;
  for (const RobotGroup& group : stores.groups) {
    if (group.sheet == nullptr) continue;
    reach_m = std::max(
        reach_m, 2.0 * group.sheet->body_radius_m + std::max(group.sheet->proximity_range_m, kContactReach_m) + 0.01);
    if (group.sheet->flies)  // where it may be at the end of the tick
      reach_m = std::max(reach_m, 2.0 * group.sheet->body_radius_m + tick_s * group.sheet->max_flight_speed_m_s);
  }
  return reach_m;
}

/// What hooks asked for in this step, and the moments that they keep.
class KeptMoments final : public Checkpoints {
 public:
  struct Request {
    bool save;
    std::string name;
  };

  void save(const std::string& name) override {
    names_.insert(name);
    requests.push_back({true, name});
  }
  hal::Status restore(const std::string& name) override {
    if (!names_.contains(name)) {
      return hal::Error{"there is no checkpoint '" + name +
                        "'; there are: " + listed(std::vector<std::string>(names_.begin(), names_.end()))};
    }
    requests.push_back({false, name});
    return {};
  }

  void forget(const std::string& name) {
    names_.erase(name);
    kept.erase(name);
  }

  std::vector<Request> requests;
  std::map<std::string, Snapshot> kept;

 private:
  std::set<std::string> names_;  // kept, or to be kept after this step
};

}  // namespace

/// What a snapshot holds.
struct Moment {
  std::shared_ptr<const int> of;  ///< the world that it is of
  std::unique_ptr<SpaceCopy> space;
  hal::Tick tick = 0;
  RunState state = RunState::Running;
  std::string failure;
  Incidents incidents;
  std::vector<std::uint64_t> clamped, not_finite;
  double reach_m = 0.0;  ///< of the indices, which the space's copy holds
  std::vector<std::any> hooks;
};

struct World::Impl {
  Scenario scenario;
  WorldOptions options;
  std::uint64_t seed = 0;
  Space space;
  std::unique_ptr<ThreadPool> pool;
  MeasuredPhase sensing, controlling;
  std::vector<std::unique_ptr<Engine>> engines;
  RegionKeeper keeper;
  std::vector<std::uint8_t> kinematic;  // by region: kinematics2d moves its bodies
  bool one_kind = true;                 // kinematics2d moves all bodies
  double reach_m = 0.0;                 // of the indices
  std::uint64_t indexed_version = 0;    // of the immovable objects
  std::vector<BodyKey> strays;          // left their region in this tick, or were put where there is none
  std::vector<Trouble> troubles;
  RobotDevices devices;
  std::unique_ptr<RobotFactory> factory;
  std::unique_ptr<WorldEditor> editor;
  std::shared_ptr<const int> identity = std::make_shared<int>(0);  // tells this world's snapshots from others'
  KeptMoments moments;
  std::vector<std::unique_ptr<Hook>> hooks;
  std::vector<std::string> hook_names;
  ExternalRobots* external = nullptr;

  hal::Tick tick = 0;
  RunState state = RunState::Running;
  std::string failure;
  Incidents incidents;
  std::atomic<std::uint32_t> trouble{0};    // robots that need the serial look after a parallel phase
  std::vector<std::uint8_t> block_trouble;  // by block: 1 when one of its robots does
  std::vector<hal::StepFault> faults;       // by block, for controllers that threw
  std::vector<std::uint64_t> clamped;       // by block, running counts
  std::vector<std::uint64_t> not_finite;

  SpaceStores& stores() noexcept { return space.stores(); }

  // --- one tick ---
  void act();
  void physics();
  void settle_changes();
  void stop_on_trouble();
  void find_stray_objects();
  void treat_escapes();
  void treat_escape(BodyKey body);
  void rebuild_index();
  void index_movables();
  template <class Work>
  void each_block(MeasuredPhase& phase, Work&& work);
  void sense_and_control();
  void sense(std::size_t block);
  void control(std::size_t block);
  void filter(std::size_t block);
  template <class Port, class Filter>
  void filter_port(std::size_t block, int port, Filter&& filter_one);
  void report_trouble();
  void paint_floor_if_asked();
  void fit_to_bodies();
  void forget_caches();

  template <class Call>
  void call_hooks(const char* moment, Call&& call);
  HookContext hook_context() { return {space, tick, scenario.ticks_per_second, seed, moments}; }
  DeviceContext device_context(std::size_t block) {
    SpaceStores& s = stores();
    return {s,
            s.groups[s.blocks[block].group],
            s.blocks[block],
            tick,
            hal::time_of_tick(tick, scenario.ticks_per_second),
            tick_s(),
            seed};
  }
  double tick_s() const noexcept { return 1.0 / static_cast<double>(scenario.ticks_per_second); }
  void fail(std::string why) {
    if (state == RunState::Failed) return;
    state = RunState::Failed;
    failure = std::move(why);
  }
  void incident(std::string what) {
    options.log.warning(what);
    if (incidents.first.size() < kIncidentsNamed) incidents.first.push_back(std::move(what));
  }
  std::string at_tick() const { return " at tick " + std::to_string(tick); }
  bool moved_by_kinematics(std::size_t row) noexcept {
    const std::uint16_t region = stores().bodies.region[row];
    return region != kNoRegion && kinematic[region] != 0;
  }
  std::string name_of(BodyKey body) {
    if (!body.is_object()) return "robot '" + name_of_row(body.index()) + "'";
    const Object& object = stores().objects[body.index()];
    return (object.kind == Object::Kind::Box ? "box '" : "cylinder '") + object.id + "'";
  }
  std::string name_of_row(std::size_t row) {
    const std::uint32_t entity = stores().bodies.entity[row];
    return space.robot_name({entity, stores().robots[entity].generation});
  }
};

// --- the step ---

void World::step() {
  Impl& w = *impl_;
  if (w.state != RunState::Running) return;
  w.call_hooks("before_step", [](Hook& hook, HookContext& c) { hook.before_step(c); });
  w.paint_floor_if_asked();
  if (w.external != nullptr) w.external->latch(*this);
  w.act();
  w.physics();
  if (w.external == nullptr) {
    w.sense_and_control();
  } else {
    w.each_block(w.sensing, [&w](std::size_t block) { w.sense(block); });
    w.external->after_sense(*this);
    w.each_block(w.controlling, [&w](std::size_t block) {
      w.control(block);
      w.filter(block);
    });
    w.external->after_filter(*this);
  }
  w.report_trouble();
  w.call_hooks("after_step", [](Hook& hook, HookContext& c) { hook.after_step(c); });
  ++w.tick;
  bool done = false;
  w.call_hooks("is_done", [&done](Hook& hook, HookContext& c) { done = hook.is_done(c) || done; });
  if (done && w.state == RunState::Running) w.state = RunState::Done;
  do_requests();
}

void World::Impl::act() {
  SpaceStores& s = stores();
  pool->run(s.blocks.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      const DeviceContext context = device_context(block);
      const auto& actuators = devices.blocks[block].actuators;
      for (std::size_t i = 0; i < actuators.size(); ++i) {
        if (actuators[i] != nullptr) actuators[i]->act(context, s, s.blocks[block].ports[i]);
      }
    }
  });
}

void World::Impl::physics() {
  const PhysicsContext context{stores(), *pool, tick_s(), tick};
  grip_and_release(stores(), tick_s());
  settle_changes();
  keeper.list(stores(), *pool);
  stores().bodies_changed = false;
  for (const auto& engine : engines) engine->load(context);
  for (const auto& engine : engines) engine->advance(context);
  ++stores().poses_version;
  stores().touched.clear();
  stop_on_trouble();
  rebuild_index();
  find_stray_objects();
  keeper.migrate(stores(), *pool, strays);
  if (trouble.load(std::memory_order_relaxed) != 0 || !strays.empty()) {
    treat_escapes();
    rebuild_index();
    trouble.store(0, std::memory_order_relaxed);
    strays.clear();
  }
  index_movables();
  for (const auto& engine : engines) engine->settle(context);
  follow_loads(stores(), tick_s());
}

/// What hooks, operators and real robots changed since the last step.
void World::Impl::settle_changes() {
  SpaceStores& s = stores();
  if (s.bodies_changed) fit_to_bodies();
  if (indexed_version != s.immovables_version) {
    s.static_index.build(s.objects, false, s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
    indexed_version = s.immovables_version;
  }
  if (s.bodies_changed) keeper.place(s, strays);
}

/// Robots came or went, or other objects: arrays by block, and how far indices and regions look.
void World::Impl::fit_to_bodies() {
  SpaceStores& s = stores();
  const std::size_t blocks = s.blocks.size();
  if (faults.size() < blocks) {
    block_trouble.resize(blocks, 0);
    faults.resize(blocks);
    clamped.resize(blocks, 0);
    not_finite.resize(blocks, 0);
  }
  const double needed_m = index_reach(s, tick_s());
  if (needed_m != reach_m) {
    reach_m = needed_m;
    s.body_index.set_area(s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
    ++s.immovables_version;
  }
  keeper.fit(s, tick_s());
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
  if (any || !s.movable_index.empty())
    s.movable_index.build(s.objects, true, s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
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
    const bool fixed = (b.flags[row] & kExternal) != 0 || (!one_kind && !moved_by_kinematics(row));
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
  const std::string what = !in_arena             ? "left the arena"
                           : region == kNoRegion ? "was put where no engine has its region,"
                                                 : "left the region of engine '" + s.regions[region].name + "'";
  const std::string where =
      name_of(body) + " " + what + " at (" + hal::format_number(x_m) + ", " + hal::format_number(y_m) + ")" + at_tick();
  switch (scenario.escape) {
    case EscapePolicy::Error:
      fail(where + (in_arena
                        ? ". Give the region's side a wall or a gate, or choose escape=\"stop\" or escape=\"remove\" "
                          "on <arena>."
                        : ". Give the arena walls, or choose escape=\"stop\" or escape=\"remove\" on <arena>."));
      break;
    case EscapePolicy::Remove:
      incident(where + ": removed");
      if (body.is_object()) {
        space.remove_object(space.object(body.index()));
      } else {
        const std::uint32_t entity = s.bodies.entity[body.index()];
        space.remove_robot({entity, s.robots[entity].generation});
      }
      s.bodies_changed = true;
      return;
    case EscapePolicy::Stop:
      incident(where + ": stopped at the edge");
      break;
  }
  x_m = std::clamp(x_m, s.min_x_m, s.max_x_m);
  y_m = std::clamp(y_m, s.min_y_m, s.max_y_m);
  RegionKeeper::put_back(s, body);
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

template <class Work>
void World::Impl::each_block(MeasuredPhase& phase, Work&& work) {
  phase.run(*pool, stores().blocks.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) work(block);
  });
}

void World::Impl::sense_and_control() {
  // A block's ports stay in the cache from its sensing to its control.
  each_block(controlling, [this](std::size_t block) {
    sense(block);
    control(block);
    filter(block);
  });
}

void World::Impl::sense(std::size_t block) {
  const DeviceContext context = device_context(block);
  const auto& sensors = devices.blocks[block].sensors;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    if (sensors[i] != nullptr) sensors[i]->sense(context, context.block.ports[i]);
  }
}

void World::Impl::control(std::size_t index) {
  RobotBlock& block = stores().blocks[index];
  const hal::ControllerType& type = *stores().groups[block.group].controller;
  std::size_t next = 0;
  while (next < block.used) {
    next =
        type.step_row(block.controllers, block.controller_stride, next, block.used, block.halted.data(), faults[index]);
    if (next == block.used) break;
    block.halted[next] = 2;  // thrown in this tick; reported, and its actuators made safe, after the phase
    block_trouble[index] = 1;
    ++next;
  }
}

void World::Impl::filter(std::size_t index) {
  const RobotGroup& group = stores().groups[stores().blocks[index].group];
  const hal::DataSheet& sheet = *group.sheet;
  filter_port<hal::WheelSpeeds>(index, group.wheels,
                                [&](auto& command) { return hal::filter(command, sheet.max_wheel_speed_m_s); });
  filter_port<hal::QuadrotorPosition>(index, group.flight_position, [](auto& command) { return hal::filter(command); });
  filter_port<hal::QuadrotorSpeed>(index, group.flight_speed, [&](auto& command) {
    return hal::filter(command, sheet.max_flight_speed_m_s, sheet.max_flight_turn_rad_s);
  });
  filter_port<hal::TurretDrive>(index, group.turret,
                                [&](auto& command) { return hal::filter(command, sheet.turret_turn_rad_s); });
  filter_port<hal::GripperDrive>(index, group.gripper, [](auto& command) { return hal::filter(command); });
  filter_port<hal::ScannerDrive>(index, group.scanner,
                                 [&](auto& command) { return hal::filter(command, sheet.scanner_turn_rad_s); });
}

template <class Port, class Filter>
void World::Impl::filter_port(std::size_t index, int port, Filter&& filter_one) {
  if (port < 0) return;
  RobotBlock& block = stores().blocks[index];
  auto* commands = block.port_array<Port>(static_cast<std::size_t>(port));
  for (std::size_t i = 0; i < block.used; ++i) {
    const hal::FilterResult result = filter_one(commands[i]);
    if (result == hal::FilterResult::Passed) continue;
    if (result == hal::FilterResult::Clamped) {
      ++clamped[index];
    } else {
      ++not_finite[index];
      block_trouble[index] = 1;
      stores().bodies.flags[block.first_row + i] |= kNotFinite;
    }
  }
}

void World::Impl::report_trouble() {
  for (std::size_t index = 0; index < block_trouble.size(); ++index) {
    if (block_trouble[index] == 0) continue;
    block_trouble[index] = 0;
    RobotBlock& block = stores().blocks[index];
    for (std::size_t i = 0; i < block.used; ++i) {
      const std::size_t row = block.first_row + i;
      std::uint8_t& flags = stores().bodies.flags[row];
      if ((flags & kNotFinite) != 0) {
        flags = static_cast<std::uint8_t>(flags & ~kNotFinite);
        if (incidents.first.size() < kIncidentsNamed) {
          const hal::DataSheet& sheet = *stores().groups[block.group].sheet;
          const bool more = sheet.turret_turn_rad_s > 0.0;  // than wheels to command
          incident("controller of robot '" + name_of_row(row) + "' commanded " +
                   (sheet.flies ? "a flight"
                    : more      ? "something"
                                : "a wheel speed") +
                   " that is not a finite number" + at_tick() +
                   (sheet.flies ? ": it hovers for this tick"
                    : more      ? ": that device is off for this tick"
                                : ": wheels stopped for this tick"));
        }
      }
      if (block.halted[i] == 2) {
        const std::uint32_t entity = stores().bodies.entity[row];
        const RobotId id{entity, stores().robots[entity].generation};
        space.set_halted(id, true);
        ++incidents.controllers_thrown;
        incident("controller of robot '" + space.robot_name(id) + "' threw" + at_tick() + ": " + faults[index].message +
                 "; the robot is stopped");
      }
    }
  }
}

void World::Impl::paint_floor_if_asked() {
  SpaceStores& s = stores();
  if (!s.repaint_floor || scenario.floor.source != "loop_functions" || hooks.empty()) return;
  s.repaint_floor = false;
  s.floor.paint(s.min_x_m, s.min_y_m, s.max_x_m - s.min_x_m, s.max_y_m - s.min_y_m, scenario.floor.pixels_per_meter,
                [&](double x, double y) { return hooks.front()->floor(x, y); });
}

template <class Call>
void World::Impl::call_hooks(const char* moment, Call&& call) {
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    HookContext context = hook_context();
    try {
      call(*hooks[i], context);
    } catch (const std::exception& e) {
      fail("hook '" + hook_names[i] + "' threw in " + moment + at_tick() + ": " + e.what());
    } catch (...) {
      fail("hook '" + hook_names[i] + "' threw in " + moment + at_tick());
    }
  }
}

// --- making one ---

namespace {

Object object_of(const ObjectItem& item, const PlacedObject& placed) {
  Object shape;
  shape.kind = item.shape == ShapeKind::Box ? Object::Kind::Box : Object::Kind::Cylinder;
  shape.id = placed.number < 0 ? item.id : item.id + std::to_string(placed.number);
  shape.x_m = placed.p_W[0];
  shape.y_m = placed.p_W[1];
  shape.cos_h = std::cos(placed.yaw_rad);
  shape.sin_h = std::sin(placed.yaw_rad);
  shape.half_x_m = 0.5 * item.size[0];
  shape.half_y_m = 0.5 * item.size[1];
  shape.radius_m = item.size[0];
  shape.z_low_m = placed.p_W[2];
  shape.z_high_m = placed.p_W[2] + item.size[2];
  shape.movable = item.movable;
  shape.mass_kg = item.mass_kg;
  return shape;
}

BodySize size_of_kind(const std::string& kind) {
  const hal::DataSheet* sheet = data_sheet_of(kind);
  return sheet != nullptr ? BodySize{sheet->body_radius_m, sheet->body_height_m, sheet->flies} : BodySize{};
}

/// Grippers hold by joints: robots whose controller takes one need an engine that has them. One problem an item.
void check_grippers(const Scenario& scenario, const SpaceStores& s, Problems& problems) {
  std::uint32_t complained = 0xFFFFFFFFU;
  for (const RobotEntity& e : s.robots) {
    const RobotBlock& block = s.blocks[e.block];
    const std::uint16_t region = s.bodies.region[block.first_row + e.slot];
    if (s.groups[block.group].gripper < 0 || region == kNoRegion || s.regions[region].forces || e.item == complained)
      continue;
    complained = e.item;
    const std::string name = s.names[e.item].prefix + (e.number < 0 ? "" : std::to_string(e.number));
    problems.push_back({scenario.file, scenario.robots[e.item].line,
                        "robot '" + name + "' has a gripper, but its engine '" + s.regions[region].name +
                            "' knows no forces, so that nothing can be held there; use dynamics2d or dynamics3d",
                        false});
  }
}

/// How wide the narrowest strip is that lets an object through, in m.
double narrowest_width_m(const Object& object) {
  return 2.0 * (object.kind == Object::Kind::Box ? std::min(object.half_x_m, object.half_y_m) : object.radius_m);
}

/// What keeps a body of this width from fitting into the region: the arena, or walls on all sides. Empty: nothing.
std::string too_wide_for(const SpaceStores& s, const Region& region, double width_m) {
  const auto between = [](double x_m, double y_m) {
    return " (" + hal::format_number(x_m) + " m x " + hal::format_number(y_m) + " m)";
  };
  const double arena_x_m = s.max_x_m - s.min_x_m;
  const double arena_y_m = s.max_y_m - s.min_y_m;
  if (width_m > std::min(arena_x_m, arena_y_m)) return "is larger than the arena" + between(arena_x_m, arena_y_m);
  const bool walled = !region.everywhere() && std::all_of(region.sides.begin(), region.sides.end(),
                                                          [](const RegionSide& side) { return side.wall; });
  const double x_m = region.max_x_m - region.min_x_m;
  const double y_m = region.max_y_m - region.min_y_m;
  if (walled && width_m > std::min(x_m, y_m))
    return "does not fit into the region '" + region.name + "'" + between(x_m, y_m);
  return "";
}

/// Every body's region; robots and movable objects that lie in none, or are too large for theirs, are problems.
void assign_regions(const Scenario& scenario, const Placements& placements, const RegionKeeper& keeper, SpaceStores& s,
                    Problems& problems) {
  constexpr std::size_t kNamed = 20;
  std::size_t bad = 0;
  const auto complain = [&](int line, const std::string& who, double x_m, double y_m, const std::string& why) {
    if (++bad > kNamed) return;
    problems.push_back({scenario.file, line,
                        who + " at (" + hal::format_number(x_m) + ", " + hal::format_number(y_m) + ") " + why, false});
  };
  const bool any_solid = std::any_of(s.regions.begin(), s.regions.end(), [](const Region& r) { return !r.plane; });
  for (const RobotEntity& e : s.robots) {
    const std::size_t row = s.blocks[e.block].first_row + e.slot;
    s.bodies.region[row] = keeper.find(s, BodyKey::robot(row));
    std::string why;
    if (s.bodies.region[row] != kNoRegion) {
      why = too_wide_for(s, s.regions[s.bodies.region[row]], 2.0 * static_cast<double>(s.bodies.radius_m[row]));
      if (why.empty()) continue;
    }
    const std::string name = s.names[e.item].prefix + (e.number < 0 ? "" : std::to_string(e.number));
    const bool flies = s.groups[s.blocks[e.block].group].sheet->flies;
    if (why.empty()) {
      why = flies && !any_solid ? "flies: it needs an engine of three dimensions, particle3d or dynamics3d"
                                : "lies in no engine's region";
    }
    complain(scenario.robots[e.item].line, "robot '" + name + "'", s.bodies.x_m[row], s.bodies.y_m[row], why);
  }
  check_grippers(scenario, s, problems);
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    if (!s.objects[i].movable) continue;
    s.object_region[i] = keeper.find(s, BodyKey::object(i));
    std::string why = "lies in no region of an engine that moves objects (dynamics2d, dynamics3d)";
    if (s.object_region[i] != kNoRegion) {
      why = too_wide_for(s, s.regions[s.object_region[i]], narrowest_width_m(s.objects[i]));
      if (why.empty()) continue;
    }
    complain(scenario.objects[placements.objects[i].item].line,
             std::string(s.objects[i].kind == Object::Kind::Box ? "movable box '" : "movable cylinder '") +
                 s.objects[i].id + "'",
             s.objects[i].x_m, s.objects[i].y_m, why);
  }
  if (bad > kNamed)
    problems.push_back({scenario.file, 0,
                        "... and " + std::to_string(bad - kNamed) + " more bodies in no region or too large for theirs",
                        false});
}

}  // namespace

std::unique_ptr<World> World::make(const Scenario& scenario, hal::PluginLoader& loader, const WorldOptions& options,
                                   Problems& problems) {
  auto impl = std::make_unique<Impl>();
  Impl& w = *impl;
  const std::size_t before = problems.size();
  const auto bad = [&] { return has_errors(problems, before); };
  w.scenario = scenario;
  w.options = options;
  w.seed = options.seed ? *options.seed : scenario.seed ? *scenario.seed : seed_from_clock();
  w.pool = std::make_unique<ThreadPool>(
      static_cast<std::size_t>(std::max<std::int64_t>(0, options.threads.value_or(scenario.threads))),
      options.assignment.value_or(scenario.assignment));
  SpaceStores& s = w.stores();
  s.min_x_m = scenario.arena_center[0] - 0.5 * scenario.arena_size[0];
  s.max_x_m = scenario.arena_center[0] + 0.5 * scenario.arena_size[0];
  s.min_y_m = scenario.arena_center[1] - 0.5 * scenario.arena_size[1];
  s.max_y_m = scenario.arena_center[1] + 0.5 * scenario.arena_size[1];

  if (scenario.arena_size[2] > 0.0) s.max_z_m = scenario.arena_center[2] + 0.5 * scenario.arena_size[2];

  const Placements placements = place(scenario, w.seed, &size_of_kind, problems);
  w.engines = make_engines(scenario, placements.robots.size(), s, problems);
  if (bad()) return nullptr;
  for (const Region& region : s.regions) {
    w.kinematic.push_back(region.listed ? 0 : 1);
    if (region.listed) w.one_kind = false;
  }
  s.bodies.has_motion = !w.one_kind;

  for (const PlacedObject& placed : placements.objects)
    s.objects.push_back(object_of(scenario.objects[placed.item], placed));
  for (const PlacedLight& placed : placements.lights) {
    const LightItem& item = scenario.lights[placed.item];
    s.lights.push_back({placed.number < 0 ? item.id : item.id + std::to_string(placed.number),
                        placed.p_W[0],
                        placed.p_W[1],
                        placed.p_W[2],
                        item.intensity,
                        {item.rgb[0], item.rgb[1], item.rgb[2]}});
  }
  for (const SoundItem& item : scenario.sounds)
    s.sounds.push_back({item.id, item.p_W[0], item.p_W[1], item.p_W[2], item.level});

  // Ids: entities in the order of the file.
  std::vector<RobotRequest> requests;
  requests.reserve(placements.robots.size());
  s.robots.resize(placements.robots.size());
  for (std::size_t i = 0; i < scenario.robots.size(); ++i) {
    const RobotItem& item = scenario.robots[i];
    s.names.push_back({item.id, item.distribute ? item.distribute->base_num : -1, 0, 0});
  }
  for (std::size_t i = 0; i < placements.robots.size(); ++i) {
    const PlacedRobot& placed = placements.robots[i];
    NameRange& name = s.names[placed.item];
    if (name.count == 0) name.first_entity = static_cast<std::uint32_t>(i);
    ++name.count;
    s.robots[i].item = placed.item;
    s.robots[i].number = placed.number;
    s.living.push_back(static_cast<std::uint32_t>(i));
    requests.push_back(
        {placed.item, static_cast<std::uint32_t>(i), placed.x_m, placed.y_m, placed.z_m, placed.yaw_rad});
  }
  w.factory = std::make_unique<RobotFactory>(w.scenario, w.seed, loader, s, w.devices);
  w.factory->make(requests, problems);
  w.editor = std::make_unique<WorldEditor>(w.scenario, s, *w.factory, w.devices, w.keeper);
  w.space.set_editor(w.editor.get());

  w.reach_m = index_reach(s, w.tick_s());
  s.body_index.set_area(s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, w.reach_m);
  s.static_index.build(s.objects, false, s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, w.reach_m);
  w.indexed_version = s.immovables_version;
  s.object_motion.resize(s.objects.size());
  s.object_region.resize(s.objects.size(), kNoRegion);
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    s.object_numbers.emplace(s.objects[i].id, static_cast<std::uint32_t>(i));
    const double half_rad = 0.5 * placements.objects[i].yaw_rad;
    s.object_motion[i].z_m = s.objects[i].z_low_m;
    s.object_motion[i].q_WB = {std::cos(half_rad), 0.0, 0.0, std::sin(half_rad)};
  }
  w.index_movables();
  if (!bad()) {
    w.keeper.build(s, w.tick_s());
    assign_regions(scenario, placements, w.keeper, s, problems);
  }

  if (scenario.floor.source == "image") {
    const hal::Status loaded =
        s.floor.load_png(scenario.floor.path, s.min_x_m, s.min_y_m, scenario.arena_size[0], scenario.arena_size[1]);
    if (!loaded.ok()) problems.push_back({scenario.file, scenario.floor.line, loaded.error().message, false});
  }
  s.repaint_floor = true;

  for (const HookConfig& config : scenario.hooks) {
    const auto type = loader.get(config.library, "hook", config.label);
    if (!type.ok()) {
      problems.push_back({scenario.file, config.line, "loop_functions: " + type.error().message, false});
      continue;
    }
    const auto* hook = static_cast<const HookType*>(type.value());
    w.hooks.push_back(hook->make(config.options, problems));
    w.hook_names.emplace_back(hook->name);
  }
  if (scenario.floor.source == "loop_functions" && scenario.hooks.empty()) {
    problems.push_back({scenario.file, scenario.floor.line,
                        "the floor is to be painted by loop functions, but there are none", false});
  }

  const std::size_t blocks = s.blocks.size();
  w.block_trouble.assign(blocks, 0);
  w.faults.resize(blocks);
  w.clamped.assign(blocks, 0);
  w.not_finite.assign(blocks, 0);
  auto world = std::unique_ptr<World>(new World(std::move(impl)));
  if (bad()) return nullptr;
  return world;
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

World::~World() {
  destroy_controllers(impl_->stores());
}

void World::start() {
  impl_->call_hooks("before_run", [](Hook& hook, HookContext& c) { hook.before_run(c); });
  do_requests();
}

void World::finish() {
  impl_->call_hooks("after_run", [](Hook& hook, HookContext& c) { hook.after_run(c); });
}

// --- snapshots ---

/// Nothing but the stores may tell what happens next.
void World::Impl::forget_caches() {
  for (const auto& engine : engines) engine->forget();
  stores().bodies_changed = true;
}

hal::Result<Snapshot> World::snapshot() {
  Impl& w = *impl_;
  if (w.external != nullptr) return hal::Error{"no snapshot: real robots take part, which cannot be put back"};
  auto moment = std::make_shared<Moment>();
  for (std::size_t i = 0; i < w.hooks.size(); ++i) {
    try {
      moment->hooks.push_back(w.hooks[i]->save());
    } catch (const std::exception& e) {
      return hal::Error{"no snapshot: hook '" + w.hook_names[i] + "' threw in save" + w.at_tick() + ": " + e.what()};
    } catch (...) {
      return hal::Error{"no snapshot: hook '" + w.hook_names[i] + "' threw in save" + w.at_tick()};
    }
  }
  hal::Result<std::unique_ptr<SpaceCopy>> copy = SpaceCopy::take(w.space, w.devices);
  if (!copy.ok()) return copy.error();
  w.forget_caches();
  moment->of = w.identity;
  moment->space = std::move(copy.value());
  moment->tick = w.tick;
  moment->state = w.state;
  moment->failure = w.failure;
  moment->incidents = w.incidents;
  moment->clamped = w.clamped;
  moment->not_finite = w.not_finite;
  moment->reach_m = w.reach_m;
  return Snapshot(w.tick, std::move(moment));
}

hal::Status World::restore(const Snapshot& snapshot) {
  Impl& w = *impl_;
  const Moment& moment = *snapshot.moment_;
  if (moment.of != w.identity) return hal::Error{"the snapshot is of another world"};
  if (w.external != nullptr) return hal::Error{"no way back: real robots take part, which cannot be put back"};
  hal::Status all = moment.space->put_back(w.space, w.devices);
  w.forget_caches();
  w.reach_m = moment.reach_m;
  w.tick = moment.tick;
  w.state = moment.state;
  w.failure = moment.failure;
  w.incidents = moment.incidents;
  w.clamped = moment.clamped;
  w.not_finite = moment.not_finite;
  w.block_trouble.assign(w.clamped.size(), 0);
  w.faults.assign(w.clamped.size(), {});
  w.strays.clear();
  for (std::size_t i = 0; i < w.hooks.size(); ++i) {
    try {
      w.hooks[i]->restore(moment.hooks[i]);
    } catch (const std::exception& e) {
      all = hal::Error{"hook '" + w.hook_names[i] + "' threw in restore" + w.at_tick() + ": " + e.what()};
    } catch (...) {
      all = hal::Error{"hook '" + w.hook_names[i] + "' threw in restore" + w.at_tick()};
    }
  }
  if (!all.ok()) w.fail(all.error().message);
  return all;
}

/// What hooks asked for while they were called.
void World::do_requests() {
  KeptMoments& moments = impl_->moments;
  const std::vector<KeptMoments::Request> requests = std::exchange(moments.requests, {});
  for (const KeptMoments::Request& request : requests) {
    if (impl_->state == RunState::Failed) return;
    if (request.save) {
      hal::Result<Snapshot> kept = snapshot();
      if (!kept.ok()) {
        moments.forget(request.name);
        return impl_->fail("checkpoint '" + request.name + "': " + kept.error().message);
      }
      moments.kept.insert_or_assign(request.name, std::move(kept.value()));
    } else {
      const hal::Status gone_back = restore(Snapshot(moments.kept.at(request.name)));
      if (!gone_back.ok()) return impl_->fail("checkpoint '" + request.name + "': " + gone_back.error().message);
    }
  }
}

void World::set_external(ExternalRobots* external) noexcept {
  impl_->external = external;
}
RunState World::state() const noexcept {
  return impl_->state;
}
const std::string& World::failure() const noexcept {
  return impl_->failure;
}
hal::Tick World::tick() const noexcept {
  return impl_->tick;
}
std::int64_t World::ticks_per_second() const noexcept {
  return impl_->scenario.ticks_per_second;
}
std::uint64_t World::seed() const noexcept {
  return impl_->seed;
}
std::int64_t World::threads() const noexcept {
  return static_cast<std::int64_t>(impl_->pool->size());
}
const Scenario& World::scenario() const noexcept {
  return impl_->scenario;
}
Space& World::space() noexcept {
  return impl_->space;
}
const Space& World::space() const noexcept {
  return impl_->space;
}

const Incidents& World::incidents() const noexcept {
  Incidents& i = impl_->incidents;
  i.commands_clamped = 0;
  i.commands_not_finite = 0;
  for (const std::uint64_t n : impl_->clamped) i.commands_clamped += n;
  for (const std::uint64_t n : impl_->not_finite) i.commands_not_finite += n;
  return i;
}

std::uint64_t World::state_hash() const noexcept {
  const SpaceStores& s = impl_->stores();
  const Bodies& b = s.bodies;
  std::uint64_t hash = mix(impl_->seed, static_cast<std::uint64_t>(impl_->tick));
  for (const std::uint32_t entity : s.living) {
    const RobotEntity& e = s.robots[entity];
    const RobotBlock& block = s.blocks[e.block];
    const RobotGroup& group = s.groups[block.group];
    const std::size_t row = block.first_row + e.slot;
    hash = mix(hash, entity);
    for (const auto* quantity : {&b.x_m, &b.y_m, &b.cos_h, &b.sin_h, &b.left_m, &b.right_m})
      hash = mix(hash, bits_of((*quantity)[row]));
    hash = mix(hash, block.halted[e.slot]);
    if (!b.motion.empty()) {
      hash = mix(hash, b.region[row]);
      hash = mix_motion(hash, b.motion[row]);
    }
    if (!b.flight.empty()) {
      const FlightCommand& f = b.flight[row];
      hash = mix(hash, static_cast<std::uint64_t>(f.mode));
      for (const double value : {f.target[0], f.target[1], f.target[2], f.yaw}) hash = mix(hash, bits_of(value));
    }
    hash = mix_mechanisms(hash, b, row);
    // Every port as the controller saw and left it, but the padding between fields.
    for (std::size_t i = 0; i < group.ports.size(); ++i) {
      const hal::PortType& type = *group.ports[i];
      const void* port = block.ports[i] + e.slot * type.size;
      for (const hal::Field& field : type.fields) {
        for (std::size_t k = 0; k < hal::used_count(type, port, field); ++k)
          hash = mix(hash, bits_of(hal::get_value(port, field, k)));
      }
    }
  }
  for (std::size_t i = 0; i < s.objects.size(); ++i) {
    const Object& o = s.objects[i];
    if (!o.movable || !o.alive) continue;
    hash = mix(mix(hash, i), s.object_region[i]);
    for (const double value : {o.x_m, o.y_m, o.cos_h, o.sin_h, o.z_low_m}) hash = mix(hash, bits_of(value));
    hash = mix_motion(hash, s.object_motion[i]);
  }
  for (const Joint& joint : s.joints) {
    if (!joint.alive) continue;
    hash = mix(mix(hash, joint.a.value), joint.b.value);
    for (const double value :
         {joint.ax_m, joint.ay_m, joint.az_m, joint.bx_m, joint.by_m, joint.bz_m, joint.heading_rad})
      hash = mix(hash, bits_of(value));
    if (joint.motor_torque_Nm > 0.0) hash = mix(mix(hash, bits_of(joint.motor_torque_Nm)), bits_of(joint.motor_rad_s));
  }
  return s.altered ? mix_scenery(hash, s) : hash;
}

}  // namespace tandem::core
