// A robot on two wheels whose parameters are known: drives by chance, and is seen by a tracker.
#pragma once
#include <cmath>
#include <random>

#include "bridges/emulation/imperfect_wheels.hpp"
#include "hal/angle.hpp"
#include "hal/device/fitted.hpp"
#include "mixed_reality/gap/recorded_run.hpp"

namespace tandem::mixed_reality {

struct Driven {
  hal::WheelModel model;
  double wheel_base_m = 0.053;
  double tick_s = 0.1;
  double seconds = 120.0;
  double fastest_m_s = 0.1;
  double pose_noise_m = 0.002, pose_noise_rad = 0.017;
  double mount_rad = 0.0;
  double backlash_m = 0.0;  ///< that a wheel loses whenever it turns round
  double bumps = 0.0;       ///< by how much the floor changes what wheels roll, by place
  double change_s = 1.0;    ///< between commands, about
  unsigned seed = 1;

  RecordedRobot record() const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    RecordedRobot robot;
    robot.id = "r";
    robot.real = true;
    const auto fine = static_cast<std::size_t>(std::lround(tick_s * 1e3));  // ms
    double x = 0.0, y = 0.0, heading = 0.3, counted_left = 0.0, counted_right = 0.0;
    bridges::ImperfectWheels wheels({.left = model.left,
                                     .right = model.right,
                                     .base = model.base,
                                     .delay_s = model.delay_s,
                                     .noise_sqrt_m = model.noise_sqrt_m,
                                     .backlash_m = backlash_m,
                                     .bumps = bumps,
                                     .seed = seed});
    double left = 0.0, right = 0.0;
    for (std::size_t t = 0; static_cast<double>(t) * tick_s < seconds; ++t) {
      RobotTick tick;
      tick.posed = tick.told = tick.counted = true;
      tick.x_m = x + pose_noise_m * normal(random);
      tick.y_m = y + pose_noise_m * normal(random);
      tick.heading_rad = hal::wrapped(heading + mount_rad + pose_noise_rad * normal(random));
      tick.counted_left_m = counted_left;
      tick.counted_right_m = counted_right;
      if (uniform(random) < tick_s / change_s) {
        left = fastest_m_s * (1.4 * uniform(random) - 0.4);
        right = fastest_m_s * (1.4 * uniform(random) - 0.4);
      }
      tick.told_left_m_s = left;
      tick.told_right_m_s = right;
      robot.ticks.push_back(tick);
      const auto at_ns = static_cast<hal::TimeNs>(t * fine) * hal::kNsPerMs;
      wheels.tell(at_ns, left, right);
      for (std::size_t k = 0; k < fine; ++k) {
        const hal::TimeNs from = at_ns + static_cast<hal::TimeNs>(k) * hal::kNsPerMs;
        const auto [l, r] = wheels.roll(from, from + hal::kNsPerMs, x, y);
        counted_left += model.counted_left * left * 0.001;
        counted_right += model.counted_right * right * 0.001;
        const double turn = (r - l) / (wheel_base_m * model.base);
        x += 0.5 * (l + r) * std::cos(heading + 0.5 * turn);
        y += 0.5 * (l + r) * std::sin(heading + 0.5 * turn);
        heading = hal::wrapped(heading + turn);
      }
    }
    return robot;
  }
};

}  // namespace tandem::mixed_reality
