// A thrust of limited strength by default, rotors on request: a quadrotor that leans needs sub-steps of 5 ms and a
// rigid body in ODE for every robot of its region; the thrust needs 20 ms, and ODE only in contact. The price: without
// flight="rotors" cameras and gyroscopes feel no lean. One suite of tests holds both to the same limits.
#include "core/physics/dynamics3d/drive.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr double kApproach_1_s = 2.0;   // speed of a flyer towards a position, a metre of distance, when near it
constexpr double kGravity_m_s2 = 9.81;  // that rotors are made for

// Of robots with rotors: one loop in the other, each three to five times as fast as the one around it [Mellinger and
// Kumar 2011, "Minimum snap trajectory generation and control for quadrotors", ICRA].
constexpr double kPlace_1_s = 1.0;      // speed towards a position, a metre of distance
constexpr double kSpeed_1_s = 3.0;      // acceleration, a metre a second of what lacks to the velocity
constexpr double kLean_1_s2 = 80.0;     // angular acceleration, a radian of what lacks to the lean
constexpr double kLeanRate_1_s = 16.0;  // … a radian a second
constexpr double kTurn_1_s = 5.0;       // … of what lacks to the turn rate

/// `from`, moved towards `to` by at most `most`.
double nearer(double from, double to, double most) noexcept {
  return from + std::clamp(to - from, -most, most);
}

/// Makes `v` the vector nearest to `goal` that lies within `most` of it.
void approach(Vector3& v, const Vector3& goal, double most) noexcept {
  Vector3 change{goal[0] - v[0], goal[1] - v[1], goal[2] - v[2]};
  const double size = std::sqrt(change[0] * change[0] + change[1] * change[1] + change[2] * change[2]);
  const double k = size > most ? most / size : 1.0;
  for (std::size_t i = 0; i < 3; ++i) v[i] = k < 1.0 ? v[i] + k * change[i] : goal[i];
}

/// The velocity with which a flyer nears `target_m` such that it can stop there.
Vector3 towards(const Vector3& p_m, const Vector3& target_m, const hal::Quadrotor& flight, double near_1_s) noexcept {
  Vector3 way{target_m[0] - p_m[0], target_m[1] - p_m[1], target_m[2] - p_m[2]};
  const double distance = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  if (distance == 0.0) return {};
  // Half the braking power is kept in hand.
  const double speed =
      std::min({flight.max_speed_m_s, near_1_s * distance, std::sqrt(flight.max_acceleration_m_s2 * distance)});
  for (double& w : way) w *= speed / distance;
  return way;
}

double length(const Vector3& v) noexcept {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/// The velocity that a command asks for, within the kind's limit.
Vector3 wanted_velocity(const Vector3& p_m, const FlightCommand& command, const hal::Quadrotor& flight,
                        double near_1_s) noexcept {
  const bool to_place = command.mode == FlightCommand::Mode::Position;
  Vector3 goal = to_place ? towards(p_m, command.target, flight, near_1_s) : command.target;
  const double size = length(goal);
  if (size > flight.max_speed_m_s) {
    for (double& g : goal) g *= flight.max_speed_m_s / size;
  }
  return goal;
}

/// The turn rate that a command asks for.
double wanted_turn(double cos_h, double sin_h, const FlightCommand& command, const hal::Quadrotor& flight) noexcept {
  double turn = command.yaw;
  if (command.mode == FlightCommand::Mode::Position) {
    const double c = std::cos(command.yaw);
    const double s = std::sin(command.yaw);
    turn = kApproach_1_s * std::atan2(s * cos_h - c * sin_h, c * cos_h + s * sin_h);
  }
  return std::clamp(turn, -flight.max_turn_rad_s, flight.max_turn_rad_s);
}

/// What rotors push a body that leans as told with, gravity apart, in m/s^2 of W.
Vector3 lift_of(const FlightCommand& command, const hal::Quadrotor& flight, double cos_h, double sin_h,
                double gravity_m_s2) noexcept {
  const double lift = std::clamp(command.target[2], 0.0, flight.max_thrust) * gravity_m_s2;
  const double ahead = lift * std::sin(command.target[1]) * std::cos(command.target[0]);
  const double aside = -lift * std::sin(command.target[0]);
  return {cos_h * ahead - sin_h * aside, sin_h * ahead + cos_h * aside,
          lift * std::cos(command.target[1]) * std::cos(command.target[0])};
}

}  // namespace

void drive_base(BodyProxy& proxy, double left_m_s, double right_m_s, double dt_s) noexcept {
  const hal::DifferentialDrive& wheels = *proxy.drive;
  proxy.turn_rad_s = (right_m_s - left_m_s) / wheels.wheel_base_m;
  const double inertia = 0.5 * proxy.mass_kg * proxy.prism.radius_m * proxy.prism.radius_m;
  proxy.next_w_rad_s = nearer(proxy.w_rad_s, proxy.turn_rad_s, wheels.torque_Nm / inertia * dt_s);
  // The chord of the arc: its direction is the heading in the middle, its length a little less than the arc's.
  const double half = 0.5 * proxy.next_w_rad_s * dt_s;
  const double half2 = half * half;
  const double chord_m_s =
      0.5 * (left_m_s + right_m_s) * (1.0 - half2 / 6.0 * (1.0 - half2 / 20.0 * (1.0 - half2 / 42.0)));
  const auto [c, s] = proxy.turn_by_half.of(1.0, 0.0, half);
  proxy.forward_m_s = chord_m_s * c;
  proxy.leftward_m_s = chord_m_s * s;
  const Vector3 goal{proxy.cos_h * proxy.forward_m_s - proxy.sin_h * proxy.leftward_m_s,
                     proxy.sin_h * proxy.forward_m_s + proxy.cos_h * proxy.leftward_m_s, proxy.v_m_s[2]};
  proxy.next_v_m_s = proxy.v_m_s;
  approach(proxy.next_v_m_s, goal, wheels.force_N / proxy.mass_kg * dt_s);
}

void drive_flyer(BodyProxy& proxy, const FlightCommand& command, double gravity_m_s2, double dt_s) noexcept {
  if (command.mode == FlightCommand::Mode::None) {
    drop(proxy, gravity_m_s2, dt_s);
    return;
  }
  const hal::Quadrotor& flight = *proxy.flight;
  proxy.next_v_m_s = proxy.v_m_s;
  proxy.next_w_rad_s = wanted_turn(proxy.cos_h, proxy.sin_h, command, flight);
  if (command.mode == FlightCommand::Mode::Attitude) {
    const Vector3 lift = lift_of(command, flight, proxy.cos_h, proxy.sin_h, gravity_m_s2);
    for (std::size_t i = 0; i < 3; ++i) proxy.next_v_m_s[i] += lift[i] * dt_s;
    proxy.next_v_m_s[2] -= gravity_m_s2 * dt_s;
    const double speed = length(proxy.next_v_m_s);
    if (speed > flight.max_speed_m_s) {
      for (double& v : proxy.next_v_m_s) v *= flight.max_speed_m_s / speed;
    }
    return;
  }
  approach(proxy.next_v_m_s, wanted_velocity(proxy.p_m, command, flight, kApproach_1_s),
           flight.max_acceleration_m_s2 * dt_s);
}

void drive_rotors(BodyProxy& proxy, const FlightCommand& command, double gravity_m_s2, double dt_s) {
  const hal::Quadrotor& flight = *proxy.flight;
  const dBodyID body = proxy.body.get();
  const dReal* p = dBodyGetPosition(body);
  const dReal* r = dBodyGetRotation(body);
  const dReal* v = dBodyGetLinearVel(body);
  const dReal* w = dBodyGetAngularVel(body);
  const Vector3 up{r[2], r[6], r[10]};
  const auto to_body = [r](const Vector3& a) {
    return Vector3{r[0] * a[0] + r[4] * a[1] + r[8] * a[2], r[1] * a[0] + r[5] * a[1] + r[9] * a[2],
                   r[2] * a[0] + r[6] * a[1] + r[10] * a[2]};
  };
  if (!proxy.rotors.spun) {
    if (command.mode != FlightCommand::Mode::None) proxy.rotors.thrust_N.fill(0.25 * proxy.mass_kg * gravity_m_s2);
    proxy.rotors.spun = true;
  }

  // The force that is wanted, in W.
  Vector3 force{};
  const double level = std::sqrt(r[0] * r[0] + r[4] * r[4]);
  const double cos_h = level > 0.0 ? r[0] / level : 1.0;
  const double sin_h = level > 0.0 ? r[4] / level : 0.0;
  if (command.mode == FlightCommand::Mode::Attitude) {
    force = lift_of(command, flight, cos_h, sin_h, gravity_m_s2);
  } else if (command.mode != FlightCommand::Mode::None) {
    const Vector3 base{p[0], p[1], p[2] - proxy.origin_m};
    const Vector3 goal = wanted_velocity(base, command, flight, kPlace_1_s);
    Vector3 wanted{kSpeed_1_s * (goal[0] - v[0]), kSpeed_1_s * (goal[1] - v[1]), kSpeed_1_s * (goal[2] - v[2])};
    approach(force, wanted, flight.max_acceleration_m_s2);
    force[2] += gravity_m_s2;
  }
  for (double& f : force) f *= proxy.mass_kg;

  // What the rotors together are to do: thrust along the body's axis, and torque that brings the axis to the force.
  const double size = length(force);
  const double thrust_N = force[0] * up[0] + force[1] * up[1] + force[2] * up[2];
  Vector3 torque{};
  if (size > 0.0) {
    const Vector3 lacks =
        to_body({(up[1] * force[2] - up[2] * force[1]) / size, (up[2] * force[0] - up[0] * force[2]) / size,
                 (up[0] * force[1] - up[1] * force[0]) / size});
    const Vector3 rate = to_body({w[0], w[1], w[2]});
    const double turn = wanted_turn(cos_h, sin_h, command, flight);
    torque = {flight.inertia_kg_m2 * (kLean_1_s2 * lacks[0] - kLeanRate_1_s * rate[0]),
              flight.inertia_kg_m2 * (kLean_1_s2 * lacks[1] - kLeanRate_1_s * rate[1]),
              flight.inertia_kg_m2 * kTurn_1_s * (turn - rate[2])};
  }

  // Of each rotor: ahead left, behind left, behind right, ahead right; neighbours turn against one another.
  constexpr std::array<double, 4> kAhead = {1.0, -1.0, -1.0, 1.0};
  constexpr std::array<double, 4> kLeft = {1.0, 1.0, -1.0, -1.0};
  constexpr std::array<double, 4> kSpin = {1.0, -1.0, 1.0, -1.0};
  const double arm_m = flight.rotor_arm_m * std::sqrt(0.5);
  const double most_N = 0.25 * flight.max_thrust * proxy.mass_kg * kGravity_m_s2;
  const double share = 1.0 - std::exp(-dt_s / flight.rotor_lag_s);
  double all_N = 0.0;
  Vector3 done{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double wanted_N = 0.25 * (thrust_N + (kLeft[i] * torque[0] - kAhead[i] * torque[1]) / arm_m +
                                    kSpin[i] * torque[2] / flight.rotor_torque_m);
    double& f = proxy.rotors.thrust_N[i];
    f += share * (std::clamp(wanted_N, 0.0, most_N) - f);
    all_N += f;
    done[0] += kLeft[i] * arm_m * f;
    done[1] -= kAhead[i] * arm_m * f;
    done[2] += kSpin[i] * flight.rotor_torque_m * f;
  }
  dBodyAddRelForce(body, 0.0, 0.0, all_N);
  dBodyAddRelTorque(body, done[0], done[1], done[2]);
}

void drop(BodyProxy& proxy, double gravity_m_s2, double dt_s) noexcept {
  proxy.next_v_m_s = proxy.v_m_s;
  proxy.next_v_m_s[2] -= gravity_m_s2 * dt_s;
  proxy.next_w_rad_s = proxy.w_rad_s;
}

void engage(BodyProxy& proxy, dWorldID world) {
  if (!proxy.push) {
    proxy.push = OdeJoint(dJointCreateLMotor(world, nullptr));
    dJointAttach(proxy.push.get(), proxy.body.get(), nullptr);
    proxy.turn = OdeJoint(dJointCreateAMotor(world, nullptr));
    dJointAttach(proxy.turn.get(), proxy.body.get(), nullptr);
    dJointSetAMotorMode(proxy.turn.get(), dAMotorUser);
    dJointSetAMotorNumAxes(proxy.turn.get(), 1);
    dJointSetAMotorAxis(proxy.turn.get(), 0, 0, 0.0, 0.0, 1.0);
    dJointSetAMotorParam(proxy.turn.get(), dParamFMax, proxy.drive->torque_Nm);
    dJointSetLMotorParam(proxy.push.get(), dParamFMax1, proxy.drive->force_N);
    dJointSetLMotorParam(proxy.push.get(), dParamFMax2, proxy.drive->force_N);
    dJointSetLMotorParam(proxy.push.get(), dParamFMax3, dInfinity);
    dJointSetLMotorParam(proxy.push.get(), dParamVel3, 0.0);
  }
  const dJointID push = proxy.push.get();
  dJointEnable(push);
  dJointEnable(proxy.turn.get());
  dJointSetLMotorNumAxes(push, proxy.aloft ? 2 : 3);  // the floor holds its height
  dJointSetLMotorAxis(push, 0, 0, proxy.cos_h, proxy.sin_h, 0.0);
  dJointSetLMotorAxis(push, 1, 0, -proxy.sin_h, proxy.cos_h, 0.0);
  if (!proxy.aloft) dJointSetLMotorAxis(push, 2, 0, 0.0, 0.0, 1.0);
  dJointSetLMotorParam(push, dParamVel1, proxy.forward_m_s);
  dJointSetLMotorParam(push, dParamVel2, proxy.leftward_m_s);
  dJointSetAMotorParam(proxy.turn.get(), dParamVel, proxy.turn_rad_s);
}

void release(BodyProxy& proxy) noexcept {
  if (!proxy.push) return;
  dJointDisable(proxy.push.get());
  dJointDisable(proxy.turn.get());
}

void drive_wheels(BodyProxy& proxy, double left_m_s, double right_m_s) {
  dJointSetHingeParam(proxy.axles[0].get(), dParamVel, left_m_s / proxy.drive->wheel_radius_m);
  dJointSetHingeParam(proxy.axles[1].get(), dParamVel, right_m_s / proxy.drive->wheel_radius_m);
}

void count_wheels(BodyProxy& proxy, double dt_s) noexcept {
  for (std::size_t side = 0; side < 2; ++side)
    proxy.rolled_m[side] += dJointGetHingeAngleRate(proxy.axles[side].get()) * proxy.drive->wheel_radius_m * dt_s;
}

}  // namespace tandem::core
