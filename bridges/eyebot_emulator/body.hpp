// Interface of an emulated eye-bot's body: its senses and commands in SI, the world around the firmware.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "bridges/emulation/heard.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot_emulator {

using Vec3 = std::array<double, 3>;

/// A message that the range-and-bearing board has heard.
struct Heard {
  std::int32_t sender = 0;  ///< number of the robot that sent it; 0: not known
  double range_m = 0.0;
  double bearing_rad = 0.0;    ///< counter-clockwise from forward
  double elevation_rad = 0.0;  ///< upwards
  std::vector<std::uint8_t> payload{};
  void take(const std::uint8_t* bytes, std::size_t size) { payload.assign(bytes, bytes + size); }
  friend bool operator==(const Heard&, const Heard&) = default;
};

/// A coloured light in the camera's image.
struct Blob {
  double x_px = 0.0;  ///< from the upper left corner
  double y_px = 0.0;
  std::array<std::uint8_t, 3> rgb{};
  friend bool operator==(const Blob&, const Blob&) = default;
};

/// Facts of the emulated robot's body, which simulator and bridge have, too. What its modules say is their
/// own business.
template <class Part>
const Part& robot_part() {
  return *hal::eyebot::kind().part<Part>();
}

/// Everything that the robot's devices measure at one instant. Rings are in the order of the kind's parts. The defaults
/// are a robot at rest on the ground, in the middle of nowhere.
struct BodySenses {
  Vec3 p_WB{};  ///< of the body's base, m
  Vec3 v_WB{};  ///< in W, m/s
  std::array<double, 4> q_WB = {1.0, 0.0, 0.0, 0.0};
  Vec3 turn_rad_s{};               ///< in the body frame
  double ground_m = 0.0;           ///< base to what is beneath; negative: no echo
  double ceiling_m = -1.0;         ///< top to what is above; negative: no echo
  bool on_ground = true;           ///< the feet carry the weight
  bool at_ceiling = false;         ///< the magnet holds
  std::optional<double> charge{};  ///< 0 to 1, where the body has a battery of its own
  std::array<double, 24> distance_m = filled<24>(std::numeric_limits<double>::infinity());
  std::array<double, 24> light = filled<24>(0.5);  ///< 0 dark, 1 saturated
  /// By each head of the scanner, from the robot's axis; infinite where nothing is.
  std::array<double, 4> scan_m = filled<4>(std::numeric_limits<double>::infinity());
  double scanner_rad = 0.0;  ///< counter-clockwise from forward
  double pan_rad = 0.0;
  double tilt_rad = 0.0;  ///< 0 straight down
  std::vector<Blob> blobs{};

  double yaw_rad() const noexcept;
};

/// What the flight as a whole is about: a body that steers itself needs it, one that follows velocities does not.
enum class Manoeuvre : std::uint8_t { Rest, TakeOff, Fly, Land, Attach, Detach };
enum class ScannerMode : std::uint8_t { Off, Speed, Position };

struct Lights {
  bool lower_on = false;
  bool upper_on = false;
  bool beacon_on = false;
  std::array<std::uint8_t, 48> lower{};  ///< red, green, blue of LED 0, of LED 1, …
  std::array<std::uint8_t, 48> upper{};
  std::array<std::uint8_t, 3> beacon{};
  friend bool operator==(const Lights&, const Lights&) = default;
};

/// Command of the firmware to the robot's body.
struct BodyCommand {
  bool motors = false;
  bool magnet = false;
  Manoeuvre manoeuvre = Manoeuvre::Rest;
  Vec3 velocity_m_s{};  ///< in W; counts while the motors run
  double yaw_rad_s = 0.0;
  double manoeuvre_m_s = 0.0;  ///< of climbing or sinking
  ScannerMode scanner = ScannerMode::Off;
  double scanner_rad_s = 0.0;
  double scanner_rad = 0.0;
  double pan_rad = 0.0;
  double tilt_rad = 0.0;
  bool laser = false;
  Lights lights{};
  std::vector<std::uint8_t> radio{};  ///< sent until it changes; empty: nothing is
  friend bool operator==(const BodyCommand&, const BodyCommand&) = default;
};

/// A body for the firmware to live in.
using EmulatedBody = HearingBodyOf<BodySenses, BodyCommand, Heard>;

/// The ports that the firmware senses and drives, and how: the other robot takes off, lands, attaches and lets go as
/// its own tasks do; once they are done, and between them, it flies with the firmware's velocities. With its motors cut
/// it lands: simulated eye-bots do not fall.
std::vector<const hal::PortType*> body_ports();
void read_body(const PortBank& bank, BodySenses& senses);
void write_body(PortBank& bank, const BodyCommand& command);

using PortBody = HearingPortBodyOf<EmulatedBody, Heard, read_body, write_body>;

}  // namespace tandem::bridges::eyebot_emulator
