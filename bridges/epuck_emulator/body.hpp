// Interface of an emulated e-puck's body: its senses and commands in SI, the world behind the firmware.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "bridges/emulation/emulated_body.hpp"
#include "bridges/emulation/wheeled_body.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck_emulator {

/// Facts of the emulated robot's body, which simulator and bridge have, too. What its modules say is their
/// own business.
template <class Part>
const Part& robot_part() {
  return *hal::epuck::kind().part<Part>();
}

/// Everything that the robot's devices can measure at one instant. Rings are in the order of the kind's parts.
/// The defaults are a robot at rest on white ground in the middle of nowhere.
struct BodySenses {
  std::array<double, 8> distance_m = filled<8>(std::numeric_limits<double>::infinity());  ///< from each infrared sensor
  std::array<double, 8> light = filled<8>(0.5);                                           ///< 0 dark, 1 saturated
  std::array<double, 3> ground = filled<3>(1.0);           ///< 0 black, 1 white; right, middle, left
  std::array<double, 2> cliff = filled<2>(1.0);            ///< as ground; right, left
  std::array<double, 3> force_m_s2 = {0.0, 0.0, 9.81};     ///< specific force, body frame
  std::array<double, 3> turn_rad_s{};                      ///< turn rates, body frame
  std::array<double, 3> magnetic_uT = {20.0, 0.0, -44.0};  ///< body frame
  std::array<double, 4> sound{};                           ///< 0 silence, 1 full scale
  double ahead_m = 2.0;                                    ///< the time-of-flight sensor's reading
  double battery_V = 4.0;
  double temperature_C = 25.0;
};

/// Command of the firmware to the robot's body.
struct BodyCommand {
  double left_m_s = 0.0;  ///< rim speeds that the stepper motors really have, after clamping and rounding
  double right_m_s = 0.0;
  double told_left_m_s = 0.0;  ///< before rounding, for a body that has motors of its own
  double told_right_m_s = 0.0;
  std::uint8_t ring = 0;  ///< bit i: ring LED i is lit
  bool body_led = false;
  bool front_led = false;
  std::array<std::uint8_t, 12> rgb{};  ///< e-puck2: red, green, blue of LEDs 2, 4, 6, 8 in per cent
  friend bool operator==(const BodyCommand&, const BodyCommand&) = default;
};

/// A body for the firmware to live in.
using EmulatedBody = EmulatedBodyOf<BodySenses, BodyCommand>;

/// One with a little world of its own.
class KinematicBody final : public WheeledBodyOf<EmulatedBody, hal::epuck::kind> {
 public:
  using WheeledBodyOf::WheeledBodyOf;

 private:
  void look(BodySenses& senses) const override;
};

/// The ports that the firmware senses and drives, and how.
std::vector<const hal::PortType*> body_ports();
void read_body(const PortBank& bank, BodySenses& senses);
void write_body(PortBank& bank, const BodyCommand& command);
using PortBody = PortBodyOf<EmulatedBody, read_body, write_body>;

}  // namespace tandem::bridges::epuck_emulator
