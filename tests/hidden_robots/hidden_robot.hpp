// Robots whose wheels, delays and noise nobody was told, and the records that a hub and a tracker would have made of
// them. Written from core/record/README.md, mixed_reality/gap/README.md and docs/trackers.md, without sight of
// `tandem fit`.
#pragma once
#include <cstdint>
#include <string>

namespace tandem::hidden {

/// What is to be found. A command that is given to the link at t reaches the robot at t + to_robot, its motors obey
/// command_delay later, and what rolls on the floor follows the motors by body_delay. Counters count what motors
/// turned; a reading that was taken at t is that of t - counter_delay, and reaches the hub at t + to_host.
struct Truth {
  double left = 1.0, right = 1.0;  ///< way on the floor, as a part of the way commanded
  double base = 1.0;               ///< that it turns by, as a part of its kind's
  double to_robot_s = 0.0, to_host_s = 0.0;
  double command_delay_s = 0.0;
  double body_delay_s = 0.0;
  double counter_delay_s = 0.0;
  double noise_m = 0.0;  ///< standard deviation of each wheel's way after 1 m; grows with its root
  double tracker_sd_m = 0.002, tracker_sd_rad = 0.01;
};

/// The hidden values of a robot by its number, and nothing else.
Truth draw(std::uint64_t number);

/// The record of a run of so many seconds, of a foot-bot "r0".
std::string record_of(const Truth& truth, std::uint64_t number, double seconds);

}  // namespace tandem::hidden
