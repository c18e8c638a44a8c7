// Conversions from SI to the counts of the robot's converters.
#pragma once
#include "bridges/epuck_emulator/body.hpp"

namespace tandem::bridges::epuck_emulator {

/// A sensor's reading with nothing in sight, before calibration. The real offsets differ from sensor to sensor; one
/// value serves to tell calibrated from uncalibrated answers.
inline constexpr int kInfraredOffsetRaw = 40;

/// Infrared response above the offset: the kind's curve, straight between its knots; 0 beyond its end.
int proximity_counts(double distance_m);
/// Larger is darker.
int ambient_counts(double level);
int ground_counts(double reflectance);
int microphone_counts(double level);
int acceleration_counts(double force_m_s2);
/// e-puck2: 250 degrees a second are 32768.
int gyro_counts(double turn_rad_s);
/// e-puck1, hardware 1.3: 2070 at 3.4 V, 2560 at 4.2 V.
int battery_counts(double battery_V);
/// e-puck2: 12 bits of 3.0 V behind a divider of 220 and 330 kOhm.
int battery_counts_epuck2(double battery_V);
/// 0 at 3.4 V, 100 at 4.2 V.
int battery_percent(double battery_V);

/// What the firmware derives from the accelerometer, whose axes point left, forward and up.
struct Tilt {
  float acceleration_raw = 0.0F;  ///< length of the vector of counts
  float orientation_deg = 0.0F;   ///< of its part in the plane of the body, counter-clockwise from ahead, 0 to 360
  float inclination_deg = 0.0F;   ///< between it and the body's vertical, 0 to 180
};
Tilt tilt_of(const std::array<int, 3>& counts);

}  // namespace tandem::bridges::epuck_emulator
