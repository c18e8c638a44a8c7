// The stores that hold the whole simulated state, and the doors through which hooks, views and recorders reach it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/space/ids.hpp"
#include "core/space/pose.hpp"
#include "hal/device/leds.hpp"
#include "hal/port.hpp"
#include "hal/spec/data_sheet.hpp"

namespace tandem::core {

/// A wall, a box, a cylinder. `x, y` is its centre; z_low its base.
struct Object {
  enum class Kind : std::uint8_t { Box, Cylinder };
  Kind kind = Kind::Box;
  bool movable = false;  ///< engines with forces move it; others and sensors take it as it stands
  bool alive = true;     ///< false once removed: its number is not used again
  std::string id;
  double x_m = 0.0, y_m = 0.0;
  double cos_h = 1.0, sin_h = 0.0;  ///< heading of a box
  double half_x_m = 0.0, half_y_m = 0.0;
  double radius_m = 0.0;  ///< of a cylinder
  double z_low_m = 0.0, z_high_m = 0.0;
  double mass_kg = 1.0;  ///< of a movable one

  /// Radius of the smallest disc around it, seen from above.
  double reach_m() const noexcept;
};

/// A lamp.
struct LightSource {
  std::string id;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double intensity = 1.0;
  hal::Rgb color{255, 255, 0};
};

/// A steady sound.
struct SoundSource {
  std::string id;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double level = 1.0;
};

struct SpaceStores;  // core/space/stores.hpp: the arrays themselves, for kernels

/// Everything that exists in a simulation. Rows of the arrays move; ids stay.
class Space {
 public:
  Space();
  ~Space();
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  // --- robots, in the order of the experiment file ---
  std::size_t robot_count() const noexcept;
  RobotId robot(std::size_t i) const noexcept;             ///< the i-th living robot
  RobotId find_robot(std::string_view id) const noexcept;  ///< invalid when there is none
  std::string robot_name(RobotId robot) const;
  const hal::DataSheet& data_sheet(RobotId robot) const noexcept;
  Pose pose(RobotId robot) const noexcept;
  /// Moves a robot at once. Takes effect for physics and sensing from the next phase on.
  void set_pose(RobotId robot, const Pose& pose) noexcept;
  /// Takes a robot out of the space: its controller stops, nobody sees it any more. Its id is not used again.
  void remove_robot(RobotId robot) noexcept;
  /// Angle of the robot's turret on its body, counter-clockwise from forward; 0 where it has none.
  double turret_rad(RobotId robot) const noexcept;
  bool holding(RobotId robot) const noexcept;  ///< whether its gripper holds something
  bool halted(RobotId robot) const noexcept;   ///< its controller threw or was stopped: wheels stay 0
  void set_halted(RobotId robot, bool halted) noexcept;
  /// Whether the robot's pose is set from outside (a real robot's twin): engines do not move it, others bump into it.
  bool external(RobotId robot) const noexcept;
  void set_external(RobotId robot, bool external) noexcept;
  /// A port of the robot as its controller sees it, or null when the controller took none of that name. Sensor and
  /// actuator ports may share a name, so the role is part of it.
  const void* port(RobotId robot, const hal::PortType& type) const noexcept;
  void* port(RobotId robot, const hal::PortType& type) noexcept;
  template <class T>
  T* port(RobotId robot) noexcept {
    return static_cast<T*>(port(robot, hal::port_type<T>()));
  }
  template <class T>
  const T* port(RobotId robot) const noexcept {
    return static_cast<const T*>(port(robot, hal::port_type<T>()));
  }
  /// Descriptions of all ports that the robot's controller took.
  std::vector<const hal::PortType*> ports(RobotId robot) const;

  // --- things that do not move by themselves ---
  /// Boxes and cylinders by number, in the order of the experiment file; those removed are not `alive`.
  const std::vector<Object>& objects() const noexcept;
  const std::vector<LightSource>& lights() const noexcept;
  const std::vector<SoundSource>& sounds() const noexcept;
  void set_light(std::size_t i, const LightSource& light);
  void set_sound(std::size_t i, const SoundSource& sound);

  // --- the arena ---
  double arena_size_x_m() const noexcept;
  double arena_size_y_m() const noexcept;
  double arena_center_x_m() const noexcept;
  double arena_center_y_m() const noexcept;
  /// Reflectance of the floor at (x, y), 0 black to 1 white.
  double floor(double x_m, double y_m) const noexcept;
  /// Has the floor asked for anew from the hook that paints it, before the next step.
  void repaint_floor() noexcept;

  SpaceStores& stores() noexcept { return *stores_; }
  const SpaceStores& stores() const noexcept { return *stores_; }

 private:
  std::unique_ptr<SpaceStores> stores_;
};

}  // namespace tandem::core
