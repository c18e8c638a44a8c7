#include "bridges/eyebot/driver.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "tests/bridges/eyebot/scripted_robot.hpp"

namespace tandem::bridges::eyebot {
namespace {

using messages::CmdMode;
using messages::CmdPosition;
using messages::CmdVelocity;
using messages::Status;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// --- whether it is there ---

TEST(EyebotDriver, IsActiveWithAHeartbeatAndAStatus) {
  Scene s;
  s.robot.alive = false;
  s.run(100);
  EXPECT_EQ(s.driver.state(), RobotState::Absent);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("eyebot/eb0/heartbeat"));
  s.robot.say(Topic::Heartbeat, s.robot.heartbeat);
  s.run(20);
  EXPECT_EQ(s.driver.state(), RobotState::Ready);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("eyebot/eb0/status"));
  s.robot.alive = true;
  s.run(400);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
  EXPECT_EQ(s.driver.trouble(), "");
}

TEST(EyebotDriver, IsNotActiveBeforeItHasSaidAValidPlace) {
  Scene s;
  auto& task = s.actuator<hal::FlightTask>();
  task.order = hal::FlightOrder::TakeOff;
  s.robot.state.pos[0] = kNan;  // damaged from the start
  s.run(3000);
  EXPECT_EQ(s.driver.state(), RobotState::Ready);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("has not said a valid place on eyebot/eb0/state"));
  s.robot.state.pos[0] = 0.0;
  s.robot.state.pos_valid = 0;
  s.run(1000);
  EXPECT_EQ(s.driver.state(), RobotState::Ready);
  EXPECT_TRUE(s.robot.obeyed.empty());
  s.robot.state.pos_valid = 1;
  s.run(500);
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF));
}

TEST(EyebotDriver, NamesTheRobotsThatAreHeardWhenItsOwnIsNot) {
  Scene s;
  s.robot.alive = false;
  s.inbox.neighbours().hear_robot("eb9");
  s.inbox.neighbours().hear_robot("eb1");
  s.inbox.neighbours().hear_robot("eb9");
  s.run(2100);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("no heartbeat is heard on eyebot/eb0/heartbeat; heard are: eb1, eb9"));
  EXPECT_TRUE(s.has_logged("heard are: eb1, eb9"));
}

TEST(EyebotDriver, IsSuspectAfterThreePeriodsLostAfterTwoSecondsAndBackByItself) {
  Scene s;
  s.run(1000);
  ASSERT_EQ(s.driver.state(), RobotState::Active);
  s.robot.alive = false;
  const hal::TimeNs last = s.driver.liveness().heartbeat_ns();
  while (s.driver.state() == RobotState::Active) s.run(10);
  EXPECT_LE(s.now - last, 620 * kMs);
  EXPECT_EQ(s.driver.state(), RobotState::Suspect);
  while (s.driver.state() == RobotState::Suspect) s.run(10);
  EXPECT_EQ(s.now - last, 2010 * kMs);
  EXPECT_EQ(s.driver.state(), RobotState::Lost);
  EXPECT_TRUE(s.has_logged("lost"));
  s.robot.alive = true;
  s.run(10);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
  EXPECT_EQ(s.driver.statistics().lost, 1U);
  EXPECT_EQ(s.driver.statistics().recovered, 1U);
}

TEST(EyebotDriver, AStallOfOurOwnThreadIsNoLostLink) {
  DriverSettings settings;
  settings.command_timeout_ns = 2000 * kMs;
  Scene s(settings);
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.now += 700 * kMs;  // longer than three heartbeats
  s.driver.pump(s.now);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
  s.run(1000);
  EXPECT_EQ(s.driver.statistics().link_stops, 0U);
  EXPECT_EQ(s.driver.statistics().stalls, 1U);
}

TEST(EyebotDriver, DoesNotUnderstandAnotherVersion) {
  Scene s;
  s.robot.heartbeat.proto_major = 2;
  s.run(500);
  EXPECT_EQ(s.driver.state(), RobotState::Ready);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("version 2"));
}

TEST(EyebotDriver, BeatsTheHubsHeartFiveTimesASecond) {
  Scene s;
  s.run(2000);
  const auto beats = s.robot.all("hub/lab/heartbeat");
  EXPECT_EQ(beats.size(), 10U);
  const auto m = beats.back().as<messages::Heartbeat>();
  EXPECT_EQ(m.name, "lab");
  EXPECT_EQ(m.role, messages::Heartbeat::ROLE_HUB);
  EXPECT_EQ(m.hdr.session, 0x1234);
  EXPECT_EQ(m.hdr.seq, 9);
  EXPECT_EQ(m.period_ms, 200);
}

TEST(EyebotDriver, SaysNothingWhenItOnlyObserves) {
  DriverSettings settings;
  settings.observe = true;
  Scene s(settings);
  s.actuator<hal::RingLeds>();
  s.fly();
  s.driver.stop(s.now);
  s.run(500);
  EXPECT_TRUE(s.robot.said.empty());
  EXPECT_EQ(s.driver.state(), RobotState::Active);
}

// --- what it says ---

TEST(EyebotDriver, FillsReadingsWithWhenTheyWereTaken) {
  DriverSettings settings;
  settings.robot.origin_ns = 1000 * hal::kNsPerSecond;
  Scene s(settings);
  const auto& place = s.sensor<hal::Positioning>();
  const auto& flight = s.sensor<hal::FlightState>();
  s.robot.state.pos[0] = 1.5;
  s.robot.state.pos[2] = 2.0;
  s.robot.state.vel[1] = -0.5;
  s.robot.state.omega[2] = 0.25;
  s.robot.status.mode = Status::MODE_LAND;
  s.robot.status.failsafe = Status::FS_LOW_BATTERY;
  EXPECT_EQ(place.validity, hal::Validity::Absent);
  s.run(1000);
  EXPECT_EQ(place.validity, hal::Validity::Fresh);
  EXPECT_THAT(place.p_WB, ElementsAre(1.5, 0.0, 2.0));
  EXPECT_GE(place.taken_ns, 980 * kMs);
  EXPECT_LE(place.taken_ns, 1000 * kMs);
  EXPECT_EQ(flight.validity, hal::Validity::Fresh);
  EXPECT_EQ(flight.phase, hal::FlightPhase::Landing);
  EXPECT_EQ(flight.failsafe, hal::FlightFailsafe::LowBattery);
  EXPECT_THAT(flight.velocity, ElementsAre(0.0, -0.5, 0.0));
  EXPECT_EQ(flight.yaw_rad_s, 0.25);
}

TEST(EyebotDriver, ReadingsOfASilentRobotGrowStale) {
  Scene s;
  const auto& place = s.sensor<hal::Positioning>();
  s.run(1000);
  const hal::TimeNs taken = place.taken_ns;
  s.robot.alive = false;
  s.run(300);
  EXPECT_EQ(place.validity, hal::Validity::Stale);
  EXPECT_LE(place.taken_ns - taken, 20 * kMs);
}

TEST(EyebotDriver, APlaceThatTheRobotDoesNotTrustGrowsStaleAndKeepsItsValue) {
  Scene s;
  const auto& place = s.sensor<hal::Positioning>();
  s.robot.state.pos[0] = 1.0;
  s.run(500);
  s.robot.state.pos_valid = 0;
  s.robot.state.pos[0] = kNan;
  s.run(500);
  EXPECT_EQ(place.validity, hal::Validity::Stale);
  EXPECT_EQ(place.p_WB[0], 1.0);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
}

TEST(EyebotDriver, LeavesOutDamagedMessagesAndCountsThem) {
  Scene s;
  const auto& place = s.sensor<hal::Positioning>();
  s.robot.state.pos[0] = 1.0;
  s.run(500);
  s.robot.state.pos[0] = kNan;
  s.run(300);
  EXPECT_EQ(place.validity, hal::Validity::Stale);
  EXPECT_EQ(place.p_WB[0], 1.0);
  EXPECT_EQ(s.driver.statistics().not_understood, 15U);
  EXPECT_EQ(std::count_if(s.logged.begin(), s.logged.end(),
                          [](const std::string& l) { return l.find("not finite") != std::string::npos; }),
            1);  // a line in ten seconds
  s.robot.state.pos[0] = 2.0;
  s.run(200);
  EXPECT_EQ(place.p_WB[0], 2.0);
  EXPECT_EQ(place.validity, hal::Validity::Fresh);
}

TEST(EyebotDriver, OfAFloodTheNewestWins) {
  Scene s;
  const auto& place = s.sensor<hal::Positioning>();
  s.run(500);
  for (int i = 1; i <= 1000; ++i) {
    s.robot.state.pos[0] = 1e-4 * i;
    s.robot.say(Topic::State, s.robot.state);
  }
  s.driver.pump(s.now);
  s.driver.latch(0, s.now);
  EXPECT_EQ(place.p_WB[0], 0.1);
  EXPECT_EQ(s.inbox.statistics(Topic::State).replaced, 999U);
  EXPECT_EQ(s.inbox.statistics(Topic::State).lost, 0U);
}

TEST(EyebotDriver, SurvivesAClockThatIsSetByAnHour) {
  for (const hal::TimeNs hour : {3600 * hal::kNsPerSecond, -3600 * hal::kNsPerSecond}) {
    Scene s;
    const auto& place = s.sensor<hal::Positioning>();
    s.run(1000);
    s.robot.clock_minus_ours_ns += hour;
    s.run(300);
    EXPECT_EQ(s.driver.clock().jumps(), 1U);
    EXPECT_EQ(place.validity, hal::Validity::Fresh);
    EXPECT_EQ(s.driver.state(), RobotState::Active);
    const hal::TimeNs age = s.now - place.taken_ns;  // the run began at 0
    EXPECT_GE(age, 0);
    EXPECT_LE(age, 100 * kMs);
  }
}

TEST(EyebotDriver, WhatLayOnTheWayWhileWeSleptIsOld) {
  Scene s;
  const auto& place = s.sensor<hal::Positioning>();
  s.run(1000);
  s.now += 4 * hal::kNsPerSecond;
  s.robot.at(s.now);
  s.driver.pump(s.now);
  ASSERT_EQ(s.driver.state(), RobotState::Lost);
  const hal::TimeNs right = s.robot.clock_minus_ours_ns;
  for (int i = 0; i < 30; ++i) {  // all at once
    s.robot.clock_minus_ours_ns = right - (4000 - 100 * i) * kMs;
    s.robot.say(Topic::Heartbeat, s.robot.heartbeat);
    s.robot.say(Topic::Status, s.robot.status);
    s.robot.say(Topic::State, s.robot.state);
    s.driver.pump(s.now);
    s.driver.latch(0, s.now);
    EXPECT_NE(s.driver.state(), RobotState::Active) << i;
    EXPECT_EQ(place.validity, hal::Validity::Stale) << i;
  }
  s.robot.clock_minus_ours_ns = right;
  s.run(300);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
  EXPECT_EQ(place.validity, hal::Validity::Fresh);
  EXPECT_EQ(s.driver.clock().jumps(), 0U);
}

TEST(EyebotDriver, HearsEveryPacketBetweenTwoTicksOnce) {
  Scene s;
  const auto& heard = s.sensor<hal::RangeAndBearing>();
  messages::Rab rab{};
  rab.n = 1;
  rab.pkt.resize(1);
  rab.pkt[0].range = 2.0F;
  rab.pkt[0].elevation = 0.5F;
  rab.pkt[0].len = 2;
  rab.pkt[0].data = {7, 8};
  s.run(1000);
  s.robot.say(Topic::Rab, rab);
  rab.pkt[0].range = 1.0F;
  s.robot.say(Topic::Rab, rab);
  s.run(100);
  ASSERT_EQ(heard.count, 2U);
  EXPECT_EQ(heard.range_m[0], 1.0F);
  EXPECT_EQ(heard.range_m[1], 2.0F);
  EXPECT_EQ(heard.elevation_rad[1], 0.5F);
  EXPECT_EQ(heard.size[0], 2U);
  EXPECT_EQ(heard.message(0)[1], 8);
  s.run(100);
  EXPECT_EQ(heard.count, 0U);
}

// --- who it is ---

TEST(EyebotDriver, ARobotThatRestartsIsNotSentUpAgainByItself) {
  Scene s;
  auto& task = s.actuator<hal::FlightTask>();
  s.run(500);
  task.order = hal::FlightOrder::TakeOff;
  s.run(1000);
  ASSERT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF));
  s.robot.session = 78;
  s.robot.seq.clear();
  s.robot.status.mode = Status::MODE_IDLE;
  s.robot.status.armed = 0;
  s.run(3000);
  EXPECT_EQ(s.driver.liveness().restarts(), 1U);
  EXPECT_EQ(s.robot.obeyed.size(), 2U);
  task.order = hal::FlightOrder::Fly;
  s.run(200);
  task.order = hal::FlightOrder::TakeOff;
  s.run(500);
  EXPECT_EQ(s.robot.obeyed.size(), 4U);
}

TEST(EyebotDriver, TwoRobotsOfOneNameAreATrouble) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  ASSERT_GT(s.robot.all("cmd/velocity").size(), 0U);
  ScriptedRobot twin(s.inbox);
  twin.session = 99;
  for (int i = 0; i < 50; ++i) {
    s.run(10);
    twin.live(s.now);
  }
  s.run(10);
  EXPECT_EQ(s.driver.state(), RobotState::Suspect);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("two robots are called 'eb0'"));
  EXPECT_GT(s.driver.liveness().others(), 3U);
  const std::size_t said = s.robot.all("cmd/velocity").size();
  for (int i = 0; i < 20; ++i) {
    s.run(10);
    twin.live(s.now);
  }
  EXPECT_EQ(s.robot.all("cmd/velocity").size(), said);
  s.run(4000);  // the twin is gone: the one that is left is taken
  EXPECT_EQ(s.driver.state(), RobotState::Active);
}

TEST(EyebotDriver, ASecondRobotOfItsNameThatIsThereFromTheStartKeepsItFromArming) {
  Scene s;
  s.actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
  ScriptedRobot twin(s.inbox);
  twin.session = 99;
  for (int i = 0; i < 300; ++i) {
    twin.live(s.now);
    s.run(10);
  }
  EXPECT_TRUE(s.robot.obeyed.empty());
  EXPECT_THAT(s.driver.trouble(), HasSubstr("two robots are called 'eb0'"));
}

TEST(EyebotDriver, AHubThatIsNotInControlYieldsToAnotherAndNamesIt) {
  Scene s;
  s.actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
  s.actuator<hal::RingLeds>();
  s.inbox.neighbours().hear_hub("lab2", 4711);
  for (int i = 0; i < 300; ++i) {
    if (i % 50 == 0) s.inbox.neighbours().hear_command(4711, s.now);
    s.run(10);
  }
  EXPECT_TRUE(s.robot.obeyed.empty());
  EXPECT_TRUE(s.robot.all("cmd/leds").empty());
  EXPECT_EQ(s.driver.state(), RobotState::Ready);
  EXPECT_EQ(s.driver.trouble(), "another hub, 'lab2', commands it");
  s.run(4500);  // the other one is gone
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF));
  s.inbox.neighbours().hear_command(4711, s.now);  // and back: now it is ours
  s.run(500);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
}

TEST(EyebotDriver, ARestartInTheAirIsACountedStop) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.mode = Status::MODE_VELOCITY;
  s.run(500);
  ASSERT_EQ(s.driver.statistics().link_stops, 0U);
  s.robot.session = 78;
  s.robot.seq.clear();
  s.robot.status.mode = Status::MODE_IDLE;
  s.robot.status.armed = 0;
  s.run(100);
  EXPECT_EQ(s.driver.state(), RobotState::Suspect);
  s.run(900);
  EXPECT_EQ(s.driver.state(), RobotState::Active);
  EXPECT_EQ(s.driver.liveness().restarts(), 1U);
  EXPECT_EQ(s.driver.statistics().link_stops, 1U);
}

TEST(EyebotDriver, ARobotThatSavesItselfIsHeldAndSaysWhy) {
  for (const auto& [failsafe, why] :
       {std::pair{Status::FS_LOW_BATTERY, "its battery is low"}, std::pair{Status::FS_HARDWARE, "a device failed"}}) {
    Scene s;
    s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
    s.fly();
    s.robot.status.mode = Status::MODE_LAND;
    s.robot.status.failsafe = failsafe;
    s.run(500);
    EXPECT_EQ(s.driver.state(), RobotState::Suspect);
    EXPECT_EQ(s.driver.trouble(), why);
    EXPECT_EQ(s.driver.statistics().saved_itself, 1U);
    EXPECT_EQ(s.driver.statistics().link_stops, 1U);
    EXPECT_TRUE(s.has_logged(why));
  }
}

TEST(EyebotDriver, ALandingThatNobodyToldItIsACountedStop) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.mode = Status::MODE_LAND;
  s.run(10);
  s.driver.pump(s.now);
  s.run(100);
  EXPECT_EQ(s.driver.statistics().saved_itself, 1U);
  EXPECT_EQ(s.driver.statistics().link_stops, 1U);
}

TEST(EyebotDriver, AnOrderedLandingIsNoStop) {
  Scene s;
  auto& task = s.actuator<hal::FlightTask>();
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  task.order = hal::FlightOrder::Land;
  s.run(1500);
  ASSERT_EQ(s.robot.status.mode, Status::MODE_IDLE);
  EXPECT_EQ(s.driver.statistics().saved_itself, 0U);
  EXPECT_EQ(s.driver.statistics().link_stops, 0U);
}

TEST(EyebotDriver, LandsARobotThatIsToHoverWithALowBattery) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  messages::Battery battery{};
  battery.voltage = 10.0F;
  battery.charge = 0.5F;
  s.robot.say(Topic::Battery, battery);
  s.driver.stop(s.now);
  s.run(500);
  EXPECT_EQ(s.robot.status.mode, Status::MODE_HOVER);
  battery.low = 1;
  s.robot.say(Topic::Battery, battery);
  s.run(500);
  EXPECT_EQ(s.robot.status.mode, Status::MODE_IDLE);
  EXPECT_TRUE(s.driver.at_rest());
}

// --- its clock ---

/// What the robot makes of stamps: a robot whose clock is synchronised refuses those that are 250 ms off.
bool is_fresh(const Scene& s, const Said& said) {
  const std::int64_t robots_us = (said.at_ns + s.robot.clock_minus_ours_ns) / 1000;
  std::int64_t stamp_us = 0;
  for (std::size_t i = 8; i < 16; ++i) stamp_us = stamp_us << 8 | std::to_integer<std::int64_t>(said.data[i]);
  return std::abs(stamp_us - robots_us) <= 250'000;
}
const hal::TimeNs* g_now = nullptr;
hal::TimeNs clock_of_scene() noexcept {
  return *g_now + 1'700'000'000 * hal::kNsPerSecond;
}
DriverSettings synchronised() {
  DriverSettings settings;
  settings.unix_clock = &clock_of_scene;
  return settings;
}

TEST(EyebotDriver, CommandsAreYoungEnoughWithinASecondAfterAClockWasSet) {
  for (const hal::TimeNs jump : {3600 * hal::kNsPerSecond, -3600 * hal::kNsPerSecond}) {
    Scene s(synchronised());
    g_now = &s.now;
    s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
    s.fly();
    s.robot.clock_minus_ours_ns += jump;
    s.run(1000);
    EXPECT_EQ(s.driver.clock().jumps(), 1U);
    EXPECT_EQ(s.driver.statistics().link_stops, 1U);
    EXPECT_TRUE(s.has_logged("clock was set"));
    s.robot.said.clear();
    s.run(500);
    s.driver.land(s.now);
    s.run(500);
    ASSERT_FALSE(s.robot.all("cmd/velocity").empty());
    for (const Said& said : s.robot.all("/cmd/velocity")) EXPECT_TRUE(is_fresh(s, said));
    for (const Said& said : s.robot.all("/cmd/mode")) EXPECT_TRUE(is_fresh(s, said));
    EXPECT_TRUE(s.driver.landed());
  }
}

TEST(EyebotDriver, AsksNowAndThenSuchThatTheErrorOfTheRobotsClockIsBounded) {
  Scene s(synchronised());
  g_now = &s.now;
  s.actuator<hal::QuadrotorSpeed>().set(0.0, 0.0, 0.0, 0.0);
  s.fly();
  s.run(45'000);
  const ClockState clock = s.driver.clock().state(s.now);
  EXPECT_GE(clock.exchanges, 5U) << "orders, and one every ten seconds";
  EXPECT_LE(clock.exchanges, 12U);
  ASSERT_TRUE(clock.bound_ns);
  EXPECT_LE(*clock.bound_ns, 20 * kMs);
  EXPECT_EQ(s.driver.statistics().link_stops, 0U);
  EXPECT_EQ(s.driver.orders().statistics().unanswered, 0U);
}

hal::TimeNs g_set_by = 0;
hal::TimeNs clock_that_is_set() noexcept {
  return clock_of_scene() + g_set_by;
}

TEST(EyebotDriver, CommandsStayYoungWhenTheClockOfThisMachineIsSet) {
  for (const hal::TimeNs jump : {3600 * hal::kNsPerSecond, -400 * kMs}) {
    DriverSettings settings;
    settings.unix_clock = &clock_that_is_set;
    g_set_by = 0;
    Scene s(settings);
    g_now = &s.now;
    s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
    s.robot.clock_minus_ours_ns = 1'700'000'000 * hal::kNsPerSecond;
    s.fly();
    s.robot.said.clear();
    g_set_by = jump;
    s.run(1000);
    ASSERT_FALSE(s.robot.all("cmd/velocity").empty());
    for (const Said& said : s.robot.all("/cmd/velocity")) EXPECT_TRUE(is_fresh(s, said));
    EXPECT_EQ(s.driver.statistics().link_stops, 0U);
  }
}

TEST(EyebotDriver, AnOrderThatIsRefusedForItsStampIsSaidAnewByTheRobotsClock) {
  for (const hal::TimeNs jump : {600 * kMs, -600 * kMs}) {
    Scene s(synchronised());
    g_now = &s.now;
    s.actuator<hal::FlightTask>();
    s.fly();
    s.robot.clock_minus_ours_ns += jump;
    s.run(20);
    s.robot.said.clear();
    s.robot.result = messages::Ack::REJECTED_STALE;
    s.driver.land(s.now);
    s.robot.result = messages::Ack::OK;
    s.run(600);
    ASSERT_GE(s.robot.all("/cmd/mode").size(), 2U);
    EXPECT_TRUE(is_fresh(s, s.robot.all("/cmd/mode")[1]));
    EXPECT_TRUE(s.driver.landed());
  }
}

// --- where it can be ---

TEST(EyebotDriver, APlaceThatItCannotHaveFlownToIsNotBelieved) {
  Scene s;
  const auto& place = s.sensor<hal::Positioning>();
  s.run(1000);
  s.robot.state.pos[0] = 5.0;
  s.run(300);
  EXPECT_EQ(place.p_WB[0], 0.0);
  EXPECT_EQ(place.validity, hal::Validity::Stale);
  EXPECT_GT(s.driver.places().refused(), 10U);
  s.robot.state.pos[0] = 0.1;
  s.run(100);
  EXPECT_EQ(place.p_WB[0], 0.1);
  EXPECT_EQ(place.validity, hal::Validity::Fresh);
  s.robot.state.pos[0] = 9.0;  // and stays there: its positioning has begun anew
  s.run(1000);
  EXPECT_EQ(place.p_WB[0], 9.0);
  EXPECT_EQ(s.driver.places().jumps(), 1U);
}

// --- orders ---

TEST(EyebotDriver, TakesOffByArmingFirst) {
  Scene s;
  auto& task = s.actuator<hal::FlightTask>();
  s.run(500);
  EXPECT_TRUE(s.robot.obeyed.empty());
  task.order = hal::FlightOrder::TakeOff;
  task.speed_m_s = 0.5;
  s.run(1000);
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF));
  EXPECT_EQ(s.robot.all("cmd/mode").back().as<CmdMode>().param, 0.5F);
  EXPECT_TRUE(s.driver.controlled());
  task.order = hal::FlightOrder::Land;
  s.run(1000);
  EXPECT_THAT(s.robot.obeyed,
              ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF, CmdMode::ACT_LAND, CmdMode::ACT_DISARM));
  s.run(3000);
  EXPECT_EQ(s.robot.obeyed.size(), 4U);
}

TEST(EyebotDriver, AttachesAndDetaches) {
  Scene s;
  auto& task = s.actuator<hal::FlightTask>();
  task.order = hal::FlightOrder::Attach;
  s.run(1500);
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF, CmdMode::ACT_ATTACH));
  task.order = hal::FlightOrder::Detach;
  s.run(500);
  EXPECT_EQ(s.robot.obeyed.back(), CmdMode::ACT_DETACH);
  EXPECT_EQ(s.robot.obeyed.size(), 4U);
}

TEST(EyebotDriver, RepeatsAnOrderWithTheSameNumberUntilItIsAnswered) {
  Scene s;
  s.actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
  s.robot.deaf_times = 3;
  s.run(1500);
  const auto orders = s.robot.all("cmd/mode");
  ASSERT_EQ(orders.size(), 5U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(orders[static_cast<std::size_t>(i)].as<CmdMode>().hdr.seq, 0);
    EXPECT_EQ(orders[static_cast<std::size_t>(i)].at_ns - orders[0].at_ns, i * 200 * kMs);
  }
  EXPECT_EQ(orders[4].as<CmdMode>().hdr.seq, 1);
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF));
  EXPECT_EQ(s.driver.orders().statistics().said_again, 3U);
}

TEST(EyebotDriver, GivesAnOrderUpAfterTenTimesAndTriesAgainLater) {
  Scene s;
  s.actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
  s.robot.deaf_times = 1000;
  s.run(2500);
  EXPECT_EQ(s.robot.all("cmd/mode").size(), 10U);
  EXPECT_EQ(s.driver.orders().statistics().unanswered, 1U);
  s.run(1000);
  const auto orders = s.robot.all("cmd/mode");
  ASSERT_GT(orders.size(), 10U);
  EXPECT_EQ(orders[10].as<CmdMode>().hdr.seq, 1);
  EXPECT_THAT(s.driver.trouble(), HasSubstr("did not arm: not answered"));
}

TEST(EyebotDriver, SaysThatAnotherHubControlsTheRobotAndAsksAgain) {
  Scene s;
  s.actuator<hal::FlightTask>().order = hal::FlightOrder::TakeOff;
  s.robot.result = messages::Ack::REJECTED_SOURCE;
  s.run(1000);
  EXPECT_EQ(s.driver.trouble(), "another hub controls it");
  EXPECT_GE(s.driver.statistics().refused_control, 1U);
  EXPECT_FALSE(s.driver.controlled());
  s.robot.result = messages::Ack::OK;
  s.run(2500);
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM, CmdMode::ACT_TAKEOFF));
  EXPECT_EQ(s.driver.trouble(), "");
}

TEST(EyebotDriver, DoesNotAskForControlWhenNobodyCommandsFlight) {
  Scene s;
  s.actuator<hal::RingLeds>();
  s.robot.status.mode = Status::MODE_HOVER;
  s.run(2000);
  EXPECT_TRUE(s.robot.all("cmd/mode").empty());
}

TEST(EyebotDriver, DoesNothingAgainstALowBattery) {
  Scene s;
  auto& task = s.actuator<hal::FlightTask>();
  s.fly();
  const std::size_t before = s.robot.obeyed.size();
  s.robot.status.mode = Status::MODE_LAND;
  s.robot.status.failsafe = Status::FS_LOW_BATTERY;
  task.order = hal::FlightOrder::TakeOff;
  s.run(3000);
  EXPECT_EQ(s.robot.obeyed.size(), before);
  EXPECT_EQ(s.driver.trouble(), "its battery is low");
}

TEST(EyebotDriver, ClearsALinkThatTheRobotHadLost) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(0.5, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.failsafe = Status::FS_LINK_LOST;
  s.run(500);
  EXPECT_EQ(s.robot.obeyed.back(), CmdMode::ACT_CLEAR_FAILSAFE);
  const std::size_t said = s.robot.all("cmd/velocity").size();
  s.run(500);
  EXPECT_GT(s.robot.all("cmd/velocity").size(), said);
}

TEST(EyebotDriver, SaysThatSomebodyCutTheMotors) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(0.5, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.mode = Status::MODE_ESTOP;
  s.run(500);
  EXPECT_EQ(s.driver.trouble(), "its motors were cut in an emergency");
}

// --- where it flies ---

TEST(EyebotDriver, SaysVelocitiesAtOnceAndAgain) {
  Scene s;
  auto& speed = s.actuator<hal::QuadrotorSpeed>();
  s.fly();
  EXPECT_THAT(s.robot.obeyed, ElementsAre(CmdMode::ACT_ARM));  // it was in the air, but not ours
  s.robot.said.clear();
  s.controller = [&] { speed.set(0.5, -0.25, 0.125, 0.1); };
  s.run(1000);
  const auto said = s.robot.all("eyebot/eb0/cmd/velocity");
  EXPECT_GE(said.size(), 10U);
  EXPECT_LE(said.size(), 21U);
  const auto m = said.back().as<CmdVelocity>();
  EXPECT_EQ(m.frame, CmdVelocity::FRAME_WORLD);
  EXPECT_EQ(m.vel[0], 0.5);
  EXPECT_EQ(m.vel[1], -0.25);
  EXPECT_EQ(m.vel[2], 0.125);
  EXPECT_EQ(m.yaw_rate, 0.1);
  EXPECT_EQ(m.timeout_ms, 500);
  EXPECT_EQ(m.hdr.session, 0x1234);
  for (std::size_t i = 1; i < said.size(); ++i) {
    EXPECT_EQ(said[i].as<CmdVelocity>().hdr.seq, said[i - 1].as<CmdVelocity>().hdr.seq + 1);
  }
}

TEST(EyebotDriver, SaysPlacesInTheRobotsOwnWorld) {
  DriverSettings settings;
  settings.world = {{1.0, 2.0, 0.0}, std::acos(0.0)};  // turned to the left by a right angle
  Scene s(settings);
  auto& position = s.actuator<hal::QuadrotorPosition>();
  const auto& place = s.sensor<hal::Positioning>();
  s.robot.state.pos[0] = 3.0;
  s.fly();
  EXPECT_NEAR(place.p_WB[0], 1.0, 1e-12);
  EXPECT_NEAR(place.p_WB[1], 5.0, 1e-12);
  EXPECT_NEAR(place.q_WB[3], std::sqrt(0.5), 1e-12);
  s.robot.said.clear();
  position.set(1.0, 5.0, 1.5, 0.0);
  s.run(2000);
  const auto said = s.robot.all("cmd/position");
  EXPECT_GE(said.size(), 4U);
  EXPECT_LE(said.size(), 6U);  // on change, and twice a second
  const auto m = said.back().as<CmdPosition>();
  EXPECT_NEAR(m.pos[0], 3.0, 1e-12);
  EXPECT_NEAR(m.pos[1], 0.0, 1e-12);
  EXPECT_EQ(m.pos[2], 1.5);
  EXPECT_NEAR(m.yaw, -std::acos(0.0), 1e-12);
  EXPECT_EQ(m.use_yaw, 1);
  EXPECT_GT(m.timeout_ms, 1000);
  EXPECT_TRUE(s.robot.all("cmd/velocity").size() <= 1);
}

TEST(EyebotDriver, MakesSafeWhatIsNoNumberAndClampsWhatIsTooFast) {
  Scene s;
  auto& speed = s.actuator<hal::QuadrotorSpeed>();
  s.fly();
  speed.set(kNan, 1.0, 0.0, 0.0);
  s.run(200);
  auto m = s.robot.all("cmd/velocity").back().as<CmdVelocity>();
  EXPECT_EQ(m.vel[1], 0.0);
  EXPECT_GE(s.driver.statistics().not_finite, 1U);
  speed.set(100.0, 0.0, 0.0, 0.0);
  s.run(200);
  m = s.robot.all("cmd/velocity").back().as<CmdVelocity>();
  EXPECT_DOUBLE_EQ(m.vel[0], hal::eyebot::kind().flight()->max_speed_m_s);
  EXPECT_GE(s.driver.statistics().clamped, 1U);
  EXPECT_EQ(speed.velocity[0], 100.0);  // the controller's own is left alone
}

TEST(EyebotDriver, HoversWhenTheLoopHangsAndRampsWhenItIsBack) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.mode = Status::MODE_VELOCITY;
  s.run(100);
  s.commits = false;
  s.run(700);
  EXPECT_EQ(s.robot.obeyed.back(), CmdMode::ACT_HOVER);
  EXPECT_EQ(s.driver.statistics().watchdog_stops, 1U);
  const std::size_t said = s.robot.all("cmd/velocity").size();
  s.run(1000);
  EXPECT_EQ(s.robot.all("cmd/velocity").size(), said);
  s.commits = true;
  s.robot.said.clear();
  s.run(1000);
  const auto after = s.robot.all("cmd/velocity");
  ASSERT_GE(after.size(), 3U);
  EXPECT_EQ(after.back().as<CmdVelocity>().vel[0], 1.0);
  EXPECT_EQ(s.driver.statistics().rearmed, 1U);
}

TEST(EyebotDriver, HoversWhenTheRobotIsNotHeard) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.mode = Status::MODE_VELOCITY;
  s.run(200);
  s.robot.alive = false;
  s.run(800);
  EXPECT_EQ(s.driver.statistics().link_stops, 1U);
  EXPECT_EQ(s.robot.obeyed.back(), CmdMode::ACT_HOVER);
  const std::size_t said = s.robot.all("cmd/velocity").size();
  s.run(2000);
  EXPECT_EQ(s.robot.all("cmd/velocity").size(), said);
}

TEST(EyebotDriver, AStopHasItHoverUntilItIsResumed) {
  Scene s;
  auto& speed = s.actuator<hal::QuadrotorSpeed>();
  speed.set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.robot.status.mode = Status::MODE_VELOCITY;
  s.run(200);
  s.driver.stop(s.now);
  EXPECT_EQ(s.robot.obeyed.back(), CmdMode::ACT_HOVER);
  s.run(300);
  EXPECT_TRUE(s.driver.at_rest());
  s.robot.said.clear();
  s.run(500);
  EXPECT_TRUE(s.robot.all("cmd/velocity").empty());
  s.driver.resume();
  EXPECT_FALSE(s.driver.at_rest());
  s.run(300);
  EXPECT_FALSE(s.robot.all("cmd/velocity").empty());
}

TEST(EyebotDriver, LandsAndSwitchesTheMotorsOff) {
  Scene s;
  s.actuator<hal::QuadrotorSpeed>().set(1.0, 0.0, 0.0, 0.0);
  s.fly();
  s.driver.stop(s.now);
  s.run(300);
  EXPECT_TRUE(s.driver.at_rest());
  EXPECT_FALSE(s.driver.landed());
  s.driver.land(s.now);
  EXPECT_FALSE(s.driver.landed());
  s.run(500);
  EXPECT_TRUE(s.driver.landed());
  EXPECT_EQ(s.robot.obeyed[s.robot.obeyed.size() - 2], CmdMode::ACT_LAND);
  EXPECT_EQ(s.robot.obeyed.back(), CmdMode::ACT_DISARM);
}

TEST(EyebotDriver, LeavesARobotAloneThatIsNotItsOwn) {
  Scene s;
  s.robot.status.mode = Status::MODE_VELOCITY;
  s.commits = false;
  s.run(500);
  s.driver.stop(s.now);
  s.run(500);
  s.driver.land(s.now);
  s.run(500);
  EXPECT_TRUE(s.robot.obeyed.empty());
  EXPECT_TRUE(s.driver.landed());
}

// --- its other devices ---

TEST(EyebotDriver, SaysLightsWhenTheyChangeAndOnceASecond) {
  Scene s;
  auto& lower = s.actuator<hal::RingLeds>();
  auto& upper = s.actuator<hal::UpperRingLeds>();
  s.run(500);
  s.robot.said.clear();
  lower.set(3, hal::kRed);
  upper.set(15, hal::kBlue);
  s.run(2100);
  const auto said = s.robot.all("eyebot/eb0/cmd/leds");
  EXPECT_EQ(said.size(), 3U);
  const auto m = said[0].as<messages::Leds>();
  EXPECT_EQ(m.rings, 3);  // the beacon is nobody's
  EXPECT_EQ(m.lower[3][0], 255);
  EXPECT_EQ(m.upper[15][2], 255);
}

TEST(EyebotDriver, SaysWhereItsHeadsAreToLook) {
  Scene s;
  auto& head = s.actuator<hal::PanTiltDrive>();
  auto& scanner = s.actuator<hal::ScannerDrive>();
  head.pan_rad = 1.0;
  head.tilt_rad = 0.5;
  head.laser = true;
  scanner.turn(std::acos(-1.0));
  s.run(500);
  const auto looks = s.robot.all("cmd/pan_tilt").back().as<messages::CmdPanTilt>();
  EXPECT_EQ(looks.pan_target, 1.0F);
  EXPECT_EQ(looks.tilt_target, 0.5F);
  EXPECT_EQ(looks.laser, 1);
  auto turns = s.robot.all("cmd/scanner").back().as<messages::CmdScanner>();
  EXPECT_EQ(turns.enable, 1);
  EXPECT_EQ(turns.fixed, 0);
  EXPECT_FLOAT_EQ(turns.rpm, 30.0F);
  scanner.go_to(0.25);
  s.run(200);
  turns = s.robot.all("cmd/scanner").back().as<messages::CmdScanner>();
  EXPECT_EQ(turns.fixed, 1);
  EXPECT_EQ(turns.angle, 0.25F);
  head.pan_rad = kNan;
  s.run(200);
  EXPECT_EQ(s.robot.all("cmd/pan_tilt").back().as<messages::CmdPanTilt>().pan_target, 0.0F);
}

TEST(EyebotDriver, SendsMessagesToNeighbours) {
  Scene s;
  auto& radio = s.actuator<hal::RangeAndBearingSend>();
  radio.sending = true;
  radio.size = 3;
  radio.payload[2] = 42;
  s.run(500);
  auto m = s.robot.all("cmd/rab").back().as<messages::CmdRab>();
  ASSERT_EQ(m.len, 3);
  EXPECT_EQ(m.data[2], 42);
  radio.sending = false;
  s.run(200);
  EXPECT_EQ(s.robot.all("cmd/rab").back().as<messages::CmdRab>().len, 0);
}

// --- what it has ---

TEST(EyebotRobot, HasTheDevicesThatTheMessagesCarry) {
  Scene s;
  EXPECT_THROW(s.actuator<hal::QuadrotorAttitude>(), hal::DeviceError);  // balancing over a radio is not safe
  EXPECT_THROW(s.sensor<hal::OmnidirectionalCamera>(), hal::DeviceError);
  for (const hal::PortType* type : port_types()) EXPECT_NE(s.driver.robot().require(*type), nullptr);
}

TEST(EyebotRobot, GivesOnlyWhatTheConfigurationLists) {
  DriverSettings settings;
  settings.robot.sensors = {"positioning"};
  settings.robot.actuators = std::vector<std::string>{};
  Scene s(settings);
  EXPECT_NO_THROW(s.sensor<hal::Positioning>());
  EXPECT_THROW(s.sensor<hal::Battery>(), hal::DeviceError);
  EXPECT_THROW(s.actuator<hal::RingLeds>(), hal::DeviceError);
}

}  // namespace
}  // namespace tandem::bridges::eyebot
