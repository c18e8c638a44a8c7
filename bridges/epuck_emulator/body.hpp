// Interface of an emulated e-puck's body: its senses and commands in SI, the world behind the firmware.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "hal/robot/epuck.hpp"
#include "hal/time.hpp"

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

  template <std::size_t n>
  static constexpr std::array<double, n> filled(double value) {
    std::array<double, n> a{};
    a.fill(value);
    return a;
  }
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

/// A body for the firmware to live in. Times never decrease. All calls come from the thread that runs the firmware.
class EmulatedBody {
 public:
  virtual ~EmulatedBody() = default;
  virtual BodySenses sense(hal::TimeNs now) = 0;
  /// `command` holds from `now` until the next call.
  virtual void actuate(hal::TimeNs now, const BodyCommand& command) = 0;
};

}  // namespace tandem::bridges::epuck_emulator
