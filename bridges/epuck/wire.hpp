// Facts of the e-puck's protocol and of the converters behind it: what its raw numbers mean, whatever robot sends them.
//
// Sources: [GCtronic] e-puck-library and its wiki; [Webots] E-puck.proto.
#pragma once
#include <numbers>

namespace tandem::bridges::epuck::wire {

inline constexpr int kStepsPerTurn = 1000;      // of a wheel [GCtronic]: 20 steps, gear 50:1
inline constexpr double kCountsPerG = 800.0;    // of the accelerometer [GCtronic, Webots]
inline constexpr int kAmbientDarkRaw = 4095;    // 12 bits; falls with brightness: 0 saturated, linear between
inline constexpr int kGroundWhiteRaw = 1023;    // [GCtronic] the ground board's converter has 10 bits; 0 is black
inline constexpr int kMicrophoneMaxRaw = 4095;  // [GCtronic] a volume is the spread of 12-bit samples
// Boards from HW1.3 on [GCtronic]: two points of a straight line. Older ones say 1 or 0.
inline constexpr int kBatteryRawAt4_2V = 2560, kBatteryRawAt3_4V = 2070;
// e-puck2's gyroscope: 250 degrees a second are 32768 [e-puck2_main-processor].
inline constexpr double kGyroRad_s = 250.0 / 32768.0 * std::numbers::pi / 180.0;
// e-puck2: 12-bit converter at 3 V behind a divider of 220 and 330 kOhm [e-puck2_main-processor, battery code].
inline constexpr double kEpuck2VoltsPerCount = 3.0 / 4096.0 * (220.0 + 330.0) / 330.0;

}  // namespace tandem::bridges::epuck::wire
