// The real e-puck's driver against the emulator's firmware, in time that the test turns by hand: faults of the line and
// of the robot, several at once from a seed. Verdicts come from the robot's side.
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

#include "bridges/epuck_emulator/faults.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/epuck/wire_rig.hpp"

namespace tandem::scenarios {
namespace {

using namespace bridges::epuck;
namespace emulator = bridges::epuck_emulator;

constexpr hal::TimeNs kTick = 50 * kMs;
constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

emulator::FaultPlan plan_of(const std::vector<std::string>& texts, std::uint64_t seed) {
  std::vector<emulator::Fault> faults;
  for (const std::string& text : texts) faults.push_back(emulator::kFaults.parse(text).value());
  return {std::move(faults), seed};
}

/// A hub that drives one robot, and what goes wrong.
class Drive {
 public:
  Drive(const std::vector<std::string>& faults, std::uint64_t seed)
      : plan_(plan_of(faults, seed)),
        rig({.robot = {.tick_ns = kTick}}, seed, static_cast<emulator::Variant>(seed % 4)),
        proximity_(rig.driver.robot().sensor<hal::Proximity>()),
        wheels_(rig.driver.robot().actuator<hal::WheelSpeeds>()),
        start_(rig.now) {
    plan_.begin(start_);
    rig.to_robot.fault = [this](std::uint8_t byte, hal::TimeNs at) { return arrivals(plan_.to_robot(byte, at), at); };
    rig.to_host.fault = [this](std::uint8_t byte, hal::TimeNs at) { return arrivals(plan_.to_host(byte, at), at); };
    rig.each_step = [this] { apply(); };
  }

  void until(double t_s, bool stopped = false) {
    while (rig.now < start_ + static_cast<hal::TimeNs>(t_s * 1e9)) {
      rig.tick(kTick, [&] {
        if (stopped) rig.driver.stop(rig.now);
        wheels_.set(0.06, turn_ ? 0.03 : 0.06);
        turn_ = !turn_;
        const bool old = rig.now - rig.heard_ns > rig.driver.robot().settings().fresh_ns + kTick;
        if (old && proximity_.validity == hal::Validity::Fresh) ++stale_as_fresh;
      });
    }
  }

 private:
  std::vector<std::uint8_t> arrivals(std::optional<std::uint8_t> byte, hal::TimeNs at) {
    if (!byte || hung_up_) return {};
    if (plan_.doubles(at)) return {*byte, *byte};
    return {*byte};
  }
  void apply() {
    rig.to_host.delay_ns = plan_.delay_ns(rig.now);
    while (const auto change = plan_.next_change(rig.now)) {
      if (change->fault->kind == emulator::FaultKind::Reset) rig.firmware.reset(rig.now, "fault");
      if (change->fault->kind == emulator::FaultKind::Truncate) rig.firmware.cut_next_answer();
      if (change->fault->kind != emulator::FaultKind::Hangup) continue;
      hung_up_ = change->begins;
      rig.driver.link_gone(rig.now);
      if (!hung_up_) rig.plug_in();
    }
  }

  emulator::FaultPlan plan_;

 public:
  WireRig rig;
  int stale_as_fresh = 0;

 private:
  const hal::Proximity& proximity_;
  hal::WheelSpeeds& wheels_;
  hal::TimeNs start_;
  bool turn_ = false;
  bool hung_up_ = false;
};

/// Three faults at once and a line that loses, doubles and flips bytes, from 3 to 8 s. In every third run the hub stops
/// the robot in the middle of it.
TEST(EpuckFaults, OfAllKindsTogetherLeaveNoRobotMovingAndAllComeBack) {
  static constexpr std::array<const char*, 10> kFaults = {
      "silent@4s+1s",     "deaf@5s+2s",       "garbage@6s+1s", "reset@5s",      "truncate@4s",
      "hangup@6500ms+1s", "delay=60ms@4s+3s", "reset@7s",      "deaf@3s+100ms", "silent@7500ms+400ms"};
  const char* wanted = std::getenv("TANDEM_FAULT_RUNS");
  const int runs = wanted != nullptr ? std::atoi(wanted) : 60;
  for (int seed = 1; seed <= runs; ++seed) {
    std::mt19937 chance(static_cast<unsigned>(seed));
    const char* much = seed % 2 == 0 ? "0.02" : "0.2";
    std::vector<std::string> faults = {std::string("drop=") + much + "@3s+5s", "double=0.02@3s+5s",
                                       "corrupt=0.01@3s+5s"};
    std::string all = std::string("loss ") + much + " ";
    for (int i = 0; i < 3; ++i) {
      faults.emplace_back(kFaults[chance() % kFaults.size()]);
      all += faults.back() + " ";
    }
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + all);
    Drive drive(faults, static_cast<std::uint64_t>(seed));
    drive.until(3.0);
    ASSERT_TRUE(drive.rig.body.moves());
    const bool stopped = seed % 3 == 0;
    drive.until(5.5);
    drive.until(8.0, stopped);
    drive.until(9.0, stopped);
    EXPECT_EQ(drive.rig.driver.state(), SessionState::Active) << drive.rig.driver.session().trouble();
    EXPECT_EQ(drive.rig.body.moves(), !stopped);
    if (stopped) {
      EXPECT_TRUE(drive.rig.driver.at_rest());
    }
    EXPECT_EQ(drive.stale_as_fresh, 0);
    drive.rig.driver.shut_down(drive.rig.now);
    drive.rig.run(kSecond);
    EXPECT_FALSE(drive.rig.body.moves());
    EXPECT_TRUE(drive.rig.driver.at_rest());
  }
}

}  // namespace
}  // namespace tandem::scenarios
