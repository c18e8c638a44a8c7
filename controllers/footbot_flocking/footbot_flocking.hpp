// A flock that keeps a hexagonal pattern on its way to a light.
#pragma once
#include <span>

#include "controllers/steering/nearby.hpp"
#include "hal/controller.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::controllers {

/// Each robot shows a red beacon. Those of others push and pull it as molecules do, by a force like that of Lennard and
/// Jones that is 0 at the wanted distance t: gain ((t/d)^8 - (t/d)^4) away from a beacon at distance d, the mean over
/// those nearer than 1.8 t. Smaller exponents let the neighbours' neighbours squeeze the pattern until it is hexagonal
/// no more. The pull of the light is added, and the sum turned into wheel speeds: ahead by what of it points ahead,
/// turning by what points aside. This is the physicomimetics of Spears et al. (2004), "Distributed, physics-based
/// control of swarms of vehicles", Autonomous Robots 17, with the motion control of Ferrante et al. (2012),
/// "Self-organized flocking with a mobile robot swarm: a novel motion control method", Adaptive Behavior 20(6). Without
/// a fresh picture it stands still.
///
/// The camera must see as far as 1.8 times the wanted distance: `omnidirectional_camera_aperture` of the robot.
class FootbotFlocking final : public hal::Controller {
 public:
  struct Params {
    double distance_m = 0.6;
    double gain = 6.0;
    double light = 0.4;
    double velocity_m_s = 0.1;
    void describe(hal::ParamVisitor& v) {
      v.number("distance", distance_m, hal::unit::m, {0.2, 10.0}, "From beacon to beacon in the flock.");
      v.number("gain", gain, hal::unit::none, hal::kNotNegative, "How strongly robots push and pull one another.");
      v.number("light_gain", light, hal::unit::none, {0.0, 1.0},
               "How strongly the light pulls; a sum of pushes and pulls of 1 is full speed.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.01, 0.3}, "Full speed.");
    }
  };

  FootbotFlocking(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  hal::Vector2 flock() const noexcept;
  hal::Vector2 light() const noexcept;

  const hal::OmnidirectionalCamera& camera_;
  const hal::Light& light_;
  hal::WheelSpeeds& wheels_;
  hal::RingLeds& leds_;
  std::span<const hal::Mount> light_mounts_;
  std::size_t beacon_;
  Params params_;
};

}  // namespace tandem::controllers
