// The real eye-bot's driver against the emulator's firmware, in time that the test turns by hand: what may go wrong
// with a robot, one by one and several at once from a seed. Verdicts come from the firmware.
#include <cstdlib>
#include <deque>
#include <gmock/gmock.h>
#include <random>

#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot/shutdown_sequence.hpp"
#include "bridges/eyebot_emulator/faults.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "hal/device/body_sensors.hpp"

namespace tandem::scenarios {
namespace {

namespace emulator = bridges::eyebot_emulator;
namespace eyebot = bridges::eyebot;
using emulator::Mode;
using eyebot::RobotState;
using hal::TimeNs;
using testing::HasSubstr;

constexpr TimeNs kMs = hal::kNsPerMs;
constexpr TimeNs kSecond = hal::kNsPerSecond;
constexpr TimeNs kStart = 1000 * kSecond;
constexpr std::int64_t kUnix_us = 1'700'000'000'000'000;  // at time 0

TimeNs g_now = 0;
TimeNs unix_clock() noexcept {
  return g_now + kUnix_us * 1000;
}

/// A robot's firmware with its body.
struct Robot {
  Robot(std::int32_t session, bridges::EventSink sink)
      : body(emulator::Start{{0.0, 0.0, 0.0}, 0.0}, std::nullopt), firmware(options(session), body, std::move(sink)) {
    firmware.power_on(g_now, kUnix_us + g_now / 1000);
  }
  static emulator::Eyebot::Options options(std::int32_t session) {
    emulator::Eyebot::Options o;
    o.session = session;
    return o;
  }
  emulator::PointBody body;
  emulator::Eyebot firmware;
};

/// Hub and robot, and all that may go wrong between them.
class Flight : private eyebot::Outbox {
 public:
  explicit Flight(const std::vector<std::string>& faults, std::uint64_t seed = 1)
      : start_((g_now = kStart, kStart)),
        plan_(parsed(faults), seed),
        robot_(1001, [this](TimeNs at, std::string_view event,
                            const bridges::EventFields& fields) { note(at, event, fields); }),
        driver(settings(), inbox, *this,
               hal::Log([this](hal::Severity, std::string_view t) { logged += std::string(t) + "\n"; })) {
    plan_.begin(start_);
    task = &driver.robot().actuator<hal::FlightTask>();
    speed = &driver.robot().actuator<hal::QuadrotorSpeed>();
    place = &driver.robot().sensor<hal::Positioning>();
    (void)driver.robot().sensor<hal::Battery>();
    task->order = hal::FlightOrder::TakeOff;
  }

  /// Until so many seconds after the start: takes off, then flies to and fro.
  void fly_until(double time_s) {
    for (const TimeNs end = start_ + static_cast<TimeNs>(time_s * 1e9); g_now < end;) {
      turn();
      if ((g_now / kMs) % 100 != 0) {
        driver.pump(g_now);
        continue;
      }
      driver.latch(tick_++, g_now);
      if (mode() == Mode::Hover) task->order = hal::FlightOrder::Fly;
      speed->set((g_now / kSecond) % 2 == 0 ? 0.5 : -0.5, 0.0, 0.0, 0.0);
      driver.commit(g_now);
    }
  }
  /// The run ends: whether the robot is on the ground within a minute, by itself if its hub is gone before.
  bool comes_down() {
    eyebot::ShutdownSequence sequence({});
    for (const TimeNs end = g_now + 60 * kSecond; g_now < end;) {
      turn();
      ended_ = ended_ || sequence.step(driver, g_now);
      if (ended_ && (mode() == Mode::Idle || mode() == Mode::Off)) return true;
    }
    return false;
  }
  Mode mode() const { return robot_.firmware.supervisor().mode(); }
  bool armed() const { return robot_.firmware.supervisor().armed(); }

 private:
  static eyebot::DriverSettings settings() {
    eyebot::DriverSettings s;
    s.robot.id = "eb0";
    s.hub = "lab";
    s.session = 4711;
    s.unix_clock = &unix_clock;
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
  void note(TimeNs, std::string_view event, const bridges::EventFields& fields) {
    if (event != "command") return;
    bool ok = false;
    bool estop = false;
    std::int64_t age_us = 0;
    for (const auto& field : fields) {
      if (field.name == "verdict") ok = std::get<std::string>(field.value) == "ok";
      if (field.name == "action") estop = std::get<std::string>(field.value) == "estop";
      if (field.name == "age_us") age_us = std::get<std::int64_t>(field.value);
    }
    if (ok && !estop) oldest_obeyed_us = std::max(oldest_obeyed_us, std::abs(age_us));
  }
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override {
    const emulator::Datagram message{channel, {data.begin(), data.end()}, g_now};
    std::vector<emulator::Datagram> arriving;
    plan_.to_robot(message, arriving);
    for (emulator::Datagram& d : arriving) to_robot_.push_back(std::move(d));
    if (twin_) to_twin_.push_back(message);
    return true;
  }
  void turn() {
    g_now += 10 * kMs;
    while (const auto change = plan_.next_change(g_now)) {
      emulator::apply(*change, robot_.firmware, 2000 + ++restarts_);
      if (change->fault->kind == emulator::FaultKind::Namesake) {
        twin_ = change->begins ? std::make_unique<Robot>(3001, bridges::EventSink{}) : nullptr;
      }
    }
    for (; !to_robot_.empty() && to_robot_.front().at <= g_now; to_robot_.pop_front()) {
      robot_.firmware.receive(to_robot_.front().channel, to_robot_.front().data, to_robot_.front().at);
    }
    for (; twin_ && !to_twin_.empty(); to_twin_.pop_front()) {
      twin_->firmware.receive(to_twin_.front().channel, to_twin_.front().data, g_now);
    }
    report(robot_.firmware, true);
    if (twin_) report(twin_->firmware, false);
    for (; !to_hub_.empty() && to_hub_.front().at <= g_now; to_hub_.pop_front()) {
      const emulator::Datagram& d = to_hub_.front();
      if (const auto topic = eyebot::topic_of("eb0", d.channel)) inbox.deliver(*topic, d.data, g_now);
      if (!ended_) driver.pump(g_now);
    }
  }
  void report(emulator::Eyebot& firmware, bool faulty) {
    firmware.run_until(g_now);
    std::vector<emulator::Datagram> sent, leaving;
    firmware.take_sent(sent);
    for (const emulator::Datagram& d : sent) {
      if (faulty) {
        plan_.to_hub(d, leaving);
      } else {
        leaving.push_back(d);
      }
    }
    for (emulator::Datagram& d : leaving) to_hub_.push_back(std::move(d));
  }

  TimeNs start_;
  emulator::FaultPlan plan_;
  Robot robot_;
  std::unique_ptr<Robot> twin_;
  std::deque<emulator::Datagram> to_robot_, to_twin_, to_hub_;
  std::int32_t restarts_ = 0;
  bool ended_ = false;  // the hub is silent
  hal::Tick tick_ = 0;

 public:
  eyebot::Inbox inbox;
  std::string logged;
  eyebot::EyebotDriver driver;
  hal::FlightTask* task = nullptr;
  hal::QuadrotorSpeed* speed = nullptr;
  const hal::Positioning* place = nullptr;
  std::int64_t oldest_obeyed_us = 0;
};

TEST(EyebotFaults, NoneIsNoStop) {
  Flight f({});
  f.fly_until(20.0);
  EXPECT_EQ(f.mode(), Mode::Velocity);
  EXPECT_EQ(f.driver.statistics().link_stops, 0U) << f.logged;
  EXPECT_TRUE(f.comes_down());
}

TEST(EyebotFaults, AClockThatJumpsIsACountedStopAndTheRobotFliesOnAndLands) {
  for (const char* jump : {"clock=1h@8s", "clock=-1h@8s", "clock=600ms@8s", "clock=-600ms@8s"}) {
    Flight f({jump});
    f.fly_until(8.0);
    ASSERT_EQ(f.mode(), Mode::Velocity);
    f.fly_until(11.0);
    EXPECT_EQ(f.mode(), Mode::Velocity) << jump << f.logged;
    EXPECT_GE(f.driver.statistics().link_stops, 1U) << jump << f.logged;
    EXPECT_LE(f.oldest_obeyed_us, 250'000);
    EXPECT_TRUE(f.comes_down()) << jump << f.logged;
  }
}

TEST(EyebotFaults, AClockThatJumpsJustBeforeTheEndDoesNotKeepItInTheAir) {
  for (const char* jump : {"clock=1h@8s", "clock=-1h@8s", "clock=-600ms@8s"}) {
    Flight f({jump});
    f.fly_until(8.02);
    ASSERT_EQ(f.mode(), Mode::Velocity);
    const TimeNs asked = g_now;
    EXPECT_TRUE(f.comes_down()) << jump << f.logged;
    EXPECT_LT(g_now - asked, 9 * kSecond) << "it was told to land, and did not wait until its hub was gone";
  }
}

TEST(EyebotFaults, AClockThatIsSetBackALittleIsLearntWithinASecond) {
  Flight f({"clock=-600ms@8s"});
  f.fly_until(8.0);
  f.driver.stop(g_now);  // nothing is ordered that could tell
  f.fly_until(9.0);
  EXPECT_EQ(f.driver.clock().jumps(), 1U);
  EXPECT_EQ(f.driver.state(), RobotState::Active);
  EXPECT_EQ(f.place->validity, hal::Validity::Fresh);
}

TEST(EyebotFaults, ALongerWayIsNoClockThatWasSet) {
  Flight f({"delay=200ms@8s+5s"});
  f.fly_until(12.0);
  EXPECT_EQ(f.driver.clock().jumps(), 0U);
  EXPECT_GE(f.driver.robot().settings().origin_ns + g_now - f.place->taken_ns, 190 * kMs) << "it is as old as it is";
}

TEST(EyebotFaults, ARestartInTheAirIsACountedStopAndItIsNotSentUpAgain) {
  Flight f({"restart@8s"});
  f.fly_until(8.2);
  EXPECT_NE(f.driver.state(), RobotState::Active);
  f.fly_until(15.0);
  EXPECT_EQ(f.driver.statistics().link_stops, 1U) << f.logged;
  EXPECT_EQ(f.driver.liveness().restarts(), 1U);
  EXPECT_EQ(f.mode(), Mode::Idle);
  EXPECT_FALSE(f.armed());
}

TEST(EyebotFaults, ARobotThatSavesItselfIsHeldWithItsReason) {
  for (const auto& [fault, reason] : {std::pair{"battery=0.05@8s", "its battery is low"},
                                      {"hardware@8s", "a device failed"},
                                      {"no-position@8s", "it does not know where it is"}}) {
    Flight f({fault});
    f.fly_until(9.0);
    EXPECT_EQ(f.driver.state(), RobotState::Suspect) << fault;
    EXPECT_EQ(f.driver.trouble(), reason);
    EXPECT_EQ(f.driver.statistics().saved_itself, 1U) << fault;
    EXPECT_EQ(f.driver.statistics().link_stops, 1U) << fault;
    EXPECT_TRUE(f.comes_down());
  }
}

TEST(EyebotFaults, AShortDeafnessIsNoStopOfTheRobotsOwn) {
  Flight f({"deaf@8s+1500ms"});
  f.fly_until(9.4);
  EXPECT_NE(f.mode(), Mode::Velocity);
  f.fly_until(10.5);
  EXPECT_EQ(f.mode(), Mode::Velocity) << f.logged;
  EXPECT_EQ(f.driver.statistics().saved_itself, 0U);
  EXPECT_GE(f.driver.statistics().link_stops, 1U);
}

TEST(EyebotFaults, ALongDeafnessIsAStopOfTheRobotsOwnAndIsOverWithinASecond) {
  Flight f({"deaf@8s+4s"});
  f.fly_until(12.0);
  EXPECT_NE(f.mode(), Mode::Velocity);
  EXPECT_EQ(f.driver.statistics().saved_itself, 1U) << "nothing reached it: it was absent, and says so";
  f.fly_until(13.0);
  EXPECT_EQ(f.mode(), Mode::Velocity) << f.logged;
  EXPECT_GE(f.driver.statistics().link_stops, 1U);
}

TEST(EyebotFaults, ALowBatteryLandsARobotThatIsStopped) {
  Flight f({"battery=0.15@8s"});  // low, and not yet so low that the robot lands by itself
  f.fly_until(10.0);
  ASSERT_EQ(f.mode(), Mode::Velocity);
  f.driver.stop(g_now);
  f.fly_until(18.0);
  EXPECT_EQ(f.mode(), Mode::Idle);
  EXPECT_TRUE(f.driver.at_rest());
}

TEST(EyebotFaults, WithoutAValidPlaceItIsNotArmed) {
  for (const char* fault : {"damage=state", "silent=state", "no-position"}) {
    Flight f({fault});
    f.fly_until(10.0);
    EXPECT_FALSE(f.armed()) << fault;
    EXPECT_EQ(f.mode(), Mode::Idle) << fault;
    EXPECT_EQ(f.driver.state(), RobotState::Ready) << fault;
  }
}

TEST(EyebotFaults, ASecondRobotOfItsNameKeepsBothOnTheGround) {
  Flight f({"namesake"});
  f.fly_until(10.0);
  EXPECT_FALSE(f.armed());
  EXPECT_THAT(f.driver.trouble(), HasSubstr("two robots are called 'eb0'"));
}

TEST(EyebotFaults, ASecondRobotOfItsNameHasItHoverUntilItIsGone) {
  Flight f({"namesake@8s+3s"});
  f.fly_until(10.0);
  EXPECT_EQ(f.mode(), Mode::Hover) << f.logged;
  EXPECT_EQ(f.driver.statistics().link_stops, 1U);
  f.fly_until(16.0);
  EXPECT_EQ(f.mode(), Mode::Velocity) << f.logged;
  EXPECT_TRUE(f.comes_down());
}

TEST(EyebotFaults, APlaceThatItCannotHaveFlownToIsNotBelieved) {
  Flight f({"place=5m@8s+300ms"});
  for (double t = 5.0; t < 10.0; t += 0.1) {
    f.fly_until(t);
    EXPECT_LT(std::abs(f.place->p_WB[0]), 3.0) << t;
  }
  EXPECT_GT(f.driver.places().refused(), 0U);
}

TEST(EyebotFaults, StampsOfTheFutureChangeNothing) {
  Flight f({"future=0.05"});
  f.fly_until(20.0);
  EXPECT_EQ(f.driver.statistics().link_stops, 0U) << f.logged;
  EXPECT_EQ(f.driver.clock().jumps(), 0U);
  EXPECT_EQ(f.mode(), Mode::Velocity);
}

/// Three faults at once, drawn from a seed, and a network that loses, doubles and swaps.
TEST(EyebotFaults, OfAllKindsTogetherLeaveNoRobotInTheAir) {
  static constexpr std::array<const char*, 16> kFaults = {
      "clock=1h@8s",         "clock=-1h@9s",       "clock=-600ms@7s",   "restart@9s",
      "battery=0.05@10s",    "no-position@8s+2s",  "hardware@11s",      "namesake@8s+2s",
      "place=5m@8s+1s",      "future=0.1",         "silent@9s+3s",      "deaf@9s+3s",
      "silent=status@8s+2s", "damage=state@8s+2s", "delay=150ms@8s+3s", "lag=150ms@8s+3s"};
  const char* wanted = std::getenv("TANDEM_FAULT_RUNS");
  const int runs = wanted != nullptr ? std::atoi(wanted) : 40;
  for (int seed = 1; seed <= runs; ++seed) {
    std::mt19937 chance(static_cast<unsigned>(seed));
    std::vector<std::string> faults = {"drop=0.05", "lose=0.05",   "double=0.05",
                                       "swap=0.02", "repeat=0.05", "truncate=0.02"};
    std::string all;
    for (int i = 0; i < 3; ++i) {
      faults.emplace_back(kFaults[chance() % kFaults.size()]);
      all += faults.back() + " ";
    }
    Flight f(faults, static_cast<std::uint64_t>(seed));
    f.fly_until(16.0);
    EXPECT_TRUE(f.comes_down()) << "seed " << seed << ": " << all << "\n" << f.logged;
    EXPECT_LE(f.oldest_obeyed_us, 250'000) << "seed " << seed << ": " << all;
  }
}

}  // namespace
}  // namespace tandem::scenarios
