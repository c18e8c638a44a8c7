#include "bridges/epuck/session.hpp"

#include <cstring>
#include <deque>
#include <functional>
#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "tests/bridges/epuck/scripted_robot.hpp"

namespace tandem::bridges::epuck {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const QuantitySet kProximity{Quantity::Proximity};

Actuation driving(int left, int right) {
  Actuation a;
  a.left = {static_cast<std::int16_t>(left)};
  a.right = {static_cast<std::int16_t>(right)};
  return a;
}

/// A session and a robot joined by a wire without length, in a time that the test moves.
struct Rig {
  Session session;
  ScriptedRobot robot;
  hal::TimeNs now = 1000 * kMs;
  std::size_t largest_output = 0;
  std::function<Bytes(Bytes)> upstream = [](Bytes b) { return b; };    // what becomes of the robot's bytes
  std::function<Bytes(Bytes)> downstream = [](Bytes b) { return b; };  // and of the host's

  void flush() {
    while (!session.output().empty()) {
      const Bytes out(session.output().bytes().begin(), session.output().bytes().end());
      largest_output = std::max(largest_output, out.size());
      session.clear_output();
      const Bytes answer = upstream(robot.hear(downstream(out)));
      if (!answer.empty()) session.on_bytes(answer, now);
    }
  }
  void hear(const Bytes& bytes) {
    session.on_bytes(bytes, now);
    flush();
  }
  void run(hal::TimeNs duration) {
    for (const hal::TimeNs end = now + duration; now < end;) {
      now += kMs;
      session.poll(now);
      flush();
    }
  }
  void connect() {
    session.link_up(now);
    flush();
    run(400 * kMs);
  }
  void request(const Actuation& actuation, QuantitySet quantities = kProximity) {
    session.request(actuation, quantities, now);
    flush();
  }
};

TEST(EpuckSession, ShakesHandsStopsTheRobotAndBecomesActive) {
  Rig rig;
  rig.robot.left = 700;
  EXPECT_EQ(rig.session.state(), SessionState::Absent);
  rig.connect();
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.identity().firmware, Firmware::GCtronic);
  EXPECT_EQ(rig.session.identity().hardware, 1U);
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_GE(rig.robot.stops, 1);
  EXPECT_TRUE(rig.session.at_rest());
  EXPECT_EQ(rig.session.statistics().handshake_failures, 0U);
  EXPECT_STREQ(rig.session.trouble(), "");
}

TEST(EpuckSession, LearnsHowEachFirmwareAnswers) {
  struct Case {
    const char* version;
    bool hardware_line;
    std::size_t ground, battery;
    Firmware firmware;
  };
  for (const Case& c : {Case{"Version 2.0.0 January 2008", false, 6, 0, Firmware::BTcom},
                        Case{"Version 1.2.2 August 2008 GCtronic", true, 6, 2, Firmware::GCtronic},
                        Case{"Version 1.2.2 August 2008 GCtronic", true, 10, 2, Firmware::GCtronic},
                        Case{"Version 1.2.2 August 2008 GCtronic", true, 0, 2, Firmware::GCtronic},
                        Case{"Version 1.5.3 November 2016 (Webots)", true, 6, 2, Firmware::Webots},
                        Case{"Version 2.0 January 2018 GCtronic", true, 8, 2, Firmware::Epuck2}}) {
    Rig rig;
    rig.robot.version = c.version;
    rig.robot.hardware_line = c.hardware_line;
    rig.robot.ground_bytes = c.ground;
    rig.robot.battery_bytes = c.battery;
    rig.connect();
    EXPECT_EQ(rig.session.state(), SessionState::Active) << c.version;
    EXPECT_EQ(rig.session.identity().firmware, c.firmware);
    EXPECT_EQ(rig.session.layout().ground_bytes, c.ground);
    EXPECT_EQ(rig.session.layout().battery_bytes, c.battery);
    rig.robot.proximity = {1, 2, 3, 4, 5, 6, 7, 8};
    rig.request({}, {Quantity::Ground, Quantity::Battery, Quantity::Proximity});
    EXPECT_THAT(rig.session.samples().raw.proximity, testing::ElementsAre(1, 2, 3, 4, 5, 6, 7, 8)) << c.version;
    EXPECT_EQ(rig.session.samples().raw.battery, c.battery > 0 ? 2315 : 0);
    EXPECT_EQ(rig.session.samples().known.has(Quantity::Battery), c.battery > 0);
    EXPECT_EQ(rig.session.samples().known.has(Quantity::Ground), c.ground > 0);
    EXPECT_EQ(rig.session.samples().raw.ground[0], c.ground > 0 ? 1023 : 0);
  }
}

TEST(EpuckSession, KnowsAFirmwareThroughNoiseInItsVersion) {
  Rig rig;
  rig.upstream = [](Bytes b) {
    const std::string text(b.begin(), b.end());
    const std::size_t at = text.find("Version 1.2.2");
    if (at != std::string::npos) b[at + 10] ^= 0x12;
    return b;
  };
  rig.connect();
  rig.run(300 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.identity().firmware, Firmware::GCtronic);
  EXPECT_GE(rig.session.statistics().odd_versions, 2U) << "it was asked again";
}

TEST(EpuckSession, AsksAgainForAVersionThatWasMaimedOnce) {
  Rig rig;
  rig.upstream = [&](Bytes b) {
    const std::string text(b.begin(), b.end());
    if (text.find("Version") != std::string::npos) {
      rig.upstream = [](Bytes later) { return later; };
      return Bytes(b.begin(), b.begin() + 14);
    }
    return b;
  };
  rig.connect();
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.identity().version_text(), "Version 1.2.2 August 2008 GCtronic");
  EXPECT_EQ(rig.session.statistics().handshake_failures, 0U);
}

TEST(EpuckSession, GetsThroughWhenTheFirmwareStillWaitsInsideALine) {
  for (const char* rest : {"\r\n", "\r", "D,50", "N", "\xBC\x10", "\x89\x01\x02", "\xB4"}) {
    Rig rig;
    rig.robot.hear(Bytes(rest, rest + std::strlen(rest)));
    rig.connect();
    EXPECT_EQ(rig.session.state(), SessionState::Active) << rest;
    EXPECT_EQ(rig.robot.left, 0) << rest;
    EXPECT_EQ(rig.robot.right, 0) << rest;
    EXPECT_EQ(rig.session.statistics().handshake_failures, 0U) << rest;
  }
}

TEST(EpuckSession, NeverSendsMoreThanTheRobotsBufferHolds) {
  Rig rig;
  rig.connect();
  Actuation all = driving(1000, -1000);
  all.ring.fill(hal::kWhite);
  all.body = all.front = true;
  rig.session.request(all,
                      {Quantity::Encoders, Quantity::Proximity, Quantity::Ambient, Quantity::Acceleration,
                       Quantity::Microphones, Quantity::Battery, Quantity::Ground, Quantity::Gyro},
                      rig.now);
  EXPECT_LE(rig.session.output().size(), Session::kLongestRequest);
  rig.flush();
  EXPECT_LE(rig.largest_output, Packet::kCapacity);
  EXPECT_EQ(rig.robot.leds, (std::array<int, 10>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(EpuckSession, SendsSpeedsOnChangeAndLedsOnceASecondAsWell) {
  Rig rig;
  rig.connect();
  rig.robot.speeds.clear();
  rig.robot.led_settings = 0;
  for (int tick = 0; tick < 40; ++tick) {
    rig.request(driving(300, 200));
    rig.run(100 * kMs);
  }
  EXPECT_EQ(rig.robot.speeds.size(), 1U);
  EXPECT_GE(rig.robot.led_settings, 30);
  EXPECT_LE(rig.robot.led_settings, 50);
  rig.robot.speeds.clear();
  rig.request(driving(301, 200));
  EXPECT_THAT(rig.robot.speeds, testing::Contains(std::pair(301, 200)));
}

TEST(EpuckSession, SendsCommandsAndQuestionsApart) {
  Rig rig;
  rig.connect();
  rig.robot.proximity[0] = 77;
  rig.session.command(driving(300, 200), rig.now);
  rig.flush();
  EXPECT_EQ(rig.robot.left, 300);
  EXPECT_NE(rig.session.samples().raw.proximity[0], 77);
  const auto packets = rig.session.statistics().packets;
  rig.session.command(driving(300, 200), rig.now);
  EXPECT_EQ(rig.session.statistics().packets, packets) << "nothing new to be told";
  rig.session.ask(kProximity, rig.now);
  rig.flush();
  EXPECT_EQ(rig.session.samples().raw.proximity[0], 77);
}

TEST(EpuckSession, TellsTheSpeedsAgainWhenTheRobotStillHasItsOldOnes) {
  Rig rig;
  rig.connect();
  rig.request(driving(300, 300));
  rig.downstream = [&](Bytes b) {
    rig.downstream = [](Bytes later) { return later; };
    b.erase(b.begin(), std::find(b.begin(), b.end(), 0xAF));  // the command is lost, the question is not
    return b;
  };
  rig.request(driving(500, -500));
  EXPECT_EQ(rig.robot.left, 500);
  EXPECT_EQ(rig.robot.right, -500);
  EXPECT_EQ(rig.session.statistics().wrong_speeds, 1U);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
}

TEST(EpuckSession, StopsARobotThatHasSpeedsWhichItWasNeverTold) {
  Rig rig;
  rig.connect();
  rig.downstream = [&](Bytes b) {
    rig.downstream = [](Bytes later) { return later; };
    b.erase(std::find(b.begin(), b.end(), 0xBC) + 2);  // a byte of the speeds is lost
    return b;
  };
  rig.request(driving(500, 500));
  EXPECT_EQ(rig.session.state(), SessionState::Suspect);
  EXPECT_EQ(rig.robot.left, 0) << "at once";
  rig.run(200 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.robot.left, 0);
}

TEST(EpuckSession, DoesNotRepeatSpeedsWithinARefresh) {
  Rig rig;
  rig.connect();
  rig.request(driving(300, 200));
  rig.robot.speeds.clear();
  rig.run(10 * kMs);
  rig.request(driving(300, 200));
  EXPECT_TRUE(rig.robot.speeds.empty());
}

TEST(EpuckSession, SendsColoursToAnEpuck2) {
  Rig rig;
  rig.robot.version = "Version 2.0 January 2018 GCtronic";
  rig.robot.ground_bytes = 8;
  rig.connect();
  Actuation a;
  a.ring[1] = {255, 0, 51};
  a.ring[2] = hal::kRed;
  rig.request(a);
  EXPECT_THAT(std::vector<int>(rig.robot.rgb.begin(), rig.robot.rgb.begin() + 4), testing::ElementsAre(100, 0, 20, 0));
  EXPECT_EQ(rig.robot.leds[2], 1);
  EXPECT_EQ(rig.robot.leds[1], 0);
}

TEST(EpuckSession, StampsAnAnswerWithItsArrival) {
  Rig rig;
  rig.connect();
  rig.run(123 * kMs);
  rig.request({});
  EXPECT_EQ(rig.session.samples().taken_ns[static_cast<std::size_t>(Quantity::Proximity)], rig.now);
}

TEST(EpuckSession, HoldsOneRequestBackWhileAnAnswerIsAwaited) {
  Rig rig;
  rig.connect();
  rig.robot.speeds.clear();
  Bytes held;
  rig.upstream = [&](Bytes b) {
    held.insert(held.end(), b.begin(), b.end());
    return Bytes{};
  };
  rig.request(driving(100, 100));
  rig.request(driving(200, 200));
  rig.request(driving(300, 300));
  EXPECT_EQ(rig.robot.left, 100);
  EXPECT_EQ(rig.session.statistics().replaced, 1U);
  rig.upstream = [](Bytes b) { return b; };
  rig.hear(held);
  EXPECT_THAT(rig.robot.speeds, testing::ElementsAre(std::pair(100, 100), std::pair(300, 300)));
}

TEST(EpuckSession, AsksAgainForATruncatedAnswerWithoutStoppingTheRobot) {
  Rig rig;
  rig.connect();
  rig.upstream = [&](Bytes b) {
    if (b.size() > 3) b.resize(b.size() - 3);
    return b;
  };
  rig.request(driving(500, 500));
  rig.upstream = [](Bytes b) { return b; };
  const auto begun = rig.now;
  rig.run(150 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_LE(rig.session.samples().taken_ns[0] - begun, 150 * kMs);
  EXPECT_GT(rig.session.samples().taken_ns[0], begun);
  EXPECT_EQ(rig.session.statistics().cut_short, 1U);
  EXPECT_EQ(rig.session.statistics().asked_again, 1U);
  EXPECT_EQ(rig.session.statistics().resynchronised, 0U);
  EXPECT_EQ(rig.robot.left, 500);
}

TEST(EpuckSession, StopsTheRobotWhenItsSecondAnswerIsTruncatedToo) {
  Rig rig;
  rig.connect();
  rig.upstream = [&](Bytes b) {
    if (b.size() > 3) b.resize(b.size() - 3);
    return b;
  };
  rig.request(driving(500, 500));
  rig.run(250 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Suspect);
  EXPECT_EQ(rig.robot.left, 0);
  rig.upstream = [](Bytes b) { return b; };
  rig.run(300 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.statistics().resynchronised, 1U);
  EXPECT_EQ(rig.robot.left, 0);  // stands until it is asked anew
}

/// A robot whose answers are held back, and come in the order of the questions.
struct LateRig : Rig {
  std::deque<Bytes> held;
  bool hold = true;
  LateRig() {
    connect();
    request(driving(500, 500));
    run(10 * kMs);
    upstream = [this](Bytes b) {
      if (hold && !b.empty()) held.push_back(b);
      return hold ? Bytes{} : b;
    };
  }
  void release() {
    const Bytes bytes = held.front();
    held.pop_front();
    hear(bytes);
  }
  hal::TimeNs taken() const { return session.samples().taken_ns[static_cast<std::size_t>(Quantity::Proximity)]; }
  void expect_undisturbed() {
    EXPECT_EQ(session.state(), SessionState::Active) << session.trouble();
    EXPECT_EQ(session.epoch(), 1U);
    EXPECT_EQ(robot.left, 500);
    EXPECT_EQ(session.statistics().unasked_bytes, 0U);
  }
  /// Answers come in time again.
  void expect_in_step() {
    hold = false;
    for (int i = 1; i <= 5; ++i) {
      robot.proximity[0] = 1000 + i;
      robot.encoders[0] += 5;
      request(driving(500, 500));
      run(20 * kMs);
      EXPECT_EQ(session.samples().raw.proximity[0], 1000 + i) << "not the answer to an older question";
      EXPECT_GE(taken(), now - 20 * kMs);
    }
    expect_undisturbed();
  }
};

TEST(EpuckSession, GoesOnWhenTheFirstAnswerIsLateAndTheSecondFollows) {
  LateRig rig;
  rig.robot.proximity[0] = 11;
  rig.request(driving(500, 500));
  rig.run(140 * kMs);
  ASSERT_EQ(rig.held.size(), 2U) << "it was asked again";
  rig.release();
  rig.run(3 * kMs);
  rig.release();
  rig.run(5 * kMs);
  EXPECT_EQ(rig.session.statistics().overdue, 1U);
  EXPECT_EQ(rig.session.samples().raw.proximity[0], 11);
  EXPECT_TRUE(rig.session.idle());
  rig.expect_in_step();
}

TEST(EpuckSession, TakesTheFirstAnswerOldAsItIsWhenTheSecondIsLost) {
  LateRig rig;
  rig.robot.proximity[0] = 11;
  const hal::TimeNs asked = rig.now;
  rig.request(driving(500, 500));
  rig.run(140 * kMs);
  ASSERT_EQ(rig.held.size(), 2U);
  rig.release();
  rig.held.clear();
  rig.hold = false;
  rig.run(110 * kMs);
  EXPECT_EQ(rig.session.samples().raw.proximity[0], 11);
  EXPECT_EQ(rig.taken(), asked) << "nobody knows when after that it was measured";
  rig.run(60 * kMs);
  EXPECT_GT(rig.taken(), asked) << "and it was asked again";
  rig.expect_in_step();
}

TEST(EpuckSession, GoesOnWhenBothAnswersAreLateAndTellsTheSecondFromThatOfTheNextQuestion) {
  LateRig rig;
  rig.robot.proximity[0] = 11;
  rig.request(driving(500, 500));
  rig.run(150 * kMs);
  rig.robot.proximity[0] = 33;
  rig.run(50 * kMs);
  rig.release();
  rig.run(60 * kMs);
  ASSERT_EQ(rig.session.statistics().asked_again, 2U) << "the second one is overdue as well";
  ASSERT_EQ(rig.held.size(), 2U) << "asked for the third time";
  rig.release();
  rig.run(5 * kMs);
  EXPECT_EQ(rig.session.samples().raw.proximity[0], 11);
  rig.release();
  EXPECT_EQ(rig.session.samples().raw.proximity[0], 33) << "of the third question";
  EXPECT_GE(rig.taken(), rig.now - 20 * kMs);
  EXPECT_EQ(rig.session.statistics().overdue, 2U);
  rig.expect_in_step();
}

/// However slow the robot is, no reading is younger than its question, and none is taken for another's.
TEST(EpuckSession, DrivesARobotThatIsAlwaysLate) {
  for (const hal::TimeNs late : {60 * kMs, 110 * kMs, 130 * kMs, 160 * kMs, 190 * kMs, 220 * kMs}) {
    LateRig rig;
    std::deque<std::pair<hal::TimeNs, Bytes>> under_way;
    rig.upstream = [&](Bytes b) {
      if (!b.empty()) under_way.emplace_back(rig.now + late, b);
      return Bytes{};
    };
    hal::TimeNs oldest = 0;
    for (int ms = 0; ms < 3000; ++ms) {
      rig.robot.proximity[0] = ms;  // the robot tells the time
      const hal::TimeNs measured = rig.now;
      if (ms % 20 == 0) rig.request(driving(500, 500));
      rig.run(kMs);
      while (!under_way.empty() && under_way.front().first <= rig.now) {
        const Bytes bytes = under_way.front().second;
        under_way.pop_front();
        rig.hear(bytes);
      }
      if (ms < 300) continue;
      const hal::TimeNs truth = measured - (ms - rig.session.samples().raw.proximity[0]) * kMs;
      ASSERT_LE(rig.taken(), truth + late / 2 + 2 * kMs) << late / kMs << " ms late, " << ms;
      oldest = std::max(oldest, rig.now - rig.taken());
    }
    EXPECT_LE(oldest, 600 * kMs) << late / kMs;
    rig.expect_undisturbed();
  }
}

TEST(EpuckSession, GoesOnWhenTheRestOfAnAnswerIsLate) {
  LateRig rig;
  rig.request(driving(500, 500));
  const Bytes whole = rig.held.front();
  rig.held.clear();
  const auto half = whole.begin() + 9;
  rig.hear(Bytes(whole.begin(), half));
  rig.run(150 * kMs);
  ASSERT_EQ(rig.held.size(), 1U);
  rig.hear(Bytes(half, whole.end()));
  rig.release();
  rig.expect_in_step();
}

TEST(EpuckSession, DatesAnAnswerThatComesBeforeItIsAskedForAgainWithItsQuestion) {
  LateRig rig;
  const hal::TimeNs asked = rig.now;
  rig.request(driving(500, 500));
  rig.run(115 * kMs);
  ASSERT_EQ(rig.held.size(), 1U);
  rig.release();
  EXPECT_EQ(rig.taken(), asked);
  EXPECT_TRUE(rig.session.idle());
  rig.expect_in_step();
}

TEST(EpuckSession, DoesNotTakeWheelsForFasterBecauseAnAnswerWasLate) {
  LateRig rig;
  rig.request(driving(500, 500));
  rig.run(140 * kMs);
  rig.held[0][0] = 60;  // measured 120 ms after the question, at 500 a second
  rig.held.pop_back();
  rig.release();
  rig.run(100 * kMs);
  EXPECT_EQ(rig.session.samples().left_steps, 60);
  EXPECT_LE(rig.session.samples().left_steps_per_s, 500.0);
  rig.expect_undisturbed();
}

TEST(EpuckSession, StopsARobotWhoseLateAnswersAreNotWhatWasAskedFor) {
  const auto shortened = [](Bytes& first, Bytes&) { first.pop_back(); };
  const auto lengthened = [](Bytes& first, Bytes&) { first.push_back(7); };
  const auto doubled = [](Bytes& first, Bytes&) { first.insert(first.end(), first.begin(), first.end()); };
  const auto second_doubled = [](Bytes&, Bytes& second) { second.insert(second.end(), second.begin(), second.end()); };
  const auto second_cut = [](Bytes& first, Bytes& second) {
    first.clear();
    second.pop_back();
  };
  const auto other_speeds = [](Bytes&, Bytes& second) { second[second.size() - 1] ^= 1; };
  const auto other_speeds_alone = [](Bytes& first, Bytes& second) {
    second.clear();
    first[first.size() - 2] ^= 1;
  };
  const auto counters = [](Bytes&, Bytes& second) { second[5] ^= 0x40; };
  const auto impossible = [](Bytes& first, Bytes&) { first[4 + 1] = 0x70; };
  const std::vector<std::function<void(Bytes&, Bytes&)>> faults = {shortened,          lengthened, doubled,
                                                                   second_doubled,     second_cut, other_speeds,
                                                                   other_speeds_alone, counters,   impossible};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    LateRig rig;
    rig.robot.proximity = {10, 20, 30, 40, 50, 60, 70, 80};
    rig.robot.encoders = {300, 290};
    rig.request(driving(500, 500));
    rig.run(140 * kMs);
    ASSERT_EQ(rig.held.size(), 2U);
    faults[i](rig.held[0], rig.held[1]);
    rig.release();
    rig.release();
    rig.run(150 * kMs);
    EXPECT_NE(rig.session.state(), SessionState::Active) << i;
    EXPECT_EQ(rig.robot.left, 0) << i;
    rig.hold = false;
    rig.run(600 * kMs);
    EXPECT_EQ(rig.session.state(), SessionState::Active) << i;
    EXPECT_EQ(rig.robot.left, 0) << i;
  }
}

TEST(EpuckSession, WaitsLongerForTheSecondAnswerOnlyWhenTheMachineIsSlow) {
  LateRig rig;
  rig.session.be_patient(200 * kMs);
  rig.request(driving(500, 500));
  rig.run(400 * kMs);
  rig.expect_undisturbed();
  EXPECT_EQ(rig.session.statistics().asked_again, 1U) << "the first one is asked for again at once";
  rig.run(40 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Suspect);
  EXPECT_EQ(rig.robot.left, 0);
}

TEST(EpuckSession, WaitsLongerWhenItsCallerWasStalled) {
  Rig rig;
  rig.connect();
  rig.upstream = [](Bytes) { return Bytes{}; };
  rig.request(driving(500, 500));
  rig.now += 300 * kMs;
  rig.session.stalled(280 * kMs);
  rig.session.poll(rig.now);
  EXPECT_EQ(rig.session.statistics().silent, 0U);
  rig.now += 100 * kMs;
  rig.session.poll(rig.now);
  EXPECT_EQ(rig.session.statistics().silent, 1U);
}

TEST(EpuckSession, LosesStepOnBytesThatItDidNotAskFor) {
  Rig rig;
  rig.connect();
  rig.upstream = [](Bytes b) {
    b.push_back(0x42);
    return b;
  };
  rig.session.request({}, kProximity, rig.now);
  const Bytes out(rig.session.output().bytes().begin(), rig.session.output().bytes().end());
  rig.session.clear_output();
  rig.session.on_bytes(rig.upstream(rig.robot.hear(out)), rig.now);
  EXPECT_EQ(rig.session.state(), SessionState::Suspect);
  EXPECT_EQ(rig.session.statistics().unasked_bytes, 1U);
  rig.upstream = [](Bytes b) { return b; };
  rig.run(300 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
}

TEST(EpuckSession, LosesStepOnValuesThatCannotBe) {
  Rig rig;
  rig.connect();
  rig.upstream = [&](Bytes b) {
    b[4 + 2 * 3 + 1] = 0x70;
    rig.upstream = [](Bytes later) { return later; };
    return b;
  };
  rig.robot.proximity[3] = 50;
  rig.session.request({}, kProximity, rig.now);
  rig.flush();
  rig.run(200 * kMs);
  EXPECT_EQ(rig.session.statistics().implausible, 1U);
  EXPECT_EQ(rig.session.statistics().resynchronised, 1U);
  rig.request({});
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.samples().raw.proximity[3], 50);
}

TEST(EpuckSession, RestsWhenARobotShakesHandsWellButAnswersOddlyForEver) {
  Rig rig;
  rig.connect();
  rig.robot.proximity[3] = 5000;
  rig.request({});
  rig.run(5000 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Lost);
  EXPECT_LT(rig.session.statistics().implausible, 25U);
  rig.robot.proximity[3] = 50;
  rig.run(2000 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
}

TEST(EpuckSession, LearnsTheLengthsAnewWhenAnswersStayOdd) {
  Rig rig;
  rig.connect();
  rig.robot.ground_bytes = 10;  // another robot, or another board, behind the same link
  for (int tick = 0; tick < 10; ++tick) {
    rig.request({}, {Quantity::Ground});
    rig.run(200 * kMs);
  }
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.layout().ground_bytes, 10);
  EXPECT_EQ(rig.session.samples().raw.ground[0], 1023);
}

TEST(EpuckSession, IsSuspectThenLostWhenTheRobotIsSilentAndComesBackByItself) {
  Rig rig;
  rig.connect();
  rig.request(driving(500, 500));
  rig.robot.silent = true;
  rig.request(driving(500, 500));
  rig.run(260 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Suspect);
  EXPECT_EQ(rig.session.statistics().silent, 2U);
  EXPECT_EQ(rig.robot.left, 0);  // it hears, so it was stopped
  rig.run(4000 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Lost);
  EXPECT_STREQ(rig.session.trouble(), "no answer");
  EXPECT_GE(rig.session.statistics().handshake_failures, 3U);
  rig.robot.silent = false;
  rig.run(400 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.statistics().resynchronised, 1U);
}

TEST(EpuckSession, GivesUpOnGarbageOfAWrongBaudRateButKeepsTrying) {
  Rig rig;
  std::uint32_t noise = 1;
  rig.upstream = [&](Bytes b) {
    for (auto& byte : b) byte = static_cast<std::uint8_t>(noise = noise * 1664525U + 1013904223U);
    return b;
  };
  rig.connect();
  rig.run(5000 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Lost);
  EXPECT_STREQ(rig.session.trouble(), "no e-puck answers");
  rig.upstream = [](Bytes b) { return b; };
  rig.run(2500 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
}

TEST(EpuckSession, ShakesHandsAgainWhenTheRobotWasRestarted) {
  Rig rig;
  rig.connect();
  rig.robot.encoders = {100, 90};
  rig.request(driving(500, 500));
  EXPECT_EQ(rig.session.samples().left_steps, 100);
  const auto epoch = rig.session.epoch();
  rig.hear(rig.robot.restart());
  EXPECT_NE(rig.session.state(), SessionState::Active);
  rig.run(400 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.statistics().restarts, 1U);
  EXPECT_EQ(rig.session.epoch(), epoch + 1);
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_EQ(rig.session.samples().left_steps, 100);  // the counters fell to 0, the way rolled did not
  rig.robot.encoders = {7, 5};
  rig.request({});
  EXPECT_EQ(rig.session.samples().left_steps, 107);
  EXPECT_EQ(rig.session.samples().right_steps, 95);
}

TEST(EpuckSession, NoticesARestartInTheMiddleOfAnAnswer) {
  Rig rig;
  rig.connect();
  rig.upstream = [&](Bytes b) {
    b.resize(5);
    const Bytes greeting = rig.robot.restart();
    b.insert(b.end(), greeting.begin(), greeting.end());
    rig.upstream = [](Bytes later) { return later; };
    return b;
  };
  rig.request({});
  rig.run(400 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.statistics().restarts, 1U);
}

TEST(EpuckSession, CountsAcrossTheWrapOfTheWheelCounters) {
  Rig rig;
  rig.robot.encoders = {32700, -32700};
  rig.connect();
  EXPECT_EQ(rig.session.samples().left_steps, 0);
  for (int tick = 1; tick <= 20; ++tick) {
    rig.run(100 * kMs);
    rig.robot.encoders = {static_cast<std::int16_t>(32700 + tick * 100),
                          static_cast<std::int16_t>(-32700 - tick * 100)};
    rig.request({});
  }
  EXPECT_EQ(rig.session.samples().left_steps, 2000);
  EXPECT_EQ(rig.session.samples().right_steps, -2000);
  EXPECT_NEAR(rig.session.samples().left_steps_per_s, 1000.0, 1.0);
  EXPECT_EQ(rig.session.statistics().encoder_rebased, 0U);
}

TEST(EpuckSession, DoesNotBelieveACounterThatJumps) {
  Rig rig;
  rig.connect();
  rig.run(100 * kMs);
  rig.upstream = [&](Bytes b) {
    b[1] ^= 0x40;  // a flipped bit: 16384 steps
    rig.upstream = [](Bytes later) { return later; };
    return b;
  };
  rig.request({});
  rig.run(300 * kMs);
  rig.request({});
  EXPECT_EQ(rig.session.statistics().encoder_jumps, 1U);
  EXPECT_EQ(rig.session.samples().left_steps, 0);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
}

TEST(EpuckSession, TakesTheCountersUpAnewAfterALongLoss) {
  Rig rig;
  rig.connect();
  rig.session.link_down(rig.now);
  EXPECT_EQ(rig.session.state(), SessionState::Lost);
  rig.run(30000 * kMs);
  rig.robot.encoders = {30000, 30000};
  rig.connect();
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_EQ(rig.session.samples().left_steps, 0);
  EXPECT_EQ(rig.session.statistics().encoder_rebased, 1U);
  EXPECT_EQ(rig.session.statistics().restarts, 0U) << "it may have rolled so far, or on and on";
  EXPECT_EQ(rig.session.statistics().links_lost, 1U);
}

TEST(EpuckSession, CountersThatNoWheelCanHaveReachedTellThatItRestartedOrIsAnotherRobot) {
  for (const auto counter : std::initializer_list<std::int16_t>{0, 6000, -9000}) {
    Rig rig;
    rig.robot.encoders = {20000, 20000};
    rig.connect();
    rig.request(driving(500, 500));
    rig.session.link_down(rig.now);
    rig.run(1000 * kMs);
    rig.robot.encoders = {counter, counter};
    rig.connect();
    EXPECT_EQ(rig.session.statistics().restarts, 1U) << counter;
    EXPECT_EQ(rig.session.statistics().encoder_rebased, 1U);
  }
}

TEST(EpuckSession, KeepsWhatWasRolledDuringAShortLoss) {
  Rig rig;
  rig.connect();
  rig.request(driving(500, 500));
  rig.session.link_down(rig.now);
  rig.run(1000 * kMs);
  rig.robot.encoders = {500, 500};
  rig.connect();
  EXPECT_EQ(rig.session.samples().left_steps, 500);
  EXPECT_EQ(rig.robot.left, 0);
}

TEST(EpuckSession, ForgetsTheSpeedsThatWereWantedBeforeALoss) {
  Rig rig;
  rig.connect();
  rig.request(driving(500, 500));
  rig.session.link_down(rig.now);
  rig.request(driving(600, 600));  // nobody hears it
  rig.robot.speeds.clear();
  rig.connect();
  for (const auto& [left, right] : rig.robot.speeds) {
    EXPECT_EQ(left, 0);
    EXPECT_EQ(right, 0);
  }
}

TEST(EpuckSession, StopsAlsoWhileAnAnswerIsAwaited) {
  Rig rig;
  rig.connect();
  rig.request(driving(500, 500));
  rig.run(20 * kMs);
  Bytes held;
  rig.upstream = [&](Bytes b) {
    held.insert(held.end(), b.begin(), b.end());
    return Bytes{};
  };
  rig.request(driving(600, 600));
  EXPECT_EQ(rig.robot.left, 600);
  rig.session.stop(rig.now);
  rig.session.stop(rig.now);
  rig.flush();
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_FALSE(rig.session.idle());
  EXPECT_FALSE(rig.session.at_rest());
  rig.upstream = [](Bytes b) { return b; };
  rig.hear(held);
  rig.run(150 * kMs);
  EXPECT_TRUE(rig.session.idle());
  EXPECT_TRUE(rig.session.at_rest());
  EXPECT_EQ(rig.session.statistics().stops, 1U);
  EXPECT_EQ(rig.session.statistics().stops_confirmed, 1U);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  rig.request(driving(100, 100));
  EXPECT_EQ(rig.robot.left, 100);
  EXPECT_FALSE(rig.session.at_rest());
}

TEST(EpuckSession, IsAtRestOnlyWhenWhatItWasToldSinceHasNotMovedIt) {
  Rig rig;
  rig.connect();
  rig.session.stop(rig.now);
  rig.run(300 * kMs);
  ASSERT_TRUE(rig.session.at_rest());
  rig.downstream = [](Bytes b) {
    if (!b.empty() && b[0] == 0xB4) b[0] = 0xBC;  // "lamp" becomes "speeds"
    return b;
  };
  rig.upstream = [](Bytes) { return Bytes{}; };
  Actuation lit;
  lit.ring[0] = {255, 0, 0};
  rig.request(lit);
  EXPECT_NE(rig.robot.left, 0);
  EXPECT_FALSE(rig.session.at_rest());
  rig.upstream = rig.downstream = [](Bytes b) { return b; };
  rig.run(500 * kMs);
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_TRUE(rig.session.at_rest());
  rig.request(lit);
  EXPECT_TRUE(rig.session.at_rest());  // the answer said so
  lit.ring[0] = {0, 0, 0};
  rig.upstream = [](Bytes) { return Bytes{}; };
  rig.request(lit);
  EXPECT_FALSE(rig.session.at_rest());  // nothing has said so yet
}

TEST(EpuckSession, IsNotAtRestWhileAStopThatMayBeDamagedIsUnderWay) {
  for (const bool ending : {false, true}) {
    Rig rig;
    rig.connect();
    ASSERT_TRUE(rig.session.at_rest());
    rig.downstream = [](Bytes b) {
      if (b[0] == 0xBC) b.insert(b.begin(), 0xBC);  // doubled: the second one is a speed
      return b;
    };
    if (ending)
      rig.session.shut_down(rig.now);
    else
      rig.hear({0});  // nobody asked for it
    bool moved = false;
    for (int i = 0; i < 30; ++i) {
      rig.run(kMs);
      moved = moved || rig.robot.left == 0xBC;
      EXPECT_FALSE(rig.session.at_rest());
    }
    EXPECT_TRUE(moved);
    rig.downstream = [](Bytes b) { return b; };
    rig.run(500 * kMs);
    EXPECT_EQ(rig.robot.left, 0);
    EXPECT_TRUE(rig.session.at_rest());
  }
}

TEST(EpuckSession, DoesNotTakeAStopForConfirmedWhileTheWheelsTurn) {
  Rig rig;
  rig.connect();
  rig.request(driving(500, 500));
  rig.session.stop(rig.now);
  for (int i = 0; i < 20; ++i) {
    rig.robot.encoders[0] += 5;  // somebody else drives it
    rig.run(20 * kMs);
    EXPECT_FALSE(rig.session.at_rest());
  }
  rig.run(300 * kMs);
  EXPECT_TRUE(rig.session.at_rest());
}

TEST(EpuckSession, ShutsDownInTheMiddleOfAHandshakeUntilItIsConfirmed) {
  Rig rig;
  rig.robot.silent = true;
  rig.robot.left = 500;
  rig.downstream = [](Bytes) { return Bytes{0xBC, 0x10}; };  // only part of it arrives
  rig.session.link_up(rig.now);
  rig.flush();
  rig.downstream = [](Bytes b) { return b; };
  rig.session.shut_down(rig.now);
  rig.run(50 * kMs);
  EXPECT_EQ(rig.robot.left, 0);
  EXPECT_EQ(rig.robot.right, 0);
  EXPECT_FALSE(rig.session.idle());
  rig.robot.silent = false;
  rig.run(300 * kMs);
  EXPECT_TRUE(rig.session.idle());
  EXPECT_TRUE(rig.session.at_rest());
}

TEST(EpuckSession, LosesALostStopConfirmationAndStopsAgain) {
  Rig rig;
  rig.connect();
  rig.request(driving(500, 500));
  rig.upstream = [](Bytes) { return Bytes{}; };
  rig.session.stop(rig.now);
  rig.run(150 * kMs);
  rig.upstream = [](Bytes b) { return b; };
  const int before = rig.robot.stops;
  rig.run(300 * kMs);
  EXPECT_EQ(rig.session.state(), SessionState::Active);
  EXPECT_GT(rig.robot.stops, before);
}

/// Everything that a robot says in a conversation, fed in any pieces, gives the same session.
RC_GTEST_PROP(EpuckSessionProperty, DecodesTheSameHoweverTheStreamIsCut,
              (std::vector<std::uint8_t> cuts, bool restart)) {
  const auto talk = [&](bool in_pieces) {
    Session session;
    ScriptedRobot robot;
    robot.encoders = {1234, -321};
    robot.proximity = {1, 2, 3, 4, 5, 6, 7, 8};
    hal::TimeNs now = 0;
    std::size_t cut = 0;
    const auto feed = [&](const Bytes& bytes) {
      for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t n = in_pieces && !cuts.empty() ? 1 + cuts[cut++ % cuts.size()] % 9 : bytes.size();
        const std::size_t size = std::min(n, bytes.size() - at);
        session.on_bytes(std::span(bytes).subspan(at, size), now);
        at += size;
      }
    };
    session.link_up(now);
    for (int step = 0; step < 500; ++step) {
      now += kMs;
      session.poll(now);
      if (step == 300) session.request(driving(10, 20), kProximity, now);
      if (step == 350 && restart) feed(robot.restart());
      while (!session.output().empty()) {
        const Bytes out(session.output().bytes().begin(), session.output().bytes().end());
        session.clear_output();
        feed(robot.hear(out));
      }
    }
    return std::tuple(session.state(), session.samples().raw, session.samples().left_steps,
                      session.statistics().answers, session.epoch(), robot.left, robot.packets);
  };
  RC_ASSERT(talk(true) == talk(false));
}

/// Whatever comes in, the session stays sane and comes back when the robot does.
RC_GTEST_PROP(EpuckSessionProperty, RecoversFromAnyNoise, (const std::vector<Bytes>& noise)) {
  Rig rig;
  rig.connect();
  for (const Bytes& bytes : noise) {
    rig.request(driving(100, 100));
    rig.hear(bytes);
    rig.run(5 * kMs);
  }
  rig.run(8000 * kMs);
  rig.request({});
  RC_ASSERT(rig.session.state() == SessionState::Active);
  RC_ASSERT(rig.largest_output <= Packet::kCapacity);
}

}  // namespace
}  // namespace tandem::bridges::epuck
