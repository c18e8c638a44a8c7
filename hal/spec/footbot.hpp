// Data sheet of the foot-bot, the Swarmanoid project's configuration of the marXbot [Bonani et al. 2010, "The marXbot,
// a miniature mobile robot opening new perspectives for the collective-robotic research", IROS].
//
// Sources: [ARGoS] ARGoS 3, foot-bot plug-in; [robot] the control interface of the real robot as published with
// ARGoS 2; [marXbot] the paper above; [chosen] no figure is published, the reason stands beside.
#pragma once
#include <array>
#include <numbers>

#include "hal/spec/data_sheet.hpp"
#include "hal/spec/ring.hpp"

namespace tandem::hal::footbot {

inline constexpr double kBodyRadius_m = 0.085036758;   // [ARGoS]
inline constexpr double kHeight_m = 0.146899733;       // [ARGoS]
inline constexpr double kMass_kg = 1.6;                // [ARGoS]
inline constexpr double kWheelRadius_m = 0.029112741;  // [ARGoS]
inline constexpr double kWheelBase_m = 0.14;           // [ARGoS]; the real robot measures its own at the start
inline constexpr double kMaxWheelSpeed_m_s = 0.3;      // [robot]
inline constexpr double kDriveForce_N = 1.5;           // [ARGoS] what its engines let both treels push with
inline constexpr double kPulsesPerMetre = 48312.0;     // [robot] of the wheels' encoders
inline constexpr double kPulsePeriod_s = 0.005;        // [robot] speeds are in pulses per period

inline constexpr double kProximityRange_m = 0.1;  // [ARGoS]
inline constexpr double kSensorHeight_m = 0.06;   // [ARGoS] of proximity and light sensors
inline constexpr double kRabRange_m = 3.0;        // [ARGoS]
inline constexpr double kRabHeight_m = 0.1;       // [ARGoS]
inline constexpr unsigned kRabPayload = 10;       // [ARGoS, robot]

// The ring of 12 LEDs sits on the turret [ARGoS]: 5 mm outside the body, the first at 15 degrees, one every 30 degrees,
// counter-clockwise. The beacon, number 12, stands on the axis.
inline constexpr double kLedRadius_m = kBodyRadius_m + 0.005;
inline constexpr double kLedHeight_m = 0.085;
inline constexpr double kBeaconHeight_m = 0.174249733;
inline constexpr std::size_t kRingLeds = 12;
inline constexpr std::size_t kBeacon = 12;

inline constexpr double kTurretTurn_rad_s = 0.5 * std::numbers::pi;  // [chosen] a quarter turn a second
inline constexpr double kTurretTorque_Nm = 0.5;    // [chosen] turns another foot-bot that does not drive
inline constexpr double kGripperHeight_m = 0.085;  // [ARGoS]
inline constexpr double kGripperReach_m = 0.03;    // [chosen] the claws' length beyond the rim

// Scanner [robot]: two heads for short distances, two for long ones, alternately, each measuring about 60 times a
// second; 30 turns a minute are recommended.
inline constexpr double kScannerHeight_m = 0.1232;  // [ARGoS]
inline constexpr double kShortMin_m = 0.04, kShortMax_m = 0.30;
inline constexpr double kLongMin_m = 0.20, kLongMax_m = 1.50;
inline constexpr double kScannerRate_hz = 60.0;
inline constexpr double kScannerTurn_rad_s = 2.0 * std::numbers::pi;  // [chosen] twice what is recommended

// The omnidirectional camera looks up into a mirror and sees a disc of the ground [ARGoS]. The camera with a lens looks
// up from the same place, or ahead from the rim.
inline constexpr double kOmniCameraHeight_m = 0.2887;                                 // [ARGoS]
inline constexpr double kOmniCameraAperture_rad = 70.0 * (std::numbers::pi / 180.0);  // [ARGoS]
inline constexpr double kCameraAperture_rad = 30.0 * (std::numbers::pi / 180.0);      // [ARGoS]
inline constexpr double kCameraFocalLength_m = 0.035;  // [chosen] of a common lens; pixels do not depend on it
inline constexpr double kCameraRange_m = 2.0;          // [chosen] an LED is then seen at about one pixel
inline constexpr unsigned kCameraWidth_px = 640;       // [chosen] VGA, as small cameras of its time have
inline constexpr unsigned kCameraHeight_px = 480;

inline constexpr double kBatteryFull_V = 4.2;   // [marXbot] one lithium-polymer cell of 10 Ah
inline constexpr double kBatteryEmpty_V = 3.4;  // [chosen] as for the e-puck's cell
inline constexpr double kBatteryLow_V = 3.4;    // [chosen] …: stop driving

// 24 proximity and light sensors [ARGoS]: the first at 7.5 degrees, one every 15 degrees, counter-clockwise.
inline const std::array<Mount, 24> kRing = ring_of<24>(7.5, kBodyRadius_m, kSensorHeight_m);

// Ground sensors [robot]: eight around the base, the first ahead, counter-clockwise; four between the tracks, the first
// front left, counter-clockwise.
inline constexpr std::array<Mount, 8> kBaseGround = {
    Mount{0, 0.08, 0, 0},  Mount{0, 0.042, 0.065, 0},   Mount{0, 0, 0.08, 0},  Mount{0, -0.042, 0.065, 0},
    Mount{0, -0.08, 0, 0}, Mount{0, -0.042, -0.065, 0}, Mount{0, 0, -0.08, 0}, Mount{0, 0.042, -0.065, 0}};
inline constexpr std::array<Mount, 4> kMotorGround = {Mount{0, 0.063, 0.0116, 0}, Mount{0, -0.063, 0.0116, 0},
                                                      Mount{0, -0.063, -0.0116, 0}, Mount{0, 0.063, -0.0116, 0}};

inline const std::array<Mount, 13> kLeds = [] {
  std::array<Mount, 13> all;
  const auto ring = ring_of<kRingLeds>(15.0, kLedRadius_m, kLedHeight_m);
  for (std::size_t i = 0; i < kRingLeds; ++i) all[i] = ring[i];
  all[kBeacon] = {0.0, 0.0, 0.0, kBeaconHeight_m};
  return all;
}();

inline constexpr std::array<ScannerHead, 4> kScanner = {ScannerHead{0.0, kShortMin_m, kShortMax_m},
                                                        ScannerHead{0.5 * std::numbers::pi, kLongMin_m, kLongMax_m},
                                                        ScannerHead{std::numbers::pi, kShortMin_m, kShortMax_m},
                                                        ScannerHead{-0.5 * std::numbers::pi, kLongMin_m, kLongMax_m}};

inline const DataSheet kDataSheet = {
    .kind = "foot-bot",
    .body_radius_m = kBodyRadius_m,
    .body_height_m = kHeight_m,
    .mass_kg = kMass_kg,
    .wheel_radius_m = kWheelRadius_m,
    .wheel_base_m = kWheelBase_m,
    .max_wheel_speed_m_s = kMaxWheelSpeed_m_s,
    .drive_force_N = kDriveForce_N,
    .drive_torque_Nm = kDriveForce_N * kWheelBase_m / 2,
    .proximity_range_m = kProximityRange_m,
    .rab_range_m = kRabRange_m,
    .rab_height_m = kRabHeight_m,
    .rab_payload = kRabPayload,
    .battery_full_V = kBatteryFull_V,
    .battery_empty_V = kBatteryEmpty_V,
    .proximity = kRing,
    .light = kRing,
    .ground = {},
    .base_ground = kBaseGround,
    .motor_ground = kMotorGround,
    .microphones = {},
    .leds = kLeds,
    .leds_on_turret = true,
    .gyroscope = true,
    .turret_turn_rad_s = kTurretTurn_rad_s,
    .turret_torque_Nm = kTurretTorque_Nm,
    .gripper_reach_m = kGripperReach_m,
    .gripper_height_m = kGripperHeight_m,
    .scanner = kScanner,
    .scanner_height_m = kScannerHeight_m,
    .scanner_turn_rad_s = kScannerTurn_rad_s,
    .scanner_rate_hz = kScannerRate_hz,
    .omni_camera = {kOmniCameraHeight_m, kOmniCameraAperture_rad},
    .camera = {.usual = {0.0, kOmniCameraHeight_m, 0.5 * std::numbers::pi},
               .front = {kBodyRadius_m, kBeaconHeight_m, 0.0},
               .aperture_rad = kCameraAperture_rad,
               .focal_length_m = kCameraFocalLength_m,
               .range_m = kCameraRange_m,
               .width_px = kCameraWidth_px,
               .height_px = kCameraHeight_px},
};

}  // namespace tandem::hal::footbot
