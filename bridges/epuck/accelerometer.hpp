// The e-puck's accelerometer: zero and axes by firmware, and whether it may be believed.
//
// Its chip points with raw[0] to the left, raw[1] ahead, raw[2] up. Without a force BTcom answers 0; GCtronic's
// firmware, Webots' (in binary) and the e-puck2's answer 2048. No command tells which, so what the version promises is
// checked whenever the robot stands: it must then read 1 g.
#pragma once
#include <array>
#include <cstdint>

#include "bridges/epuck/line.hpp"

namespace tandem::bridges::epuck {

/// Counts without a force, of those that answer the command `a`.
int accelerometer_zero(Firmware firmware) noexcept;

/// Specific force in the body frame (x ahead, y left, z up) from raw values whose zero is `zero`.
std::array<double, 3> force_m_s2(const std::array<std::int16_t, 3>& raw, int zero) noexcept;

/// Judges the readings of one robot. A first good reading at rest is believed at once; any other change of the verdict
/// takes three in a row.
class AccelerometerCheck {
 public:
  enum class Verdict : std::uint8_t {
    Unchecked,  ///< not yet read at rest
    Believed,
    Refused  ///< at rest it does not read 1 g within 20 %
  };

  /// Another robot or firmware may be there. An unknown firmware's zero is found by trying.
  void reset(Firmware firmware) noexcept;
  /// A reading while the robot stands.
  void at_rest(const std::array<std::int16_t, 3>& raw) noexcept;

  Verdict verdict() const noexcept { return verdict_; }
  int zero() const noexcept { return zero_; }
  /// Length of the newest reading at rest.
  double at_rest_m_s2() const noexcept { return at_rest_m_s2_; }

 private:
  Verdict verdict_ = Verdict::Unchecked;
  bool zero_known_ = true;
  int zero_ = 0;
  int against_ = 0;  // readings in a row that speak against the verdict
  double at_rest_m_s2_ = 0.0;
};

}  // namespace tandem::bridges::epuck
