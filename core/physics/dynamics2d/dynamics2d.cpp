#include "core/physics/dynamics2d/dynamics2d.hpp"

#include <algorithm>
#include <array>
#include <box2d/b2_distance.h>
#include <box2d/box2d.h>
#include <cmath>
#include <new>
#include <string>
#include <utility>

#include "core/physics/body_table.hpp"
#include "core/physics/crowd_passes.hpp"
#include "core/physics/dynamics2d/params.hpp"
#include "core/physics/wheels.hpp"
#include "core/physics/world_memory.hpp"
#include "core/space/object_index.hpp"
#include "hal/check.hpp"
#include "hal/rounded.hpp"

namespace tandem::core {
namespace {

using box2d::Params;

// Box2D's tolerances are lengths of its own unit: what is 1 m to it allows 5 mm of overlap and looks 10 cm around every
// body. Ten units a metre suit robots of some centimetres.
constexpr double kUnits_m = 10.0;
constexpr float kUnits = static_cast<float>(kUnits_m);

constexpr double kTouchMargin_m = 0.05;        // around a region: immovable objects so near stand in it
constexpr double kLargestHop = 0.5;            // of one sub-step, in body radii: nothing is jumped over
constexpr double kMostOfBox2dsHop = 0.99;      // Box2D silently cuts faster bodies to one hop a sub-step
constexpr double kLongestLead_m = 0.2;         // in a tick, of a body that is led; farther away it is put
constexpr float kRest = 0.5F * b2_linearSlop;  // how deep bodies rest in one another: Box2D then sees that they touch
constexpr double kSamePlace_m = 1e-5;
constexpr double kFarthest_m = 1e6;       // from where Box2D's floats still tell places apart, somehow
constexpr double kThinnest_m = 1e-4;      // of a movable object: smaller areas than its square are none to Box2D
constexpr double kSmallest_m = 0.005;     // radius below which hops are not made smaller
constexpr double kLargestTurn_rad = 1.0;  // of an object in one sub-step
constexpr double kMostHops = 200.0;       // sub-steps a tick for the sake of fast objects
constexpr double kHoldingStep_s = 0.025;  // with longer ones, Box2D's passes leave joints and what is squeezed cm apart
constexpr float kLinearSlowing = 1.0F;    // correction factor of a drive: all of the error within one sub-step

/// A body's double in Box2D.
struct BodyProxy {
  b2Body* body = nullptr;
  b2Joint* hold = nullptr;  ///< to the ground: a movable object's friction, or a robot's drive while it pushes
  // The state in the stores that the double agrees with.
  double x_m = NAN, y_m = NAN, cos_h = 0.0, sin_h = 0.0, vx_m_s = 0.0, vy_m_s = 0.0, w_rad_s = 0.0;
  double turn_rad = 0.0;  ///< of a robot that pushes nothing: in this sub-step, by its wheels
  bool unfit = false;     ///< Box2D cannot have it at all
  bool flawed = false;    ///< takes no part in this tick: unfit, or its state is no number that Box2D can have

  void turn_to(float angle_rad) noexcept {
    cos_h = std::cos(static_cast<double>(angle_rad));
    sin_h = std::sin(static_cast<double>(angle_rad));
  }
};

/// Cosine and sine of a heading.
struct Heading {
  double cos_h, sin_h;
};

/// A heading turned by d rad: by series that are exact to 1e-13 where a robot's turns within a sub-step are.
Heading turned(Heading h, double d) noexcept {
  double c = 0.0;
  double s = 0.0;
  if (std::fabs(d) < 0.5) {
    const double d2 = d * d;
    s = d * (1.0 - d2 * (1.0 / 6 - d2 * (1.0 / 120 - d2 * (1.0 / 5040 - d2 * (1.0 / 362880 - d2 / 39916800.0)))));
    c = 1.0 - d2 * (0.5 - d2 * (1.0 / 24 - d2 * (1.0 / 720 - d2 * (1.0 / 40320 - d2 / 3628800.0))));
  } else {
    c = std::cos(d);
    s = std::sin(d);
  }
  return {h.cos_h * c - h.sin_h * s, h.sin_h * c + h.cos_h * s};
}

/// Chord of an arc, in parts of its length.
double chord_of(double half_turn_rad) noexcept {
  const double half2 = half_turn_rad * half_turn_rad;
  return 1.0 - half2 / 6.0 * (1.0 - half2 / 20.0 * (1.0 - half2 / 42.0));
}

/// Mean distance of an object's footprint from its centre: the lever of friction against turning.
double mean_radius_m(const Object& o) noexcept {
  if (o.kind == Object::Kind::Cylinder) return 2.0 / 3.0 * o.radius_m;
  const double p = o.half_x_m;
  const double q = o.half_y_m;
  const double d = std::hypot(p, q);
  return d / 3.0 + (p * p / q * std::log((q + d) / p) + q * q / p * std::log((p + d) / q)) / 6.0;
}

/// Of the largest disc in an object's footprint.
double inner_radius_m(const Object& o) noexcept {
  return o.kind == Object::Kind::Cylinder ? o.radius_m : std::min(o.half_x_m, o.half_y_m);
}

/// `rad` plus the whole turns that bring it nearest to `near_rad`: Box2D's joints compare angles that count turns.
float nearest_turn(double rad, float near_rad) noexcept {
  const auto near = static_cast<double>(near_rad);
  return static_cast<float>(near + std::remainder(rad - near, 2.0 * M_PI));
}

/// Why a body cannot take part in a tick; null when it can.
const char* flaw_of(const SpaceStores& s, BodyKey key) noexcept {
  const std::size_t i = key.index();
  const bool object = key.is_object();
  const Motion& m = object ? s.object_motion[i] : s.bodies.motion[i];
  const std::array values{object ? s.objects[i].x_m : s.bodies.x_m[i],
                          object ? s.objects[i].y_m : s.bodies.y_m[i],
                          object ? s.objects[i].cos_h : s.bodies.cos_h[i],
                          object ? s.objects[i].sin_h : s.bodies.sin_h[i],
                          object ? 0.0 : s.bodies.left_m_s[i],
                          object ? 0.0 : s.bodies.right_m_s[i],
                          m.v_m_s[0],
                          m.v_m_s[1],
                          m.w_rad_s[2]};
  const auto all = [&](auto fits) { return std::all_of(values.begin(), values.end(), fits); };
  if (all([](double value) { return std::fabs(value) <= kFarthest_m; })) return nullptr;
  return all([](double value) { return std::isfinite(value); })
             ? "is farther away, or faster, than its engine can follow"
             : "has a position or speed that is not a finite number";
}

std::string unfit(const Object& o) {
  const bool round = o.kind == Object::Kind::Cylinder;
  return beyond_limits("dynamics2d", o,
                       {2.0 * (round ? o.radius_m : o.half_x_m), 2.0 * (round ? o.radius_m : o.half_y_m)}, kThinnest_m);
}

class Dynamics2d final : public Solver {
 public:
  Dynamics2d(const Params& params, const SpaceStores& stores)
      : params_(params),
        origin_x_m_(0.5 * (stores.min_x_m + stores.max_x_m)),
        origin_y_m_(0.5 * (stores.min_y_m + stores.max_y_m)) {}

  void load(const SolverContext& context) override {
    const WorldMemory::Use use(&memory_);
    const SpaceStores& s = context.stores;
    if (world_ == nullptr) make_world();
    if (version_ != s.immovables_version) place_immovables(context);
    bodies_table_.update(
        context.region, s, [&](BodyKey key) { return make(s, key); }, [this](BodyProxy& proxy) { drop(proxy); });
    hops_ = 0.0;
    std::uintptr_t number = 0;
    for (auto& entry : bodies_table_.entries()) {
      BodyProxy& proxy = entry.body;
      proxy.body->GetUserData().pointer = number++;
      proxy.flawed = proxy.unfit || flaw_of(s, entry.key) != nullptr;
      if (proxy.body->IsEnabled() == proxy.flawed) proxy.body->SetEnabled(!proxy.flawed);
      if (proxy.flawed)
        leave_out(s, entry.key, entry.owned, proxy);
      else
        take_over(s, entry.key, entry.owned, proxy, context.tick_s);
    }
    if (std::exchange(crowds_moved, false)) world_->Step(0.0F, 1, 1);  // moves nothing: what touches what, now
    if (!s.joints.empty() || !joints_.empty()) join(s);
  }

  void advance(const SolverContext& context) override {
    const WorldMemory::Use use(&memory_);
    SpaceStores& s = context.stores;
    const int steps = sub_steps(s, context.tick_s);
    const double dt = context.tick_s / steps;
    auto& entries = bodies_table_.entries();
    for (int step = 0; step < steps; ++step) {
      for (auto& entry : entries) steer(s, entry, dt);
      brake(static_cast<float>(dt));
      world_->Step(static_cast<float>(dt), static_cast<int>(params_.velocity_iterations),
                   static_cast<int>(params_.position_iterations));
      for (auto& entry : entries) {
        BodyProxy& proxy = entry.body;
        if (entry.key.is_object() || proxy.hold == nullptr || proxy.body->GetType() != b2_dynamicBody) continue;
        proxy.turn_to(proxy.body->GetAngle());  // which Box2D also corrects
      }
    }
    overlap = deepest_overlap();
    for (auto& entry : entries) write_back(s, entry, context.tick_s, dt);
  }

  bool remember(hal::Archive& archive) override {
    if (archive.reads()) know_contacts();
    if (!memory_.remember(archive, world_, anchor_, immovable_)) return false;
    archive(placed_, crowds_moved);
    bodies_table_.remember(archive, [&](BodyProxy& b) {
      memory_.remember_pointer(archive, b.body);
      memory_.remember_pointer(archive, b.hold);
      archive(b.x_m, b.y_m, b.cos_h, b.sin_h, b.vx_m_s, b.vy_m_s, b.w_rad_s, b.turn_rad, b.unfit, b.flawed);
    });
    std::uint64_t joints = joints_.size();
    archive(joints);
    if (archive.reads()) joints_.clear();
    for (std::uint64_t i = 0; i < joints && archive.ok(); ++i) {
      if (archive.reads()) joints_.emplace_back();
      archive(joints_[i].number, joints_[i].generation);
      memory_.remember_pointer(archive, joints_[i].joint);
    }
    if (archive.reads()) version_ = 0;  // looks whether they are those that stand there
    return true;
  }

 private:
  using Entry = BodyTable<BodyProxy>::Entry;
  struct Held {
    std::size_t number;
    std::uint32_t generation;
    b2Joint* joint;
  };
  /// An immovable object as it stands in Box2D.
  struct Placed {
    Object::Kind kind;
    std::array<double, 7> shape;
    friend bool operator==(const Placed&, const Placed&) = default;
  };

  b2Vec2 at(double x_m, double y_m) const noexcept {
    return {static_cast<float>((x_m - origin_x_m_) * kUnits_m), static_cast<float>((y_m - origin_y_m_) * kUnits_m)};
  }
  static b2Vec2 speed(double vx_m_s, double vy_m_s) noexcept {
    return {static_cast<float>(vx_m_s * kUnits_m), static_cast<float>(vy_m_s * kUnits_m)};
  }

  // --- the world ---

  /// Box2D's table of kinds of contacts, which it fills when the first touch: those that were read have touched.
  static void know_contacts() {
    WorldMemory memory;
    const WorldMemory::Use use(&memory);
    auto* const world = new (memory.allocate(sizeof(b2World))) b2World(b2Vec2(0.0F, 0.0F));  // goes with its memory
    b2CircleShape circle;
    circle.m_radius = 1.0F;
    b2BodyDef def;
    world->CreateBody(&def)->CreateFixture(&circle, 1.0F);
    def.type = b2_dynamicBody;
    world->CreateBody(&def)->CreateFixture(&circle, 1.0F);
    world->Step(0.01F, 1, 1);
  }

  void make_world() {
    world_ = new (memory_.allocate(sizeof(b2World))) b2World(b2Vec2(0.0F, 0.0F));  // goes with its memory
    TANDEM_CHECK(memory_.blocks() > 1, "Box2D must take its memory from the engine");
    world_->SetAllowSleeping(false);
    world_->SetContinuousPhysics(false);  // nothing moves far enough in a sub-step
    b2BodyDef def;
    anchor_ = world_->CreateBody(&def);
    version_ = 0;
  }

  /// Those that stand as they stood are left alone, with what touches them.
  void place_immovables(const SolverContext& context) {
    version_ = context.stores.immovables_version;
    std::vector<const Object*> here;
    std::vector<Placed> wanted;
    for (const Object& o : context.stores.objects) {
      if (!o.alive || o.movable || !context.region.touches(o, kTouchMargin_m + context.stores.border_reach_m)) continue;
      here.push_back(&o);
      wanted.push_back({o.kind, {o.x_m, o.y_m, o.cos_h, o.sin_h, o.half_x_m, o.half_y_m, o.radius_m}});
    }
    if (immovable_ != nullptr && wanted == placed_) return;
    placed_ = std::move(wanted);
    if (immovable_ != nullptr) world_->DestroyBody(immovable_);
    b2BodyDef def;
    immovable_ = world_->CreateBody(&def);
    for (const Object* o : here) add_fixture(immovable_, *o, true, 0.0F);
    const auto& sides = context.region.sides;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      if (!sides[i].wall) continue;
      const RegionSide& b = sides[(i + 1) % sides.size()];
      b2EdgeShape edge;
      edge.SetTwoSided(at(sides[i].x_m, sides[i].y_m), at(b.x_m, b.y_m));
      b2FixtureDef fixture;
      fixture.shape = &edge;
      fixture.friction = static_cast<float>(params_.friction);
      immovable_->CreateFixture(&fixture);
    }
  }

  /// `placed`: the shape lies at the object's pose; else at the body's origin.
  void add_fixture(b2Body* body, const Object& o, bool placed, float density) const {
    b2FixtureDef fixture;
    fixture.density = density;
    fixture.friction = static_cast<float>(params_.friction);
    b2CircleShape circle;
    b2PolygonShape box;
    if (o.kind == Object::Kind::Cylinder) {
      circle.m_radius = static_cast<float>(o.radius_m * kUnits_m);
      if (placed) circle.m_p = at(o.x_m, o.y_m);
      fixture.shape = &circle;
    } else {
      const auto hx = static_cast<float>(o.half_x_m * kUnits_m);
      const auto hy = static_cast<float>(o.half_y_m * kUnits_m);
      if (placed)
        box.SetAsBox(hx, hy, at(o.x_m, o.y_m), static_cast<float>(std::atan2(o.sin_h, o.cos_h)));
      else
        box.SetAsBox(hx, hy);
      fixture.shape = &box;
    }
    body->CreateFixture(&fixture);
  }

  // --- doubles ---

  BodyProxy make(const SpaceStores& s, BodyKey key) {
    BodyProxy proxy;
    b2BodyDef def;
    def.allowSleep = false;
    def.type = b2_dynamicBody;
    const std::size_t i = key.index();
    const bool placed = flaw_of(s, key) == nullptr;
    if (key.is_object()) {
      const Object& o = s.objects[i];
      if (placed) def.position = at(o.x_m, o.y_m);
      if (placed) def.angle = static_cast<float>(std::atan2(o.sin_h, o.cos_h));
      proxy.body = world_->CreateBody(&def);
      proxy.unfit = !unfit(o).empty();
      if (proxy.unfit) return proxy;
      const double area =
          o.kind == Object::Kind::Cylinder ? M_PI * o.radius_m * o.radius_m : 4 * o.half_x_m * o.half_y_m;
      add_fixture(proxy.body, o, false, static_cast<float>(o.mass_kg / (area * kUnits_m * kUnits_m)));
      const bool round = o.kind == Object::Kind::Cylinder;
      const double force = round ? params_.cylinder_linear_friction : params_.box_linear_friction;  // per kg
      const double torque = round ? params_.cylinder_angular_friction : params_.box_angular_friction;
      b2FrictionJointDef rub;
      rub.bodyA = anchor_;
      rub.bodyB = proxy.body;
      rub.collideConnected = true;
      rub.maxForce = static_cast<float>(o.mass_kg * force * kUnits_m);
      rub.maxTorque =
          static_cast<float>(o.mass_kg * (torque < 0.0 ? force * mean_radius_m(o) : torque) * kUnits_m * kUnits_m);
      proxy.hold = world_->CreateJoint(&rub);
    } else {
      const hal::RobotKind& kind = s.kind_of_row(i);
      if (placed) def.position = at(s.bodies.x_m[i], s.bodies.y_m[i]);
      if (placed) def.angle = static_cast<float>(std::atan2(s.bodies.sin_h[i], s.bodies.cos_h[i]));
      proxy.body = world_->CreateBody(&def);
      b2CircleShape disc;
      disc.m_radius = s.bodies.radius_m[i] * kUnits;
      b2FixtureDef fixture;
      fixture.shape = &disc;
      fixture.friction = static_cast<float>(params_.friction);
      fixture.density = static_cast<float>(kind.body.mass_kg) / (b2_pi * disc.m_radius * disc.m_radius);
      proxy.body->CreateFixture(&fixture);
      proxy.body->SetFixedRotation(true);
    }
    return proxy;
  }

  void drop(BodyProxy& proxy) {
    if (proxy.body == nullptr) return;
    // Joints between bodies go with either of them.
    std::erase_if(joints_, [&](const Held& held) {
      return held.joint->GetBodyA() == proxy.body || held.joint->GetBodyB() == proxy.body;
    });
    world_->DestroyBody(proxy.body);
    proxy.body = nullptr;
  }

  /// Box2D ends the process over what is no number.
  void leave_out(const SpaceStores& s, BodyKey key, bool owned, BodyProxy& proxy) {
    proxy.x_m = NAN;  // placed anew when it is sound again
    proxy.vx_m_s = NAN;
    if (owned) trouble.push_back({key, proxy.unfit ? unfit(s.objects[key.index()]) : flaw_of(s, key)});
  }

  void take_over(const SpaceStores& s, BodyKey key, bool owned, BodyProxy& proxy, double tick_s) {
    const std::size_t i = key.index();
    const bool object = key.is_object();
    const double x = object ? s.objects[i].x_m : s.bodies.x_m[i];
    const double y = object ? s.objects[i].y_m : s.bodies.y_m[i];
    const double c = object ? s.objects[i].cos_h : s.bodies.cos_h[i];
    const double h = object ? s.objects[i].sin_h : s.bodies.sin_h[i];
    const Motion& m = object ? s.object_motion[i] : s.bodies.motion[i];
    if (!object && (s.bodies.flags[i] & kExternal) != 0) {
      lead(proxy, x, y, c, h, tick_s);
      return;
    }
    if (proxy.body->GetType() != b2_dynamicBody) proxy.body->SetType(b2_dynamicBody);
    if (x != proxy.x_m || y != proxy.y_m || c != proxy.cos_h || h != proxy.sin_h) {
      const bool put_there = owned && std::isfinite(proxy.x_m);  // by a hook: else it is new, or mirrored
      proxy.body->SetTransform(at(x, y), nearest_turn(std::atan2(h, c), proxy.body->GetAngle()));
      if (put_there) part_from_proxies(proxy, key);
      proxy.x_m = x;
      proxy.y_m = y;
      proxy.cos_h = c;
      proxy.sin_h = h;
    }
    if (m.v_m_s[0] != proxy.vx_m_s || m.v_m_s[1] != proxy.vy_m_s || m.w_rad_s[2] != proxy.w_rad_s) {
      proxy.vx_m_s = m.v_m_s[0];
      proxy.vy_m_s = m.v_m_s[1];
      proxy.w_rad_s = m.w_rad_s[2];
      proxy.body->SetLinearVelocity(speed(proxy.vx_m_s, proxy.vy_m_s));
      proxy.body->SetAngularVelocity(static_cast<float>(proxy.w_rad_s));
    }
    if (!object) return;
    const double reach_m = kLargestHop * std::max(inner_radius_m(s.objects[i]), kSmallest_m);
    hops_ = std::max({hops_, std::hypot(proxy.vx_m_s, proxy.vy_m_s) * tick_s / reach_m,
                      std::fabs(proxy.w_rad_s) * tick_s / kLargestTurn_rad});
  }

  /// A body whose pose comes from outside moves there within the tick, so that others are pushed and not jumped upon.
  void lead(BodyProxy& proxy, double x_m, double y_m, double cos_h, double sin_h, double tick_s) {
    if (proxy.body->GetType() != b2_kinematicBody) proxy.body->SetType(b2_kinematicBody);
    const b2Vec2 there = at(x_m, y_m);
    const b2Vec2 way = there - proxy.body->GetPosition();
    const bool jumps = !std::isfinite(proxy.x_m) || way.Length() > kUnits * static_cast<float>(kLongestLead_m);
    const float angle = nearest_turn(std::atan2(sin_h, cos_h), proxy.body->GetAngle());
    if (jumps) proxy.body->SetTransform(there, angle);
    const float per_s = 1.0F / static_cast<float>(tick_s);
    proxy.body->SetLinearVelocity(jumps ? b2Vec2(0.0F, 0.0F) : per_s * way);
    proxy.body->SetAngularVelocity(per_s * (angle - proxy.body->GetAngle()));
    proxy.x_m = x_m;
    proxy.y_m = y_m;
    proxy.cos_h = cos_h;
    proxy.sin_h = sin_h;
  }

  /// Box2D cannot tell in which direction two discs with one centre are to part: the one just put there gives way a
  /// little, in a direction of its own.
  void part_from_proxies(BodyProxy& proxy, BodyKey key) {
    struct Finder final : b2QueryCallback {
      b2Body* self = nullptr;
      bool found = false;
      bool ReportFixture(b2Fixture* fixture) override {
        const b2Body* other = fixture->GetBody();
        found = other != self && other->GetType() == b2_dynamicBody &&
                (other->GetPosition() - self->GetPosition()).Length() < static_cast<float>(kSamePlace_m * kUnits_m);
        return !found;
      }
    } finder;
    finder.self = proxy.body;
    const b2Vec2 p = proxy.body->GetPosition();
    world_->QueryAABB(&finder, {p, p});
    if (!finder.found) return;
    const auto direction = static_cast<float>(key.value);
    const auto step = static_cast<float>(kSamePlace_m * kUnits_m);
    proxy.body->SetTransform(p + b2Vec2(step * std::cos(direction), step * std::sin(direction)),
                             proxy.body->GetAngle());
  }

  BodyProxy* find(BodyKey key) noexcept {
    auto& entries = bodies_table_.entries();
    const auto found = std::lower_bound(entries.begin(), entries.end(), key,
                                        [](const auto& entry, BodyKey wanted) { return entry.key < wanted; });
    return found != entries.end() && found->key == key ? &found->body : nullptr;
  }

  void join(const SpaceStores& s) {
    std::erase_if(joints_, [&](const Held& held) {
      const Joint& joint = s.joints[held.number];
      if (joint.alive && joint.generation == held.generation) return false;
      world_->DestroyJoint(held.joint);
      return true;
    });
    for (std::size_t i = 0; i < s.joints.size(); ++i) {
      const Joint& joint = s.joints[i];
      const bool held = std::any_of(joints_.begin(), joints_.end(), [&](const Held& h) { return h.number == i; });
      if (!joint.alive || held) continue;
      const BodyProxy* a = find(joint.a);
      const BodyProxy* b = find(joint.b);
      if (a == nullptr || b == nullptr || a->flawed || b->flawed) continue;
      for (const BodyProxy* proxy : {a, b})  // robots that push nothing turn in doubles alone
        proxy->body->SetTransform(proxy->body->GetPosition(),
                                  nearest_turn(std::atan2(proxy->sin_h, proxy->cos_h), proxy->body->GetAngle()));
      joints_.push_back({i, joint.generation, make_joint(joint, a->body, b->body)});
    }
    for (const Held& held : joints_) {
      const JointForm& form = s.joints[held.number].form;
      if (!(form.motor_most > 0.0)) continue;
      if (form.kind == JointKind::Turning)
        static_cast<b2RevoluteJoint*>(held.joint)->SetMotorSpeed(static_cast<float>(form.motor_speed));
      else if (held.joint->GetType() == e_prismaticJoint)
        static_cast<b2PrismaticJoint*>(held.joint)->SetMotorSpeed(static_cast<float>(form.motor_speed * kUnits_m));
    }
  }

  b2Joint* make_joint(const Joint& joint, b2Body* a, b2Body* b) {
    const auto make = [&](auto& def) {
      def.bodyA = a;
      def.bodyB = b;
      def.localAnchorA.Set(static_cast<float>(joint.ax_m * kUnits_m), static_cast<float>(joint.ay_m * kUnits_m));
      def.localAnchorB.Set(static_cast<float>(joint.bx_m * kUnits_m), static_cast<float>(joint.by_m * kUnits_m));
      return world_->CreateJoint(&def);
    };
    const JointForm& form = joint.form;
    const float turned = b->GetAngle() - a->GetAngle();
    if (form.kind == JointKind::Turning) {
      b2RevoluteJointDef def;
      if (form.limited) {  // counted from where the two have one heading, by whichever turns are between them
        def.referenceAngle = nearest_turn(0.0, turned);
        def.enableLimit = true;
        // Of narrower ranges Box2D holds the lower end alone: the middle is nearer to what was asked.
        const bool narrow = form.high - form.low < 2.0 * static_cast<double>(b2_angularSlop);
        def.lowerAngle = static_cast<float>(narrow ? 0.5 * (form.low + form.high) : form.low);
        def.upperAngle = narrow ? def.lowerAngle : static_cast<float>(form.high);
      }
      def.enableMotor = form.motor_most > 0.0;
      def.maxMotorTorque = static_cast<float>(form.motor_most * kUnits_m * kUnits_m);
      return make(def);
    }
    const double level = std::hypot(form.axis[0], form.axis[1]);
    if (form.kind == JointKind::Sliding && level > 0.0) {
      b2PrismaticJointDef def;
      def.localAxisA.Set(static_cast<float>(form.axis[0] / level), static_cast<float>(form.axis[1] / level));
      def.referenceAngle = nearest_turn(joint.heading_rad, turned);
      def.enableLimit = form.limited;
      def.lowerTranslation = static_cast<float>(form.low * kUnits_m);
      def.upperTranslation = static_cast<float>(form.high * kUnits_m);
      def.enableMotor = form.motor_most > 0.0;
      def.maxMotorForce = static_cast<float>(form.motor_most * kUnits_m);
      return make(def);
    }
    b2WeldJointDef def;
    def.referenceAngle = nearest_turn(joint.heading_rad, turned);
    return make(def);
  }

  // --- one tick ---

  int sub_steps(const SpaceStores& s, double tick_s) const noexcept {
    if (params_.iterations > 0) return static_cast<int>(params_.iterations);
    double hop = std::min(hops_, kMostHops);
    if (!joints_.empty() || any_squeezed()) hop = std::max(hop, tick_s / kHoldingStep_s);
    for (const RobotGroup& group : s.groups) {
      if (group.kind == nullptr) continue;
      const hal::DifferentialDrive& wheels = wheels_of(*group.kind);
      double most_m_s = wheels.limited() ? wheels.max_speed_m_s : 0.0;
      for (std::size_t i = 0; !wheels.limited() && i < group.blocks.size(); ++i)
        most_m_s = std::max(most_m_s, top_wheel_m_s(s, s.blocks[group.blocks[i]]));
      hop = std::max(hop, most_m_s * tick_s / (kLargestHop * group.kind->body.radius_m));
    }
    return static_cast<int>(std::clamp(std::ceil(hop), 1.0, static_cast<double>(box2d::kMostSubSteps)));
  }

  /// Whether an object has a robot and something else near it, which may squeeze it.
  bool any_squeezed() const {
    const auto& entries = bodies_table_.entries();
    for (auto entry = entries.rbegin(); entry != entries.rend() && entry->key.is_object(); ++entry) {  // after robots
      if (entry->body.flawed) continue;
      const b2ContactEdge* const first = entry->body.body->GetContactList();
      if (first == nullptr || first->next == nullptr) continue;
      for (const b2ContactEdge* edge = first; edge != nullptr; edge = edge->next) {
        if (is_robot(edge->other)) return true;
      }
    }
    return false;
  }

  /// Whether a robot pushes something that a drive must hold its own against: an object, or a robot that pushes.
  static bool pushes(const BodyProxy& proxy) noexcept {
    for (const b2ContactEdge* edge = proxy.body->GetContactList(); edge != nullptr; edge = edge->next) {
      if (!edge->contact->IsTouching() || edge->other->GetType() != b2_dynamicBody) continue;
      if (edge->other->GetJointList() != nullptr) return true;
    }
    return false;
  }

  /// Gives a robot the velocity that its wheels command, as far as their force goes.
  void steer(const SpaceStores& s, Entry& entry, double dt) {
    if (entry.key.is_object() || entry.body.flawed) return;
    const std::size_t row = entry.key.index();
    if ((s.bodies.flags[row] & kExternal) != 0) return;
    BodyProxy& proxy = entry.body;
    const hal::RobotKind& kind = s.kind_of_row(row);
    const hal::DifferentialDrive& wheels = wheels_of(kind);
    const double turn = (s.bodies.right_m_s[row] - s.bodies.left_m_s[row]) / wheels.wheel_base_m * dt;
    const double way = 0.5 * (s.bodies.left_m_s[row] + s.bodies.right_m_s[row]) * dt;
    // The chord of the arc: its direction is the heading in the middle, its length a little less than the arc's.
    const double chord = way * chord_of(0.5 * turn);
    const Heading start{proxy.cos_h, proxy.sin_h};
    const Heading middle = turned(start, 0.5 * turn);
    const double dx = chord * middle.cos_h;
    const double dy = chord * middle.sin_h;
    if (pushes(proxy) || holds(proxy)) {
      drive(proxy, wheels, dx, dy, turn, std::atan2(start.sin_h, start.cos_h));
      return;
    }
    if (proxy.hold != nullptr) {
      world_->DestroyJoint(proxy.hold);
      proxy.hold = nullptr;
      proxy.body->SetFixedRotation(true);
    }
    // The wheels hold the heading against whatever the disc rubs on.
    proxy.turn_rad = turn;
    const auto [cos_h, sin_h] = turned(start, turn);
    proxy.cos_h = cos_h;
    proxy.sin_h = sin_h;
    const auto most = static_cast<float>(wheels.force_N / kind.body.mass_kg * dt * kUnits_m);
    b2Vec2 change = speed(dx / dt, dy / dt) - proxy.body->GetLinearVelocity();
    const float length = change.Length();
    if (length > most) change *= most / length;
    proxy.body->SetLinearVelocity(proxy.body->GetLinearVelocity() + change);
  }

  /// Slows robots so that they do not run into what they near within the sub-step. Box2D sees a contact only when
  /// bodies overlap already, which at some steps a second is deep; so robots stop at one another's rims, each losing
  /// what it contributes to the approach. Movable objects are not braked for: they are to be pushed.
  void brake(float dt_s) {
    braking_.assign(bodies_table_.entries().size(), b2Vec2_zero);
    for (b2Contact* c = world_->GetContactList(); c != nullptr; c = c->GetNext()) {
      if (c->IsTouching()) continue;
      add_braking(*c->GetFixtureA(), *c->GetFixtureB(), dt_s);
      add_braking(*c->GetFixtureB(), *c->GetFixtureA(), dt_s);
    }
    for (b2Contact* c = world_->GetContactList(); c != nullptr; c = c->GetNext()) {
      for (b2Body* body : {c->GetFixtureA()->GetBody(), c->GetFixtureB()->GetBody()}) {
        if (body->GetType() != b2_dynamicBody) continue;  // those that stand have no number
        b2Vec2& loss = braking_[body->GetUserData().pointer];
        if (loss.LengthSquared() > 0.0F) body->SetLinearVelocity(body->GetLinearVelocity() - loss);
        loss.SetZero();
      }
    }
  }

  /// What a robot loses because of one body that it nears.
  void add_braking(b2Fixture& own, const b2Fixture& other, float dt_s) {
    const b2Body* const body = own.GetBody();
    const b2Body* const with = other.GetBody();
    if (!is_robot(body) || entry_of(body).body.hold != nullptr || body->GetType() != b2_dynamicBody) return;
    if (with->GetType() == b2_dynamicBody && !is_robot(with)) return;
    b2Vec2 normal;
    const float gap =
        gap_between(*own.GetShape(), body->GetTransform(), *other.GetShape(), with->GetTransform(), normal);
    if (gap <= 0.0F) return;
    const b2Vec2 v = body->GetLinearVelocity();
    const float towards = std::max(0.0F, b2Dot(v, normal));
    const float other_towards = std::max(0.0F, -b2Dot(with->GetLinearVelocity(), normal));
    const float excess = b2Dot(v - with->GetLinearVelocity(), normal) - (gap + kRest) / dt_s;
    if (excess <= 0.0F || towards <= 0.0F) return;
    braking_[own.GetBody()->GetUserData().pointer] += excess * towards / (towards + other_towards) * normal;
  }

  /// Between a disc and another shape; `normal` is the unit vector from the disc to it.
  static float gap_between(const b2Shape& disc, const b2Transform& at_disc, const b2Shape& other,
                           const b2Transform& at_other, b2Vec2& normal) {
    if (other.GetType() == b2Shape::e_circle) {
      const auto& round = static_cast<const b2CircleShape&>(other);
      normal = b2Mul(at_other, round.m_p) - at_disc.p;
      const float distance = normal.Normalize();
      return distance - disc.m_radius - round.m_radius;
    }
    b2DistanceInput input;
    input.proxyA.Set(&disc, 0);
    input.proxyB.Set(&other, 0);
    input.transformA = at_disc;
    input.transformB = at_other;
    input.useRadii = false;
    b2SimplexCache cache;
    cache.count = 0;
    b2DistanceOutput output;
    b2Distance(&output, &cache, &input);
    normal = output.pointB - output.pointA;
    normal.Normalize();
    return output.distance - disc.m_radius - other.m_radius;
  }

  // --- crowds ---

  const Entry& entry_of(const b2Body* body) const {
    return bodies_table_.entries()[const_cast<b2Body*>(body)->GetUserData().pointer];
  }
  /// Else it is an object's, or that of all immovable ones.
  bool is_robot(const b2Body* body) const {
    return body != immovable_ && body != anchor_ && !entry_of(body).key.is_object();
  }

  /// Of two own robots, at the end of the last sub-step.
  double deepest_overlap() const {
    double deepest = 0.0;
    for (const b2Contact* c = world_->GetContactList(); c != nullptr; c = c->GetNext()) {
      const b2Fixture* const one = c->GetFixtureA();
      const b2Fixture* const other = c->GetFixtureB();
      if (one->GetType() != b2Shape::e_circle || other->GetType() != b2Shape::e_circle) continue;
      const float touch = one->GetShape()->m_radius + other->GetShape()->m_radius;
      const b2Vec2 way = one->GetBody()->GetPosition() - other->GetBody()->GetPosition();
      if (way.LengthSquared() >= touch * touch || !is_robot(one->GetBody()) || !is_robot(other->GetBody())) continue;
      if (!entry_of(one->GetBody()).owned || !entry_of(other->GetBody()).owned) continue;
      const auto depth = static_cast<double>(touch - way.Length());
      deepest = std::max(deepest, CrowdPasses::overlap(depth, static_cast<double>(one->GetShape()->m_radius),
                                                       static_cast<double>(other->GetShape()->m_radius)));
    }
    return deepest;
  }

  /// Whether a robot is joined to something.
  static bool holds(const BodyProxy& proxy) noexcept {
    for (const b2JointEdge* edge = proxy.body->GetJointList(); edge != nullptr; edge = edge->next) {
      if (edge->joint != proxy.hold) return true;
    }
    return false;
  }

  /// The drive as a joint to the ground: its force is part of what Box2D solves, so pushing against a load is exact.
  void drive(BodyProxy& proxy, const hal::DifferentialDrive& wheels, double dx_m, double dy_m, double turn_rad,
             double heading_rad) {
    const b2Vec2 target = proxy.body->GetPosition() + speed(dx_m, dy_m);
    const float angle = proxy.body->GetAngle() + static_cast<float>(turn_rad);
    if (proxy.hold == nullptr) {
      b2MotorJointDef def;
      def.bodyA = anchor_;
      def.bodyB = proxy.body;
      def.collideConnected = true;
      def.maxForce = static_cast<float>(wheels.force_N * kUnits_m);
      def.maxTorque = static_cast<float>(wheels.torque_Nm * kUnits_m * kUnits_m);
      def.correctionFactor = kLinearSlowing;
      proxy.hold = world_->CreateJoint(&def);
      proxy.body->SetFixedRotation(false);
      proxy.body->SetTransform(proxy.body->GetPosition(), nearest_turn(heading_rad, proxy.body->GetAngle()));
    }
    auto* motor = static_cast<b2MotorJoint*>(proxy.hold);
    motor->SetLinearOffset(target);
    motor->SetAngularOffset(angle);
  }

  /// Box2D moves a robot along the chord of its last sub-step; at the end of the arc it goes another way, and faster.
  static void end_of_arc(BodyProxy& proxy, double dt) noexcept {
    const double half = 0.5 * proxy.w_rad_s * dt;
    if (half == 0.0) return;
    const double shorter = chord_of(half);
    const Heading v = turned({proxy.vx_m_s / shorter, proxy.vy_m_s / shorter}, half);
    proxy.vx_m_s = v.cos_h;
    proxy.vy_m_s = v.sin_h;
  }

  void write_back(SpaceStores& s, Entry& entry, double tick_s, double dt) {
    BodyProxy& proxy = entry.body;
    if (proxy.flawed) return;
    const b2Vec2 p = proxy.body->GetPosition();
    const b2Vec2 v = proxy.body->GetLinearVelocity();
    const bool driven = !entry.key.is_object() && proxy.hold == nullptr;
    const auto w = driven ? static_cast<float>(proxy.turn_rad / dt) : proxy.body->GetAngularVelocity();
    const double vx = static_cast<double>(v.x) / kUnits_m;
    const double vy = static_cast<double>(v.y) / kUnits_m;
    const bool finite = std::isfinite(static_cast<double>(p.x) + static_cast<double>(p.y) + vx + vy +
                                      static_cast<double>(w));  // sums of so few floats are within a double
    const double hop = kMostOfBox2dsHop * static_cast<double>(b2_maxTranslation) / (kUnits_m * dt);  // in m/s
    if (!finite || vx * vx + vy * vy > hop * hop) {
      if (entry.owned)
        trouble.push_back({entry.key, finite ? "moves faster than its engine can follow (" +
                                                   hal::rounded(std::hypot(vx, vy)) + " m/s)"
                                             : "has a position or speed that is not a finite number"});
      return;
    }
    const std::size_t i = entry.key.index();
    const bool object = entry.key.is_object();
    if (!object && (s.bodies.flags[i] & kExternal) != 0) return;
    proxy.x_m = origin_x_m_ + static_cast<double>(p.x) / kUnits_m;
    proxy.y_m = origin_y_m_ + static_cast<double>(p.y) / kUnits_m;
    proxy.vx_m_s = vx;
    proxy.vy_m_s = vy;
    proxy.w_rad_s = static_cast<double>(w);
    if (object) {
      proxy.turn_to(proxy.body->GetAngle());
    } else {
      end_of_arc(proxy, dt);
      const double k = 1.5 - 0.5 * (proxy.cos_h * proxy.cos_h + proxy.sin_h * proxy.sin_h);
      proxy.cos_h *= k;  // one Newton step keeps the heading a unit vector
      proxy.sin_h *= k;
    }
    if (!entry.owned) return;
    Motion& m = object ? s.object_motion[i] : s.bodies.motion[i];
    m.v_m_s = {proxy.vx_m_s, proxy.vy_m_s, 0.0};
    m.w_rad_s = {0.0, 0.0, proxy.w_rad_s};
    if (object) {
      Object& o = s.objects[i];
      o.x_m = proxy.x_m;
      o.y_m = proxy.y_m;
      o.cos_h = proxy.cos_h;
      o.sin_h = proxy.sin_h;
    } else {
      s.bodies.x_m[i] = proxy.x_m;
      s.bodies.y_m[i] = proxy.y_m;
      s.bodies.cos_h[i] = proxy.cos_h;
      s.bodies.sin_h[i] = proxy.sin_h;
      s.bodies.left_m[i] += s.bodies.left_m_s[i] * tick_s;
      s.bodies.right_m[i] += s.bodies.right_m_s[i] * tick_s;
    }
  }

  Params params_;
  // Of Box2D's frame: the arena's middle for every region, so that a robot rounds alike in all of them.
  double origin_x_m_, origin_y_m_;
  WorldMemory memory_;  // all of Box2D's
  b2World* world_ = nullptr;
  b2Body* anchor_ = nullptr;     // the ground that drives and friction push against
  b2Body* immovable_ = nullptr;  // walls, boxes, cylinders
  std::uint64_t version_ = 0;    // of the immovable objects
  std::vector<Placed> placed_;   // of these, those near the region
  BodyTable<BodyProxy> bodies_table_;
  std::vector<b2Vec2> braking_;  // parallel to the roster, within a sub-step
  double hops_ = 0.0;            // sub-steps of the tick that its objects' speeds ask for
  std::vector<Held> joints_;
};

}  // namespace

const EngineType& dynamics2d_type() {
  static const EngineType type = [] {
    EngineType t;
    t.kind = "dynamics2d";
    t.summary = "Masses, forces and friction in the plane, on Box2D.";
    t.traits.forces = true;
    t.traits.joints = kEveryJoint;
    t.read = [](const Element& options, Problems& problems) -> std::shared_ptr<const void> {
      return box2d::read_params(options, problems);
    };
    t.describe = [](hal::ParamVisitor& visitor) { Params{}.describe(visitor); };
    t.unfit = &unfit;
    t.make = &make_solvers;
    t.make_solver = [](const std::shared_ptr<const void>& params, const SpaceStores& stores, const Region&,
                       double) -> std::unique_ptr<Solver> {
      return std::make_unique<Dynamics2d>(*static_cast<const Params*>(params.get()), stores);
    };
    return t;
  }();
  return type;
}

}  // namespace tandem::core

// Box2D times every island of bodies with gettimeofday, for a profile that nobody here reads; a robot that touches
// nothing is an island, and a quarter of the whole time went there. The library calls its timer through the dynamic
// linker, which takes a program's own definitions first: these.
b2Timer::b2Timer() : m_start_sec(0), m_start_usec(0) {}

void b2Timer::Reset() {}

float b2Timer::GetMilliseconds() const {
  return 0.0F;
}

// So are these, that all of Box2D's memory comes from.
void* b2Alloc_Default(int32 size) {
  return tandem::core::WorldMemory::allocate_in_use(static_cast<std::size_t>(size));
}

void b2Free_Default(void* memory) {
  tandem::core::WorldMemory::free_in_use(memory);
}
