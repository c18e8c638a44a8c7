// The whole robot on its bus: hand-written frames in, frames out.
#include "bridges/footbot_emulator/footbot.hpp"

#include "tests/bridges/footbot_emulator/bench.hpp"
#include "tests/bridges/footbot_emulator/held_body.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr Footbot::Options kV5 = {.protocol = Protocol::V5};
constexpr int kSpeed = 34;  // address of the first own variable of every module

TEST(Footbot, HasNineModules) {
  Bench bench(kV5);
  EXPECT_THAT(bench.ask("300#11A00500"),
              UnorderedElementsAre("301#0C900500", "302#0C900500", "303#0C900500", "304#0C900500", "305#0C900500",
                                   "306#0C900500", "307#0C900500", "308#0C900500", "309#0C900500"));
  std::vector<std::string> names;
  for (const Message& m : bench.ask_messages("300#00A00400")) {
    if (m.type == type::kDescription) names.emplace_back(m.payload.begin() + 1, m.payload.begin() + 1 + m.payload[0]);
  }
  EXPECT_THAT(names, UnorderedElementsAre("left motor", "right motor", "proximity sensors", "distance sensors",
                                          "turret", "gripper", "leds", "range and bearing", "base"));
}

TEST(Footbot, OfTheOldKindAnswersToTheOldQuestionOnly) {
  Bench bench;
  EXPECT_THAT(bench.ask("300#11A00500"), IsEmpty());
  EXPECT_THAT(bench.ask("300#10A001000500"), IsEmpty());
  EXPECT_FALSE(bench.ask("300#00A00500").empty());
}

TEST(Footbot, AnswersAsOnTheWire) {
  Bench bench;
  EXPECT_THAT(bench.ask("300#0BA0010000000400"), ElementsAre("101#0590000001000000", "201#00000000"));
  EXPECT_THAT(bench.ask("300#0CA0010022001E00"), IsEmpty());
  EXPECT_THAT(bench.ask("300#0BA0010022000100"), ElementsAre("301#059022001E00"));
  EXPECT_THAT(bench.ask("300#0BA0090000000600"), testing::SizeIs(2));
  EXPECT_THAT(bench.ask("300#0BA0630000000600"), IsEmpty());  // nobody has this number
}

TEST(Footbot, AnswersAfterAWhile) {
  Bench bench;
  bench.say("300#0BA0010022000100");
  bench.pass(kMs / 2);
  EXPECT_THAT(bench.heard(), IsEmpty());
  bench.pass(kMs / 2);
  EXPECT_THAT(bench.heard(), testing::SizeIs(1));
}

TEST(Footbot, DrivesUntilItIsToldOtherwise) {
  Bench bench;
  bench.say("300#0CA0010022000000");
  EXPECT_FALSE(bench.robot.first_driven_at());
  bench.say("300#0CA0010022000A00");
  const auto driven_at = bench.robot.first_driven_at();
  EXPECT_EQ(driven_at, bench.now);
  bench.say("300#0CA0020022000A00");
  EXPECT_EQ(bench.robot.first_driven_at(), driven_at);
  EXPECT_EQ(bench.logged(R"("event":"wheels","left":10,"right":10,"by":"host","changed":true)"), 1);
  EXPECT_EQ(bench.robot.wheels_commanded_at(), bench.now);
  bench.pass(60'000 * kMs);  // nothing stops it
  // 10 pulses in 5 ms for 60 s, 483.12 of them a centimetre.
  EXPECT_NEAR(bench.body.pose().x_m, 120'000 / 48312.0, 1e-9);
  EXPECT_NEAR(bench.body.pose().y_m, 0.0, 1e-9);
  const auto odo = bench.read(1, 35, 2);
  EXPECT_EQ((odo[1] << 16) + (odo[0] & 0xFFFF), 120'000);
  bench.say("300#0CA0010022000000");
  bench.say("300#0CA0020022000000");
  const BodyPose stopped = bench.body.pose();
  bench.pass(1000 * kMs);
  EXPECT_EQ(bench.body.pose().x_m, stopped.x_m);
}

TEST(Footbot, KeepsToItsSpeedLimit) {
  Bench bench;
  bench.say("300#0CA001002200E803");  // 1000
  EXPECT_NEAR(bench.robot.command().left_m_s, 72 / (48312 * 0.005), 1e-12);
  EXPECT_THAT(bench.read(1, kSpeed, 1), ElementsAre(1000));
  bench.say("300#0CA0010022000080");  // -32768
  EXPECT_NEAR(bench.robot.command().left_m_s, -72 / (48312 * 0.005), 1e-12);
}

TEST(Footbot, CountsPulsesBackwards) {
  Bench bench;
  bench.say("300#0CA001002200FFFF");
  bench.pass(1003 * kMs);
  const auto odo = bench.read(1, 35, 2);
  EXPECT_EQ((odo[1] << 16) + (odo[0] & 0xFFFF), -201);
}

TEST(Footbot, SeesWalls) {
  Bench bench({}, Arena{1.0, 1.0});
  bench.say("300#0CA0010022004800");  // full speed ahead, until the wall stops it
  bench.say("300#0CA0020022004800");
  bench.pass(5000 * kMs);
  const auto near = bench.read(3, 34, 24);
  EXPECT_GT(near[0], 3900);  // the two sensors beside the front touch
  EXPECT_GT(near[23], 3900);
  EXPECT_EQ(near[12], 0);
  EXPECT_THAT(bench.read(3, 58, 12),
              ElementsAre(4096, 4096, 4096, 4096, 4096, 4096, 4096, 4096, 1024, 1024, 1024, 1024));
  EXPECT_EQ(bench.read(3, 70, 24), std::vector<int>(24, 2048));
}

TEST(Footbot, ScansWhereItIsToldTo) {
  Bench bench({}, Arena{2.0, 1.0});
  EXPECT_THAT(bench.read(4, 34, 5), ElementsAre(-2, -2, -2, -2, 0));
  bench.say("100#0CA0040027000200");  // mode 2 at 39,
  bench.say("200#00000040");          // speed 0, target 16384: to the left
  bench.pass(2000 * kMs);
  // Short heads look left and right, 50 cm to the walls: nothing. Long ones back and front, 100 cm.
  EXPECT_THAT(bench.read(4, 34, 5), ElementsAre(-2, 100, -2, 100, 16384));
}

TEST(Footbot, TurnsItsTurret) {
  Bench bench;
  bench.say("100#0CA0050022000200");  // mode 2,
  bench.say("200#0400");              // speed 4: a quarter turn a second
  bench.pass(1000 * kMs);
  EXPECT_NEAR(bench.read(5, 37, 1).at(0), 16384 * 1.0, 16384 * 0.02);
  bench.say("300#0CA0050022000000");  // off
  const auto there = bench.read(5, 37, 1);
  bench.pass(1000 * kMs);
  EXPECT_EQ(bench.read(5, 37, 1), there);
}

TEST(Footbot, TriesItsGripAndTurnsNothingMeanwhile) {
  Bench bench;
  bench.say("300#0CA0060022000040");  // 90 degrees
  bench.pass(100 * kMs);
  bench.say("300#0CA0050022000200");
  bench.say("300#0CA0050023000400");
  bench.pass(600 * kMs);
  EXPECT_THAT(bench.read(6, 35, 2), ElementsAre(16384, 1));
  EXPECT_THAT(bench.read(5, 37, 1), ElementsAre(0));
  bench.pass(1000 * kMs);
  EXPECT_THAT(bench.read(6, 36, 1), ElementsAre(0));
  EXPECT_THAT(bench.read(6, 35, 1), ElementsAre(0)) << "there was nothing to hold";
  EXPECT_GT(bench.read(5, 37, 1).at(0), 1000);
}

TEST(Footbot, LightsItsLeds) {
  Bench bench;
  bench.say("300#0CA007002300FF00");  // red of LED 1
  bench.say("100#0CA0070046000100");  // beacon 1, 2, 300
  bench.say("200#02002C01");
  const auto& rgb = bench.robot.command().rgb;
  EXPECT_EQ(rgb[3], 255);
  EXPECT_EQ(rgb[36], 1);
  EXPECT_EQ(rgb[37], 2);
  EXPECT_EQ(rgb[38], 255);
  EXPECT_EQ(bench.logged(R"("event":"leds")"), 2);
}

TEST(Footbot, SpeaksAndHearsByRadio) {
  Bench bench;
  EXPECT_FALSE(bench.robot.command().radio_sends);
  bench.say("300#0CA0080022000201");
  EXPECT_TRUE(bench.robot.command().radio_sends);
  EXPECT_EQ(bench.robot.command().radio[0], 2);
  EXPECT_EQ(bench.robot.command().radio[1], 1);
  bench.say("300#0CA0080022000000");
  EXPECT_FALSE(bench.robot.command().radio_sends);

  bench.body.heard.push_back({1.234, -M_PI / 2, 0.0, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}});
  bench.pass(20 * kMs);
  EXPECT_THAT(bench.heard(), ElementsAre("108#0000D20400C00000", "008#0102030405060708", "208#090A"));
}

TEST(Footbot, TellsItsState) {
  Bench bench;
  bench.body.surroundings.battery_V = 3.777;
  bench.say("300#0CA0010022000A00");
  // 10 pulses a period on the left wheel alone: to the right by 16.94 degrees a second.
  EXPECT_THAT(bench.read(9, 34, 5), ElementsAre(3777, 0, 0, 1000, -169));
}

TEST(Footbot, ForgetsEverythingWhenAModuleRestarts) {
  Bench bench;
  bench.say("300#0CA0010022000A00");
  bench.say("300#0CA0020022000A00");
  bench.pass(1000 * kMs);
  bench.robot.restart(Place::LeftMotor, bench.now, "test");
  EXPECT_EQ(bench.logged(R"("left":0,"right":10,"by":"test","changed":true)"), 1);
  EXPECT_EQ(bench.robot.command().left_m_s, 0.0);
  bench.say("300#0CA0010022000A00");  // while it boots
  EXPECT_THAT(bench.read(1, kSpeed, 3), IsEmpty());
  bench.pass(200 * kMs);
  EXPECT_THAT(bench.read(1, kSpeed, 3), ElementsAre(0, 0, 0));
  EXPECT_THAT(bench.read(2, kSpeed, 1), ElementsAre(10));
  EXPECT_EQ(bench.logged(R"("event":"boot","module":"left motor")"), 2);
}

TEST(Footbot, RestartsAModuleThatIsToldTo) {
  Bench bench;
  bench.say("300#0CA0010022000A00");
  bench.say("300#0EA00100");
  EXPECT_THAT(bench.read(1, kSpeed, 1), IsEmpty());
  bench.pass(200 * kMs);
  EXPECT_THAT(bench.read(1, kSpeed, 1), ElementsAre(0));
}

TEST(Footbot, MayLackAModule) {
  Bench bench(kV5);
  bench.robot.set_missing(Place::Gripper, true, bench.now);
  EXPECT_THAT(bench.ask("300#11A00500"), testing::SizeIs(8));
  bench.say("300#0CA0060022000040");
  EXPECT_THAT(bench.read(6, kSpeed, 1), IsEmpty());
  bench.robot.set_missing(Place::Gripper, false, bench.now);
  EXPECT_THAT(bench.ask("300#11A00500"), testing::SizeIs(9));
  EXPECT_THAT(bench.read(6, kSpeed, 1), ElementsAre(0));
}

TEST(Footbot, MayBeDeafOrSilent) {
  Bench bench;
  bench.robot.set_silent(Place::LeftMotor, true);
  bench.robot.set_deaf(Place::RightMotor, true);
  bench.say("300#0CA0010022000A00");
  bench.say("300#0CA0020022000A00");
  EXPECT_THAT(bench.read(1, kSpeed, 1), IsEmpty());
  EXPECT_THAT(bench.read(2, kSpeed, 1), IsEmpty());
  EXPECT_EQ(bench.logged(R"("event":"wheels")"), 1);
  bench.robot.set_silent(Place::LeftMotor, false);
  bench.robot.set_deaf(Place::RightMotor, false);
  EXPECT_THAT(bench.read(1, kSpeed, 1), ElementsAre(10));
  EXPECT_THAT(bench.read(2, kSpeed, 1), ElementsAre(0));
}

TEST(Footbot, ObeysNothingThatItDidNotUnderstand) {
  Bench bench;
  bench.say("100#0CA0010022000A00");  // never ended
  bench.say("400#0CA0010022000A00");
  bench.say("300#0C");
  bench.say("300#0CA00100");
  bench.pass(1000 * kMs);
  EXPECT_EQ(bench.logged(R"("event":"wheels")"), 0);
  EXPECT_EQ(bench.robot.command(), BodyCommand{});
}

TEST(Footbot, LogsEveryFrame) {
  Bench bench;
  bench.ask("300#0BA0010022000100");
  EXPECT_EQ(bench.logged(R"("event":"frame","way":"in","frame":"300#0BA0010022000100")"), 1);
  EXPECT_EQ(bench.logged(R"("event":"frame","way":"out","frame":"301#059022000000")"), 1);
  EXPECT_EQ(bench.logged(R"("event":"get","module":"left motor","start":34,"words":1)"), 1);
}

TEST(Footbot, MayLiveInABodyThatIsElsewhere) {
  HeldBody body;
  Footbot robot({}, body, {});
  robot.power_on(0);
  BodySenses senses;
  senses.distance_m[7] = 0.05;
  body.set_senses(senses, {{0.5, 0.0, 0.0, {42}}});
  robot.receive(frame("300#0CA001002200F6FF"), kMs);
  EXPECT_NEAR(body.command().left_m_s, -0.0413976, 1e-6);
  robot.receive(frame("300#0BA0030029000100"), 2 * kMs);
  robot.run_until(50 * kMs);
  std::vector<TimedFrame> sent;
  robot.take_sent(sent);
  std::vector<std::string> all;
  for (const TimedFrame& f : sent) all.push_back(to_text(f.frame));
  EXPECT_THAT(all, testing::Contains("303#059029000008"));
  EXPECT_THAT(all, testing::Contains("108#0000F40100000000"));
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
