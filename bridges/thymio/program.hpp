// The program that runs in a Thymio while a hub drives it: stops the motors when the hub falls silent, and does what
// only native functions can do.
//
// It talks to the hub by its mailbox: words behind the robot's named variables, written and read like those.
//
//   every 20 ms                    -> beat + 1, the signature is written
//   alive > 0                      -> alive - 1; the motors' targets are `left` and `right`
//   alive has just become 0        -> lapses + 1, and silence
//   alive is 0                     -> the motors' targets are 0
//   leds differs from shown        -> the LEDs are set, shown = leds
//   tone differs from played       -> a tone is played, played = tone
//
// The robot forgets the program with its power. Loading it, or any other, resets the robot: all variables become 0, and
// it stops. Source of that: AsebaVMResetCB of the robot's firmware, aseba-community/aseba-target-thymio2, main.c.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bridges/aseba/resident_program.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::thymio {

inline constexpr hal::TimeNs kBeat_ns = 20 * hal::kNsPerMs;

/// Words of the mailbox.
namespace mailbox {
// By the program.
using aseba::mail_head::kBeat;
using aseba::mail_head::kLapses;
using aseba::mail_head::kSignature;
inline constexpr std::uint16_t kShown = 3, kPlayed = 4;
// By the hub.
inline constexpr std::uint16_t kAlive = 5, kLeft = 6, kRight = 7;
inline constexpr std::uint16_t kLeds = 8, kFirstLed = 9;
inline constexpr std::uint16_t kTone = 26, kTone_Hz = 27, kToneLength = 28;  ///< 0: on and on, -1: silence
inline constexpr std::uint16_t kSilence = 29;                                ///< -1, by the program, to be silent
inline constexpr std::uint16_t kWords = 30;
inline constexpr std::uint16_t kTold = 8;  ///< words that are read to know how it goes
}  // namespace mailbox

/// Words of LEDs: circle, then red, green and blue of below left, below right and top; each 0 to 32.
inline constexpr std::size_t kLedWords = 17;

/// Variables that any Thymio has, by address.
struct MotorAddresses {
  std::uint16_t left_target = 0, right_target = 0;
  std::uint16_t left_speed = 0, right_speed = 0;
};

struct Program : aseba::NodeProgram {
  MotorAddresses motors = {};
  bool lights = false;  ///< it sets LEDs
  bool sounds = false;  ///< it plays tones
};

/// The program for a node as it describes itself. Errors: a variable or event that a Thymio has is not there, or of
/// another size; it has no room.
hal::Result<Program> make_program(const aseba::NodeDescription& node);

}  // namespace tandem::bridges::thymio
