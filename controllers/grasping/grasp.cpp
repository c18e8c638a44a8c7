#include "controllers/grasping/grasp.hpp"

#include <cmath>

#include "controllers/steering/drive.hpp"

namespace tandem::controllers {
namespace {

constexpr hal::TimeNs kPatience_ns = 15'000'000'000;  // of one attempt
constexpr hal::TimeNs kClawsOpen_ns = 1'500'000'000;  // that claws which meet nothing stay open
constexpr double kApproach_m_s = 0.05;
constexpr double kTurn_m_s = 0.03;
constexpr double kAhead_rad = 0.12;
constexpr double kRobotInTheWay_m = 0.45;

}  // namespace

Grasp::Grasp(hal::Robot& robot, double broadest_m)
    : proximity_(robot.sensor<hal::Proximity>()),
      heard_(robot.sensor<hal::RangeAndBearing>()),
      gripper_(robot.sensor<hal::Gripper>()),
      clock_(robot.sensor<hal::Clock>()),
      wheels_(robot.actuator<hal::WheelSpeeds>()),
      claws_(robot.actuator<hal::GripperDrive>()),
      mounts_(robot.part<hal::ProximityPart>().mounts),
      broadest_m_(broadest_m),
      reach_m_(robot.part<hal::GripperPart>().reach_m) {}

Thing Grasp::thing() const noexcept {
  return nearest_thing(proximity_, mounts_, heard_);
}

void Grasp::start() noexcept {
  claws_.unlock();
  started_ns_ = clock_.now_ns;
}

Grasp::Outcome Grasp::give_up(Outcome outcome) noexcept {
  claws_.unlock();
  wheels_.set(0.0, 0.0);
  return outcome;
}

Grasp::Outcome Grasp::step() noexcept {
  if (claws_.locks()) {
    wheels_.set(0.0, 0.0);
    if (gripper_.holding) return Outcome::Held;
    return clock_.now_ns - opened_ns_ > kClawsOpen_ns ? give_up(Outcome::Obstacle) : Outcome::Working;
  }
  const Thing it = thing();
  if (!it.seen) return give_up(Outcome::Lost);
  if (it.breadth_m > broadest_m_ || clock_.now_ns - started_ns_ > kPatience_ns) return give_up(Outcome::Obstacle);
  if (robot_near(heard_, it.bearing_rad, 1.0, kRobotInTheWay_m)) return give_up(Outcome::Obstacle);  // it may be theirs
  if (std::fabs(it.bearing_rad) > kAhead_rad) {
    turn_by(wheels_, it.bearing_rad, kTurn_m_s, kAhead_rad);
  } else if (it.gap_m > 0.5 * reach_m_) {
    drive_towards(wheels_, it.bearing_rad, kApproach_m_s);
  } else {
    wheels_.set(0.0, 0.0);
    claws_.lock();
    opened_ns_ = clock_.now_ns;
  }
  return Outcome::Working;
}

}  // namespace tandem::controllers
