#include "controllers/footbot_gripping/footbot_gripping.hpp"

#include <cmath>

#include "controllers/steering/drive.hpp"
#include "controllers/steering/nearby.hpp"
#include "hal/angle.hpp"
#include "hal/elementary.hpp"

namespace tandem::controllers {
namespace {

constexpr double kTurn_m_s = 0.05;
constexpr double kAtHome_m = 0.05;
constexpr double kLeave_m = 0.15;  // on from what it let go

}  // namespace

FootbotGripping::FootbotGripping(hal::Robot& robot, const Params& params)
    : proximity_(robot.sensor<hal::Proximity>()),
      odometry_(robot.sensor<hal::Odometry>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      turret_(robot.actuator<hal::TurretDrive>()),
      send_(robot.actuator<hal::RangeAndBearingSend>()),
      params_(params),
      grasp_(robot, params.broadest_m) {
  send_.sending = true;  // so that others of its kind do not grip it
  send_.size = 1;
  robot.publish("state", state_, {"look", "grasp", "turn", "home", "leave", "stay"}, "what it does");
}

void FootbotGripping::step() noexcept {
  if (proximity_.validity != hal::Validity::Fresh || odometry_.validity != hal::Validity::Fresh) {
    wheels_.set(0.0, 0.0);
    return;
  }
  switch (state_) {
    case State::Look:
      return look();
    case State::Grasp:
      return grasp();
    case State::Turn:
      return turn();
    case State::Home:
      return go_home();
    case State::Leave:
      return leave();
    case State::Stay:
      return wheels_.set(0.0, 0.0);
  }
}

double FootbotGripping::from_home_m() const noexcept {
  return hal::hypot(odometry_.x_m, odometry_.y_m);
}

double FootbotGripping::bearing_of_home_rad() const noexcept {
  return hal::wrapped(hal::atan2(-odometry_.y_m, -odometry_.x_m) - odometry_.heading_rad);
}

void FootbotGripping::look() noexcept {
  if (grasp_.thing().seen) {
    turret_.turn_off();
    grasp_.start();
    state_ = State::Grasp;
    return grasp();
  }
  if (odometry_.x_m >= params_.range_m) state_ = State::Home;
  wheels_.set(params_.velocity_m_s, params_.velocity_m_s);
}

void FootbotGripping::grasp() noexcept {
  switch (grasp_.step()) {
    case Grasp::Outcome::Working:
      return;
    case Grasp::Outcome::Lost:
      state_ = State::Look;
      return;
    case Grasp::Outcome::Obstacle:
      state_ = State::Home;
      return;
    case Grasp::Outcome::Held:
      break;
  }
  turret_.let_go();
  state_ = State::Turn;
}

void FootbotGripping::turn() noexcept {
  if (!turn_by(wheels_, bearing_of_home_rad(), kTurn_m_s, 0.05)) return;
  turret_.turn_off();
  state_ = State::Home;
}

void FootbotGripping::go_home() noexcept {
  if (from_home_m() > kAtHome_m) return drive_towards(wheels_, bearing_of_home_rad(), params_.velocity_m_s);
  wheels_.set(0.0, 0.0);
  state_ = grasp_.holding() ? State::Leave : State::Stay;
  grasp_.let_go();
}

void FootbotGripping::leave() noexcept {
  if (from_home_m() > kLeave_m) state_ = State::Stay;
  wheels_.set(params_.velocity_m_s, params_.velocity_m_s);
}

}  // namespace tandem::controllers
