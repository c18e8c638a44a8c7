// The real foot-bot's driver against the emulator's modules on their bus, in time that the test turns by hand: what may
// go wrong with modules, bus and hub, one by one and several at once from a seed. Verdicts come from the modules.
#include <cstdlib>
#include <deque>
#include <gmock/gmock.h>
#include <random>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "bridges/footbot_emulator/faults.hpp"
#include "bridges/footbot_emulator/kinematic_body.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/checkout.hpp"

namespace tandem::scenarios {
namespace {

namespace emulator = bridges::footbot_emulator;
namespace footbot = bridges::footbot;
using emulator::Place;
using footbot::RobotState;
using hal::TimeNs;

constexpr TimeNs kMs = hal::kNsPerMs;
constexpr TimeNs kSecond = hal::kNsPerSecond;
constexpr TimeNs kStart = 1000 * kSecond;

const footbot::FootbotMap& default_map() {
  static const footbot::FootbotMap map = [] {
    hal::Problems problems;
    const auto read =
        bridges::footbot::read_footbot_map(std::string(test::kSourceDir) + "/configs/footbot_map.xml", problems);
    for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
    return read.value_or(footbot::FootbotMap{});
  }();
  return map;
}

/// The adapter between driver and bus.
struct Wire {
  std::deque<bridges::CanFrame> to_robot, to_host;
  bool up = true;
};

class WireEnd final : public bridges::CanLink {
 public:
  explicit WireEnd(Wire& wire) : wire_(wire) {}
  bridges::Sent send(const bridges::CanFrame& frame) noexcept override {
    if (!wire_.up) return bridges::Sent::Refused;
    wire_.to_robot.push_back(frame);
    return bridges::Sent::Taken;
  }
  bool receive(bridges::CanFrame& frame) noexcept override {
    record_.become(wire_.up ? bridges::BusState::Active : bridges::BusState::Down);
    if (wire_.to_host.empty()) return false;
    frame = wire_.to_host.front();
    wire_.to_host.pop_front();
    return true;
  }
  bool wait(TimeNs) noexcept override { return !wire_.to_host.empty(); }
  bridges::BusState state() const noexcept override { return record_.state(); }
  bridges::CanStatistics statistics() const noexcept override { return record_.counts; }
  std::string name() const override { return "wire"; }

 private:
  Wire& wire_;
  bridges::BusRecord record_;
};

/// Hub and robot, and all that may go wrong between them.
class Drive {
 public:
  explicit Drive(const std::vector<std::string>& faults, int ticks_per_second = 10, std::uint64_t seed = 1,
                 emulator::Protocol protocol = emulator::Protocol::V4)
      : tick_ns_(kSecond / ticks_per_second),
        plan_(parsed(faults), seed),
        robot_({.protocol = protocol}, body_, [](TimeNs, std::string_view, const bridges::EventFields&) {}),
        link_(std::make_unique<WireEnd>(wire_), {}, [this] { return now; }),
        driver(settings(tick_ns_), link_,
               hal::Log([this](hal::Severity, std::string_view text) { logged += std::string(text) + "\n"; })) {
    plan_.begin(now);
    robot_.power_on(now);
    wheels_ = &driver.robot().actuator<hal::WheelSpeeds>();
    proximity = &driver.robot().sensor<hal::Proximity>();
    driver.note_ports();
  }

  /// Until so many seconds after the start.
  void drive_until(double time_s) {
    while (now < kStart + static_cast<TimeNs>(time_s * 1e9)) {
      turn(true);
      if (now < next_tick_) continue;
      next_tick_ = std::max(next_tick_ + tick_ns_, now);
      driver.latch(tick_++, now);
      age_ns = now - kStart - proximity->taken_ns;
      oldest_ns = std::max(oldest_ns, tick_ > 50 ? age_ns : 0);
      wheels_->set(0.1, 0.1);
      driver.commit(now);
    }
  }
  /// The hub's threads do not run.
  void stall(TimeNs time) {
    for (const TimeNs end = now + time; now < end;) turn(false);
  }
  /// Whether the robot rests, and says so, within that time.
  bool comes_to_rest(TimeNs within) {
    driver.stop(now);
    for (const TimeNs end = now + within; now < end;) {
      turn(true);
      if (driver.at_rest() && !moves()) return true;
    }
    return false;
  }
  bool moves() const { return speed(Place::LeftMotor) != 0 || speed(Place::RightMotor) != 0; }
  double time_s() const { return hal::to_seconds(now - kStart); }

 private:
  static footbot::DriverSettings settings(TimeNs tick_ns) {
    footbot::DriverSettings s;
    s.map = default_map();
    s.robot.id = "fb0";
    s.robot.tick_ns = tick_ns;
    s.robot.origin_ns = kStart;
    return s;
  }
  static std::vector<emulator::Fault> parsed(const std::vector<std::string>& texts) {
    std::vector<emulator::Fault> faults;
    for (const std::string& text : texts) {
      auto fault = emulator::kFaults.parse(text);
      EXPECT_TRUE(fault.ok()) << fault.error().message;
      if (fault.ok()) faults.push_back(std::move(fault).value());
    }
    return faults;
  }
  std::int16_t speed(Place place) const { return robot_.module(place).words("speed")[0]; }

  void turn(bool hub_runs) {
    now += kMs;
    while (const auto change = plan_.next_change(now)) {
      emulator::apply(*change, robot_);
      if (change->fault->kind != emulator::FaultKind::Hangup) continue;
      wire_ = {};
      wire_.up = !change->begins;
      late_.clear();
    }
    for (; !wire_.to_robot.empty(); wire_.to_robot.pop_front()) {
      const bridges::CanFrame& f = wire_.to_robot.front();
      if (plan_.reaches_robot(now)) robot_.receive({static_cast<std::uint16_t>(f.id), f.size, f.data}, now);
    }
    robot_.run_until(now);
    std::vector<emulator::TimedFrame> sent, leaving;
    robot_.take_sent(sent);
    for (const emulator::TimedFrame& f : sent) plan_.to_host(f, leaving);
    if (wire_.up) late_.insert(late_.end(), leaving.begin(), leaving.end());
    for (; !late_.empty() && late_.front().at <= now; late_.pop_front()) {
      const emulator::Frame& f = late_.front().frame;
      bridges::CanFrame frame = bridges::make_frame(f.id, std::span(f.data).first(f.size));
      frame.at_ns = late_.front().at;
      wire_.to_host.push_back(frame);
    }
    if (hub_runs) driver.pump(now);
  }

 public:
  TimeNs now = kStart;

 private:
  TimeNs tick_ns_;
  TimeNs next_tick_ = kStart;
  hal::Tick tick_ = 0;
  emulator::FaultPlan plan_;
  emulator::KinematicBody body_;
  emulator::Footbot robot_;
  Wire wire_;
  std::deque<emulator::TimedFrame> late_;
  bridges::aseba::CanMessages link_;
  hal::WheelSpeeds* wheels_ = nullptr;

 public:
  std::string logged;
  footbot::FootbotDriver driver;
  const hal::Proximity* proximity = nullptr;
  TimeNs age_ns = 0, oldest_ns = 0;  // of the reading that the controller saw last, and the oldest that it saw
};

TEST(FootbotFaults, NoneIsNoStopAtAnyRateAndReadingsAreYoung) {
  for (const auto protocol : {emulator::Protocol::V4, emulator::Protocol::V5}) {
    for (const int rate : {10, 50, 100}) {
      Drive d({}, rate, 1, protocol);
      d.drive_until(30.0);
      EXPECT_EQ(d.driver.state(), RobotState::Active) << rate;
      EXPECT_TRUE(d.moves());
      EXPECT_EQ(d.driver.statistics().link_stops, 0U) << rate << d.logged;
      EXPECT_LE(d.oldest_ns, 30 * kMs) << rate;
      EXPECT_TRUE(d.comes_to_rest(kSecond));
    }
  }
}

TEST(FootbotFaults, StallsOfTheHubAreNoLostLink) {
  for (const int rate : {50, 100}) {
    Drive d({}, rate);
    std::mt19937 chance(7);
    d.drive_until(3.0);
    while (d.time_s() < 60.0) {
      d.drive_until(d.time_s() + 0.001 * static_cast<double>(chance() % 1000));
      d.stall(static_cast<TimeNs>(chance() % 450) * kMs);
      d.drive_until(d.time_s() + 0.05);
    }
    EXPECT_EQ(d.driver.statistics().link_stops, 0U) << d.logged;
    EXPECT_EQ(d.driver.statistics().lost, 0U);
    EXPECT_GT(d.driver.statistics().stalls, 50U);
  }
}

TEST(FootbotFaults, AHubThatFallsSilentWithNobodyBesideItLeavesTheWheelsAtRestAfterHalfASecond) {
  Drive run({});
  run.drive_until(5.0);
  ASSERT_TRUE(run.moves());
  run.stall(300 * kMs);
  EXPECT_TRUE(run.moves()) << "a hub may be late";
  run.stall(240 * kMs);  // 0.54 s in all: an event of the module comes every 20 ms
  EXPECT_FALSE(run.moves());
}

TEST(FootbotFaults, AnOutageIsACountedStopAndItDrivesWithinASecondAfterIt) {
  for (const auto protocol : {emulator::Protocol::V4, emulator::Protocol::V5}) {
    for (const char* fault : {"hangup@5s+3s", "silent@5s+3s", "hangup@5s+300ms"}) {
      Drive d({fault}, 10, 1, protocol);
      d.drive_until(5.0);
      ASSERT_TRUE(d.moves());
      const double end_s = std::string(fault).ends_with("300ms") ? 5.3 : 8.0;
      d.drive_until(end_s - 0.02);
      EXPECT_NE(d.driver.state(), RobotState::Active) << fault;
      while (d.driver.state() != RobotState::Active && d.time_s() < end_s + 5.0) d.drive_until(d.time_s() + 0.01);
      EXPECT_LE(d.time_s() - end_s, 0.5) << fault << " " << d.logged;
      d.drive_until(end_s + 1.0);
      EXPECT_TRUE(d.moves()) << fault;
      EXPECT_EQ(d.driver.statistics().link_stops, 1U) << fault << d.logged;
      EXPECT_EQ(d.driver.statistics().restarts, 0U) << fault << d.logged;
    }
  }
}

TEST(FootbotFaults, AModuleThatRestartsIsToldAnew) {
  Drive d({"restart=left-motor@5s"});
  d.drive_until(8.0);
  EXPECT_EQ(d.driver.state(), RobotState::Active);
  EXPECT_EQ(d.driver.statistics().restarts, 1U) << d.logged;
  EXPECT_TRUE(d.moves());
  EXPECT_TRUE(d.comes_to_rest(kSecond));
}

TEST(FootbotFaults, AModuleThatRestartsIsFoundOutWheneverInATickThatIs) {
  for (const int rate : {10, 50}) {
    for (int ms = 0; ms < 200; ms += 5) {
      const std::string fault = "restart=left-motor@" + std::to_string(5000 + ms) + "ms";
      Drive d({fault}, rate);
      d.drive_until(8.0);
      EXPECT_EQ(d.driver.statistics().restarts, 1U) << fault << " at " << rate << " Hz " << d.logged;
      EXPECT_EQ(d.driver.state(), RobotState::Active);
      EXPECT_TRUE(d.moves());
    }
  }
}

/// Three faults at once, drawn from a seed, on a bus that loses and doubles; and a hub that stalls.
TEST(FootbotFaults, OfAllKindsTogetherLeaveNoRobotMoving) {
  static constexpr std::array<const char*, 12> kFaults = {"hangup@5s+2s",
                                                          "silent@6s+2s",
                                                          "silent=left-motor@5s+3s",
                                                          "deaf=left-motor@6s+2s",
                                                          "restart@7s",
                                                          "restart=right-motor@6s",
                                                          "missing=right-motor@5s+3s",
                                                          "delay=80ms@5s+3s",
                                                          "drop=0.3@5s+3s",
                                                          "lose=0.3@5s+3s",
                                                          "swap=0.1@5s+3s",
                                                          "missing=3@5s+3s"};
  const char* wanted = std::getenv("TANDEM_FAULT_RUNS");
  const int runs = wanted != nullptr ? std::atoi(wanted) : 20;
  for (int seed = 1; seed <= runs; ++seed) {
    std::mt19937 chance(static_cast<unsigned>(seed));
    std::vector<std::string> faults = {"drop=0.01", "lose=0.01", "double=0.01"};
    std::string all;
    for (int i = 0; i < 3; ++i) {
      faults.emplace_back(kFaults[chance() % kFaults.size()]);
      all += faults.back() + " ";
    }
    Drive d(faults, chance() % 2 == 0 ? 10 : 50, static_cast<std::uint64_t>(seed),
            chance() % 2 == 0 ? emulator::Protocol::V4 : emulator::Protocol::V5);
    d.drive_until(5.0 + 0.001 * static_cast<double>(chance() % 3000));
    d.stall(static_cast<TimeNs>(chance() % 450) * kMs);
    d.drive_until(8.0);
    while (d.driver.state() != RobotState::Active && d.time_s() < 16.0) d.drive_until(d.time_s() + 0.1);
    EXPECT_EQ(d.driver.state(), RobotState::Active) << "seed " << seed << ": " << all << "\n" << d.logged;
    EXPECT_TRUE(d.comes_to_rest(3 * kSecond)) << "seed " << seed << ": " << all << "\n" << d.logged;
  }
}

}  // namespace
}  // namespace tandem::scenarios
