// ASEBA's own simulated robot as the other side: asebaplayground (Debian package aseba), on a screen that nobody sees.
#include "tests/bridges/aseba/playground.hpp"

#include <array>
#include <functional>
#include <gtest/gtest.h>

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/network.hpp"
#include "bridges/aseba/reopening_messages.hpp"

namespace tandem::bridges::aseba {
namespace {

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

class PlaygroundEpuck : public testing::Test {
 protected:
  void SetUp() override {
    const std::string missing = test::Playground::missing();
    if (!missing.empty()) GTEST_SKIP() << missing << " is missing; apt-get install aseba xvfb libgl1-mesa-dri";
    playground_ = std::make_unique<test::Playground>("type=\"e-puck\" x=\"50\" y=\"50\" name=\"ep\"", 100.0);
    ASSERT_TRUE(playground_->has_screen()) << "Xvfb does not start";
    const auto opener = message_link_opener(playground_->link());
    ASSERT_TRUE(opener.ok());
    link_ = std::make_unique<ReopeningMessages>(opener.value());
    network_ = std::make_unique<Network>(*link_);
  }
  /// Serves the network until it holds, at most some time that is longer than any machine needs.
  bool serve_until(const std::function<bool()>& holds) {
    for (const hal::TimeNs end = monotonic_ns() + 60 * kSecond; monotonic_ns() < end;) {
      network_->poll(monotonic_ns());
      if (holds()) return true;
      link_->wait(5 * hal::kNsPerMs);
    }
    return false;
  }
  testing::AssertionResult read(std::size_t address, std::size_t count) {
    const hal::TimeNs asked = monotonic_ns();
    const bool wanted = network_->want(1, address, count);
    if (wanted && serve_until([&] { return network_->node(1).taken_ns(address, count) >= asked; })) {
      return testing::AssertionSuccess();
    }
    const NodeStatistics& s = network_->node(1).statistics;
    return testing::AssertionFailure() << "node " << node_state_name(network_->node(1).state) << ", " << s.messages
                                       << " messages, " << s.reads << " reads, " << s.asked_again << " asked again, "
                                       << s.answers << " answered, " << s.unanswered << " not, " << s.unasked
                                       << " unasked, " << s.wrong_length << " of a wrong length, lost " << s.times_lost
                                       << " times";
  }

  std::unique_ptr<test::Playground> playground_;
  std::unique_ptr<ReopeningMessages> link_;
  std::unique_ptr<Network> network_;
};

TEST_F(PlaygroundEpuck, DescribesItselfAndObeys) {
  ASSERT_TRUE(serve_until([&] { return network_->node(1).ready(); })) << link_->trouble();
  const Node& node = network_->node(1);
  EXPECT_EQ(node.version, 5);
  EXPECT_EQ(node.description.variables.size(), 14U);
  EXPECT_EQ(node.description.local_events.size(), 2U);
  EXPECT_EQ(node.description.native_functions.size(), 33U);
  for (const auto& [name, address, words] : {std::tuple{"id", 0, 1},
                                             {"args", 2, 32},
                                             {"_productId", 34, 1},
                                             {"speed.left", 35, 1},
                                             {"speed.right", 36, 1},
                                             {"prox", 40, 8},
                                             {"cam.red", 48, 60},
                                             {"cam.blue", 168, 60},
                                             {"energy", 228, 1}}) {
    const Variable* variable = node.description.variable(name);
    ASSERT_NE(variable, nullptr) << name;
    EXPECT_EQ(variable->address, address) << name;
    EXPECT_EQ(variable->words, words) << name;
  }
  EXPECT_EQ(node.statistics.impossible, 0U);
  EXPECT_EQ(node.statistics.not_understood, 0U);

  ASSERT_TRUE(read(0, 1));
  EXPECT_EQ(node.value(0), 1);
  ASSERT_TRUE(read(34, 1));
  EXPECT_EQ(node.value(34), 2);  // the product number of a simulated e-puck

  const std::array<std::int16_t, 2> speeds = {-300, 77};
  EXPECT_TRUE(network_->write(1, 35, speeds));
  ASSERT_TRUE(read(34, 4));
  EXPECT_EQ(node.value(35), -300);
  EXPECT_EQ(node.value(36), 77);

  ASSERT_TRUE(read(0, node.image.size()));  // all there is
  EXPECT_EQ(node.statistics.wrong_length, 0U);

  constexpr std::array<std::uint8_t, 6> kArguments = {1, 0, 0xFE, 0xFF, 3, 0};
  EXPECT_TRUE(network_->send(aseba::UserEvent{5, aseba::Words(kArguments)}));
  ASSERT_TRUE(read(2, 3));
  EXPECT_EQ(node.value(2), 1);
  EXPECT_EQ(node.value(3), -2);
  EXPECT_EQ(node.value(4), 3);
  EXPECT_EQ(network_->statistics().not_understood, 0U);
}

TEST_F(PlaygroundEpuck, IsFoundAgainAfterItsEnd) {
  ASSERT_TRUE(serve_until([&] { return network_->node(1).ready(); })) << link_->trouble();
  playground_->stop();
  ASSERT_TRUE(serve_until([&] { return network_->node(1).state == NodeState::Lost; }));
  const std::array<std::int16_t, 1> speed = {1};
  EXPECT_FALSE(network_->write(1, 35, speed));
  playground_->start();
  ASSERT_TRUE(serve_until([&] { return network_->node(1).ready(); })) << link_->trouble();
  EXPECT_EQ(network_->node(1).generation, 2U);
  ASSERT_TRUE(read(35, 1));
  EXPECT_EQ(network_->node(1).value(35), 0);
}

}  // namespace
}  // namespace tandem::bridges::aseba
