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

/// From which elevations, seen from the LED, a group of LEDs is seen.
struct LightSpread {
  double sin_lowest = -1.0;  ///< sine of the lowest: -1 is straight beneath
  double sin_highest = 1.0;  ///< … of the highest
  bool past_body = false;    ///< its own robot's body hides none of them
};

/// How a robot flies, beyond how fast. [Mellinger and Kumar 2011, "Minimum snap trajectory generation and control for
/// quadrotors", ICRA] has the model: four rotors whose thrusts follow what is commanded with a lag.
struct FlightSheet {
  double most_lean_rad = 0.0;   ///< that it obeys
  double most_thrust = 0.0;     ///< of all rotors together, in parts of its weight
  double climb_m_s = 0.0;       ///< when taking off or rising to the ceiling, unless told otherwise
  double sink_m_s = 0.0;        ///< when landing, unless told otherwise
  double take_off_m = 0.0;      ///< height to which it takes off
  double altimeter_m = 0.0;     ///< farthest echo
  double inertia_kg_m2 = 0.0;   ///< moment of inertia about each axis
  double rotor_arm_m = 0.0;     ///< from the axis to each of four rotors, at 45, 135, -135 and -45 degrees
  double rotor_lag_s = 0.0;     ///< in which a rotor's thrust covers 63 % of a change
  double rotor_torque_m = 0.0;  ///< drag torque about the rotor's axis for each newton of its thrust
};

/// A head that a camera hangs in.
struct HeadSheet {
  double turn_rad_s = 0.0;     ///< fastest turn about either axis; 0: none
  double most_tilt_rad = 0.0;  ///< from straight down, to either side
};

/// One kind of robot. All spans point at constants.
struct DataSheet {
  static constexpr std::string_view kCategory = "robot";
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
  FlightSheet flight = {};
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
  bool leds_on_turret = false;             ///< the places of the LEDs turn with the turret
  LightSpread leds_spread = {};            ///< from where `leds` are seen
  std::span<const Mount> upper_leds = {};  ///< of robots with a second ring
  LightSpread upper_leds_spread = {};      ///< from where those are seen
  bool camera_led = false;                 ///< a light beside the camera, seen as `leds` are
  bool body_lamps = false;                 ///< an e-puck's light in the body and at the front
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
  HeadSheet camera_head = {};  ///< that the camera hangs in where it sits usually

  std::string_view catalog_name() const noexcept { return kind; }
};

}  // namespace tandem::hal
