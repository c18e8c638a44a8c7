// A foot-bot on a link that is driven by hand; verdicts come from the robot's own log.
#include <gtest/gtest.h>

#include "tests/checkout.hpp"
#include "tests/controllers/footbot_manual/operator.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

TEST(ManualRobot, DrivesWhileItIsToldAndStopsWhenItsOperatorFallsSilent) {
  Folder folder;
  EmulatedFootbot footbot(folder);
  ASSERT_TRUE(footbot.ready());
  const std::uint16_t port = test::free_ports()[0];
  folder.write("manual.xml",
               R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<footbot_manual id="m" library="footbot_manual"><actuators><differential_steering/></actuators>
<sensors><clock/></sensors><params port=")" +
                   std::to_string(port) +
                   R"("/></footbot_manual></controllers><arena size="2,2,1"><foot-bot id="fb0"><body position="0,0,0"/>
<controller config="m"/><bridge link="slcan:fb0@1000000" map=")" +
                   std::string(test::kSourceDir) + R"(/configs/footbot_map.xml"/></foot-bot></arena></tandem>)");
  Tandem robot({"robot", "manual.xml"}, folder.path());
  const test::Operator person;
  EXPECT_TRUE(eventually(
      [&] {
        person.say(port, "drive 5 cm/s 0");
        return footbot.moves();
      },
      20.0))
      << robot.errors();
  EXPECT_TRUE(eventually([&] { return !footbot.moves(); }, 10.0)) << footbot.log();
  EXPECT_TRUE(eventually(
      [&] {
        person.say(port, "drive -5 cm/s 0");
        const auto wheels = footbot.wheels();
        return wheels.back().left == -12 && wheels.back().right == -12;  // pulses in 5 ms
      },
      20.0))
      << robot.errors();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_FALSE(footbot.moves());
}

}  // namespace
}  // namespace tandem::scenarios
