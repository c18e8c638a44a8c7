#include "core/physics/dynamics3d/drive.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr double kApproach_1_s = 2.0;  // speed of a flyer towards a position, a metre of distance, when near it

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
Vector3 towards(const Vector3& p_m, const Vector3& target_m, const hal::DataSheet& sheet) noexcept {
  Vector3 way{target_m[0] - p_m[0], target_m[1] - p_m[1], target_m[2] - p_m[2]};
  const double distance = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  if (distance == 0.0) return {};
  // Half the braking power is kept in hand.
  const double speed = std::min(
      {sheet.max_flight_speed_m_s, kApproach_1_s * distance, std::sqrt(sheet.max_flight_acceleration_m_s2 * distance)});
  for (double& w : way) w *= speed / distance;
  return way;
}

}  // namespace

void drive_base(Twin& twin, double left_m_s, double right_m_s, double dt_s) noexcept {
  const hal::DataSheet& sheet = *twin.sheet;
  twin.turn_rad_s = (right_m_s - left_m_s) / sheet.wheel_base_m;
  const double inertia = 0.5 * twin.mass_kg * twin.prism.radius_m * twin.prism.radius_m;
  twin.next_w_rad_s = nearer(twin.w_rad_s, twin.turn_rad_s, sheet.drive_torque_Nm / inertia * dt_s);
  // The chord of the arc: its direction is the heading in the middle, its length a little less than the arc's.
  const double half = 0.5 * twin.next_w_rad_s * dt_s;
  const double half2 = half * half;
  const double chord_m_s =
      0.5 * (left_m_s + right_m_s) * (1.0 - half2 / 6.0 * (1.0 - half2 / 20.0 * (1.0 - half2 / 42.0)));
  const auto [c, s] = turned(1.0, 0.0, half);
  twin.forward_m_s = chord_m_s * c;
  twin.leftward_m_s = chord_m_s * s;
  const Vector3 goal{twin.cos_h * twin.forward_m_s - twin.sin_h * twin.leftward_m_s,
                     twin.sin_h * twin.forward_m_s + twin.cos_h * twin.leftward_m_s, twin.v_m_s[2]};
  twin.next_v_m_s = twin.v_m_s;
  approach(twin.next_v_m_s, goal, sheet.drive_force_N / twin.mass_kg * dt_s);
}

void drive_flyer(Twin& twin, const FlightCommand& command, double gravity_m_s2, double dt_s) noexcept {
  if (command.mode == FlightCommand::Mode::None) {
    drop(twin, gravity_m_s2, dt_s);
    return;
  }
  const hal::DataSheet& sheet = *twin.sheet;
  const bool hold = command.mode == FlightCommand::Mode::Position;
  Vector3 goal = hold ? towards(twin.p_m, command.target, sheet) : command.target;
  const double size = std::sqrt(goal[0] * goal[0] + goal[1] * goal[1] + goal[2] * goal[2]);
  if (size > sheet.max_flight_speed_m_s) {
    for (double& g : goal) g *= sheet.max_flight_speed_m_s / size;
  }
  twin.next_v_m_s = twin.v_m_s;
  approach(twin.next_v_m_s, goal, sheet.max_flight_acceleration_m_s2 * dt_s);
  double turn = command.yaw;
  if (hold) {
    const double c = std::cos(command.yaw);
    const double s = std::sin(command.yaw);
    turn = kApproach_1_s * std::atan2(s * twin.cos_h - c * twin.sin_h, c * twin.cos_h + s * twin.sin_h);
  }
  twin.next_w_rad_s = std::clamp(turn, -sheet.max_flight_turn_rad_s, sheet.max_flight_turn_rad_s);
}

void drop(Twin& twin, double gravity_m_s2, double dt_s) noexcept {
  twin.next_v_m_s = twin.v_m_s;
  twin.next_v_m_s[2] -= gravity_m_s2 * dt_s;
  twin.next_w_rad_s = twin.w_rad_s;
}

void engage(Twin& twin, dWorldID world) {
  if (!twin.push) {
    twin.push = OdeJoint(dJointCreateLMotor(world, nullptr));
    dJointAttach(twin.push.get(), twin.body.get(), nullptr);
    twin.turn = OdeJoint(dJointCreateAMotor(world, nullptr));
    dJointAttach(twin.turn.get(), twin.body.get(), nullptr);
    dJointSetAMotorMode(twin.turn.get(), dAMotorUser);
    dJointSetAMotorNumAxes(twin.turn.get(), 1);
    dJointSetAMotorAxis(twin.turn.get(), 0, 0, 0.0, 0.0, 1.0);
    dJointSetAMotorParam(twin.turn.get(), dParamFMax, twin.sheet->drive_torque_Nm);
    dJointSetLMotorParam(twin.push.get(), dParamFMax1, twin.sheet->drive_force_N);
    dJointSetLMotorParam(twin.push.get(), dParamFMax2, twin.sheet->drive_force_N);
    dJointSetLMotorParam(twin.push.get(), dParamFMax3, dInfinity);
    dJointSetLMotorParam(twin.push.get(), dParamVel3, 0.0);
  }
  const dJointID push = twin.push.get();
  dJointEnable(push);
  dJointEnable(twin.turn.get());
  dJointSetLMotorNumAxes(push, twin.aloft ? 2 : 3);  // the floor holds its height
  dJointSetLMotorAxis(push, 0, 0, twin.cos_h, twin.sin_h, 0.0);
  dJointSetLMotorAxis(push, 1, 0, -twin.sin_h, twin.cos_h, 0.0);
  if (!twin.aloft) dJointSetLMotorAxis(push, 2, 0, 0.0, 0.0, 1.0);
  dJointSetLMotorParam(push, dParamVel1, twin.forward_m_s);
  dJointSetLMotorParam(push, dParamVel2, twin.leftward_m_s);
  dJointSetAMotorParam(twin.turn.get(), dParamVel, twin.turn_rad_s);
}

void release(Twin& twin) noexcept {
  if (!twin.push) return;
  dJointDisable(twin.push.get());
  dJointDisable(twin.turn.get());
}

void drive_wheels(Twin& twin, double left_m_s, double right_m_s) {
  dJointSetHingeParam(twin.axles[0].get(), dParamVel, left_m_s / twin.sheet->wheel_radius_m);
  dJointSetHingeParam(twin.axles[1].get(), dParamVel, right_m_s / twin.sheet->wheel_radius_m);
}

void count_wheels(Twin& twin, double dt_s) noexcept {
  for (std::size_t side = 0; side < 2; ++side)
    twin.rolled_m[side] += dJointGetHingeAngleRate(twin.axles[side].get()) * twin.sheet->wheel_radius_m * dt_s;
}

}  // namespace tandem::core
