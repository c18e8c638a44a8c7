// Data sheet of the e-puck (versions 1 and 2).
//
// Sources: [ARGoS] ARGoS 3, e-puck plug-in; [GCtronic] e-puck-library and its wiki; [Webots] E-puck.proto;
// [Enki] EPuck model. Sensors and LEDs are numbered as on the real robot: clockwise from the front, seen from above.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "hal/spec/data_sheet.hpp"

namespace tandem::hal::epuck {

inline constexpr double kBodyRadius_m = 0.035;    // [ARGoS, ROS driver]; Webots 0.0355 to 0.037
inline constexpr double kHeight_m = 0.086;        // [ARGoS], with the range-and-bearing board
inline constexpr double kMass_kg = 0.15;          // [Webots]
inline constexpr double kWheelRadius_m = 0.0205;  // [GCtronic] diameter 41 mm
inline constexpr double kWheelBase_m = 0.053;     // [ARGoS, ROS driver]
inline constexpr double kDriveForce_N = 1.5;      // [ARGoS] what its engines let both wheels push with
inline constexpr int kStepsPerTurn = 1000;        // [GCtronic] 20 steps, gear 50:1
inline constexpr int kMaxSteps_s = 1000;          // [GCtronic] firmware clamp of version 1; version 2 clamps at 1100
inline constexpr double kMetresPerStep = 2.0 * std::numbers::pi * kWheelRadius_m / kStepsPerTurn;  // 0.1288 mm
inline constexpr double kProximityRange_m = 0.1;                                                   // [ARGoS]
inline constexpr double kRabRange_m = 0.8;                                                         // [ARGoS]
inline constexpr unsigned kRabPayload = 2;                                                         // [ARGoS]
inline constexpr double kGravity_m_s2 = 9.81;
inline constexpr double kCountsPerG = 800.0;  // accelerometer [GCtronic, Webots]
inline constexpr int kAdcMax = 4095;          // 12 bits
inline constexpr int kAmbientDarkRaw =
    4095;  // ambient light falls with brightness: 4095 dark, 0 saturated, linear between
inline constexpr int kGroundWhiteRaw = 1023;    // [GCtronic] the ground board's converter has 10 bits; 0 is black
inline constexpr int kMicrophoneMaxRaw = 4095;  // [GCtronic] a volume is the spread of 12-bit samples
inline constexpr double kBatteryFull_V = 4.2;   // [GCtronic] raw 2560
inline constexpr double kBatteryEmpty_V = 3.4;  // [GCtronic] raw 2070
inline constexpr double kBatteryLow_V = 3.4;    // [GCtronic] older boards say "empty" below it; stop driving
inline constexpr int kBatteryFullRaw = 2560;
inline constexpr int kBatteryEmptyRaw = 2070;

namespace detail {
constexpr double radians(double deg) {
  return deg * std::numbers::pi / 180.0;
}
constexpr Mount on_rim(double bearing_deg, double cos_b, double sin_b, double radius_m, double z_m) {
  return {radians(bearing_deg), radius_m * cos_b, radius_m * sin_b, z_m};
}
}  // namespace detail

// Bearings of the infrared sensors ps0 … ps7 [GCtronic, Webots; rounded]: front right first, clockwise.
inline constexpr double kSensorHeight_m = 0.03;
inline constexpr std::array<Mount, 8> kInfrared = {
    detail::on_rim(-17, 0.956304755963035, -0.292371704722737, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(-50, 0.642787609686539, -0.766044443118978, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(-90, 0.0, -1.0, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(-150, -0.866025403784439, -0.5, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(150, -0.866025403784439, 0.5, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(90, 0.0, 1.0, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(50, 0.642787609686539, 0.766044443118978, kBodyRadius_m, kSensorHeight_m),
    detail::on_rim(17, 0.956304755963035, 0.292371704722737, kBodyRadius_m, kSensorHeight_m)};

// Ground sensors [ARGoS]: 30 mm ahead, index 0 right. The real board counts from the left [GCtronic, sensors/ground.h]:
// the bridge turns its readings round.
inline constexpr std::array<Mount, 3> kGround = {Mount{0, 0.03, -0.009, 0}, Mount{0, 0.03, 0, 0},
                                                 Mount{0, 0.03, 0.009, 0}};

// Microphones: right, left, rear [Webots E-puck.proto].
inline constexpr std::array<Mount, 3> kMicrophones = {detail::on_rim(-90, 0, -1, 0.032, 0.04),
                                                      detail::on_rim(90, 0, 1, 0.032, 0.04),
                                                      detail::on_rim(180, -1, 0, 0.032, 0.04)};

// Ring LEDs 0 … 7: front first, clockwise, every 45 degrees [GCtronic].
inline constexpr double kDiag = 0.707106781186548;
inline constexpr std::array<Mount, 8> kLeds = {
    detail::on_rim(0, 1, 0, kBodyRadius_m, 0.04),    detail::on_rim(-45, kDiag, -kDiag, kBodyRadius_m, 0.04),
    detail::on_rim(-90, 0, -1, kBodyRadius_m, 0.04), detail::on_rim(-135, -kDiag, -kDiag, kBodyRadius_m, 0.04),
    detail::on_rim(180, -1, 0, kBodyRadius_m, 0.04), detail::on_rim(135, -kDiag, kDiag, kBodyRadius_m, 0.04),
    detail::on_rim(90, 0, 1, kBodyRadius_m, 0.04),   detail::on_rim(45, kDiag, kDiag, kBodyRadius_m, 0.04)};

// The light in the middle of the translucent body, and the one at its front [GCtronic; heights rounded].
inline constexpr Mount kBodyLamp{0, 0, 0, 0.03};
inline constexpr Mount kFrontLamp = detail::on_rim(0, 1, 0, kBodyRadius_m, 0.03);

inline constexpr DataSheet kDataSheet = {
    .kind = "e-puck",
    .body_radius_m = kBodyRadius_m,
    .body_height_m = kHeight_m,
    .mass_kg = kMass_kg,
    .wheel_radius_m = kWheelRadius_m,
    .wheel_base_m = kWheelBase_m,
    .max_wheel_speed_m_s = kMaxSteps_s * kMetresPerStep,
    .drive_force_N = kDriveForce_N,
    .drive_torque_Nm = kDriveForce_N * kWheelBase_m / 2,
    .proximity_range_m = kProximityRange_m,
    .rab_range_m = kRabRange_m,
    .rab_height_m = kHeight_m,
    .rab_payload = kRabPayload,
    .battery_full_V = kBatteryFull_V,
    .battery_empty_V = kBatteryEmpty_V,
    .proximity = kInfrared,
    .light = kInfrared,  // the same devices
    .ground = kGround,
    .base_ground = {},
    .motor_ground = {},
    .microphones = kMicrophones,
    .leds = kLeds,
    .body_lamps = true,
    .scanner = {},
    .body_lamp = kBodyLamp,
    .front_lamp = kFrontLamp,
};

/// One knot of the infrared response: calibrated counts at a distance from the sensor, white paper.
struct InfraredKnot {
  double distance_m;
  double counts;
};

/// Mean response measured by [Webots] (lookup table of E-puck.proto, ambient offset removed) up to 7 cm; from there a
/// straight line to 0 at the data sheet's range, so that the curve is strictly falling and can be inverted.
inline constexpr std::array<InfraredKnot, 11> kInfraredCurve = {{{0.0, 4095.0},
                                                                 {0.005, 2133.33},
                                                                 {0.01, 1465.73},
                                                                 {0.015, 601.46},
                                                                 {0.02, 383.84},
                                                                 {0.03, 234.93},
                                                                 {0.04, 158.03},
                                                                 {0.05, 120.0},
                                                                 {0.06, 104.09},
                                                                 {0.07, 67.19},
                                                                 {0.1, 0.0}}};

}  // namespace tandem::hal::epuck
