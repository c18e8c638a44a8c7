// What a window costs the run that it shows, and how soon it shows something.
#pragma once
#include <cstdint>
#include <string>

#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::bench {

struct ViewCase {
  std::int64_t robots = 10'000;
  std::string robot;  ///< kind
  std::string engine;
  std::int64_t threads = 0;
  std::int64_t ticks = 600;  ///< of each half of a pair
  std::int64_t pairs = 5;
  double frames_per_s = 20.0;  ///< that the viewer asks for
};

/// Runs the diffusion scene behind a window, as fast as possible, in pairs without a viewer and with one, on a thread
/// of this process; prints one JSON object: medians of the quotients of wall time and of the stepping thread's
/// processor time, frames a second, bytes a robot and frame. Errors: what World::make and the window say.
hal::Status bench_view(const ViewCase& c, hal::PluginLoader& loader);

/// Starts `tandem view` with so many e-pucks, and prints one JSON object: seconds from there to the address, and to the
/// first frame of a viewer; medians. Errors: it does not start.
hal::Status bench_first_frame(std::int64_t robots, std::int64_t repeat);

}  // namespace tandem::bench
