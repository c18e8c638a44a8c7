// Wheels of emulated robots that do not roll as their firmware believes: scale, delay, noise, play, uneven ground.
#pragma once
#include <cstdint>
#include <deque>

#include "hal/params.hpp"
#include "hal/random.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// How wheels err. The defaults are wheels that do not.
struct WheelErrors {
  double left = 1.0, right = 1.0;  ///< what a wheel rolls, of what it should
  double base = 1.0;               ///< the wheel base that the body turns by, of that in the data sheet
  double delay_s = 0.0;            ///< by which the wheels are later than the motors, whose counters know nothing of it
  double noise_sqrt_m = 0.0;       ///< standard deviation of each wheel's way after 1 m; grows with the way's root
  double backlash_m = 0.0;         ///< that a wheel loses at its rim whenever it turns round
  double bumps = 0.0;              ///< by what part the floor changes what wheels roll, from place to place
  std::int64_t seed = 1;

  void describe(hal::ParamVisitor& v);
  bool any() const noexcept;
};

/// Two wheels of one robot, with a memory of their commands.
class ImperfectWheels {
 public:
  struct Ways {
    double left_m = 0.0, right_m = 0.0;
  };

  explicit ImperfectWheels(const WheelErrors& errors = {});

  const WheelErrors& errors() const noexcept { return errors_; }
  /// From `now` on the firmware has them turn like this. Times never decrease.
  void tell(hal::TimeNs now, double left_m_s, double right_m_s);
  /// What they roll on the floor in that time, in which the robot is about (x, y). Times never go back.
  Ways roll(hal::TimeNs from, hal::TimeNs until, double x_m, double y_m);
  /// Speeds on the floor at `at`, which is not before the last `roll`: as they obey, without noise and play.
  Ways speeds_m_s(hal::TimeNs at) const noexcept;
  /// Whether they stand, and will until they are told otherwise.
  bool still() const noexcept;

 private:
  struct Told {
    hal::TimeNs from = 0;
    double left_m_s = 0.0, right_m_s = 0.0;
  };
  double rolled(double way_m, double scale, double floor, double& play_m);

  WheelErrors errors_;
  hal::TimeNs delay_ns_;
  hal::Random random_;
  std::deque<Told> told_{{}};  // the first is what they do now
  double play_left_m_ = 0.0, play_right_m_ = 0.0;
};

}  // namespace tandem::bridges
