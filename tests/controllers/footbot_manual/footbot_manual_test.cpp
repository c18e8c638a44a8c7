// Orders as text, and robots that obey them.
#include <gmock/gmock.h>

#include "controllers/footbot_manual/order.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/footbot_manual/operator.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

using controllers::Drive;
using controllers::Grip;
using controllers::Order;
using controllers::parse_order;
using controllers::TurretFree;
using controllers::TurretTo;
using controllers::TurretTurn;
using testing::HasSubstr;

TEST(Order, IsReadWithItsUnits) {
  const std::vector<std::pair<const char*, Order>> good = {
      {"drive 10 cm/s 0.5 rad/s", Drive{0.1, 0.5}},
      {"drive 0.1m/s -28.64788975654116deg/s", Drive{0.1, -0.5}},
      {"  drive\t-50 mm/s   0\r", Drive{-0.05, 0.0}},
      {"drive 0 0", Drive{}},
      {"drive 1e-1 m/s +.5 rad/s", Drive{0.1, 0.5}},
      {"stop", Drive{}},
      {"grip", Grip{true}},
      {"release", Grip{false}},
      {"turret 1.5 rad", TurretTo{1.5}},
      {"turret -90 deg", TurretTo{-0.5 * std::numbers::pi}},
      {"turret 0", TurretTo{0.0}},
      {"turret 0.4 rad/s", TurretTurn{0.4}},
      {"turret off", TurretFree{false}},
      {"turret passive", TurretFree{true}},
  };
  for (const auto& [line, order] : good) {
    const auto read = parse_order(line);
    ASSERT_TRUE(read.ok()) << line << ": " << read.error().message;
    EXPECT_TRUE(read.value() == order) << line;
  }
}

TEST(Order, ThatIsWrongIsAnsweredWithWhatWouldBeRight) {
  const std::vector<std::pair<const char*, const char*>> bad = {
      {"", "there are: drive"},
      {"   ", "there are: drive"},
      {"fly 1 m/s", "no order 'fly'; there are: drive"},
      {"drive", "takes a speed and a turn"},
      {"drive 10 cm/s", "takes a speed and a turn"},
      {"drive 10 cm/s 0 0", "takes a speed and a turn"},
      {"drive 10 0", "'10' has no unit; write '10 m/s'"},
      {"drive 0 1e3", "'1e3' has no unit; write '1e3 rad/s'"},
      {"drive 10 cm 0", "unit 'cm' does not fit; use one of: m/s, cm/s, mm/s"},
      {"drive fast 0", "'fast' is not a number"},
      {"drive 1e999 m/s 0", "is not a number"},
      {"drive 1e308 m/s 0", "is beyond all reason"},
      {"drive nan m/s 0", "is not a number"},
      {"stop now", "'stop' takes nothing after it"},
      {"turret", "takes an angle"},
      {"turret 3", "'3' has no unit; write '3 rad'"},
      {"turret 3 m", "unit 'm' does not fit"},
      {"turret 3 m/s", "unit 'm/s' does not fit"},
      {"turret asleep", "is not a number"},
      {"Drive 0 0", "no order 'Drive'"},
  };
  for (const auto& [line, answer] : bad) {
    const auto read = parse_order(line);
    ASSERT_FALSE(read.ok()) << line;
    EXPECT_THAT(read.error().message, HasSubstr(answer)) << line;
  }
}

const std::string kConfig = "footbot_manual.xml";

/// The two robots of the configuration, at ports of their own.
struct Driven {
  std::array<std::uint16_t, 2> ports = test::free_ports();
  test::Operator person;
  test::Experiment experiment;

  explicit Driven(std::vector<std::string> overrides = {}) : experiment(kConfig, with_ports(std::move(overrides))) {
    experiment->start();
  }
  std::vector<std::string> with_ports(std::vector<std::string> overrides) const {
    overrides.push_back("controllers.footbot_manual[hand].params.port=" + std::to_string(ports[0]));
    overrides.push_back("arena.foot-bot[fb1].controller.params.port=" + std::to_string(ports[1]));
    return overrides;
  }
  void say(const std::string& text, std::size_t robot = 0) const { person.say(ports.at(robot), text); }
  void steps(int n) const {
    for (int k = 0; k < n; ++k) experiment->step();
  }
  template <class Port>
  const Port& port(const std::string& id = "fb0") const {
    return *experiment->space().port<Port>(experiment->space().find_robot(id));
  }
};

TEST(Manual, DrivesAsItIsToldAndStopsWhenNobodySpeaksAnyMore) {
  const Driven d;
  d.steps(3);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, 0.0);
  d.say("drive 10 cm/s 0.5 rad/s");
  d.steps(1);
  EXPECT_NEAR(d.port<hal::WheelSpeeds>().left_m_s, 0.1 - 0.25 * hal::footbot::kind().drive()->wheel_base_m, 1e-12);
  EXPECT_NEAR(d.port<hal::WheelSpeeds>().right_m_s, 0.1 + 0.25 * hal::footbot::kind().drive()->wheel_base_m, 1e-12);
  EXPECT_EQ(d.port<hal::WheelSpeeds>("fb1").left_m_s, 0.0) << "the other one listens elsewhere";
  d.steps(4);  // the last 0.4 s after the order
  EXPECT_GT(d.port<hal::WheelSpeeds>().right_m_s, 0.1);
  d.steps(1);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, 0.0);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().right_m_s, 0.0);
  d.say("drive 0 1 rad/s", 1);
  d.steps(1);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().right_m_s, 0.0);
  EXPECT_GT(d.port<hal::WheelSpeeds>("fb1").right_m_s, 0.0);
}

TEST(Manual, DrivesOnAsLongAsTheOrderIsRepeated) {
  const Driven d;
  for (int k = 0; k < 20; ++k) {
    d.say("drive 10 cm/s 0");
    d.steps(3);
  }
  const core::Pose pose = d.experiment->space().pose(d.experiment->space().find_robot("fb0"));
  EXPECT_NEAR(pose.x_m, 0.1 * 0.1 * 59, 0.01);  // from the tick after the first order on
  EXPECT_NEAR(pose.y_m, 0.0, 1e-6);
}

TEST(Manual, ObeysSeveralOrdersInTheOrderOfTheirArrival) {
  const Driven d;
  d.say("drive 1 cm/s 0\ndrive 2 cm/s 0\n");
  d.say("turret 90 deg\ndrive 3 cm/s 0");
  d.steps(1);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, 0.03);
  EXPECT_EQ(d.port<hal::TurretDrive>().mode, hal::TurretMode::Position);
}

TEST(Manual, IsSlowerAlongTheSameArcWhereTheWheelsCannotFollow) {
  const Driven d;
  d.say("drive 3 m/s 10 rad/s");
  d.steps(1);
  const auto& wheels = d.port<hal::WheelSpeeds>();
  const double fastest_m_s = hal::footbot::kind().drive()->max_speed_m_s;
  EXPECT_NEAR(wheels.right_m_s, fastest_m_s, 1e-12);
  EXPECT_NEAR((wheels.right_m_s - wheels.left_m_s) / hal::footbot::kind().drive()->wheel_base_m * 2.0 /
                  (wheels.right_m_s + wheels.left_m_s),
              10.0 / 3.0, 1e-9);
}

TEST(Manual, GripsAndKeepsItsHoldWhenNobodySpeaks) {
  const Driven d;
  d.experiment->space().set_pose(d.experiment->space().find_robot("fb0"),
                                 core::Pose::at(0.7 - 0.06 - hal::footbot::kind().body.radius_m - 0.01, 0.0, 0.0));
  d.say("grip");
  d.steps(20);
  EXPECT_TRUE(d.experiment->space().holding(d.experiment->space().find_robot("fb0")));
  d.say("release");
  d.steps(2);
  EXPECT_FALSE(d.experiment->space().holding(d.experiment->space().find_robot("fb0")));
}

TEST(Manual, StopsATurretThatTurnsButNotOneThatLooksSomewhere) {
  const Driven d;
  d.say("turret 0.4 rad/s");
  d.steps(1);
  EXPECT_EQ(d.port<hal::TurretDrive>().speed_rad_s, 0.4);
  d.steps(10);
  EXPECT_EQ(d.port<hal::TurretDrive>().mode, hal::TurretMode::Off);
  d.say("turret 1 rad");
  d.steps(10);
  EXPECT_EQ(d.port<hal::TurretDrive>().mode, hal::TurretMode::Position);
  EXPECT_EQ(d.port<hal::TurretDrive>().angle_rad, 1.0);
  d.say("turret passive");
  d.steps(10);
  EXPECT_EQ(d.port<hal::TurretDrive>().mode, hal::TurretMode::Passive);
  d.say("turret off");
  d.steps(1);
  EXPECT_EQ(d.port<hal::TurretDrive>().mode, hal::TurretMode::Off);
}

TEST(Manual, AnswersWhatItCannotDoAndDrivesOnNotForThat) {
  const Driven d;
  d.say("drive 10 cm/s 0");
  d.steps(1);
  for (int k = 0; k < 6; ++k) {  // mistakes are no sign of life
    d.say("drive 10 0");
    d.steps(1);
    EXPECT_EQ(d.person.hear(), "error: '10' has no unit; write '10 m/s'\n");
  }
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, 0.0);
  d.say(std::string(3000, 'x'));
  d.steps(1);
  EXPECT_THAT(d.person.hear(), HasSubstr("error: no order 'xxx"));
  d.say("error: no order\nfly");
  d.steps(1);
  EXPECT_THAT(d.person.hear(), HasSubstr("no order 'fly'")) << "an answer is not answered, what follows it is";
}

TEST(Manual, SaysWhenAPortIsTaken) {
  const test::Operator other;
  core::Problems problems;
  hal::PluginLoader loader({std::string(test::kBuildDir) + "/lib"}, test::catalog());
  const auto scenario = core::read_experiment(
      std::string(test::kSourceDir) + "/configs/" + kConfig,
      {"controllers.footbot_manual[hand].params.port=" + std::to_string(other.port())}, test::catalog(), problems);
  ASSERT_TRUE(scenario);
  EXPECT_EQ(core::World::make(*scenario, loader, {}, problems), nullptr);
  std::string all;
  for (const core::Problem& p : problems) all += core::to_text(p) + "\n";
  EXPECT_THAT(all, HasSubstr("127.0.0.1, port " + std::to_string(other.port())));
  EXPECT_THAT(all, HasSubstr("each robot needs a port of its own"));
  EXPECT_THAT(all, HasSubstr("fb0"));
}

TEST(Manual, StillListensAfterGoingBackToACheckpoint) {
  const Driven d;
  d.say("drive 10 cm/s 0");
  d.steps(2);
  const auto moment = d.experiment->snapshot();
  ASSERT_TRUE(moment.ok()) << moment.error().message;
  d.steps(10);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, 0.0);
  ASSERT_TRUE(d.experiment->restore(moment.value()).ok());
  d.steps(2);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, 0.1) << "it had been told 0.3 s ago";
  d.say("drive -5 cm/s 0");
  d.steps(1);
  EXPECT_EQ(d.port<hal::WheelSpeeds>().left_m_s, -0.05);
}

TEST(ManualPlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_manual.so");
}

}  // namespace
}  // namespace tandem
