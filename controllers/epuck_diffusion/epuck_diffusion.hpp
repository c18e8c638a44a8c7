// Diffusion: robots spread out by driving straight and turning away from whatever is near.
#pragma once
#include "hal/controller.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_directions.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// The potential-field spreading of Howard et al. (2002), reduced to what an e-puck can do, as in the benchmark of
/// Pinciroli et al. (2012), section 4.1: the infrared readings are summed as vectors that point at the obstacles. A
/// short sum, or one that leaves the way ahead free, means straight on; otherwise the robot pivots on the wheel away
/// from the obstacle.
class EpuckDiffusion final : public hal::Controller {
 public:
  struct Params {
    double alpha_rad = 7.5 * hal::unit::deg.to_si;
    double delta = 0.1;
    double velocity_m_s = 0.05;
    bool talk = false;
    void describe(hal::ParamVisitor& v) {
      v.number("alpha", alpha_rad, hal::unit::deg, {0.0, 1.5},
               "The way ahead is free when the free direction is within this of it.");
      v.number("delta", delta, hal::unit::none, {0.0, 24.0},
               "Sums of closeness (0 far, 1 contact, each sensor) below this count as free.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.0, 10.0}, "Wheel speed.");
      v.flag("talk", talk,
             "Tells the others by range-and-bearing how many it hears; drives no other for it. Shows what the device "
             "costs.");
    }
  };

  EpuckDiffusion(hal::Robot& robot, const Params& params);

  void step() noexcept override;
  void controls(hal::Controls& c) override {
    c.number("velocity", velocity_m_s_, hal::unit::cm_s, {0.0, 0.1}, "Wheel speed.");
  }

 private:
  const hal::Proximity& proximity_;
  hal::WheelSpeeds& wheels_;
  const hal::RangeAndBearing* heard_ = nullptr;  // with both or none of them
  hal::RangeAndBearingSend* said_ = nullptr;
  const hal::RingDirections& directions_;  // shared by all robots of the kind
  float delta_;
  float tan_alpha_;
  double velocity_m_s_;
};

}  // namespace tandem::controllers
