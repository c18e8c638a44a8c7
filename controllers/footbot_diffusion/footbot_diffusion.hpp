// Diffusion on a foot-bot's 24 proximity sensors: straight on where the way ahead is free, else away from what is near.
#pragma once
#include <array>
#include <memory>

#include "hal/controller.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_directions.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// The first experiment of most who work with foot-bots: the readings are averaged as vectors that point at the
/// obstacles. A short average, or one that points backwards, means straight on; otherwise the robot turns on the spot,
/// away from the obstacle, and to the same side until the way is free: so it leaves corners. The potential fields are
/// those of Howard et al. (2002).
class FootbotDiffusion final : public hal::Controller {
 public:
  struct Params {
    double alpha_rad = 7.5 * hal::unit::deg.to_si;
    double delta = 0.01;
    double velocity_m_s = 0.05;
    bool talk = false;
    bool look = false;
    void describe(hal::ParamVisitor& v) {
      v.number("alpha", alpha_rad, hal::unit::deg, {0.0, 1.5},
               "Obstacles within this of straight behind leave the way ahead free.");
      v.number("delta", delta, hal::unit::none, {0.0, 1.0},
               "An average of closeness (0 far, 1 contact, each sensor) up to this counts as free.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.0, 0.3}, "Wheel speed.");
      v.flag("talk", talk,
             "Tells the others by range-and-bearing how many it hears; drives no other for it. Shows what the device "
             "costs.");
      v.flag("look", look,
             "Lights all LEDs, red where the omnidirectional camera sees none of another, else green; drives no other "
             "for it. Shows what the camera costs.");
    }
  };

  FootbotDiffusion(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  /// What `talk` and `look` ask for.
  struct Company {
    const hal::RangeAndBearing* heard = nullptr;
    hal::RangeAndBearingSend* said = nullptr;
    const hal::OmnidirectionalCamera* seen = nullptr;
    hal::RingLeds* leds = nullptr;

    void step() const noexcept;
  };
  /// Null without both: the many without stay small. Copies have their own.
  struct CompanyOwner : std::unique_ptr<const Company> {
    CompanyOwner() = default;
    CompanyOwner(const CompanyOwner& other)
        : unique_ptr(other == nullptr ? nullptr : std::make_unique<const Company>(*other)) {}
  };

  const hal::Proximity& proximity_;
  hal::WheelSpeeds& wheels_;
  const hal::RingDirections& directions_;  // shared by all robots of the kind
  float delta_;
  float tan_alpha_;
  double velocity_m_s_;
  int turning_ = 0;  // 1 left, -1 right
  CompanyOwner company_;
};

}  // namespace tandem::controllers
