// Follows a robot that calls by range-and-bearing, in the air or on the ground.
#pragma once
#include "hal/controller.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Drives towards the nearest robot that broadcasts that it is to be followed, until it is as near as asked for, seen
/// from above; around what its proximity sensors see. Its beacon is green while it hears one. It stands still while it
/// hears no call, or is blind.
class FootbotFollow final : public hal::Controller {
 public:
  struct Params {
    double speed_m_s = 0.15;
    double keep_m = 0.3;
    void describe(hal::ParamVisitor& v) {
      v.number("speed", speed_m_s, hal::unit::cm_s, {0.01, 0.3}, "Fastest wheel speed.");
      v.number("keep", keep_m, hal::unit::m, {0.0, 10.0}, "Distance to keep from who is followed, along the ground.");
    }
  };

  FootbotFollow(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  const hal::RangeAndBearing& heard_;
  const hal::Proximity& proximity_;
  hal::WheelSpeeds& wheels_;
  hal::RingLeds& leds_;
  std::span<const hal::Mount> mounts_;
  std::size_t beacon_;
  Params params_;
};

}  // namespace tandem::controllers
