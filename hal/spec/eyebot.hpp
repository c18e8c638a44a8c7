// Data sheet of the eye-bot, the flying robot of the Swarmanoid project [Dorigo et al. 2013, "Swarmanoid", IEEE
// Robotics & Automation Magazine 20(4)].
//
// Sources: [ARGoS] ARGoS 3, eye-bot plug-in; [ARGoS 2] the control interface of the real robot as published with
// ARGoS 2; [chosen] no figure is published, the reason stands beside.
#pragma once
#include <array>
#include <numbers>

#include "hal/spec/data_sheet.hpp"
#include "hal/spec/ring.hpp"

namespace tandem::hal::eyebot {

inline constexpr double kBodyRadius_m = 0.25;        // [ARGoS]
inline constexpr double kHeight_m = 0.566;           // [ARGoS]
inline constexpr double kMass_kg = 1.0;              // [ARGoS]
inline constexpr double kRingRadius_m = 0.255;       // [ARGoS] of the sensors and LEDs
inline constexpr double kSensorHeight_m = 0.1635;    // [ARGoS] of proximity and light sensors, above the base
inline constexpr double kLedHeight_m = 0.1535;       // [ARGoS] of the lower ring of LEDs
inline constexpr double kUpperLedHeight_m = 0.1635;  // [ARGoS] of the upper ring
inline constexpr double kInertia_kg_m2 = 0.01;       // [ARGoS] about every axis
inline constexpr double kProximityRange_m = 3.0;     // [ARGoS]
inline constexpr double kRabRange_m = 3.0;           // [ARGoS]
inline constexpr unsigned kRabPayload = 10;          // [ARGoS]
inline constexpr double kMaxAcceleration_m_s2 = 3;   // [chosen] what a lean of 17 degrees gives: atan(3 / 9.81)
inline constexpr double kMaxSpeed_m_s = 2.0;         // [chosen] stops within 0.7 m, a quarter of what proximity sees
inline constexpr double kMaxTurn_rad_s = 0.5 * std::numbers::pi;            // [chosen] a quarter turn a second
inline constexpr double kMostLean_rad = 30.0 * (std::numbers::pi / 180.0);  // [chosen] 6 m/s^2 to the side
inline constexpr double kMostThrust = 2.0;       // [chosen] twice the weight, as common quadrotors have
inline constexpr double kClimb_m_s = 0.5;        // [chosen] up from the ground to hovering in two seconds
inline constexpr double kSink_m_s = 0.3;         // [chosen] touches down without bouncing
inline constexpr double kTakeOff_m = 1.0;        // as the port says
inline constexpr double kAltimeter_m = 6.0;      // [chosen] what common ultrasound rangers reach
inline constexpr double kRotorArm_m = 0.2;       // [chosen] the rotors' middles lie within the body
inline constexpr double kRotorLag_s = 0.03;      // [chosen] of common small motors with propellers: 20 to 50 ms
inline constexpr double kRotorTorque_m = 0.016;  // [chosen] of common propellers of that size
inline constexpr double kHeadTurn_rad_s = std::numbers::pi;          // [chosen] half a turn a second
inline constexpr double kHeadMostTilt_rad = 0.5 * std::numbers::pi;  // [ARGoS] from straight down to level

// Four heads like the foot-bot's turn beneath the body [ARGoS 2]. Their ranges are not published: [chosen] from beside
// the body, which is open beneath, as far as proximity sensors see.
inline constexpr double kScannerHeight_m = 0.1;  // [ARGoS 2]
inline constexpr double kScannerMin_m = 0.12, kScannerMax_m = 3.0;
inline constexpr double kScannerRate_hz = 60.0;                       // as the foot-bot's
inline constexpr double kScannerTurn_rad_s = 2.0 * std::numbers::pi;  // …

inline constexpr double kBatteryFull_V = 12.6;  // [chosen] three lithium-polymer cells
inline constexpr double kBatteryEmpty_V = 9.9;
inline constexpr double kBatteryLow = 0.15;  // [chosen] of the full charge: land, while a minute of flight is left

// The camera looks down from the base, or ahead from the rim. [chosen] its figures are those of the foot-bot's, but
// that it sees the ground from as high as range-and-bearing reaches.
inline constexpr double kCameraAperture_rad = 30.0 * (std::numbers::pi / 180.0);
inline constexpr double kCameraFocalLength_m = 0.035;
inline constexpr double kCameraRange_m = 3.5;
inline constexpr unsigned kCameraWidth_px = 640;
inline constexpr unsigned kCameraHeight_px = 480;

/// 24 proximity and light sensors [ARGoS]: the first at 7.5 degrees, one every 15 degrees, counter-clockwise.
inline const std::array<Mount, 24> kRing = ring_of<24>(7.5, kRingRadius_m, kSensorHeight_m);
/// Two rings of 16 LEDs [ARGoS]: the first at 11.25 degrees. The lower one shines downwards, the upper one sideways
/// [ARGoS 2]: [chosen] up to 60 degrees from straight down, and up to 45 degrees from level, so that between them none
/// are out of sight from beneath or beside.
inline const std::array<Mount, 16> kLeds = ring_of<16>(11.25, kRingRadius_m, kLedHeight_m);
inline const std::array<Mount, 16> kUpperLeds = ring_of<16>(11.25, kRingRadius_m, kUpperLedHeight_m);
inline constexpr LightSpread kDownwards{-1.0, -0.5, true};
inline constexpr LightSpread kSideways{-0.5 * std::numbers::sqrt2, 0.5 * std::numbers::sqrt2, false};

inline constexpr std::array<ScannerHead, 4> kScanner = {
    ScannerHead{0.0, kScannerMin_m, kScannerMax_m}, ScannerHead{0.5 * std::numbers::pi, kScannerMin_m, kScannerMax_m},
    ScannerHead{std::numbers::pi, kScannerMin_m, kScannerMax_m},
    ScannerHead{-0.5 * std::numbers::pi, kScannerMin_m, kScannerMax_m}};

inline const DataSheet kDataSheet = {
    .kind = "eye-bot",
    .body_radius_m = kBodyRadius_m,
    .body_height_m = kHeight_m,
    .mass_kg = kMass_kg,
    .flies = true,
    .max_flight_speed_m_s = kMaxSpeed_m_s,
    .max_flight_acceleration_m_s2 = kMaxAcceleration_m_s2,
    .max_flight_turn_rad_s = kMaxTurn_rad_s,
    .flight = {kMostLean_rad, kMostThrust, kClimb_m_s, kSink_m_s, kTakeOff_m, kAltimeter_m, kInertia_kg_m2, kRotorArm_m,
               kRotorLag_s, kRotorTorque_m},
    .proximity_range_m = kProximityRange_m,
    .rab_range_m = kRabRange_m,
    .rab_height_m = kSensorHeight_m,
    .rab_payload = kRabPayload,
    .battery_full_V = kBatteryFull_V,
    .battery_empty_V = kBatteryEmpty_V,
    .proximity = kRing,
    .light = kRing,
    .ground = {},
    .base_ground = {},
    .motor_ground = {},
    .microphones = {},
    .leds = kLeds,
    .leds_spread = kDownwards,
    .upper_leds = kUpperLeds,
    .upper_leds_spread = kSideways,
    .camera_led = true,
    .gyroscope = true,
    .scanner = kScanner,
    .scanner_height_m = kScannerHeight_m,
    .scanner_turn_rad_s = kScannerTurn_rad_s,
    .scanner_rate_hz = kScannerRate_hz,
    .camera = {.usual = {0.0, 0.0, -0.5 * std::numbers::pi},
               .front = {kBodyRadius_m, kLedHeight_m, 0.0},
               .aperture_rad = kCameraAperture_rad,
               .focal_length_m = kCameraFocalLength_m,
               .range_m = kCameraRange_m,
               .width_px = kCameraWidth_px,
               .height_px = kCameraHeight_px},
    .camera_head = {kHeadTurn_rad_s, kHeadMostTilt_rad},
};

}  // namespace tandem::hal::eyebot
