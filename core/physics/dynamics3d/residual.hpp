// Velocity errors that ODE's passes leave in the constraints of a sub-step.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/physics/dynamics3d/body_proxy.hpp"

namespace tandem::core {

/// Knows every constraint of a sub-step, and measures after ODE's step how far velocities and forces are from what the
/// constraints ask for, island by island: bodies that constraints connect, directly or through others. ODE tells
/// nothing of it. Islands that are too far from it are put back to be solved again, while the others wait.
///
/// Of a constraint that asks for a speed u* with a force f between two limits, the error is how far the speed is from
/// u*, but only as far as the force could still change it: |f - clamp(f - m (u - u*) / dt)| dt / m. It is 0 where the
/// constraint is met, where a contact that parts pushes nothing, and where friction or a motor that slips does its
/// most. Steady use allocates nothing.
class Residual {
 public:
  struct Settings {
    double dt_s = 0.0;
    double erp = 0.0, cfm = 0.0;
    double most_parting_m_s = 0.0;  ///< ODE's limit for what lies in one another
  };
  void begin(const Settings& settings) noexcept;

  /// Has ODE tell the force of a joint that is made again in every sub-step.
  void add_contact(dJointID joint, dBodyID a, dBodyID b, const dContact& contact);
  /// A wheel's axle, whose motor strives for `rim_m_s` forwards.
  void add_axle(dJointID axle, dBodyID wheel, dBodyID chassis, double radius_m, double rim_m_s, double most_Nm);
  /// The drive of a base: strives for a velocity along two directions, the second to the left of `ahead`.
  void add_push(dJointID motor, dBodyID body, const Vector3& ahead, double forward_m_s, double leftward_m_s,
                double most_N);
  void add_turn(dJointID motor, dBodyID body, double rate_rad_s, double lever_m, double most_Nm);
  /// Points of two bodies, given in their frames, that are held together; along all directions but `free`, of a's
  /// frame, if that is one.
  void add_hold(dBodyID a, dBodyID b, const Vector3& at_a, const Vector3& at_b, const Vector3& free);

  /// Every body that ODE is to move in this sub-step; takes down where it is.
  void add_body(dBodyID body);
  /// Call when all is added, right before ODE's step.
  void prepare();
  /// After a step: the largest error in m/s, of all islands.
  double measure() noexcept;
  /// Puts back the bodies of islands that are farther off than `most_m_s`, and has ODE leave the others alone.
  void begin_again(double most_m_s) noexcept;
  /// Ends the sub-step: ODE moves all bodies again, and forgets what it was to tell.
  void end() noexcept;

 private:
  struct Pair {
    dBodyID a = nullptr;
    dBodyID b = nullptr;       // null: does not move
    double mass_kg = 0.0;      // of both together
    std::uint32_t number = 0;  // of the first, among all bodies
    Vector3 arm_a{}, arm_b{};  // from the bodies' origins to the point, in W
  };
  struct Contact {
    Pair pair;
    Vector3 p_m{}, normal{}, first{}, second{};
    double target_m_s = 0.0, along = 0.0, across = 0.0;
    const dJointFeedback* force = nullptr;
  };
  /// One direction, with the limits of its force; turning ones are reckoned at a lever.
  struct Row {
    Pair pair;
    Vector3 along{};
    double target_m_s = 0.0, lever_m = 0.0, most_N = 0.0;
    const dJointFeedback* force = nullptr;
  };
  struct Hold {
    Pair pair;
    Vector3 at_a{}, at_b{}, free{};
    Vector3 target_m_s{};
  };
  struct Body {
    dBodyID body = nullptr;
    bool moves = false;  // by ODE, in this sub-step
    Vector3 p_m{}, v_m_s{}, w_rad_s{}, force_N{}, torque_Nm{};
    dQuaternion turn{};
    std::uint32_t island = 0;  // one of them; that one's own number: it stands for all
    // Of those that stand for islands:
    bool waits = false;  // solved well enough
    double error_m_s = 0.0;
  };
  static Vector3 relative_velocity(const Pair& pair) noexcept;
  std::uint32_t number_of(dBodyID body);
  std::uint32_t island_of(std::uint32_t number) noexcept;
  void connect(Pair& pair);
  double error_of(const Contact& contact) const noexcept;
  double error_of(const Row& row) const noexcept;
  static double error_of(const Hold& hold) noexcept;
  template <class Constraint>
  void measure_all(const std::vector<Constraint>& constraints) noexcept;
  double error(double speed_m_s, double target_m_s, double force_N, double low_N, double high_N,
               double mass_kg) const noexcept;
  dJointFeedback* listen(dJointID joint, bool lasts);

  Settings settings_;
  std::vector<Contact> contacts_;
  std::vector<Row> rows_;
  std::vector<Hold> holds_;
  std::vector<Body> bodies_;
  std::vector<dJointID> lasting_;
  std::vector<std::unique_ptr<dJointFeedback>> forces_;  // ODE has their addresses
  std::size_t used_ = 0;
};

}  // namespace tandem::core
