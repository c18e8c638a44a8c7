// Interface of an emulated Thymio's body: its senses and commands in SI, the world behind the node.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "bridges/emulation/emulated_body.hpp"
#include "bridges/emulation/wheeled_body.hpp"
#include "hal/robot/thymio.hpp"

namespace tandem::bridges::thymio_emulator {

/// Everything that the robot's devices measure at one instant, in the order of its variables. The defaults are a robot
/// at rest on white ground in the middle of nowhere.
struct BodySenses {
  std::array<double, 7> distance_m = filled<7>(std::numeric_limits<double>::infinity());  ///< from each infrared sensor
  std::array<double, 2> ground = {1.0, 1.0};                                              ///< 0 black, 1 white
  std::array<double, 3> force_m_s2 = {0.0, 0.0, 9.81};  ///< specific force: x forward, y left, z up
  std::array<bool, 5> buttons{};                        ///< backward, left, center, forward, right: pressed
  double sound = 0.0;                                   ///< 0 silence, 1 full scale
};

inline constexpr std::size_t kLeds = 11;  ///< circle, below left, below right, top

/// Command of the node to the robot's body.
struct BodyCommand {
  double left_m_s = 0.0;  ///< rim speeds
  double right_m_s = 0.0;
  std::array<std::uint8_t, 3 * kLeds> rgb{};  ///< red, green, blue of LED 0, of LED 1, …
  double tone_Hz = 0.0;                       ///< 0: silence
  friend bool operator==(const BodyCommand&, const BodyCommand&) = default;
};

/// A body for the node to live in.
using EmulatedBody = EmulatedBodyOf<BodySenses, BodyCommand>;
using KinematicBody = WheeledBodyOf<EmulatedBody, hal::thymio::kind>;

/// The ports that the node senses and drives, and how.
std::vector<const hal::PortType*> body_ports();
void read_body(const PortBank& bank, BodySenses& senses);
void write_body(PortBank& bank, const BodyCommand& command);
using PortBody = PortBodyOf<EmulatedBody, read_body, write_body>;

}  // namespace tandem::bridges::thymio_emulator
