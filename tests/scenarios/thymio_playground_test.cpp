// The command as a user types it, against the Thymio of ASEBA's own simulator behind ASEBA's own switch; verdicts come
// from the robot's variables, read through another connection to the switch.
#include <functional>
#include <gmock/gmock.h>

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/network.hpp"
#include "bridges/aseba/reopening_messages.hpp"
#include "tests/bridges/aseba/playground.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using bridges::aseba::Network;
using bridges::aseba::ReopeningMessages;
using testing::HasSubstr;

/// Looks at the robot and moves nothing.
class Witness {
 public:
  explicit Witness(const std::string& link)
      : link_(bridges::aseba::message_link_opener(link).value()), network_(link_) {}

  /// Every word of a variable as it is now; empty: it does not answer.
  std::vector<int> read(const std::string& name) {
    const auto& node = network_.node(1);
    if (!until([&] { return node.ready(); })) return {};
    const auto* const variable = node.description.variable(name);
    if (variable == nullptr) return {};
    const hal::TimeNs asked = bridges::monotonic_ns();
    (void)network_.want(1, variable->address, variable->words);
    if (!until([&] { return node.taken_ns(variable->address, variable->words) >= asked; })) return {};
    std::vector<int> words;
    for (std::size_t i = 0; i < variable->words; ++i) words.push_back(node.value(variable->address + i));
    return words;
  }
  /// Left and right.
  std::pair<int, int> speeds() {
    const auto left = read("motor.left.speed"), right = read("motor.right.speed");
    return left.empty() || right.empty() ? std::pair{-1, -1} : std::pair{left[0], right[0]};
  }

 private:
  bool until(const std::function<bool()>& holds) {
    for (const hal::TimeNs end = bridges::monotonic_ns() + 60 * hal::kNsPerSecond; bridges::monotonic_ns() < end;) {
      network_.poll(bridges::monotonic_ns());
      if (holds()) return true;
      link_.wait(5 * hal::kNsPerMs);
    }
    return false;
  }
  ReopeningMessages link_;
  Network network_;
};

class PlaygroundThymio : public testing::Test {
 protected:
  void SetUp() override {
    const std::string missing = test::Playground::missing();
    if (!missing.empty()) GTEST_SKIP() << missing << " is missing; apt-get install aseba xvfb libgl1-mesa-dri";
    playground_ = std::make_unique<test::Playground>(
        "type=\"thymio2\" x=\"40\" y=\"40\" angle=\"0\" name=\"\" nodeId=\"1\"", 80.0);
    ASSERT_TRUE(playground_->has_screen()) << "Xvfb does not start";
    ASSERT_TRUE(playground_->listens());
    const std::uint16_t port = test::free_port();
    link_ = "tcp:127.0.0.1:" + std::to_string(port);
    switch_ = std::make_unique<test::Program>("asebaswitch -p " + std::to_string(port) +
                                              " 'tcp:host=127.0.0.1;port=" + std::to_string(playground_->port()) + "'");
    witness_ = std::make_unique<Witness>(link_);
    ASSERT_EQ(witness_->read("_productId"), std::vector<int>{8});
    folder_.write("robot.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework>
<controllers><obstacle_avoidance id="avoid" library="obstacle_avoidance"><actuators><differential_steering/></actuators>
<sensors><proximity/></sensors><params cruise="8 cm/s" gain="1.5"/></obstacle_avoidance></controllers>
<arena size="20,20,1"><thymio id="th0"><body position="0,0,0"/><controller config="avoid"/>
<bridge link=")" + link_ + R"(" full_speed="16.6 cm/s"/></thymio></arena></tandem>)");
  }
  static bool cruises(std::pair<int, int> s) { return s == std::pair{240, 240} || s == std::pair{241, 241}; }

  Folder folder_;
  std::unique_ptr<test::Playground> playground_;
  std::string link_;
  std::unique_ptr<test::Program> switch_;
  std::unique_ptr<Witness> witness_;
};

TEST_F(PlaygroundThymio, DrivesTurnsAwayFromTheWallAndStops) {
  Tandem robot({"robot", "robot.xml", "--report", "r.json"}, folder_.path());
  ASSERT_TRUE(eventually([&] { return cruises(witness_->speeds()); }, 60.0)) << robot.errors();
  bool saw = false, turned = false;
  EXPECT_TRUE(eventually(
      [&] {
        const auto proximity = witness_->read("prox.horizontal");
        saw = saw || (!proximity.empty() && *std::ranges::max_element(proximity) > 1200);
        const auto [left, right] = witness_->speeds();
        turned = turned || left * right < 0;
        return saw && turned;
      },
      90.0))
      << "it drives on until its sensors see the wall: saw " << saw << ", turned " << turned << robot.errors();
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(), 130) << robot.errors();
  EXPECT_EQ(witness_->read("motor.left.target"), std::vector<int>{0});
  EXPECT_EQ(witness_->read("motor.right.target"), std::vector<int>{0});
  const std::string report = text_of(folder_.path() / "r.json");
  EXPECT_EQ(json_value(report, "programs_sent"), "1") << report;
  EXPECT_EQ(json_value(report, "not_understood"), "0") << report;
  EXPECT_THAT(robot.errors() + robot.output(), HasSubstr("thymio-II, firmware 11, node 1"));
}

TEST_F(PlaygroundThymio, IsStoppedWhenTheHubIsKilled) {
  Tandem robot({"robot", "robot.xml"}, folder_.path());
  ASSERT_TRUE(eventually([&] { return cruises(witness_->speeds()); }, 60.0)) << robot.errors();
  robot.signal(SIGKILL);
  EXPECT_TRUE(eventually([&] { return witness_->speeds() == std::pair{0, 0}; }, 10.0));
}

TEST_F(PlaygroundThymio, StopsByItselfWhenTheGuardianIsKilledFirst) {
  Tandem robot({"robot", "robot.xml"}, folder_.path());
  ASSERT_TRUE(eventually([&] { return cruises(witness_->speeds()); }, 60.0)) << robot.errors();
  const pid_t guardian = robot.guardian();
  ASSERT_GT(guardian, 0);
  kill(guardian, SIGSTOP);
  robot.signal(SIGKILL);
  kill(guardian, SIGKILL);
  EXPECT_TRUE(eventually([&] { return witness_->speeds() == std::pair{0, 0}; }, 10.0));
}

// It serves one host at a time, so that nobody else can look on.
TEST_F(PlaygroundThymio, IsDrivenWithoutASwitchToo) {
  witness_.reset();
  switch_.reset();
  playground_->stop();  // it does not outlive its host
  playground_->start();
  ASSERT_TRUE(playground_->listens());
  Tandem robot({"robot", "robot.xml", "--link", playground_->link(), "--seconds", "3", "--report", "r.json"},
               folder_.path());
  EXPECT_EQ(robot.wait(60), 0) << robot.errors();
  const std::string report = text_of(folder_.path() / "r.json");
  EXPECT_EQ(json_value(report, "state"), "active") << report;
  EXPECT_EQ(json_value(report, "stop_confirmed"), "true") << report;
}

}  // namespace
}  // namespace tandem::scenarios
