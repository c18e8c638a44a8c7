// Odometry of a real robot that tells no more than how far its wheels have rolled.
#pragma once
#include <cmath>

#include "hal/angle.hpp"
#include "hal/device/wheels.hpp"
#include "hal/elementary.hpp"

namespace tandem::bridges {

/// Adds up arcs [Siegwart 2011, section 5.2.4]. Begins where the first reading finds the robot.
class Reckoning {
 public:
  explicit Reckoning(double wheel_base_m) : wheel_base_m_(wheel_base_m) {}

  /// Takes the newest reading of the wheels over.
  void follow(const hal::WheelEncoders& wheels, hal::Odometry& place) noexcept {
    static_cast<hal::Reading&>(place) = wheels;
    if (wheels.validity == hal::Validity::Absent) return;
    const double left = wheels.left_m - left_m_;
    const double right = wheels.right_m - right_m_;
    left_m_ = wheels.left_m;
    right_m_ = wheels.right_m;
    if (!begun_) {
      begun_ = true;
      return;
    }
    // Along the arc's chord, whose direction is the mean of the headings before and after.
    const double turn = wheel_base_m_ > 0.0 ? (right - left) / wheel_base_m_ : 0.0;
    const double half = 0.5 * turn;
    const double chord = 0.5 * (left + right) * (std::fabs(half) < 1e-9 ? 1.0 : hal::sin(half) / half);
    place.x_m += chord * hal::cos(place.heading_rad + half);
    place.y_m += chord * hal::sin(place.heading_rad + half);
    place.heading_rad = hal::wrapped(place.heading_rad + turn);
  }

 private:
  double wheel_base_m_;
  bool begun_ = false;
  double left_m_ = 0.0, right_m_ = 0.0;  // that the odometry has seen
};

}  // namespace tandem::bridges
