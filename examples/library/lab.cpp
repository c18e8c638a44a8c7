// A program of one's own that holds a world: makes it from a file, steps it, looks into it, and goes back once.
//   lab EXPERIMENT [TICKS [RECORD]]
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/sim/world.hpp"
#include "hal/device/ring_sensors.hpp"
#include "library/open_world.hpp"

namespace {

/// Robots that see something within reach of their proximity sensors.
int robots_near_something(const tandem::core::World& world) {
  int count = 0;
  const tandem::core::Space& space = world.space();
  for (std::size_t n = 0; n < space.robot_count(); ++n) {
    const auto* const proximity = space.port<tandem::hal::Proximity>(space.robot(n));
    if (proximity == nullptr) continue;
    bool any = false;
    for (std::size_t i = 0; i < proximity->count; ++i) any = any || proximity->distance_m[i] < 0.03;
    count += any ? 1 : 0;
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "lab EXPERIMENT [TICKS [RECORD]]\n");
    return 2;
  }
  auto opened = tandem::library::open_world({.file = argv[1], .seed = 7, .record = argc > 3 ? argv[3] : ""});
  if (!opened.ok()) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 1;
  }
  tandem::core::World& world = opened.value()->world();
  tandem::core::Run& run = opened.value()->run();
  const long ticks = argc > 2 ? std::atol(argv[2]) : 100;
  run.add(std::make_unique<tandem::core::Length>(ticks));
  if (!run.begin()) {
    std::fprintf(stderr, "%s\n", run.failure().c_str());
    return 3;
  }
  const auto snapshot = world.snapshot();
  if (!snapshot.ok()) {
    std::fprintf(stderr, "%s\n", snapshot.error().message.c_str());
    return 3;
  }
  for (int turn = 0; turn < 2; ++turn) {
    if (turn > 0 && !world.restore(snapshot.value()).ok()) return 3;
    while (run.tick()) {
    }
    std::printf("%ld ticks, %d robots near something, state %016llx\n", static_cast<long>(world.tick()),
                robots_near_something(world), static_cast<unsigned long long>(world.state_hash()));
  }
  run.end();
  if (run.failure().empty()) return 0;
  std::fprintf(stderr, "%s\n", run.failure().c_str());
  return 3;
}
