// Solvers of <particle3d> on a space put together by hand.
#pragma once
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "core/physics/particle3d/particle3d.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {

inline const double kFlyerRadius_m = hal::eyebot::kind().body.radius_m;
inline const double kFlyerHeight_m = hal::eyebot::kind().body.height_m;
inline const double kFlyerSpeed_m_s = hal::eyebot::kind().flight()->max_speed_m_s;
inline const double kFlyerAcceleration_m_s2 = hal::eyebot::kind().flight()->max_acceleration_m_s2;
inline const double kRollerRadius_m = hal::epuck::kind().body.radius_m;
inline const double kRollerHeight_m = hal::epuck::kind().body.height_m;

/// An arena of 40 m x 40 m without a ceiling; regions are added before the first step, else one is everywhere.
class Bench {
 public:
  explicit Bench(double tick_s = 0.1, const std::vector<Element::Attribute>& attributes = {}) : tick_s_(tick_s) {
    SpaceStores& s = stores();
    s.min_x_m = s.min_y_m = -20.0;
    s.max_x_m = s.max_y_m = 20.0;
    s.bodies.has_motion = true;
    options_.name = "particle3d";
    options_.attributes = attributes;
  }

  SpaceStores& stores() { return space_.stores(); }
  Space& space() { return space_; }
  Motion& motion(std::size_t row) { return stores().bodies.motion[row]; }
  FlightCommand& flight(std::size_t row) { return *stores().state_of(stores().flight, row); }
  double x(std::size_t row) { return stores().bodies.x_m[row]; }
  double y(std::size_t row) { return stores().bodies.y_m[row]; }
  double z(std::size_t row) { return motion(row).z_m; }
  double heading(std::size_t row) { return std::atan2(stores().bodies.sin_h[row], stores().bodies.cos_h[row]); }
  double speed(std::size_t row) {
    const auto& v = motion(row).v_m_s;
    return std::hypot(v[0], v[1], v[2]);
  }

  /// A robot that hovers; its row.
  std::size_t flyer(double x_m, double y_m, double z_m, double heading_rad = 0.0) {
    const std::size_t row = robot(hal::eyebot::kind(), x_m, y_m, z_m, heading_rad);
    add_state<FlightCommand>(space_, {stores().bodies.entity[row], 0});
    flight(row).mode = FlightCommand::Mode::Velocity;
    return row;
  }
  std::size_t roller(double x_m, double y_m, double heading_rad, double left_m_s, double right_m_s, double z_m = 0.0) {
    const std::size_t row = robot(hal::epuck::kind(), x_m, y_m, z_m, heading_rad);
    stores().bodies.left_m_s[row] = left_m_s;
    stores().bodies.right_m_s[row] = right_m_s;
    return row;
  }
  void fly(std::size_t row, double x_m_s, double y_m_s, double z_m_s, double turn_rad_s = 0.0) {
    flight(row) = {FlightCommand::Mode::Velocity, {x_m_s, y_m_s, z_m_s}, turn_rad_s};
  }
  void fly_to(std::size_t row, double x_m, double y_m, double z_m, double yaw_rad = 0.0) {
    flight(row) = {FlightCommand::Mode::Position, {x_m, y_m, z_m}, yaw_rad};
  }
  void drop(std::size_t row) { flight(row) = {}; }

  void box(double x_m, double y_m, double size_x_m, double size_y_m, double z_low_m, double z_high_m,
           double heading_rad = 0.0) {
    Object& o = add_object(space_, Object::Kind::Box, x_m, y_m, z_low_m, z_high_m);
    o.half_x_m = 0.5 * size_x_m;
    o.half_y_m = 0.5 * size_y_m;
    o.cos_h = std::cos(heading_rad);
    o.sin_h = std::sin(heading_rad);
  }
  void cylinder(double x_m, double y_m, double radius_m, double z_low_m, double z_high_m) {
    add_object(space_, Object::Kind::Cylinder, x_m, y_m, z_low_m, z_high_m).radius_m = radius_m;
  }

  void step() {
    SpaceStores& s = stores();
    if (solvers_.empty()) start();
    list_robots(space_, 1.5);
    for (std::size_t r = 0; r < solvers_.size(); ++r) solvers_[r]->load({s, s.regions[r], tick_s_, tick_});
    for (std::size_t r = 0; r < solvers_.size(); ++r) solvers_[r]->advance({s, s.regions[r], tick_s_, tick_});
    ++tick_;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) step();
  }
  /// What the solvers reported since the last time.
  std::vector<Trouble> troubles() {
    std::vector<Trouble> all;
    for (auto& solver : solvers_) {
      all.insert(all.end(), solver->trouble.begin(), solver->trouble.end());
      solver->trouble.clear();
    }
    return all;
  }
  /// Every number of every body that solvers write.
  std::vector<double> state() {
    std::vector<double> all;
    const Bodies& b = stores().bodies;
    for (std::size_t row = 0; row < b.size(); ++row) {
      const Motion& m = b.motion[row];
      all.insert(all.end(), {b.x_m[row], b.y_m[row], b.cos_h[row], b.sin_h[row], b.left_m[row], b.right_m[row], m.z_m});
      all.insert(all.end(), m.q_WB.begin(), m.q_WB.end());
      all.insert(all.end(), m.v_m_s.begin(), m.v_m_s.end());
      all.insert(all.end(), m.w_rad_s.begin(), m.w_rad_s.end());
    }
    return all;
  }

 private:
  std::size_t robot(const hal::RobotKind& kind, double x_m, double y_m, double z_m, double heading_rad) {
    const RobotId id = add_robot(space_, kind, "r" + std::to_string(stores().bodies.size()), x_m, y_m, heading_rad);
    space_.set_pose(id, {x_m, y_m, z_m, std::cos(heading_rad), std::sin(heading_rad)});
    return stores().row_of(id);
  }
  void start() {
    if (stores().regions.empty()) add_region(space_);
    index_objects(space_, 1.0);
    Problems problems;
    const auto params = particle3d_type().read(options_, problems);
    EXPECT_TRUE(problems.empty()) << to_text(problems.front());
    for (const Region& region : stores().regions)
      solvers_.push_back(particle3d_type().make_solver(params, stores(), region, tick_s_));
  }

  double tick_s_;
  hal::Tick tick_ = 0;
  Space space_;
  Element options_;
  std::vector<std::unique_ptr<Solver>> solvers_;
};

inline Element::Attribute attribute(const std::string& name, double value) {
  return {name, hal::format_number(value), 1};
}

}  // namespace tandem::core
