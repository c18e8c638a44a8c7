#include "core/physics/dynamics3d/world3d.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/physics/wheels.hpp"
#include "core/space/attitude.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr double kTouchMargin_m = 0.05;     // around a region: immovable objects so near stand in it
constexpr double kLongestLead_m = 0.2;      // in a tick, of a body that is led; farther away it is put
constexpr double kFastest_m_s = 100.0;      // what is faster has exploded
constexpr double kFastestTurn_rad_s = 1e4;  // …
constexpr double kPartingSpeed_m_s = 0.3;   // with which bodies that were put into one another part
constexpr double kSlack_m = 0.01;        // a body may stray so far from its planned way before candidates are renewed
constexpr double kMoreWay = 1.5;         // … of what its speed gives
constexpr double kFloats_m = 1e-6;       // above the floor
constexpr std::int64_t kMorePasses = 3;  // times as many when they were too few
constexpr std::int64_t kMostPasses = 2500;  // unless the file asks for more
constexpr double kRestsUpTo_m = 5e-4;       // so deep in one another things may come to rest
constexpr double kWallThickness_m = 0.2;
constexpr double kWallHeight_m = 2000.0;

bool external_in(const SpaceStores& stores, BodyKey key) noexcept {
  return !key.is_object() && stores.led_or_held(key.index());
}

double length(const Vector3& v) noexcept {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Sort sort_of(const SpaceStores& stores, BodyKey key, const World3dSettings& settings) noexcept {
  if (key.is_object()) return Sort::Object;
  const hal::RobotKind& kind = stores.kind_of_row(key.index());
  if (kind.flies()) return settings.rotors && !external_in(stores, key) ? Sort::Rotors : Sort::Flyer;
  return settings.wheels && wheels_of(kind).wheel_radius_m > 0.0 && !external_in(stores, key) ? Sort::Wheels
                                                                                              : Sort::Base;
}

/// Of the fastest of its points, at most; of what lives in ODE.
double speed_of(const BodyProxy& proxy) noexcept {
  const dReal* v = dBodyGetLinearVel(proxy.body.get());
  const dReal* w = dBodyGetAngularVel(proxy.body.get());
  const double reach_m = length({proxy.prism.round ? proxy.prism.radius_m : proxy.prism.half_x_m,
                                 proxy.prism.round ? 0.0 : proxy.prism.half_y_m,
                                 std::max(proxy.origin_m, proxy.height_m - proxy.origin_m)});
  return length({v[0], v[1], v[2]}) + length({w[0], w[1], w[2]}) * reach_m;
}

/// Fingerprint of all that decides whether a heap stands.
std::uint64_t mark_of(const std::vector<BodyProxy*>& objects, const std::vector<Support>& supports) noexcept {
  std::uint64_t mark = 0xCBF29CE484222325ULL;
  const auto mix = [&mark](double value) {
    mark = (mark ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15ULL;
    mark ^= mark >> 29;
  };
  for (const BodyProxy* object : objects) {
    mix(static_cast<double>(object->key.value));
    mix(object->mass_kg);
    for (const double x : object->before_m) mix(x);
    for (const double x : object->turned_before) mix(x);
  }
  for (const Support& support : supports) {
    mix(support.b == nullptr ? -1.0 : static_cast<double>(support.b->key.value));
    for (const double x : support.p_m) mix(x);
    for (const double x : support.normal) mix(x);
    mix(support.friction);
  }
  return mark;
}

/// The same as the store holds, for all that its double keeps.
bool agrees(const BodyProxy& proxy, const BodyState& store) noexcept {
  if (!proxy.light()) return state_of(proxy) == store;
  // It turns about the vertical only: what else the store says of turning is not its concern.
  return proxy.p_m == Vector3{store.x_m, store.y_m, store.z_m} && proxy.cos_h == store.cos_h &&
         proxy.sin_h == store.sin_h && proxy.v_m_s == store.v_m_s && proxy.w_rad_s == store.w_rad_s[2];
}

}  // namespace

// --- the world ---

template <class Work>
void World3d::guarded(const SolverContext& context, Work&& work) {
  if (broken_) return;
  try {
    use_ode();
    const WorldMemory::Use use(&memory_);
    work();
  } catch (const OdeError& error) {
    broken_ = true;
    drop_world();
    const Region& region = context.region;
    const BodyKey first = region.owned.empty() ? region.mirrored.front() : region.owned.front();
    trouble.push_back({first, "is in a region that cannot be solved: " + std::string(error.what())});
  }
}

/// Also one that ODE gave up in.
void World3d::drop_world() noexcept {
  threading_ = {};
  world_ = {};
  contacts_ = {};
  stills_.clear();
  bodies_table_.clear();
  held_.clear();
  version_ = 0;
  memory_.clear();
}

/// Handles of ODE's things as addresses of `memory_`, and all that is not of the last sub-step.
void World3d::remember(hal::Archive& archive, BodyProxy& p) const {
  archive(p.sort, p.owned, p.external, p.unfit, p.lost, p.aloft, p.standing, p.touched, p.engaged, p.driven, p.resting,
          p.before_m, p.turned_before, p.key, p.mass_kg, p.height_m, p.origin_m, p.p_m, p.v_m_s, p.next_v_m_s, p.cos_h,
          p.sin_h, p.w_rad_s, p.next_w_rad_s, p.forward_m_s, p.leftward_m_s, p.turn_rad_s, p.led_to_m, p.hop_m,
          p.margin_m, p.from_x_m, p.from_y_m, p.prism, p.rolled_m, p.rotors);
  const auto handles = [&](auto&... handle) { (remember_handle(memory_, archive, handle), ...); };
  handles(p.body, p.push, p.turn, p.wheels[0], p.wheels[1], p.axles[0], p.axles[1]);
}

bool World3d::remember(hal::Archive& archive) {
  use_ode();
  if (archive.reads()) {
    drop_world();
  } else if (world_) {
    const WorldMemory::Use use(&memory_);
    dWorldCleanupWorkingMemory(world_.get());  // what a step needs for itself
  }
  if (!memory_.remember(archive)) return false;
  remember_handle(memory_, archive, threading_);
  remember_handle(memory_, archive, world_);
  remember_handle(memory_, archive, contacts_.group());
  bodies_table_.remember(archive, [&](OwnedProxy& proxy) {
    if (proxy == nullptr) proxy = std::make_unique<BodyProxy>();
    remember(archive, *proxy);
  });
  std::uint64_t held = held_.size();
  archive(held);
  if (archive.reads()) held_.clear();
  for (std::uint64_t i = 0; i < held && archive.ok(); ++i) {
    if (archive.reads()) held_.emplace_back();
    Held& h = held_[i];
    archive(h.number, h.generation, h.a, h.b, h.at_a_m, h.at_b_m, h.free);
    remember_handle(memory_, archive, h.joint);
  }
  for (Held& h : held_) {
    h.twin_a = find(h.a);
    h.twin_b = find(h.b);
  }
  return true;
}

/// What proxies that were read do not know yet.
void World3d::find_kinds(const SpaceStores& stores) {
  for (auto& entry : bodies_table_.entries()) {
    BodyProxy& proxy = *entry.body;
    if (proxy.robot() && proxy.kind == nullptr && entry.key.index() < stores.bodies.size()) know_kind(proxy, stores);
  }
}

void World3d::report(const BodyProxy& proxy, std::string what) {
  if (proxy.owned) trouble.push_back({proxy.key, std::move(what)});
}

void World3d::make_world() {
  threading_ = OdeThreading(dThreadingAllocateSelfThreadedImplementation());
  if (!threading_) throw OdeError("ODE has no memory for a world");
  world_ = OdeWorld(dWorldCreate());
  const dWorldID world = world_.get();
  dWorldSetStepThreadingImplementation(world, dThreadingImplementationGetFunctions(threading_.get()), threading_.get());
  dWorldSetGravity(world, 0.0, 0.0, -settings_.gravity_m_s2);
  dWorldSetAutoDisableFlag(world, 0);
  dWorldSetERP(world, settings_.erp);
  dWorldSetCFM(world, settings_.cfm);
  dWorldSetQuickStepNumIterations(world, static_cast<int>(settings_.solver_iterations));
  dWorldSetContactMaxCorrectingVel(world, kPartingSpeed_m_s);
  dWorldSetAutoDisableAverageSamplesCount(world, 0);  // else every body has arrays for it on the heap
  contacts_.make_group();
  version_ = 0;
}

void World3d::place_stills(const SolverContext& context) {
  stills_.clear();
  const SpaceStores& s = context.stores;
  for (const Object& o : s.objects) {
    if (!o.alive || o.movable || !context.region.touches(o, kTouchMargin_m + s.border_reach_m)) continue;
    Still still;
    still.height_m = o.z_high_m - o.z_low_m;
    Prism& prism = still.prism;
    prism = {o.kind == Object::Kind::Cylinder,
             true,
             o.x_m,
             o.y_m,
             o.cos_h,
             o.sin_h,
             o.half_x_m,
             o.half_y_m,
             o.radius_m,
             o.z_low_m,
             o.z_high_m,
             0.0,
             0.0};
    if (leans(turn_of(s, o))) {
      still.q_W = turn_of(s, o);
      const Attitude attitude = attitude_of(o, still.q_W);
      const std::array<double, 3> half_m = half_extents(o, attitude);
      prism.upright = false;
      prism.reach_x_m = half_m[0];
      prism.reach_y_m = half_m[1];
      prism.low_m = attitude.middle_m[2] - half_m[2];
      prism.high_m = attitude.middle_m[2] + half_m[2];
    }
    stills_.push_back(std::move(still));
  }
  const auto& sides = context.region.sides;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (!sides[i].wall) continue;
    const RegionSide& a = sides[i];
    const RegionSide& b = sides[(i + 1) % sides.size()];
    const double long_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    if (long_m <= 0.0) continue;
    Still still;
    still.wall = true;
    still.height_m = kWallHeight_m;
    Prism& prism = still.prism;
    prism.round = false;
    prism.cos_h = (b.x_m - a.x_m) / long_m;
    prism.sin_h = (b.y_m - a.y_m) / long_m;
    prism.half_x_m = 0.5 * long_m;
    prism.half_y_m = 0.5 * kWallThickness_m;
    // Outlines are counter-clockwise: outside is to the right.
    prism.x_m = 0.5 * (a.x_m + b.x_m) + prism.half_y_m * prism.sin_h;
    prism.y_m = 0.5 * (a.y_m + b.y_m) - prism.half_y_m * prism.cos_h;
    prism.low_m = -0.5 * kWallHeight_m;
    prism.high_m = 0.5 * kWallHeight_m;
    stills_.push_back(std::move(still));
  }
  for (Still& still : stills_) {
    Prism& prism = still.prism;
    if (!prism.upright) continue;
    const double c = std::fabs(prism.cos_h);
    const double n = std::fabs(prism.sin_h);
    prism.reach_x_m = prism.round ? prism.radius_m : c * prism.half_x_m + n * prism.half_y_m;
    prism.reach_y_m = prism.round ? prism.radius_m : n * prism.half_x_m + c * prism.half_y_m;
  }
  version_ = s.immovables_version;
}

// --- doubles ---

void World3d::load(const SolverContext& context) {
  guarded(context, [&] {
    const SpaceStores& s = context.stores;
    if (!world_) make_world();
    if (version_ != s.immovables_version) {
      place_stills(context);
      find_kinds(s);
    }
    surfaces_ = settings_.surfaces;
    surfaces_.floor_m = std::max(settings_.surfaces.floor_m, context.region.bottom_m);
    surfaces_.ceiling_m = context.region.top_m;
    flight_ceiling_m_ = std::min(context.region.top_m, s.max_z_m);
    surfaces_in_air_ = surfaces_;
    surfaces_in_air_.ceiling_m = flight_ceiling_m_;
    bodies_table_.update(
        context.region, s, [&](BodyKey key) { return make(s, key); }, [this](OwnedProxy& proxy) { drop_proxy(proxy); });
    for (auto& entry : bodies_table_.entries()) {
      entry.body->owned = entry.owned;
      take_over(s, entry.body, context.tick_s);
    }
    if (!s.joints.empty() || !held_.empty()) join(s);
  });
}

World3d::OwnedProxy World3d::make(const SpaceStores& stores, BodyKey key) {
  auto proxy = std::make_unique<BodyProxy>();
  try {
    make_proxy(*proxy, stores, key, sort_of(stores, key, settings_), world_.get());
    proxy->p_m[0] = NAN;  // nowhere yet
    return proxy;
  } catch (const OdeError& error) {
    trouble.push_back({key, "cannot be simulated: " + std::string(error.what())});
    end_proxy(*proxy);
    *proxy = BodyProxy();
    proxy->key = key;
    proxy->sort = Sort::Base;
    proxy->unfit = true;
    return proxy;
  }
}

void World3d::drop_proxy(OwnedProxy& proxy) {
  std::erase_if(held_, [&](Held& held) {
    if (held.a != proxy->key && held.b != proxy->key) return false;
    held.joint.destroy();
    return true;
  });
  end_proxy(*proxy);
  proxy.reset();
}

void World3d::take_over(const SpaceStores& stores, OwnedProxy& proxy, double tick_s) {
  const BodyKey key = proxy->key;
  proxy->lost = proxy->unfit;
  if (proxy->unfit) return;
  const Sort sort = sort_of(stores, key, settings_);
  if (sort != proxy->sort) {
    const bool owned = proxy->owned;
    drop_proxy(proxy);
    proxy = make(stores, key);
    proxy->owned = owned;
  }
  const BodyState store = stored_state(stores, key);
  if (!store.finite()) {
    proxy->lost = true;
    report(*proxy, "has a position or speed that is not a finite number");
    return;
  }
  if (sort == Sort::Rotors) proxy->rotors = *stores.state_of(stores.rotors, key.index());
  proxy->external = external_in(stores, key);
  if (proxy->external)
    lead(*proxy, store, tick_s);
  else if (!agrees(*proxy, store))
    put(*proxy, store);
  if (!proxy->light()) dBodyEnable(proxy->body.get());
}

/// A body whose pose comes from outside moves there within the tick, so that others are pushed and not jumped upon.
void World3d::lead(BodyProxy& proxy, const BodyState& at, double tick_s) const {
  const Vector3 there{at.x_m, at.y_m, at.z_m};
  const Vector3 way{there[0] - proxy.p_m[0], there[1] - proxy.p_m[1], there[2] - proxy.p_m[2]};
  const double far_m = length(way);
  if (!(far_m <= kLongestLead_m)) proxy.p_m = there;
  for (std::size_t i = 0; i < 3; ++i) proxy.v_m_s[i] = far_m <= kLongestLead_m ? way[i] / tick_s : 0.0;
  proxy.led_to_m = there;
  proxy.cos_h = at.cos_h;
  proxy.sin_h = at.sin_h;
  proxy.w_rad_s = 0.0;
}

BodyProxy* World3d::find(BodyKey key) noexcept {
  auto& entries = bodies_table_.entries();
  const auto found = std::lower_bound(entries.begin(), entries.end(), key,
                                      [](const auto& entry, BodyKey wanted) { return entry.key < wanted; });
  return found != entries.end() && found->key == key ? found->body.get() : nullptr;
}

void World3d::join(const SpaceStores& stores) {
  std::erase_if(held_, [&](Held& held) {
    const Joint& joint = stores.joints[held.number];
    if (joint.alive && joint.generation == held.generation) return false;
    held.joint.destroy();
    return true;
  });
  for (std::size_t i = 0; i < stores.joints.size(); ++i) {
    const Joint& joint = stores.joints[i];
    const bool held = std::any_of(held_.begin(), held_.end(), [&](const Held& h) { return h.number == i; });
    if (!joint.alive || held) continue;
    BodyProxy* a = find(joint.a);
    BodyProxy* b = find(joint.b);
    if (a == nullptr || b == nullptr || a->lost || b->lost) continue;
    held_.push_back({i, joint.generation, joint.a, joint.b, a, b, make_joint(joint, *a, *b)});
    Held& held_now = held_.back();
    held_now.at_a_m = {joint.ax_m, joint.ay_m, joint.az_m - a->origin_m};
    held_now.at_b_m = {joint.bx_m, joint.by_m, joint.bz_m - b->origin_m};
    if (joint.form.kind == JointKind::Sliding) {
      const double axis = length(joint.form.axis);
      for (std::size_t k = 0; k < 3; ++k) held_now.free[k] = joint.form.axis[k] / axis;
    }
  }
  for (const Held& held : held_) {
    const JointForm& form = stores.joints[held.number].form;
    if (!(form.motor_most > 0.0)) continue;
    // ODE turns a hinge's first body relative to its second.
    if (form.kind == JointKind::Turning) dJointSetHingeParam(held.joint.get(), dParamVel, -form.motor_speed);
    if (form.kind == JointKind::Sliding) dJointSetSliderParam(held.joint.get(), dParamVel, form.motor_speed);
  }
}

/// ODE takes a joint's geometry from where its bodies are; so for a moment they are where the joint wants them.
OdeJoint World3d::make_joint(const Joint& joint, BodyProxy& a, BodyProxy& b) {
  for (BodyProxy* proxy : {&a, &b}) {
    if (!proxy->light()) continue;
    give_body(*proxy, world_.get());
    enter(*proxy);
  }
  const dBodyID body_a = a.body.get();
  const dBodyID body_b = b.body.get();
  const JointForm& form = joint.form;
  dVector3 point{};
  dBodyGetRelPointPos(body_a, joint.ax_m, joint.ay_m, joint.az_m - a.origin_m, point);
  const dWorldID world = world_.get();
  const OdeJoint made(form.kind == JointKind::Turning   ? dJointCreateHinge(world, nullptr)
                      : form.kind == JointKind::Sliding ? dJointCreateSlider(world, nullptr)
                                                        : dJointCreateFixed(world, nullptr));
  dJointAttach(made.get(), body_a, body_b);
  const std::array<dReal, 4> q_b{dBodyGetQuaternion(body_b)[0], dBodyGetQuaternion(body_b)[1],
                                 dBodyGetQuaternion(body_b)[2], dBodyGetQuaternion(body_b)[3]};
  const Vector3 p_b{dBodyGetPosition(body_b)[0], dBodyGetPosition(body_b)[1], dBodyGetPosition(body_b)[2]};
  const double middle_rad = 0.5 * (form.low + form.high);  // where a hinge with limits has its zero
  if (form.kind != JointKind::Turning || form.limited) {
    const double heading_rad = form.kind == JointKind::Turning ? middle_rad : joint.heading_rad;
    const std::array<double, 4> turn = upright_turn(std::cos(heading_rad), std::sin(heading_rad));
    dQuaternion q{};
    dQMultiply0(q, dBodyGetQuaternion(body_a), turn.data());
    dBodySetQuaternion(body_b, q);
  }
  dVector3 arm{};
  dBodyVectorToWorld(body_b, joint.bx_m, joint.by_m, joint.bz_m - b.origin_m, arm);
  dBodySetPosition(body_b, point[0] - arm[0], point[1] - arm[1], point[2] - arm[2]);
  switch (form.kind) {
    case JointKind::Fixed:
      dJointSetFixed(made.get());
      break;
    case JointKind::Turning:
      dJointSetHingeAnchor(made.get(), point[0], point[1], point[2]);
      dJointSetHingeAxis(made.get(), 0.0, 0.0, 1.0);
      if (form.motor_most > 0.0) dJointSetHingeParam(made.get(), dParamFMax, form.motor_most);
      if (form.limited) {
        dJointSetHingeParam(made.get(), dParamLoStop, middle_rad - form.high);
        dJointSetHingeParam(made.get(), dParamHiStop, middle_rad - form.low);
      }
      break;
    case JointKind::Sliding: {
      // ODE slides the first body relative to the second: against the axis, b's way along it counts.
      dVector3 axis{};
      dBodyVectorToWorld(body_a, form.axis[0], form.axis[1], form.axis[2], axis);
      dJointSetSliderAxis(made.get(), -axis[0], -axis[1], -axis[2]);
      if (form.motor_most > 0.0) dJointSetSliderParam(made.get(), dParamFMax, form.motor_most);
      if (form.limited) {
        dJointSetSliderParam(made.get(), dParamLoStop, form.low);
        dJointSetSliderParam(made.get(), dParamHiStop, form.high);
      }
      break;
    }
  }
  dBodySetPosition(body_b, p_b[0], p_b[1], p_b[2]);
  dBodySetQuaternion(body_b, q_b.data());
  return made;
}

// --- one tick ---

void World3d::advance(const SolverContext& context) {
  guarded(context, [&] {
    SpaceStores& s = context.stores;
    const double dt_s = context.tick_s / static_cast<double>(settings_.sub_steps);
    auto& entries = bodies_table_.entries();
    for (auto& entry : entries) {
      if (entry.body->lost) continue;
      entry.body->rolled_m = {};
      plan(s, *entry.body, dt_s);
      update_prism(*entry.body);
    }
    find_candidates();
    for (std::int64_t step = 0; step < settings_.sub_steps; ++step) {
      bool strayed = false;
      for (auto& entry : entries) {
        BodyProxy& proxy = *entry.body;
        if (proxy.lost) continue;
        if (step > 0) plan(s, proxy, dt_s);
        if (step > 0) update_prism(proxy);
        const double moved_m =
            std::max(std::fabs(proxy.prism.x_m - proxy.from_x_m), std::fabs(proxy.prism.y_m - proxy.from_y_m));
        strayed = strayed || moved_m + proxy.hop_m > proxy.margin_m;
      }
      if (strayed) find_candidates();
      residual_.begin({dt_s, settings_.erp, settings_.cfm, kPartingSpeed_m_s});
      contacts_.begin(world_.get(), dt_s, residual_);
      find_contacts();
      overlap = contacts_.overlap();  // of the last sub-step, after the tick
      accuracy.overlap = std::max(accuracy.overlap, contacts_.overlap_in_flight());
      solved_.clear();
      for (auto& entry : entries) {
        BodyProxy& proxy = *entry.body;
        if (proxy.touched) enter(proxy);
        if (proxy.touched || !proxy.light()) solved_.push_back(&proxy);
      }
      find_heaps();
      rest_heaps();
      solve(dt_s, static_cast<std::uint64_t>(context.tick) * static_cast<std::uint64_t>(settings_.sub_steps) +
                      static_cast<std::uint64_t>(step));
      stop_heaps(dt_s);
      contacts_.clear();
      for (auto& entry : entries) {
        if (entry.body->lost) continue;
        leave(*entry.body, dt_s);
        check(*entry.body);
      }
    }
    for (const auto& entry : entries) write_back(s, *entry.body, context.tick_s);
  });
  broken_ = false;
}

/// What a body does in this sub-step if nothing comes in its way.
void World3d::plan(const SpaceStores& stores, BodyProxy& proxy, double dt_s) {
  const std::size_t i = proxy.key.index();
  const double fall_m_s = settings_.gravity_m_s2 * dt_s;
  proxy.touched = false;
  proxy.engaged = false;
  proxy.driven = false;
  proxy.heap = nullptr;
  if (std::exchange(proxy.resting, false)) dBodyEnable(proxy.body.get());
  if (!proxy.light()) {
    if (proxy.sort == Sort::Wheels) drive_wheels(proxy, stores.bodies.left_m_s[i], stores.bodies.right_m_s[i]);
    if (proxy.sort == Sort::Rotors) drive_rotors(proxy, stores.command_of(i), settings_.gravity_m_s2, dt_s);
    const dReal* p = dBodyGetPosition(proxy.body.get());
    const dReal* q = dBodyGetQuaternion(proxy.body.get());
    proxy.before_m = {p[0], p[1], p[2]};
    std::copy_n(q, 4, proxy.turned_before);
    proxy.hop_m = (speed_of(proxy) + fall_m_s) * dt_s;
    return;
  }
  if (proxy.external) {
    proxy.next_v_m_s = proxy.v_m_s;
    proxy.next_w_rad_s = 0.0;
    proxy.hop_m = length(proxy.v_m_s) * dt_s;
    return;
  }
  proxy.aloft = proxy.sort == Sort::Flyer || proxy.p_m[2] > surfaces_.floor_m + kFloats_m;
  if (proxy.sort == Sort::Flyer) {
    drive_flyer(proxy, stores.command_of(i), settings_.gravity_m_s2, dt_s);
  } else {
    if (!proxy.aloft || proxy.standing) drive_base(proxy, stores.bodies.left_m_s[i], stores.bodies.right_m_s[i], dt_s);
    if (proxy.aloft) {
      if (!proxy.standing)
        drop(proxy, settings_.gravity_m_s2, dt_s);
      else
        proxy.next_v_m_s[2] -= fall_m_s;
    }
  }
  proxy.standing = false;
  proxy.hop_m = std::max(length(proxy.v_m_s), length(proxy.next_v_m_s)) * dt_s;
}

void World3d::find_candidates() {
  auto& entries = bodies_table_.entries();
  const auto bodies = static_cast<std::uint32_t>(entries.size());
  const double hops = kMoreWay * static_cast<double>(settings_.sub_steps);
  finder_.clear(bodies);
  for (std::uint32_t i = 0; i < bodies; ++i) {
    BodyProxy& proxy = *entries[i].body;
    if (proxy.lost) continue;
    const Prism& prism = proxy.prism;
    proxy.margin_m = kSlack_m + hops * proxy.hop_m;
    proxy.from_x_m = prism.x_m;
    proxy.from_y_m = prism.y_m;
    const double x = prism.reach_x_m + proxy.margin_m;
    const double y = prism.reach_y_m + proxy.margin_m;
    finder_.add(i, prism.x_m - x, prism.x_m + x, prism.y_m - y, prism.y_m + y);
  }
  for (std::uint32_t i = 0; i < stills_.size(); ++i) {
    const Prism& prism = stills_[i].prism;
    finder_.add(bodies + i, prism.x_m - prism.reach_x_m, prism.x_m + prism.reach_x_m, prism.y_m - prism.reach_y_m,
                prism.y_m + prism.reach_y_m);
  }
  candidates_.clear();
  for (const PairFinder::Pair& pair : finder_.find()) {
    const BodyProxy& a = *entries[pair.first].body;
    const bool possible =
        pair.second < bodies ? may_touch(a, *entries[pair.second].body) : may_touch(a, stills_[pair.second - bodies]);
    if (possible) candidates_.push_back(pair);
  }
}

bool World3d::may_touch(const BodyProxy& a, const BodyProxy& b) const noexcept {
  if (a.external && b.external) return false;
  return std::none_of(held_.begin(), held_.end(), [&](const Held& held) {
    return (held.a == a.key && held.b == b.key) || (held.a == b.key && held.b == a.key);
  });
}

bool World3d::may_touch(const BodyProxy& a, const Still& still) const noexcept {
  return !a.external && (a.owned || !still.wall);
}

void World3d::find_contacts() {
  auto& entries = bodies_table_.entries();
  for (Held& held : held_) {
    for (BodyProxy* proxy : {held.twin_a, held.twin_b}) {
      proxy->driven = true;
      proxy->touched = proxy->light();
      proxy->engaged = proxy->sort == Sort::Base && !proxy->external;
    }
  }
  for (const PairFinder::Pair& pair : candidates_) {
    BodyProxy& a = *entries[pair.first].body;
    if (a.lost) continue;
    if (pair.second >= entries.size()) {
      contacts_.with_still(a, stills_[pair.second - entries.size()], surfaces_);
    } else if (!entries[pair.second].body->lost) {
      contacts_.between(a, *entries[pair.second].body, surfaces_);
    }
  }
  for (auto& entry : entries) {
    if (entry.body->lost || entry.body->light()) continue;
    contacts_.with_ground(*entry.body, entry.body->sort == Sort::Rotors ? surfaces_in_air_ : surfaces_);
  }
}

/// Puts a light body into ODE for this sub-step.
void World3d::enter(BodyProxy& proxy) {
  const dBodyID body = proxy.body.get();
  if (proxy.external && dBodyIsKinematic(body) == 0) dBodySetKinematic(body);
  if (!proxy.external && dBodyIsKinematic(body) != 0) dBodySetDynamic(body);
  dBodyEnable(body);
  dBodySetPosition(body, proxy.p_m[0], proxy.p_m[1], proxy.p_m[2] + proxy.origin_m);
  dBodySetQuaternion(body, upright_turn(proxy.cos_h, proxy.sin_h).data());
  const Vector3& v = proxy.engaged && !proxy.aloft ? proxy.v_m_s : proxy.next_v_m_s;
  dBodySetLinearVel(body, v[0], v[1], v[2]);
  dBodySetAngularVel(body, 0.0, 0.0, proxy.engaged ? proxy.w_rad_s : proxy.next_w_rad_s);
  if (proxy.engaged)
    engage(proxy, world_.get());
  else
    release(proxy);
}

/// Heaps of objects that touch one another, directly or through others, and the ground, and no robot.
void World3d::find_heaps() {
  heaps_.clear();
  for (BodyProxy* proxy : solved_) {
    if (proxy->sort == Sort::Object && (proxy->driven || proxy->lost)) top_of_heap(*proxy).driven = true;
  }
  for (BodyProxy* proxy : solved_) {
    if (proxy->sort != Sort::Object || top_of_heap(*proxy).driven) continue;
    heaps_.push_back({&top_of_heap(*proxy), proxy});
  }
  const auto by_key = [](const HeapMember& a, const HeapMember& b) {
    return a.top != b.top ? a.top->key < b.top->key : a.proxy->key < b.proxy->key;
  };
  std::sort(heaps_.begin(), heaps_.end(), by_key);
  heap_supports_.clear();
  const std::vector<Support>& supports = contacts_.supports();
  for (std::uint32_t i = 0; i < supports.size(); ++i) {
    const BodyProxy& top = top_of_heap(*supports[i].a);
    if (!top.driven) heap_supports_.push_back({top.key, i});
  }
  std::sort(heap_supports_.begin(), heap_supports_.end(), [](const HeapSupport& a, const HeapSupport& b) {
    return a.top != b.top ? a.top < b.top : a.number < b.number;
  });
}

/// Calls `use(first, past)` for every heap of `heaps_`.
template <class Use>
void World3d::each_heap(Use&& use) {
  for (std::size_t first = 0; first < heaps_.size();) {
    std::size_t past = first;
    while (past < heaps_.size() && heaps_[past].top == heaps_[first].top) ++past;
    use(first, past);
    first = past;
  }
}

/// Whether a heap can stay as it is. What stood in the last sub-step and is unchanged stands.
bool World3d::stands(std::size_t first, std::size_t past) {
  heap_.clear();
  supports_.clear();
  for (std::size_t i = first; i < past; ++i) heap_.push_back(heaps_[i].proxy);
  const BodyKey top = heaps_[first].top->key;
  for (auto own = std::lower_bound(heap_supports_.begin(), heap_supports_.end(), top,
                                   [](const HeapSupport&support, BodyKey key) { return support.top < key; });
       own != heap_supports_.end() && own->top == top; ++own)
    supports_.push_back(contacts_.supports()[own->number]);
  if (std::any_of(supports_.begin(), supports_.end(), [](const Support& s) { return s.depth_m > kRestsUpTo_m; }))
    return false;  // what fell into something is pushed out before it rests
  const std::uint64_t mark = mark_of(heap_, supports_);
  const bool known = std::binary_search(stood_.begin(), stood_.end(), mark);
  if (!known && !standing_.stands(heap_, supports_, settings_.gravity_m_s2)) return false;
  stands_now_.push_back(mark);
  return true;
}

/// Heaps at rest that stand take no part in the sub-step.
void World3d::rest_heaps() {
  std::swap(stood_, stands_now_);
  stands_now_.clear();
  std::sort(stood_.begin(), stood_.end());
  each_heap([&](std::size_t first, std::size_t past) {
    for (std::size_t i = first; i < past; ++i) {
      if (speed_of(*heaps_[i].proxy) != 0.0) return;
    }
    if (!stands(first, past)) return;
    for (std::size_t i = first; i < past; ++i) {
      heaps_[i].proxy->resting = true;
      dBodyDisable(heaps_[i].proxy->body.get());
    }
  });
}

/// ODE's step, with as many passes as bring the velocities of each island to what its constraints ask for.
void World3d::solve(double dt_s, std::uint64_t seed) {
  if (solved_.empty()) return;
  for (const BodyProxy* proxy : solved_) add_to_residual(*proxy);
  for (const Held& held : held_) add_to_residual(held);
  residual_.prepare();
  double error_m_s = 0.0;
  for (std::int64_t passes = settings_.solver_iterations;; passes *= kMorePasses) {
    seed_ode(seed);
    dWorldSetQuickStepNumIterations(world_.get(), static_cast<int>(passes));
    dWorldQuickStep(world_.get(), dt_s);
    error_m_s = residual_.measure();
    if (!(error_m_s > settings_.solver_error_m_s) || passes * kMorePasses > kMostPasses) break;
    residual_.begin_again(settings_.solver_error_m_s);
  }
  residual_.end();
  accuracy.constraint_error_m_s = std::max(accuracy.constraint_error_m_s, error_m_s);
  if (error_m_s > settings_.solver_error_m_s) ++accuracy.unsolved_sub_steps;
}

/// What of a body takes part in ODE's step.
void World3d::add_to_residual(const BodyProxy& proxy) {
  if (proxy.lost || proxy.resting) return;
  const dBodyID body = proxy.body.get();
  residual_.add_body(body);
  if (proxy.sort == Sort::Wheels) {
    const double radius_m = proxy.drive->wheel_radius_m;
    for (std::size_t side = 0; side < 2; ++side) {
      const dBodyID wheel = proxy.wheels[side].get();
      const dJointID axle = proxy.axles[side].get();
      residual_.add_body(wheel);
      residual_.add_axle(axle, wheel, body, radius_m, dJointGetHingeParam(axle, dParamVel) * radius_m,
                         dJointGetHingeParam(axle, dParamFMax));
    }
  }
  if (!proxy.touched || !proxy.engaged) return;
  residual_.add_push(proxy.push.get(), body, {proxy.cos_h, proxy.sin_h, 0.0}, proxy.forward_m_s, proxy.leftward_m_s,
                     proxy.drive->force_N);
  residual_.add_turn(proxy.turn.get(), body, proxy.turn_rad_s, proxy.prism.radius_m, proxy.drive->torque_Nm);
}

void World3d::add_to_residual(const Held& held) {
  const BodyProxy& a = *held.twin_a;
  const BodyProxy& b = *held.twin_b;
  if (a.lost || b.lost) return;
  residual_.add_hold(a.body.get(), b.body.get(), held.at_a_m, held.at_b_m, held.free);
}

/// Heaps that stand, and are so slow that friction stops them within half a sub-step, come to rest.
void World3d::stop_heaps(double dt_s) {
  const double friction = std::min(settings_.surfaces.floor_friction, settings_.surfaces.object_friction);
  const double slow_m_s = 0.5 * std::min(1.0, friction) * settings_.gravity_m_s2 * dt_s;
  each_heap([&](std::size_t first, std::size_t past) {
    for (std::size_t i = first; i < past; ++i) {
      if (heaps_[i].proxy->resting || speed_of(*heaps_[i].proxy) >= slow_m_s) return;
    }
    if (!stands(first, past)) return;
    for (std::size_t i = first; i < past; ++i) {
      const BodyProxy& proxy = *heaps_[i].proxy;
      dBodySetPosition(proxy.body.get(), proxy.before_m[0], proxy.before_m[1], proxy.before_m[2]);
      dBodySetQuaternion(proxy.body.get(), proxy.turned_before);
      dBodySetLinearVel(proxy.body.get(), 0.0, 0.0, 0.0);
      dBodySetAngularVel(proxy.body.get(), 0.0, 0.0, 0.0);
    }
  });
}

/// Takes it out again, and moves those that were not in.
void World3d::leave(BodyProxy& proxy, double dt_s) {
  if (!proxy.light()) {
    if (proxy.sort == Sort::Wheels) count_wheels(proxy, dt_s);
    return;
  }
  if (proxy.touched) {
    const dBodyID body = proxy.body.get();
    dBodyDisable(body);
    const dReal* p = dBodyGetPosition(body);
    const dReal* v = dBodyGetLinearVel(body);
    if (!proxy.external) {
      proxy.p_m = {p[0], p[1], p[2] - proxy.origin_m};
      proxy.v_m_s = {v[0], v[1], v[2]};
      // Wheels that push nothing hold the heading against whatever the rim rubs on.
      proxy.w_rad_s = proxy.engaged ? dBodyGetAngularVel(body)[2] : proxy.next_w_rad_s;
    }
  }
  if (!proxy.touched || proxy.external) {
    proxy.v_m_s = proxy.next_v_m_s;
    proxy.w_rad_s = proxy.next_w_rad_s;
    for (std::size_t i = 0; i < 3; ++i) proxy.p_m[i] += proxy.v_m_s[i] * dt_s;
  }
  if (proxy.external) return;
  const auto [c, s] = proxy.turn_by_all.of(proxy.cos_h, proxy.sin_h, proxy.w_rad_s * dt_s);
  proxy.cos_h = c;
  proxy.sin_h = s;
  if (!proxy.aloft || proxy.p_m[2] <= surfaces_.floor_m) {
    proxy.p_m[2] = surfaces_.floor_m;
    proxy.v_m_s[2] = proxy.aloft ? std::max(0.0, proxy.v_m_s[2]) : 0.0;
  }
  const double ceiling_m = proxy.sort == Sort::Flyer ? flight_ceiling_m_ : surfaces_.ceiling_m;
  if (proxy.p_m[2] + proxy.height_m > ceiling_m && proxy.aloft) {
    proxy.p_m[2] = std::max(surfaces_.floor_m, ceiling_m - proxy.height_m);
    proxy.v_m_s[2] = std::min(0.0, proxy.v_m_s[2]);
  }
}

/// What has exploded is named, and left out from then on.
void World3d::check(BodyProxy& proxy) {
  if (proxy.light()) {  // nearly always well, and known so without its attitude
    const Vector3& v = proxy.v_m_s;
    const double sum = proxy.p_m[0] + proxy.p_m[1] + proxy.p_m[2] + proxy.cos_h + proxy.sin_h + proxy.w_rad_s;
    if (std::isfinite(sum) && length(v) <= kFastest_m_s && std::fabs(proxy.w_rad_s) <= kFastestTurn_rad_s) return;
  }
  const BodyState now = state_of(proxy);
  const bool finite = now.finite();
  const double v = length(now.v_m_s);
  if (finite && v <= kFastest_m_s && length(now.w_rad_s) <= kFastestTurn_rad_s) return;
  proxy.lost = true;
  if (!proxy.light()) dBodyDisable(proxy.body.get());
  report(proxy, !finite ? std::string("has a position or speed that is not a finite number")
                : v > kFastest_m_s
                    ? "moves faster than its engine can follow (" + hal::rounded(v) + " m/s)"
                    : "turns faster than its engine can follow (" + hal::rounded(length(now.w_rad_s)) + " rad/s)");
}

void World3d::write_back(SpaceStores& stores, const BodyProxy& proxy, double tick_s) const {
  if (proxy.lost || proxy.external || !proxy.owned) return;
  const BodyState at = state_of(proxy);
  const std::size_t i = proxy.key.index();
  const Motion motion{at.z_m, at.q_WB, at.v_m_s, at.w_rad_s};
  if (proxy.sort == Sort::Object) {
    Object& o = stores.objects[i];
    o.x_m = at.x_m;
    o.y_m = at.y_m;
    o.cos_h = at.cos_h;
    o.sin_h = at.sin_h;
    o.z_low_m = at.z_m;
    o.z_high_m = at.z_m + proxy.height_m;
    stores.object_motion[i] = motion;
    return;
  }
  Bodies& b = stores.bodies;
  b.x_m[i] = at.x_m;
  b.y_m[i] = at.y_m;
  b.cos_h[i] = at.cos_h;
  b.sin_h[i] = at.sin_h;
  b.motion[i] = motion;
  if (proxy.sort == Sort::Rotors) *stores.state_of(stores.rotors, i) = proxy.rotors;
  b.left_m[i] += proxy.sort == Sort::Wheels ? proxy.rolled_m[0] : b.left_m_s[i] * tick_s;
  b.right_m[i] += proxy.sort == Sort::Wheels ? proxy.rolled_m[1] : b.right_m_s[i] * tick_s;
}

}  // namespace tandem::core
