#include "mixed_reality/desk/machine.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <pthread.h>
#include <sched.h>
#include <thread>

#include "mixed_reality/time/monotonic.hpp"

namespace tandem::mixed_reality {
namespace {

/// On a thread of its own, whose priority goes with it.
hal::Status try_priority(int priority) {
  hal::Status granted;
  std::thread([&] { granted = ask_for_realtime_priority(priority); }).join();
  return granted;
}

}  // namespace

Machine look_at_machine(int priority) {
  Machine machine;
  std::ifstream("/sys/devices/system/clocksource/clocksource0/current_clocksource") >> machine.clock_source;
  machine.processors = std::max(1U, std::thread::hardware_concurrency());
  std::array<double, 1> load{};
  machine.load = ::getloadavg(load.data(), 1) == 1 ? load[0] / machine.processors : -1.0;
  if (priority > 0) machine.priority = try_priority(priority);
  machine.date = system_clock();
  return machine;
}

}  // namespace tandem::mixed_reality
