// Smooth obstacle avoidance for any two-wheeled robot with a ring of proximity sensors.
#pragma once
#include "hal/controller.hpp"
#include "hal/device/ring_directions.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// A Braitenberg vehicle [Braitenberg 1984, vehicle 3]: drives at its cruising speed, slows down before what is ahead
/// and turns away from the side where more is near. Without a fresh reading it stands still.
class ObstacleAvoidance final : public hal::Controller {
 public:
  struct Params {
    double cruise_m_s = 0.08;
    double gain = 1.5;
    double turn_at = 0.6;
    void describe(hal::ParamVisitor& v) {
      v.number("cruise", cruise_m_s, hal::unit::cm_s, {0.0, 100.0}, "Speed on free ground.");
      v.number("gain", gain, hal::unit::none, {0.0, 20.0},
               "How strongly an obstacle on one side turns the robot to the other.");
      v.number("turn_at", turn_at, hal::unit::none, {0.0, 2.0},
               "Closeness ahead (0 far, 1 contact) from which it turns on the spot.");
    }
  };

  ObstacleAvoidance(hal::Robot& robot, const Params& params);

  void step() noexcept override;
  void controls(hal::Controls& c) override {
    c.number("cruise", params_.cruise_m_s, hal::unit::cm_s, {0.0, 0.3}, "Speed on free ground.");
    c.number("gain", params_.gain, hal::unit::none, {0.0, 20.0}, "How strongly it turns away from obstacles.");
  }

 private:
  const hal::Proximity& proximity_;
  hal::WheelSpeeds& wheels_;
  const hal::RingDirections& directions_;
  Params params_;
  double turning_ = 0.0;  // +1 left, -1 right while turning on the spot: keeps to one side in corners
};

}  // namespace tandem::controllers
