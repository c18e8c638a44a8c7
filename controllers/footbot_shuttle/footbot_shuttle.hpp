// There and back between two points by odometry, straight on with both wheels at one speed.
#pragma once
#include "hal/controller.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Drives straight forward until its odometry says that it has come far enough, turns round on the spot, drives back to
/// where it thinks that it started, and turns again: a number of times, then it stops. It can also come back in reverse
/// and turn nowhere. Nothing corrects its course, so treels that draw to one side [Pinciroli et al. 2012, section
/// 4.2.2] lead it elsewhere while its odometry sees a line.
class FootbotShuttle final : public hal::Controller {
 public:
  struct Params {
    double distance_m = 4.0;
    double velocity_m_s = 0.1;
    std::int64_t trips = 1;
    bool reverse = false;
    void describe(hal::ParamVisitor& v) {
      v.number("distance", distance_m, hal::unit::m, {0.01, 1000.0}, "Between the two points.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.001, 0.3}, "Wheel speed.");
      v.integer("trips", trips, {1, 1e9}, "How often there and back.");
      v.flag("reverse", reverse, "Drives back in reverse instead of turning round.");
    }
  };

  FootbotShuttle(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  const hal::Odometry& odometry_;
  hal::WheelSpeeds& wheels_;
  double wheel_base_m_;
  Params params_;
  bool home_ = false;      // on the way back
  bool turning_ = false;   // at the end of a way
  std::int64_t done_ = 0;  // trips
};

}  // namespace tandem::controllers
