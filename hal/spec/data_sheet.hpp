// What is known of a kind of robot: written once, read by the simulator, the bridge and the emulator.
#pragma once
#include <span>
#include <string_view>

namespace tandem::hal {

/// A sensor or lamp on the body. Body frame: x forward, y left, z up; bearing counter-clockwise from forward.
struct Mount {
  double bearing_rad = 0.0;  ///< where it looks
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
};

/// A ring with a motor of its own, and the range sensors on it.
struct ScannerHead {
  double bearing_rad = 0.0;  ///< where it looks while the scanner is at angle 0
  double min_m = 0.0;        ///< nearest and farthest distance that it measures, from the robot's axis
  double max_m = 0.0;
};

/// A camera on the axis that looks all around and down.
struct OmniCameraSheet {
  double height_m = 0.0;      ///< 0: none
  double aperture_rad = 0.0;  ///< from straight down to the farthest that it sees on the ground
};

/// Where a camera with a lens sits and looks.
struct CameraMount {
  double x_m = 0.0;
  double z_m = 0.0;
  double tilt_rad = 0.0;  ///< of its axis above straight ahead: pi/2 looks up, -pi/2 down
};

/// A camera with a lens.
struct CameraSheet {
  CameraMount usual, front;   ///< where it sits unless told otherwise, and where as a front camera
  double aperture_rad = 0.0;  ///< from its axis to a corner of the image; 0: none
  double focal_length_m = 0.0;
  double range_m = 0.0;  ///< up to which it makes out LEDs
  unsigned width_px = 0;
  unsigned height_px = 0;
};

/// One kind of robot. All spans point at constants.
struct DataSheet {
  std::string_view kind;  ///< as the element in experiment files, e.g. "e-puck"
  double body_radius_m = 0.0;
  double body_height_m = 0.0;
  double mass_kg = 0.0;
  double wheel_radius_m = 0.0;
  double wheel_base_m = 0.0;         ///< distance between the two wheels' contact points
  double max_wheel_speed_m_s = 0.0;  ///< at the rim
  double drive_force_N = 0.0;        ///< that the wheels together can push with
  double drive_torque_Nm = 0.0;      ///< that they can turn the body with
  bool flies = false;
  double max_flight_speed_m_s = 0.0;          ///< of one that flies, in any direction
  double max_flight_acceleration_m_s2 = 0.0;  ///< beyond what holds it up, in any direction
  double max_flight_turn_rad_s = 0.0;
  double proximity_range_m = 0.0;  ///< from the sensor
  double rab_range_m = 0.0;        ///< range-and-bearing, between centres
  double rab_height_m = 0.0;
  unsigned rab_payload = 0;  ///< bytes
  double battery_full_V = 0.0;
  double battery_empty_V = 0.0;
  std::span<const Mount> proximity;
  std::span<const Mount> light;
  std::span<const Mount> ground;
  std::span<const Mount> base_ground;   ///< of robots with two groups of ground sensors
  std::span<const Mount> motor_ground;  ///< the other group
  std::span<const Mount> microphones;
  std::span<const Mount> leds;
  bool leds_on_turret = false;  ///< the places of the LEDs turn with the turret
  bool body_lamps = false;      ///< an e-puck's light in the body and at the front
  bool gyroscope = false;
  double turret_turn_rad_s = 0.0;  ///< fastest turn of the turret; 0: none
  double turret_torque_Nm = 0.0;   ///< that its motor turns a load with
  double gripper_reach_m = 0.0;    ///< beyond the body's rim; 0: no gripper. It looks where the turret does
  double gripper_height_m = 0.0;   ///< of the claws above the ground
  std::span<const ScannerHead> scanner;
  double scanner_height_m = 0.0;
  double scanner_turn_rad_s = 0.0;        ///< fastest turn of the scanner
  double scanner_rate_hz = 0.0;           ///< measurements a second of each head
  Mount body_lamp = {}, front_lamp = {};  ///< of robots with `body_lamps`
  OmniCameraSheet omni_camera = {};
  CameraSheet camera = {};
};

}  // namespace tandem::hal
