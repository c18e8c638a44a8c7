// Flocking in space: distance and direction of the neighbours by range-and-bearing, their velocities by what they say.
#pragma once
#include <array>

#include "controllers/flight/aloft.hpp"
#include "hal/controller.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::controllers {

/// Each neighbour pulls or pushes as the generalised Lennard-Jones potential has it [Spears et al. 2004, "Distributed,
/// physics-based control of swarms of vehicles", Autonomous Robots 17], to a distance that all keep; each robot also
/// takes over a part of its neighbours' velocities [Reynolds 1987, "Flocks, herds, and schools", SIGGRAPH], drifts as
/// told, and keeps within a band of heights and near home.
class EyebotFlocking final : public hal::Controller {
 public:
  struct Params {
    double distance_m = 1.2;
    double gain_m_s = 0.3;
    std::int64_t exponent = 2;
    double alignment = 0.3;
    std::array<double, 3> drift_m_s{};
    double lowest_m = 0.5;
    double highest_m = 5.0;
    std::array<double, 3> home_m{};
    double home_radius_m = 0.0;
    double speed_m_s = 0.5;
    void describe(hal::ParamVisitor& v) {
      v.number("distance", distance_m, hal::unit::m, {0.6, 10.0}, "That neighbours keep.");
      v.number("gain", gain_m_s, hal::unit::m_s, {0.0, 10.0}, "Strength of their pull and push.");
      v.integer("exponent", exponent, {1, 6}, "Of the potential: how steep it is.");
      v.number("alignment", alignment, hal::unit::none, {0.0, 1.0},
               "Part of the neighbours' mean velocity taken over.");
      v.vector("drift", drift_m_s, hal::unit::m_s, "Velocity that the flock is to have; in W.");
      v.number("lowest", lowest_m, hal::unit::m, {0.0, 1000.0}, "Lowest height.");
      v.number("highest", highest_m, hal::unit::m, {0.0, 1000.0}, "Highest height.");
      v.vector("home", home_m, hal::unit::m, "Middle of where it keeps to, seen from above; in W.");
      v.number("home_radius", home_radius_m, hal::unit::m, hal::kNotNegative, "How far from there; 0: no matter.");
      v.number("speed", speed_m_s, hal::unit::m_s, {0.01, 2.0}, "Fastest.");
    }
  };

  EyebotFlocking(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  std::array<double, 3> pull() const noexcept;
  void add_bounds(std::array<double, 3>& v) const noexcept;
  void tell() noexcept;

  Aloft aloft_;
  const hal::RangeAndBearing& heard_;
  hal::QuadrotorSpeed& speed_;
  hal::RangeAndBearingSend& send_;
  Params params_;
};

}  // namespace tandem::controllers
