// Orders of a person or a viewer to a foot-bot: one line of text each.
#pragma once
#include <string_view>
#include <variant>

#include "hal/result.hpp"

namespace tandem::controllers {

/// `drive 10 cm/s 0.5 rad/s`: ahead, and counter-clockwise. `stop` is a drive of 0 and 0.
struct Drive {
  double ahead_m_s = 0.0, turn_rad_s = 0.0;
  friend bool operator==(const Drive&, const Drive&) = default;
};

/// `grip`, `release`.
struct Grip {
  bool holds = false;
  friend bool operator==(const Grip&, const Grip&) = default;
};

/// `turret 90 deg`: to an angle from forward.
struct TurretTo {
  double angle_rad = 0.0;
  friend bool operator==(const TurretTo&, const TurretTo&) = default;
};

/// `turret 20 deg/s`: on and on, like `drive`.
struct TurretTurn {
  double speed_rad_s = 0.0;
  friend bool operator==(const TurretTurn&, const TurretTurn&) = default;
};

/// `turret off`, `turret passive`.
struct TurretFree {
  bool passive = false;
  friend bool operator==(const TurretFree&, const TurretFree&) = default;
};

using Order = std::variant<Drive, Grip, TurretTo, TurretTurn, TurretFree>;

/// Reads one line. Units must be written, but for 0; no number is beyond a million in SI. An error says what there is
/// instead.
hal::Result<Order> parse_order(std::string_view line);

}  // namespace tandem::controllers
