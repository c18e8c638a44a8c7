// This engine's record of a robot or a movable object, between and within ticks.
#pragma once
#include <array>
#include <cstdint>

#include "core/physics/dynamics3d/ode.hpp"
#include "core/physics/dynamics3d/prism.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

using Vector3 = std::array<double, 3>;

inline Vector3 cross(const Vector3& a, const Vector3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double dot(const Vector3& a, const Vector3& b) noexcept {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Pose and velocity of a body, as in the stores. In W; z is the base's.
struct BodyState {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double cos_h = 1.0, sin_h = 0.0;
  std::array<double, 4> q_WB{1.0, 0.0, 0.0, 0.0};
  Vector3 v_m_s{}, w_rad_s{};

  bool finite() const noexcept;
  friend bool operator==(const BodyState&, const BodyState&) = default;
};

/// A turn about the vertical. Remembers the last one: most bodies turn by as much in every sub-step.
class Turn {
 public:
  /// A heading, turned by `angle_rad`.
  std::array<double, 2> of(double cos_h, double sin_h, double angle_rad) noexcept;

 private:
  double angle_rad_ = 0.0, cos_ = 1.0, sin_ = 0.0;
};

/// Form of motion of a proxy.
enum class Sort : std::uint8_t {
  Base,    ///< upright on the floor, driven over it
  Wheels,  ///< a chassis on two wheels that turn
  Flyer,   ///< upright in the air, driven by thrust
  Rotors,  ///< a body that leans, with four rotors
  Object   ///< moved by others
};

/// Base and Flyer are *light*: their state is kept here, and they are in ODE only for sub-steps in which they touch
/// something. The others live in ODE.
struct BodyProxy {
  Sort sort = Sort::Object;
  bool owned = false;
  bool external = false;  ///< led to where the stores say; nothing stops it
  bool unfit = false;     ///< ODE would not have it: its size or mass is none
  bool lost = false;      ///< not to be simulated in this tick: its state is no number
  bool aloft = false;     ///< light: falls, or stands on something other than the floor
  bool standing = false;  ///< light and aloft: something carried it in the last sub-step
  bool touched = false;   ///< light: in ODE for this sub-step
  bool engaged = false;   ///< of a base: pushes something that can move, so its drive is part of what ODE solves
  // Of an object, in this sub-step:
  bool driven = false;                   ///< touched by a robot, or joined to something
  bool resting = false;                  ///< left out of ODE's step: it stands, and stays where it is
  BodyProxy* heap = nullptr;             ///< one of those that it touches, and so on to one that stands for all of them
  Vector3 before_m{};                    ///< where ODE's body was when the sub-step began
  dQuaternion turned_before{};           ///< … and how it was turned
  const hal::RobotKind* kind = nullptr;  ///< of a robot
  const hal::DifferentialDrive* drive = nullptr;  ///< of a robot that does not fly
  const hal::Quadrotor* flight = nullptr;         ///< of one that does
  BodyKey key;

  double mass_kg = 1.0;
  double height_m = 0.0;
  double origin_m = 0.0;  ///< of ODE's body above its base

  // Of light ones: the base's middle, and what it does in this sub-step if nothing stops it.
  Vector3 p_m{}, v_m_s{}, next_v_m_s{};
  double cos_h = 1.0, sin_h = 0.0, w_rad_s = 0.0, next_w_rad_s = 0.0;
  double forward_m_s = 0.0, leftward_m_s = 0.0, turn_rad_s = 0.0;  ///< of a base: commanded, from its present heading
  Turn turn_by_half, turn_by_all;                                  ///< … in a sub-step
  Vector3 led_to_m{};

  double hop_m = 0.0;     ///< how far any point of it moves in a sub-step
  double margin_m = 0.0;  ///< within which it may move before candidates are found again
  double from_x_m = 0.0, from_y_m = 0.0;
  Prism prism;

  OdeBody body;
  OdeJoint push, turn;            ///< of an engaged base: its drive
  OdeGeom geom;                   ///< made when something that leans comes near
  std::array<OdeBody, 2> wheels;  ///< left, right
  std::array<OdeJoint, 2> axles;
  std::array<double, 2> rolled_m{};  ///< in this tick

  RotorState rotors;

  bool light() const noexcept { return sort == Sort::Base || sort == Sort::Flyer; }
  bool robot() const noexcept { return sort != Sort::Object; }
};

/// As `state`, of the stores.
BodyState stored_state(const SpaceStores& stores, BodyKey key) noexcept;
/// Of a proxy, exactly as it is written to the stores.
BodyState state_of(const BodyProxy& proxy) noexcept;

/// Sets what a robot's proxy knows of its kind.
void know_kind(BodyProxy& proxy, const SpaceStores& stores);
/// Makes a proxy without a place.
void make_proxy(BodyProxy& proxy, const SpaceStores& stores, BodyKey key, Sort sort, dWorldID world);
/// Ends what it has in ODE.
void end_proxy(BodyProxy& proxy) noexcept;
/// Puts a proxy where `at` says, with its velocities.
void put(BodyProxy& proxy, const BodyState& at);
/// Gives a light proxy its body in ODE.
void give_body(BodyProxy& proxy, dWorldID world);
/// Sets what contacts see of a proxy from its state.
void update_prism(BodyProxy& proxy);
/// The velocity of its point at `p_m` of W, before forces act.
Vector3 velocity_at(const BodyProxy& proxy, const Vector3& p_m) noexcept;

/// A box or cylinder for ODE's own contact finders, `skin_m` larger on every side.
OdeGeom make_geom(const Prism& prism, double height_m, double skin_m);
/// Its geom, made when there is none, where the proxy is now.
dGeomID geom_of(BodyProxy& proxy, double skin_m);

/// The turn about the vertical that makes this heading; w, x, y, z.
std::array<double, 4> upright_turn(double cos_h, double sin_h) noexcept;

}  // namespace tandem::core
