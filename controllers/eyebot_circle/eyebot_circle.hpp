// Flies circles over a place, lit and calling, so that robots on the ground can follow.
#pragma once
#include <array>

#include "controllers/flight/aloft.hpp"
#include "hal/controller.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::controllers {

/// Takes off, then flies at an even speed along a level circle: its velocity is the tangent's, corrected by how far it
/// is off. Its lower ring shines green, and it broadcasts that it is to be followed.
class EyebotCircle final : public hal::Controller {
 public:
  struct Params {
    std::array<double, 3> center_m = {0.0, 0.0, 1.5};
    double radius_m = 1.0;
    double speed_m_s = 0.1;
    void describe(hal::ParamVisitor& v) {
      v.vector("center", center_m, hal::unit::m, "Middle of the circle, at the height to fly at; in W.");
      v.number("radius", radius_m, hal::unit::m, {0.1, 1000.0}, "Of the circle.");
      v.number("speed", speed_m_s, hal::unit::cm_s, {-2.0, 2.0},
               "Along the circle, counter-clockwise from above; negative: clockwise.");
    }
  };

  EyebotCircle(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  Aloft aloft_;
  hal::QuadrotorSpeed& speed_;
  hal::RingLeds& leds_;
  hal::RangeAndBearingSend& call_;
  Params params_;
};

}  // namespace tandem::controllers
