// The stores that hold the whole simulated state, and the doors through which hooks, views and recorders reach it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/space/editor.hpp"
#include "core/space/halt.hpp"
#include "core/space/ids.hpp"
#include "core/space/pose.hpp"
#include "core/space/real_sense.hpp"
#include "core/space/sketch.hpp"
#include "hal/device/leds.hpp"
#include "hal/port.hpp"
#include "hal/published.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// An LED on a box or a cylinder. Black is off.
struct ObjectLed {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;  ///< from the centre of the object's base, in its frame
  hal::Rgb color = {};
  std::uint16_t medium = 0;  ///< the number of its LED medium; 0: cameras of all media see it
};

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
  double mass_kg = 1.0;          ///< of a movable one
  std::uint32_t generation = 0;  ///< of its id
  std::uint32_t version = 0;     ///< rises whenever its size, mass or kind changes
  std::vector<ObjectLed> leds = {};

  void remember(auto& archive) {
    archive(kind, movable, alive, id, x_m, y_m, cos_h, sin_h, half_x_m, half_y_m, radius_m, z_low_m, z_high_m, mass_kg,
            generation, version, leds);
  }

  /// Radius of the smallest disc around it, seen from above.
  double reach_m() const noexcept;
  /// Whether it is there and any of its LEDs is on.
  bool lit() const noexcept;
};

/// A lamp.
struct LightSource {
  std::string id;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double intensity = 1.0;
  hal::Rgb color{255, 255, 0};
  bool alive = true;         ///< false once removed: its number is not used again
  std::uint16_t medium = 0;  ///< the number of the LED medium in which cameras see it; 0: all do

  void remember(auto& archive) { archive(id, x_m, y_m, z_m, intensity, color, alive, medium); }
};

/// A steady sound.
struct SoundSource {
  std::string id;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double level = 1.0;
  bool alive = true;  ///< false once removed: its number is not used again

  void remember(auto& archive) { archive(id, x_m, y_m, z_m, level, alive); }
};

struct SpaceStores;  // core/space/stores.hpp: the arrays themselves, for kernels

/// Everything that exists in a simulation. Rows of the arrays move; ids stay.
///
/// Hooks may change anything between steps; engines, sensors and pictures see it from then on. What an id names may be
/// gone: changes of it then do nothing or are errors, and questions about it have the answers named here.
class Space {
 public:
  Space();
  ~Space();
  Space(const Space&) = delete;
  Space& operator=(const Space&) = delete;

  /// Whether anything has this id, or had it: nothing else can be given it then.
  bool had(std::string_view id) const noexcept;

  // --- robots, in the order of the experiment file, then in that of being added ---
  std::size_t robot_count() const noexcept;
  RobotId robot(std::size_t i) const noexcept;             ///< the i-th living robot
  RobotId find_robot(std::string_view id) const noexcept;  ///< invalid when there is none
  bool contains(RobotId robot) const noexcept;             ///< false once removed
  std::string robot_name(RobotId robot) const;             ///< also of one that is gone
  const hal::RobotKind& kind(RobotId robot) const noexcept;
  /// Makes a robot; it senses and steps from the next step on. Errors: an id that is taken or was; an unknown kind or
  /// configuration; bad parameters; a place that is occupied, outside the arena, or in no engine's region; a
  /// controller that throws. Nothing has changed then.
  hal::Result<RobotId> add_robot(const NewRobot& wanted);
  /// Takes a robot out of the space: its controller is destroyed, its joints are released, no sensor sees it any more.
  /// Its id is not used again.
  void remove_robot(RobotId robot) noexcept;
  Pose pose(RobotId robot) const noexcept;  ///< gone: the origin
  /// Moves a robot at once. Takes effect for physics and sensing from the next phase on. It may be put onto others:
  /// engines then part them.
  void set_pose(RobotId robot, const Pose& pose) noexcept;
  /// Whether the robot could stand there without overlapping anything else. Errors: gone; what is in the way; outside
  /// the arena, or in no region of an engine for it.
  hal::Status room_for(RobotId robot, const Pose& pose) const;
  /// Of its centre, as its engine left it. Where the engine keeps none: what its wheels do.
  Velocity velocity(RobotId robot) const noexcept;
  /// Errors: the robot is gone; its engine keeps no velocities, the wheels' commands are all there is.
  hal::Status set_velocity(RobotId robot, const Velocity& velocity);
  /// Charge as a part of the full one, 0 to 1. Errors: the robot is gone; its controller takes no battery.
  hal::Result<double> battery(RobotId robot) const;
  hal::Status set_battery(RobotId robot, double charge);
  /// Angle of the robot's turret on its body, counter-clockwise from forward; 0 where it has none.
  double turret_rad(RobotId robot) const noexcept;
  bool holding(RobotId robot) const noexcept;  ///< whether its gripper holds something
  /// Whether anyone holds the robot: its controller does not step, and its actuators stay safe. Gone: true.
  bool halted(RobotId robot) const noexcept;
  /// Whether `owner` does. Gone: only Removed does.
  bool halted_by(RobotId robot, HaltOwner owner) const noexcept;
  /// Holds the robot in the name of `owner`, or lets go of it: it goes on when no other owner holds it.
  void set_halted(RobotId robot, bool halted, HaltOwner owner = HaltOwner::Hook) noexcept;
  /// Whether the robot's pose is set from outside (a real robot's twin): engines do not move it, others bump into it.
  bool external(RobotId robot) const noexcept;
  void set_external(RobotId robot, bool external) noexcept;
  /// For such a robot: which others it senses by itself (bits of RealSense). Its actuators move nothing in the space:
  /// where its mechanisms are is written to their `state`.
  void set_real_senses(RobotId robot, std::uint8_t senses) noexcept;
  /// What the simulation keeps of that class for the robot (core/space/mechanisms.hpp), or null where none of its
  /// devices needs it or the robot is gone.
  void* state(RobotId robot, const hal::RowType& type) const noexcept;
  template <class T>
  T* state(RobotId robot) noexcept {
    return static_cast<T*>(state(robot, hal::row_type<T>()));
  }
  template <class T>
  const T* state(RobotId robot) const noexcept {
    return static_cast<const T*>(state(robot, hal::row_type<T>()));
  }
  /// A port of the robot as its controller sees it, or null when the controller took none of that name or the
  /// robot is gone. Sensor and actuator ports may share a name, so the role is part of it.
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
  /// What the controllers of the robot's group publish (hal::Robot::publish); gone: nothing.
  std::span<const hal::PublishedField> published(RobotId robot) const noexcept;
  /// One of them of this robot's controller, as a number and for people. Errors: gone; nothing is published under that
  /// name.
  hal::Result<double> published_value(RobotId robot, std::string_view name) const;
  hal::Result<std::string> published_text(RobotId robot, std::string_view name) const;
  /// The robot's controller when its class has this name; else, and when the robot is gone, null. HookContext knows the
  /// class. @throws std::runtime_error when that class has another size in the controller's plug-in
  void* controller(RobotId robot, std::string_view class_name, std::size_t size);

  // --- boxes and cylinders ---
  /// By number, in the order of the experiment file, then in that of being added; those removed are not `alive`.
  const std::vector<Object>& objects() const noexcept;
  ObjectId object(std::size_t number) const noexcept;        ///< invalid when there is none
  ObjectId find_object(std::string_view id) const noexcept;  ///< invalid when there is none
  bool contains(ObjectId object) const noexcept;
  /// Errors: an id that is taken or was; sizes or a mass that are not above 0; a place on a robot or on something
  /// movable, or for a movable one on anything; a movable one where no engine moves objects.
  hal::Result<ObjectId> add_object(const Object& wanted);
  /// Gives an object another place, size, mass, and whether it is movable: all of `changed` but its id. It may be put
  /// onto others: engines then part them. A movable one keeps its velocity. Errors: gone; otherwise as `add_object`.
  hal::Status set_object(ObjectId object, const Object& changed);
  /// As for a robot. What cannot move may overlap its like, and may lie outside the arena.
  hal::Status room_for(ObjectId object, const Pose& pose) const;
  /// Lights an LED of an object in another colour; black is off. Errors: gone; no LED of that number.
  hal::Status set_object_led(ObjectId object, std::size_t led, hal::Rgb color);
  /// Its id is not used again; its joints are released.
  void remove_object(ObjectId object) noexcept;
  Velocity object_velocity(ObjectId object) const noexcept;  ///< of an immovable one, or gone: 0
  /// Errors: gone or immovable.
  hal::Status set_object_velocity(ObjectId object, const Velocity& velocity);

  // --- joints ---
  /// Holds two bodies together at a point of W, as they stand. Errors: one is gone or immovable; both are the same; a
  /// form that is none; an engine that lacks such joints has one of them.
  hal::Result<JointId> join(BodyId a, BodyId b, const std::array<double, 3>& p_W, const JointForm& form = {});
  /// Sets what the joint's motor strives for, in rad/s or m/s. Errors: gone; it has no motor; not finite.
  hal::Status drive(JointId joint, double speed);
  /// Where a turning joint is, in rad, or a sliding one, in m; of upright bodies. 0 of others.
  double place(JointId joint) const noexcept;
  void release(JointId joint) noexcept;
  bool contains(JointId joint) const noexcept;  ///< false once released, or when one of its bodies is gone

  // --- lamps and steady sounds ---
  /// By number; those removed are not `alive`.
  const std::vector<LightSource>& lights() const noexcept;
  const std::vector<SoundSource>& sounds() const noexcept;
  /// Give the number. Errors: an id that is taken or was.
  hal::Result<std::size_t> add_light(const LightSource& light);
  hal::Result<std::size_t> add_sound(const SoundSource& sound);
  void set_light(std::size_t i, const LightSource& light);
  void set_sound(std::size_t i, const SoundSource& sound);
  void remove_light(std::size_t i);
  void remove_sound(std::size_t i);

  // --- the arena ---
  double arena_size_x_m() const noexcept;
  double arena_size_y_m() const noexcept;
  double arena_center_x_m() const noexcept;
  double arena_center_y_m() const noexcept;
  /// Reflectance of the floor at (x, y), 0 black to 1 white.
  double floor(double x_m, double y_m) const noexcept;
  /// Has the floor asked for again from the hooks that paint it, before the next step.
  void repaint_floor() noexcept;
  /// Value of a field at a point of W: of light, as if one faced every lamp. Error: there is none of that name.
  hal::Result<double> field(std::string_view name, double x_m, double y_m, double z_m = 0.0) const;
  /// Has it asked for again, if hooks paint it. Error: as above.
  hal::Status repaint(std::string_view field);

  /// What hooks draw into pictures and views.
  Sketch& sketch() noexcept;
  const Sketch& sketch() const noexcept;

  SpaceStores& stores() noexcept { return *stores_; }
  const SpaceStores& stores() const noexcept { return *stores_; }
  /// Lets `editor` add and change what the space cannot by itself; it must outlive the last call. Null: such are
  /// errors.
  void set_editor(Editor* editor) noexcept { editor_ = editor; }

 private:
  hal::Result<const hal::PublishedField*> find_published(RobotId robot, std::string_view name) const;
  hal::Result<BodyKey> key_of(const BodyId& body) const;
  void release_joints_of(BodyKey body) noexcept;

  Editor* editor_ = nullptr;
  std::unique_ptr<SpaceStores> stores_;
};

}  // namespace tandem::core
