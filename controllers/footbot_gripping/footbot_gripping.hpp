// Fetches the first thing ahead with gripper and turret.
#pragma once
#include "controllers/grasping/grasp.hpp"
#include "hal/controller.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Drives straight on until its proximity sensors see something, goes there and grips it. With the turret passive the
/// body then turns round beneath what is held; with the turret off again it pulls that behind it to where it started,
/// by its odometry, and lets go. When there is nothing within the range, or nothing that can be gripped, it comes home
/// without. At home it stays.
class FootbotGripping final : public hal::Controller {
 public:
  struct Params {
    double range_m = 3.0;
    double velocity_m_s = 0.08;
    double broadest_m = 0.13;
    void describe(hal::ParamVisitor& v) {
      v.number("range", range_m, hal::unit::m, {0.1, 100.0}, "How far it looks for something.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.01, 0.3}, "Wheel speed.");
      v.number("broadest", broadest_m, hal::unit::m, {0.01, 1.0}, "What looks broader is not gripped.");
    }
  };

  FootbotGripping(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  enum class State : std::uint8_t { Look, Grasp, Turn, Home, Leave, Stay };

  void look() noexcept;
  void grasp() noexcept;
  void turn() noexcept;
  void go_home() noexcept;
  void leave() noexcept;

  double from_home_m() const noexcept;
  double bearing_of_home_rad() const noexcept;

  const hal::Proximity& proximity_;
  const hal::Odometry& odometry_;
  hal::WheelSpeeds& wheels_;
  hal::TurretDrive& turret_;
  hal::RangeAndBearingSend& send_;
  Params params_;
  Grasp grasp_;
  State state_ = State::Look;
};

}  // namespace tandem::controllers
