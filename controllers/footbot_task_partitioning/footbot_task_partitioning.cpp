#include "controllers/footbot_task_partitioning/footbot_task_partitioning.hpp"

#include <cmath>
#include <numbers>

#include "controllers/steering/drive.hpp"
#include "hal/angle.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/vector2.hpp"

namespace tandem::controllers {
namespace {

constexpr double kTurn_m_s = 0.05;         // rim speed of turns on the spot
constexpr double kNear_m = 0.10;           // this near to a place counts as there
constexpr double kBlindAfterTurn_s = 1.5;  // straight on after a turn before things are looked at again
constexpr double kIntoNest_m = 0.15;       // the whole object is to be in the nest
constexpr double kBackOff_m = 0.12;        // after the drop, so that the turn does not take the object along
constexpr double kCarried_rad = 1.0;       // proximity sensors this near to forward see the load
constexpr double kRobotAhead_m = 0.45;     // keep so far from other robots
constexpr double kCarryMost_s = 120.0;     // then it is dropped wherever it is: robots that block one another
constexpr double kBackOffMost_s = 4.0;

constexpr hal::Rgb kColors[] = {hal::kBlack, {0, 255, 255}, {255, 255, 0}, hal::kRed,
                                hal::kBlue,  hal::kGreen,   hal::kWhite};

hal::TimeNs in_s(double s) noexcept {
  return static_cast<hal::TimeNs>(s * 1e9);
}

}  // namespace

FootbotTaskPartitioning::FootbotTaskPartitioning(hal::Robot& robot, const Params& params)
    : proximity_(robot.sensor<hal::Proximity>()),
      light_(robot.sensor<hal::Light>()),
      ground_(robot.sensor<hal::MotorGround>()),
      odometry_(robot.sensor<hal::Odometry>()),
      heard_(robot.sensor<hal::RangeAndBearing>()),
      clock_(robot.sensor<hal::Clock>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      send_(robot.actuator<hal::RangeAndBearingSend>()),
      leds_(robot.actuator<hal::RingLeds>()),
      proximity_mounts_(robot.part<hal::ProximityPart>().mounts),
      light_mounts_(robot.part<hal::LightPart>().mounts),
      params_(params),
      grasp_(robot, params.broadest_m),
      random_(robot.random()) {
  send_.sending = true;  // so that nobody takes it for an object
  send_.size = 1;
  robot.publish("state", state_, {"explore", "return", "search", "grasp", "turn", "carry", "release"}, "what it does");
}

void FootbotTaskPartitioning::step() noexcept {
  if (!fresh()) {  // blind, e.g. a real robot whose link is silent
    wheels_.set(0.0, 0.0);
    return;
  }
  switch (state_) {
    case State::Explore:
      return explore();
    case State::Return:
      return go_back();
    case State::Search:
      return search();
    case State::Grasp:
      return grasp();
    case State::Turn:
      return turn();
    case State::Carry:
      return carry();
    case State::Release:
      return release();
  }
}

bool FootbotTaskPartitioning::fresh() const noexcept {
  return proximity_.validity == hal::Validity::Fresh && odometry_.validity == hal::Validity::Fresh &&
         light_.validity == hal::Validity::Fresh;
}

double FootbotTaskPartitioning::distance_to(const hal::Vector2& place) const noexcept {
  return hal::length_of(place - hal::Vector2(odometry_.x_m, odometry_.y_m));
}

double FootbotTaskPartitioning::bearing_to(const hal::Vector2& place) const noexcept {
  return hal::turn_between(odometry_.heading_rad, hal::bearing_of(place - hal::Vector2(odometry_.x_m, odometry_.y_m)));
}

void FootbotTaskPartitioning::enter(State state) noexcept {
  state_ = state;
  since_ns_ = clock_.now_ns;
  leds_.set_all(kColors[static_cast<std::size_t>(state)]);
}

// --- looking for objects ---

void FootbotTaskPartitioning::explore() noexcept {
  if (found_something(State::Explore) || avoid_robots()) return;
  if (clock_.now_ns >= leg_until_ns_) {
    leg_until_ns_ = clock_.now_ns + in_s(random_.uniform(5.0, 15.0));
    goal_heading_rad_ = hal::wrapped(odometry_.heading_rad + random_.uniform(-1.5, 1.5));
  }
  drive_towards(wheels_, hal::wrapped(goal_heading_rad_ - odometry_.heading_rad), params_.velocity_m_s);
}

void FootbotTaskPartitioning::search() noexcept {
  if (clock_.now_ns >= search_until_ns_) {
    knows_place_ = false;
    leg_until_ns_ = 0;
    return enter(State::Explore);
  }
  if (found_something(State::Search) || avoid_robots()) return;
  if (distance_to(waypoint_) < kNear_m || clock_.now_ns >= leg_until_ns_) {
    const double direction_rad = random_.uniform(-std::numbers::pi, std::numbers::pi);
    const double away_m = params_.search_m * std::sqrt(random_.uniform(0.0, 1.0));
    waypoint_ = place_ + hal::polar(away_m, direction_rad);
    leg_until_ns_ = clock_.now_ns + in_s(5.0 + 2.0 * distance_to(waypoint_) / params_.velocity_m_s);
  }
  drive_towards(wheels_, bearing_to(waypoint_), params_.velocity_m_s);
}

/// In the nest objects are where they should be.
bool FootbotTaskPartitioning::found_something(State after) noexcept {
  const Thing thing = grasp_.thing();
  if (!thing.seen) return false;
  if (thing.breadth_m > params_.broadest_m || mean_reflectance(ground_) < params_.dark ||
      robot_near(heard_, thing.bearing_rad, 1.0, kRobotAhead_m)) {
    if (std::fabs(thing.bearing_rad) > 0.5 * std::numbers::pi) return false;  // it is passed already
    turn_away(thing.bearing_rad, after);
    return true;
  }
  after_ = after;
  grasp_.start();
  enter(State::Grasp);
  grasp();
  return true;
}

bool FootbotTaskPartitioning::avoid_robots() noexcept {
  for (std::size_t k = 0; k < heard_.count && static_cast<double>(heard_.range_m[k]) < kRobotAhead_m; ++k) {
    const double bearing_rad = static_cast<double>(heard_.bearing_rad[k]);
    if (std::fabs(bearing_rad) > 0.8) continue;
    turn_away(bearing_rad, state_);
    return true;
  }
  return false;
}

void FootbotTaskPartitioning::turn_away(double bearing_rad, State then) noexcept {
  after_ = then;
  const double off_rad = std::numbers::pi + random_.uniform(-1.2, 1.2);
  goal_heading_rad_ = hal::wrapped(odometry_.heading_rad + bearing_rad + off_rad);
  turned_ = false;
  enter(State::Turn);
  turn();
}

void FootbotTaskPartitioning::turn() noexcept {
  if (!turned_) {
    turned_ = turn_by(wheels_, hal::wrapped(goal_heading_rad_ - odometry_.heading_rad), kTurn_m_s);
    since_ns_ = clock_.now_ns;
    return;
  }
  wheels_.set(params_.velocity_m_s, params_.velocity_m_s);
  if (in_state_s() < kBlindAfterTurn_s) return;
  leg_until_ns_ = clock_.now_ns + in_s(5.0);
  enter(after_);
}

void FootbotTaskPartitioning::grasp() noexcept {
  switch (grasp_.step()) {
    case Grasp::Outcome::Working:
      return;
    case Grasp::Outcome::Lost:
      return enter(after_);
    case Grasp::Outcome::Obstacle:
      return turn_away(0.0, after_);
    case Grasp::Outcome::Held:
      break;
  }
  place_ = {odometry_.x_m, odometry_.y_m};
  knows_place_ = true;
  enter(State::Carry);
}

// --- bringing them home ---

void FootbotTaskPartitioning::carry() noexcept {
  if (!grasp_.holding()) return enter(State::Release);  // somebody took it away
  const bool home = mean_reflectance(ground_) < params_.dark;
  if (!home) waypoint_ = {odometry_.x_m, odometry_.y_m};  // the last place outside of the nest
  if ((home && distance_to(waypoint_) > kIntoNest_m) || distance_to(place_) > params_.carry_m ||
      in_state_s() > kCarryMost_s)
    return enter(State::Release);
  const hal::Vector2 light = to_light(light_, light_mounts_);
  const double brightness = hal::length_of(light);
  const hal::Vector2 push = push_away(proximity_, proximity_mounts_, kCarried_rad);
  const hal::Vector2 way = brightness > 0.0 ? hal::Vector2(light / brightness) : hal::Vector2(1.0, 0.0);
  double bearing_rad = hal::bearing_of(way + 8.0 * push);
  if (robot_near(heard_, 0.2, 0.8, kRobotAhead_m)) bearing_rad -= 1.0;  // everybody keeps right
  drive_towards(wheels_, bearing_rad, params_.velocity_m_s);
}

void FootbotTaskPartitioning::release() noexcept {
  grasp_.let_go();
  if (in_state_s() < kBackOff_m / params_.velocity_m_s && in_state_s() < kBackOffMost_s) {
    wheels_.set(-params_.velocity_m_s, -params_.velocity_m_s);
    return;
  }
  if (!knows_place_) return enter(State::Explore);
  return_until_ns_ = clock_.now_ns + in_s(20.0 + 3.0 * distance_to(place_) / params_.velocity_m_s);
  enter(State::Return);
}

void FootbotTaskPartitioning::go_back() noexcept {
  if (distance_to(place_) < kNear_m) {
    search_until_ns_ = clock_.now_ns + in_s(params_.search_s);
    waypoint_ = place_;
    leg_until_ns_ = 0;
    return enter(State::Search);
  }
  if (clock_.now_ns >= return_until_ns_) {
    knows_place_ = false;
    leg_until_ns_ = 0;
    return enter(State::Explore);
  }
  if (distance_to(place_) < params_.search_m && found_something(State::Return)) return;
  const double to_place_rad = bearing_to(place_);
  if (std::fabs(to_place_rad) > 0.6) return drive_towards(wheels_, to_place_rad, params_.velocity_m_s);
  const hal::Vector2 push = push_away(proximity_, proximity_mounts_);
  double bearing_rad = hal::bearing_of(hal::polar(1.0, to_place_rad) + 8.0 * push);
  if (robot_near(heard_, 0.2, 0.8, kRobotAhead_m)) bearing_rad -= 1.0;
  drive_towards(wheels_, bearing_rad, params_.velocity_m_s);
}

}  // namespace tandem::controllers
