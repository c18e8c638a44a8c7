// Latch, commit, pump and stop allocate nothing, whatever is said and told.
#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "bridges/epuck/driver.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/bridges/epuck/scripted_robot.hpp"

namespace {

std::atomic<bool> counting{false};
std::atomic<std::uint64_t> allocations{0};

}  // namespace

// GCC cannot see that both sides are malloc and free.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tandem::bridges::epuck {
namespace {

/// A link into two buffers of fixed size.
class PlainLink final : public ByteLink {
 public:
  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs) noexcept override {
    const std::size_t n = std::min(bytes.size(), out.size() - out_size);
    std::copy_n(bytes.begin(), n, out.begin() + static_cast<std::ptrdiff_t>(out_size));
    out_size += n;
    return n;
  }
  Received read(std::span<std::uint8_t> buffer) noexcept override {
    const std::size_t n = std::min(buffer.size(), in_size);
    std::copy_n(in.begin(), n, buffer.begin());
    std::copy(in.begin() + static_cast<std::ptrdiff_t>(n), in.begin() + static_cast<std::ptrdiff_t>(in_size),
              in.begin());
    in_size -= n;
    return {n, now};
  }
  bool wait(hal::TimeNs) noexcept override { return false; }
  LinkState state() const noexcept override { return LinkState::Open; }
  LinkStatistics statistics() const noexcept override { return {}; }
  std::string name() const override { return "plain"; }

  std::array<std::uint8_t, 4096> in{}, out{};
  std::size_t in_size = 0, out_size = 0;
  hal::TimeNs now = 0;
};

TEST(EpuckDriverInSteadyState, AllocatesNothingWhateverHappens) {
  EpuckDriver driver({});
  driver.robot().sensor<hal::Proximity>();
  driver.robot().sensor<hal::Accelerometer>();
  driver.robot().sensor<hal::Ground>();
  auto& wheels = driver.robot().actuator<hal::WheelSpeeds>();
  ScriptedRobot robot;
  PlainLink link;
  std::uint64_t active = 0;
  for (hal::Tick tick = 0; tick < 400; ++tick) {
    counting = true;
    driver.latch(tick, link.now);
    wheels.set(0.01 + 0.0001 * static_cast<double>(tick % 300), 0.02);
    driver.commit(link.now);
    if (tick % 50 == 40) driver.stop(link.now);
    if (tick % 50 == 45) driver.resume();
    counting = false;
    if (driver.state() == SessionState::Active) ++active;
    robot.silent = tick % 100 >= 80 && tick % 100 < 90;
    for (int ms = 0; ms < 100; ++ms) {
      link.now += hal::kNsPerMs;
      counting = true;
      driver.pump(link, link.now);
      counting = false;
      Bytes answer = robot.hear(std::span(link.out.data(), link.out_size));
      link.out_size = 0;
      if (tick == 60 && ms == 50) answer = robot.restart();
      std::copy(answer.begin(), answer.end(), link.in.begin() + static_cast<std::ptrdiff_t>(link.in_size));
      link.in_size += answer.size();
    }
  }
  EXPECT_EQ(allocations, 0U);
  EXPECT_GT(active, 200U);
  EXPECT_GT(driver.session().statistics().handshakes, 3U);
}

}  // namespace
}  // namespace tandem::bridges::epuck
