// Interface of an emulated foot-bot's body: its senses and commands in SI, the world behind the modules.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "bridges/emulation/heard.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::bridges::footbot_emulator {

inline constexpr std::size_t kRadioBytes = 10;  // of a message, says the protocol

/// A message that the range-and-bearing board has heard.
struct Heard {
  double range_m = 0.0;
  double bearing_rad = 0.0;    ///< counter-clockwise from forward
  double elevation_rad = 0.0;  ///< upwards
  std::array<std::uint8_t, kRadioBytes> payload{};
  void take(const std::uint8_t* bytes, std::size_t size) {
    std::copy_n(bytes, std::min(size, kRadioBytes), payload.begin());
  }
  friend bool operator==(const Heard&, const Heard&) = default;
};

/// Facts of the emulated robot's body, which simulator and bridge have, too. What its modules say is their
/// own business.
template <class Part>
const Part& robot_part() {
  return *hal::footbot::kind().part<Part>();
}

/// Everything that the robot's devices measure at one instant. Rings are in the order of the kind's parts. The defaults
/// are a robot at rest on white ground in the middle of nowhere.
struct BodySenses {
  std::array<double, 24> distance_m =
      filled<24>(std::numeric_limits<double>::infinity());  ///< from each infrared sensor
  std::array<double, 24> light = filled<24>(0.5);           ///< 0 dark, 1 saturated
  std::array<double, 8> base_ground = filled<8>(1.0);       ///< 0 black, 1 white
  std::array<double, 4> motor_ground = filled<4>(1.0);
  /// By each head of the scanner, from the robot's axis; infinite where nothing is.
  std::array<double, 4> scan_m = filled<4>(std::numeric_limits<double>::infinity());
  double scanner_rad = 0.0;  ///< angles are counter-clockwise from forward
  double turret_rad = 0.0;
  double gripper_rad = 0.0;  ///< how far the claws are apart
  bool gripper_busy = false;
  double battery_V = 4.0;
  std::array<double, 3> force_m_s2 = {0.0, 0.0, 9.81};  ///< specific force, body frame
  double turn_rad_s = 0.0;                              ///< about the vertical axis
};

enum class TurretMode : std::uint8_t { Off = 0, Passive = 1, Speed = 2, Position = 3 };
enum class ScannerMode : std::uint8_t { Off = 0, Speed = 1, Position = 2 };

/// Command of the modules to the robot's body.
struct BodyCommand {
  double left_m_s = 0.0;  ///< rim speeds
  double right_m_s = 0.0;
  TurretMode turret = TurretMode::Off;
  double turret_rad_s = 0.0;
  double turret_rad = 0.0;
  double gripper_rad = 0.0;
  ScannerMode scanner = ScannerMode::Off;
  double scanner_rad_s = 0.0;
  double scanner_rad = 0.0;
  std::array<std::uint8_t, 39> rgb{};  ///< red, green, blue of LED 0, of LED 1, …; the beacon last
  bool radio_sends = false;
  std::array<std::uint8_t, kRadioBytes> radio{};
  friend bool operator==(const BodyCommand&, const BodyCommand&) = default;
};

/// A body for the modules to live in.
using EmulatedBody = HearingBodyOf<BodySenses, BodyCommand, Heard>;

/// The ports that the modules sense and drive, and how.
std::vector<const hal::PortType*> body_ports();
void read_body(const PortBank& bank, BodySenses& senses);
void write_body(PortBank& bank, const BodyCommand& command);

using PortBody = HearingPortBodyOf<EmulatedBody, Heard, read_body, write_body>;

}  // namespace tandem::bridges::footbot_emulator
