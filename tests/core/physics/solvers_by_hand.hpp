// Solvers of one type on stores put together by hand, with nothing of the world's around them.
#pragma once
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "core/physics/solver.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {

inline constexpr double kTick_s = 0.1;
inline const double kRadius_m = hal::epuck::kind().body.radius_m;

/// How far outside a region its mirrored bodies may lie, as the world chooses it for e-pucks.
inline const double kReach_m = 4.0 * kRadius_m + 0.03;

/// Some regions side by side, a solver each. Robots and objects are added by name; `tick()` does what a step's physics
/// phase does.
class SolversByHand {
 public:
  SolversByHand(const EngineType& type, const std::vector<Element::Attribute>& options, double half_m,
                const std::vector<Element>& children = {})
      : type_(type) {
    Element element;
    element.name = type.kind;
    element.attributes = options;
    element.children = children;
    Problems problems;
    params_ = type_.read(element, problems);
    for (const Problem& problem : problems) ADD_FAILURE() << to_text(problem);
    stores().min_x_m = stores().min_y_m = -half_m;
    stores().max_x_m = stores().max_y_m = half_m;
    stores().bodies.has_motion = true;
    stores().border_reach_m = kReach_m;
  }

  SpaceStores& stores() noexcept { return space.stores(); }
  Bodies& bodies() noexcept { return stores().bodies; }
  Object& object(std::size_t i = 0) noexcept { return stores().objects[i]; }
  Motion& object_motion(std::size_t i = 0) noexcept { return stores().object_motion[i]; }

  /// Returns its row.
  std::size_t robot(double x_m, double y_m, double heading_rad, double left_m_s, double right_m_s,
                    const hal::RobotKind& kind = hal::epuck::kind()) {
    add_robot(space, kind, "r" + std::to_string(bodies().size()), x_m, y_m, heading_rad);
    bodies().left_m_s.back() = left_m_s;
    bodies().right_m_s.back() = right_m_s;
    return bodies().size() - 1;
  }
  /// Returns its number. Mass 0: immovable.
  std::size_t box(double x_m, double y_m, double size_x_m, double size_y_m, double mass_kg, double heading_rad = 0.0) {
    Object o;
    o.half_x_m = 0.5 * size_x_m;
    o.half_y_m = 0.5 * size_y_m;
    return add(o, x_m, y_m, mass_kg, heading_rad);
  }
  std::size_t cylinder(double x_m, double y_m, double radius_m, double mass_kg) {
    Object o;
    o.kind = Object::Kind::Cylinder;
    o.radius_m = radius_m;
    return add(o, x_m, y_m, mass_kg, 0.0);
  }
  /// One more region with the given outline; none: the whole plane.
  void region(const std::vector<RegionSide>& sides = {}) {
    Region r;
    r.forces = true;
    r.listed = true;
    r.sides = sides;
    r.close();
    stores().regions.push_back(r);
  }
  /// Holds two bodies together where they are, at the point (x, y). Returns the joint's number.
  std::size_t hold(BodyKey a, BodyKey b, double x_m, double y_m, const JointForm& form = {}) {
    Joint joint;
    joint.alive = true;
    joint.generation = 1;
    joint.a = a;
    joint.b = b;
    joint.form = form;
    const Frame at_a = frame(a);
    const Frame at_b = frame(b);
    joint.ax_m = at_a.cos_h * (x_m - at_a.x_m) + at_a.sin_h * (y_m - at_a.y_m);
    joint.ay_m = at_a.cos_h * (y_m - at_a.y_m) - at_a.sin_h * (x_m - at_a.x_m);
    joint.bx_m = at_b.cos_h * (x_m - at_b.x_m) + at_b.sin_h * (y_m - at_b.y_m);
    joint.by_m = at_b.cos_h * (y_m - at_b.y_m) - at_b.sin_h * (x_m - at_b.x_m);
    joint.heading_rad = relative_heading_rad(a, b);
    stores().joints.push_back(joint);
    return stores().joints.size() - 1;
  }

  void tick() {
    if (stores().regions.empty()) region();
    while (solvers_.size() < stores().regions.size())
      solvers_.push_back(type_.make_solver(params_, stores(), stores().regions[solvers_.size()], kTick_s));
    place();
    list();
    for (std::size_t i = 0; i < solvers_.size(); ++i) solvers_[i]->load(context(i));
    for (std::size_t i = 0; i < solvers_.size(); ++i) {
      solvers_[i]->advance(context(i));
      for (Trouble& t : solvers_[i]->trouble) trouble.push_back(std::move(t));
      solvers_[i]->trouble.clear();
    }
    ++tick_;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  PhysicsAccuracy accuracy() const {
    PhysicsAccuracy all;
    for (const auto& solver : solvers_) all.add(solver->accuracy);
    return all;
  }
  /// The next tick has this number.
  void start_at(hal::Tick tick) noexcept { tick_ = tick; }

  /// From the robot's forward direction at the first of two headings to that at the second, in (-pi, pi].
  double relative_heading_rad(BodyKey a, BodyKey b) {
    const Frame p = frame(a);
    const Frame q = frame(b);
    return std::atan2(q.sin_h * p.cos_h - q.cos_h * p.sin_h, q.cos_h * p.cos_h + q.sin_h * p.sin_h);
  }
  double speed_m_s(std::size_t row) const {
    const Motion& m = space.stores().bodies.motion[row];
    return std::hypot(m.v_m_s[0], m.v_m_s[1]);
  }
  /// Every bit of what the stores hold of robots and movable objects.
  std::vector<double> state() const {
    const SpaceStores& s = space.stores();
    std::vector<double> all;
    const auto add_motion = [&](const Motion& m) {
      all.push_back(m.z_m);
      all.insert(all.end(), m.q_WB.begin(), m.q_WB.end());
      all.insert(all.end(), m.v_m_s.begin(), m.v_m_s.end());
      all.insert(all.end(), m.w_rad_s.begin(), m.w_rad_s.end());
    };
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
      for (const auto* array : {&s.bodies.x_m, &s.bodies.y_m, &s.bodies.cos_h, &s.bodies.sin_h, &s.bodies.left_m})
        all.push_back((*array)[i]);
      add_motion(s.bodies.motion[i]);
    }
    for (std::size_t i = 0; i < s.objects.size(); ++i) {
      const Object& o = s.objects[i];
      for (const double value : {o.x_m, o.y_m, o.cos_h, o.sin_h}) all.push_back(value);
      add_motion(s.object_motion[i]);
    }
    return all;
  }

  Space space;
  std::vector<Trouble> trouble;  ///< of all ticks

 private:
  struct Frame {
    double x_m, y_m, cos_h, sin_h;
  };
  Frame frame(BodyKey key) {
    const std::size_t i = key.index();
    if (key.is_object()) return {object(i).x_m, object(i).y_m, object(i).cos_h, object(i).sin_h};
    return {bodies().x_m[i], bodies().y_m[i], bodies().cos_h[i], bodies().sin_h[i]};
  }
  std::size_t add(Object o, double x_m, double y_m, double mass_kg, double heading_rad) {
    o.id = "object" + std::to_string(stores().objects.size());
    o.x_m = x_m;
    o.y_m = y_m;
    o.cos_h = std::cos(heading_rad);
    o.sin_h = std::sin(heading_rad);
    o.z_high_m = 0.1;
    o.movable = mass_kg > 0.0;
    o.mass_kg = mass_kg;
    stores().objects.push_back(o);
    stores().object_motion.emplace_back();
    stores().object_region.push_back(0);
    ++stores().immovables_version;
    return stores().objects.size() - 1;
  }
  SolverContext context(std::size_t i) { return {stores(), stores().regions[i], kTick_s, tick_}; }

  void place() {
    for (std::size_t row = 0; row < bodies().size(); ++row)
      move_on(bodies().region[row], bodies().x_m[row], bodies().y_m[row]);
    for (std::size_t i = 0; i < stores().objects.size(); ++i) {
      if (object(i).movable) move_on(stores().object_region[i], object(i).x_m, object(i).y_m);
    }
  }
  void list() {
    for (std::size_t r = 0; r < stores().regions.size(); ++r) {
      Region& region = stores().regions[r];
      region.owned.clear();
      region.mirrored.clear();
      const auto sort_in = [&](BodyKey key, std::uint16_t of, double x_m, double y_m, double radius_m) {
        if (of == r)
          region.owned.push_back(key);
        else if (region.distance(x_m, y_m) <= radius_m + kReach_m)
          region.mirrored.push_back(key);
      };
      for (std::size_t row = 0; row < bodies().size(); ++row) {
        if ((bodies().flags[row] & kAlive) != 0)
          sort_in(BodyKey::robot(row), bodies().region[row], bodies().x_m[row], bodies().y_m[row], kRadius_m);
      }
      for (std::size_t i = 0; i < stores().objects.size(); ++i) {
        if (object(i).movable && object(i).alive)
          sort_in(BodyKey::object(i), stores().object_region[i], object(i).x_m, object(i).y_m, object(i).reach_m());
      }
    }
  }
  void move_on(std::uint16_t& region, double x_m, double y_m) {
    if (stores().regions[region].everywhere() || stores().regions[region].contains(x_m, y_m)) return;
    for (std::size_t r = 0; r < stores().regions.size(); ++r) {
      if (stores().regions[r].contains(x_m, y_m)) region = static_cast<std::uint16_t>(r);
    }
  }

  const EngineType& type_;
  std::shared_ptr<const void> params_;
  std::vector<std::unique_ptr<Solver>> solvers_;
  hal::Tick tick_ = 0;
};

/// The left and the right half of a square around the origin.
inline std::vector<RegionSide> west_half(double half_m = 2.0) {
  return {{-half_m, -half_m}, {0, -half_m}, {0, half_m}, {-half_m, half_m}};
}
inline std::vector<RegionSide> east_half(double half_m = 2.0) {
  return {{0, -half_m}, {half_m, -half_m}, {half_m, half_m}, {0, half_m}};
}

}  // namespace tandem::core
