#include "bridges/aseba/node_stopper.hpp"

#include <gtest/gtest.h>

#include "bridges/aseba/rest_message.hpp"
#include "tests/bridges/footbot/footbot_on_tcp.hpp"

namespace tandem::bridges::footbot {
namespace {

using guardian::StopState;

class StoppedFootbot : public testing::Test {
 protected:
  StoppedFootbot() {
    set_speeds(50);
    messages_.link = robot_.link;
    messages_.body = aseba::to_stop_body({{0xA00C, {1, 0, 34, 0, 0, 0}, true}, {0xA00C, {2, 0, 34, 0, 0, 0}, true}});
  }
  void set_speeds(std::int16_t speed) {
    robot_.with([speed](FakeModules& m) { m.word("left motor", "speed") = m.word("right motor", "speed") = speed; });
  }
  std::unique_ptr<guardian::Stopper> make() const {
    return aseba::make_node_stopper(messages_, guardian::StopCause::HubGone);
  }
  static StopState steps_until(guardian::Stopper& stopper, StopState wanted) {
    StopState state = StopState::Unreachable;
    for (int i = 0; i < 500 && (i == 0 || state != wanted); ++i) state = stopper.step(monotonic_ns());
    return state;
  }
  FootbotOnTcp robot_;
  StopMessages messages_;
};

TEST_F(StoppedFootbot, RestsAndSaysSoItself) {
  const auto stopper = make();
  EXPECT_EQ(steps_until(*stopper, StopState::Confirmed), StopState::Confirmed);
  EXPECT_FALSE(robot_.moves());
}

TEST_F(StoppedFootbot, IsToldAgainWhenItsConnectionBreaks) {
  const auto stopper = make();
  EXPECT_EQ(stopper->step(monotonic_ns()), StopState::Stopping);
  robot_.hang_up();
  set_speeds(50);
  EXPECT_EQ(steps_until(*stopper, StopState::Unreachable), StopState::Unreachable);
  EXPECT_EQ(steps_until(*stopper, StopState::Confirmed), StopState::Confirmed);
  EXPECT_FALSE(robot_.moves());
}

TEST_F(StoppedFootbot, IsNotConfirmedByAModuleThatSaysNothing) {
  messages_.body += "40972 c90022000000 read back\n";  // nobody has this number
  const auto stopper = make();
  for (int i = 0; i < 10; ++i) EXPECT_NE(stopper->step(monotonic_ns()), StopState::Confirmed);
  EXPECT_FALSE(robot_.moves());
}

TEST_F(StoppedFootbot, HasNothingToConfirmWhereNoModuleWasEverWired) {
  messages_.body = "";
  EXPECT_EQ(make()->step(monotonic_ns()), StopState::Confirmed);
  EXPECT_TRUE(robot_.moves());
}

TEST(NodeStopper, SaysWhyALinkCannotBe) {
  StopMessages messages;
  messages.link = "tcp:127.0.0.1:1";
  messages.body = "40972 010022000000 read back\n";
  const auto stopper = aseba::make_node_stopper(messages, guardian::StopCause::HubGone);
  EXPECT_EQ(stopper->step(monotonic_ns()), StopState::Unreachable);
  EXPECT_NE(stopper->trouble().find("nobody listens there"), std::string::npos) << stopper->trouble();
}

}  // namespace
}  // namespace tandem::bridges::footbot
