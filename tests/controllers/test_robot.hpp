// A robot with real ports for the tests of controllers, and a room to drive it in.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/params.hpp"
#include "hal/robot.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::test {

/// A two-wheeled robot with a proximity ring; nothing in sight, readings fresh.
class TestRobot final : public hal::Robot {
 public:
  explicit TestRobot(const hal::RobotKind& kind = hal::epuck::kind(), bool has_wheels = true)
      : kind_(kind), has_wheels_(has_wheels) {
    proximity.validity = hal::Validity::Fresh;
    proximity.count = static_cast<std::uint32_t>(kind.part<hal::ProximityPart>()->mounts.size());
    proximity.range_m = static_cast<float>(kind.part<hal::ProximityPart>()->range_m);
    clear();
  }

  std::string_view id() const noexcept override { return "robot"; }
  const hal::RobotKind& kind() const noexcept override { return kind_; }
  std::uint64_t run_seed() const noexcept override { return 1; }

  void clear() { proximity.distance_m.fill(proximity.range_m); }
  void see(std::size_t sensor, double closeness) {
    proximity.distance_m[sensor] = static_cast<float>((1.0 - closeness) * kind_.part<hal::ProximityPart>()->range_m);
  }

  hal::Proximity proximity;
  hal::WheelSpeeds wheels;

 protected:
  void* take(const hal::PortType& type) override {
    if (type.name == hal::Proximity::kName && type.role == hal::Role::Sensor) return &proximity;
    if (has_wheels_ && type.name == hal::WheelSpeeds::kName) return &wheels;
    throw hal::DeviceError("robot has no " + std::string(type.name));
  }

 private:
  const hal::RobotKind& kind_;
  bool has_wheels_;
};

/// A convex room of straight walls, each the half plane {p : p.x * nx + p.y * ny <= c}, and a robot's pose in it.
struct Room {
  struct Wall {
    double nx, ny, c;
  };
  std::vector<Wall> walls;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;

  /// Distance from the centre to the nearest wall.
  double clearance_m() const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& w : walls) nearest = std::min(nearest, w.c - x_m * w.nx - y_m * w.ny);
    return nearest;
  }

  void look(TestRobot& robot) const {
    const auto mounts = robot.kind().part<hal::ProximityPart>()->mounts;
    const double c = std::cos(heading_rad);
    const double s = std::sin(heading_rad);
    for (std::size_t i = 0; i < mounts.size(); ++i) {
      const double px = x_m + c * mounts[i].x_m - s * mounts[i].y_m;
      const double py = y_m + s * mounts[i].x_m + c * mounts[i].y_m;
      const double dx = std::cos(heading_rad + mounts[i].bearing_rad);
      const double dy = std::sin(heading_rad + mounts[i].bearing_rad);
      double nearest = robot.kind().part<hal::ProximityPart>()->range_m;
      for (const Wall& w : walls) {
        const double approach = dx * w.nx + dy * w.ny;
        if (approach > 0.0) nearest = std::min(nearest, std::max(0.0, (w.c - px * w.nx - py * w.ny) / approach));
      }
      robot.proximity.distance_m[i] = static_cast<float>(nearest);
    }
  }

  void roll(const TestRobot& robot, double dt_s) {
    const double v = 0.5 * (robot.wheels.left_m_s + robot.wheels.right_m_s);
    const double turn = (robot.wheels.right_m_s - robot.wheels.left_m_s) / robot.kind().drive()->wheel_base_m * dt_s;
    x_m += v * dt_s * std::cos(heading_rad + 0.5 * turn);
    y_m += v * dt_s * std::sin(heading_rad + 0.5 * turn);
    heading_rad += turn;
  }
};

/// Drives through `room` for `ticks` of 100 ms. @returns the smallest clearance of the centre from a wall on the way
template <class Controller>
double smallest_clearance(Controller& controller, TestRobot& robot, Room& room, int ticks) {
  double smallest = room.clearance_m();
  for (int k = 0; k < ticks; ++k) {
    room.look(robot);
    controller.step();
    room.roll(robot, 0.1);
    smallest = std::min(smallest, room.clearance_m());
  }
  return smallest;
}

/// Reads nothing, so that defaults stay, but notes what each number was called and means without a suffix.
struct NumberNotes final : hal::ParamVisitor {
  struct Note {
    std::string name, bare;
    double value_si;
    hal::Range range;
  };
  std::vector<Note> notes;
  void visit(const hal::Param& param) override {
    if (const double* const v = param.as<double>(); v != nullptr) {
      EXPECT_FALSE(param.doc.empty());
      notes.push_back({std::string(param.name), std::string(param.bare->symbol), *v, param.range});
    }
    if (const auto* const group = param.group(); group != nullptr) group->describe(group->value, *this);
    if (param.list() != nullptr) param.list()->describe_default(*this);
  }
};

/// What `nm -D` says of a shared object; empty when there is no nm.
inline std::string dynamic_symbols(const std::string& library) {
  std::string text;
  FILE* pipe = popen(("nm -D '" + library + "' 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  pclose(pipe);
  return text;
}

/// Fails when `library` refers to anything of a world: a controller must run in all of them.
inline void expect_no_world_in(const std::string& library) {
  const std::string symbols = dynamic_symbols(library);
  ASSERT_NE(symbols.find("tandem_plugin"), std::string::npos) << "nm -D shows no plug-in in " << library;
  for (const char* world : {"6tandem4core", "6tandem7bridges", "6tandem13mixed_reality", "6tandem3app"}) {
    EXPECT_EQ(symbols.find(world), std::string::npos) << world << " in " << library;
  }
}

}  // namespace tandem::test
