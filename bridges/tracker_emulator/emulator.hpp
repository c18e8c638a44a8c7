// A tracker that sees emulated robots, in real time.
#pragma once
#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include "bridges/emulation/server.hpp"
#include "bridges/tracker_emulator/faults.hpp"
#include "bridges/tracker_emulator/picture.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::tracker_emulator {

/// Its link: udp:ADDRESS:PORT, lcm:URL; frames of a camera: pipe:FILE, folder:FOLDER.
struct Options : ServerOptions {
  Options() { link = "udp:127.0.0.1:7700"; }

  /// What it sees: by which name, and the log of the emulated robot, which tells its true poses. A log may come later.
  std::vector<std::pair<std::string, std::string>> sees{};
  double rate_hz = 30.0;
  double delay_s = 0.06;                     ///< from exposure to sending
  double noise_m = 0.002, noise_rad = 0.01;  ///< standard deviations
  bool tells_noise = false;                  ///< its messages say them
  bool sees_headings = true;
  std::string clock = "own";     ///< of its stamps: own (began at another time), unix, monotonic
  std::string form = "compact";  ///< of datagrams: compact or json
  std::string channel = "tandem/poses";
  /// Of frames: the file of the camera that takes them; and the tags on the robots, whose names are then numbers.
  std::string camera{};
  std::string family = "tag36h11";
  double tag_size_m = 0.05, tag_height_m = 0.0;
  PictureOptions picture{};
};

/// Events for the log: `start`, `end` (messages, sightings), `fault` (fault, phase: begin or end) and `late` (by_ms:
/// see turn_until; drawing a frame may be what took so long).
///
/// Emulates until `stop` becomes true, which is noticed within 20 ms. Errors: a link, log or fault that there is not.
hal::Status run(const Options& options, const std::atomic<bool>& stop);

}  // namespace tandem::bridges::tracker_emulator
