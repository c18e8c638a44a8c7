// The parts that have no ports: inbox, clock, liveness, orders, names.
#include <gtest/gtest.h>

#include "bridges/eyebot/inbox.hpp"
#include "bridges/eyebot/liveness.hpp"
#include "bridges/eyebot/mode_orders.hpp"
#include "bridges/eyebot/topic.hpp"
#include "bridges/eyebot_messages/codec.hpp"

namespace tandem::bridges::eyebot {
namespace {

namespace messages = eyebot_messages;
constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr hal::TimeNs kS = hal::kNsPerSecond;

// --- names ---

TEST(EyebotTopic, ChannelsAreTakenApartAsTheyWerePutTogether) {
  for (std::size_t i = 0; i < kTopics; ++i) {
    const auto topic = static_cast<Topic>(i);
    EXPECT_EQ(topic_of("eb0", channel_of("eb0", topic)), topic);
    EXPECT_FALSE(topic_of("eb", channel_of("eb0", topic)));
    EXPECT_FALSE(topic_of("eb00", channel_of("eb0", topic)));
  }
  EXPECT_EQ(channel_of("eb0", Topic::PanTilt), "eyebot/eb0/pan_tilt");
  EXPECT_EQ(channel_of("eb0", "lab", Told::Velocity), "eyebot/eb0/cmd/velocity");
  EXPECT_EQ(channel_of("eb0", "lab", Told::Heartbeat), "hub/lab/heartbeat");
  EXPECT_FALSE(topic_of("eb0", "eyebot/eb0/cmd/mode"));
  EXPECT_FALSE(topic_of("eb0", "eyebot/eb0"));
  EXPECT_FALSE(topic_of("eb0", ""));
}

TEST(EyebotTopic, NamesHoldNothingThatARegularExpressionUses) {
  EXPECT_TRUE(is_robot_name("eb-0_A"));
  EXPECT_TRUE(is_robot_name(std::string(24, 'x')));
  for (const std::string& bad : {std::string(), std::string(25, 'x'), std::string("a.b"), std::string("a/b"),
                                 std::string("a b"), std::string("a*")}) {
    EXPECT_FALSE(is_robot_name(bad)) << bad;
  }
}

// --- the inbox ---

std::vector<std::byte> altitude(std::int32_t session, std::int32_t seq, float ground = 0.0F) {
  messages::Altitude m{};
  m.hdr.session = session;
  m.hdr.seq = seq;
  m.ground = ground;
  std::vector<std::byte> buffer(32);
  (void)messages::encode(m, buffer);
  return buffer;
}
float ground_of(const Letter& letter) {
  messages::Altitude m{};
  EXPECT_EQ(messages::decode(std::span<const std::byte>(letter.data), m), messages::Flaw::None);
  return m.ground;
}

TEST(EyebotInbox, GivesTheNewestAndCountsWhatWasLost) {
  Inbox inbox;
  Letter letter;
  EXPECT_FALSE(inbox.take(Topic::Altitude, letter));
  inbox.deliver(Topic::Altitude, altitude(1, 0, 1.0F), 10);
  inbox.deliver(Topic::Altitude, altitude(1, 5, 2.0F), 20);
  ASSERT_TRUE(inbox.take(Topic::Altitude, letter));
  EXPECT_EQ(ground_of(letter), 2.0F);
  EXPECT_EQ(letter.received_ns, 20);
  EXPECT_FALSE(inbox.take(Topic::Altitude, letter));
  const TopicStatistics s = inbox.statistics(Topic::Altitude);
  EXPECT_EQ(s.received, 2U);
  EXPECT_EQ(s.lost, 4U);
  EXPECT_EQ(s.replaced, 1U);
}

TEST(EyebotInbox, RefusesWhatIsDoubledOrWasOvertaken) {
  Inbox inbox;
  Letter letter;
  inbox.deliver(Topic::Altitude, altitude(1, 7, 7.0F), 10);
  inbox.deliver(Topic::Altitude, altitude(1, 7, 8.0F), 20);
  inbox.deliver(Topic::Altitude, altitude(1, 6, 9.0F), 30);
  ASSERT_TRUE(inbox.take(Topic::Altitude, letter));
  EXPECT_EQ(ground_of(letter), 7.0F);
  EXPECT_EQ(inbox.statistics(Topic::Altitude).old, 2U);
}

TEST(EyebotInbox, FollowsNumbersAroundTheirEnd) {
  Inbox inbox;
  Letter letter;
  inbox.deliver(Topic::Altitude, altitude(1, std::numeric_limits<std::int32_t>::max()), 10);
  inbox.deliver(Topic::Altitude, altitude(1, std::numeric_limits<std::int32_t>::min(), 2.0F), 20);
  ASSERT_TRUE(inbox.take(Topic::Altitude, letter));
  EXPECT_EQ(ground_of(letter), 2.0F);
  EXPECT_EQ(inbox.statistics(Topic::Altitude).lost, 0U);
  EXPECT_EQ(inbox.statistics(Topic::Altitude).old, 0U);
}

TEST(EyebotInbox, TakesTheNumbersOfASenderThatRestarted) {
  Inbox inbox;
  Letter letter;
  inbox.deliver(Topic::Altitude, altitude(1, 1000), 10);
  inbox.deliver(Topic::Altitude, altitude(2, 0, 5.0F), 20);
  ASSERT_TRUE(inbox.take(Topic::Altitude, letter));
  EXPECT_EQ(ground_of(letter), 5.0F);
}

TEST(EyebotInbox, IsNotLockedOutByOneWrongNumber) {
  Inbox inbox;
  Letter letter;
  inbox.deliver(Topic::Altitude, altitude(1, 2'000'000'000), 10);
  ASSERT_TRUE(inbox.take(Topic::Altitude, letter));
  int refused = 0;
  for (std::int32_t seq = 0; !inbox.take(Topic::Altitude, letter); ++seq, ++refused) {
    ASSERT_LT(refused, 30);
    inbox.deliver(Topic::Altitude, altitude(1, seq), 20);
  }
  EXPECT_EQ(refused, 20);
  inbox.deliver(Topic::Altitude, altitude(1, 20, 6.0F), 30);
  ASSERT_TRUE(inbox.take(Topic::Altitude, letter));
  EXPECT_EQ(ground_of(letter), 6.0F);
}

TEST(EyebotInbox, RefusesOtherTypesAndWhatIsTooLargeOrTooShort) {
  Inbox inbox;
  Letter letter;
  inbox.deliver(Topic::Battery, altitude(1, 0), 10);
  inbox.deliver(Topic::Altitude, std::vector<std::byte>(23), 10);
  auto large = altitude(1, 1);
  large.resize(messages::kMostBytes + 1);
  inbox.deliver(Topic::Altitude, large, 10);
  EXPECT_FALSE(inbox.take(Topic::Altitude, letter));
  EXPECT_FALSE(inbox.take(Topic::Battery, letter));
  EXPECT_EQ(inbox.statistics().refused, 3U);
}

TEST(EyebotInbox, KeepsARowOfAcknowledgements) {
  Inbox inbox;
  Letter letter;
  messages::Ack m{};
  std::vector<std::byte> buffer(1000);
  for (std::int32_t i = 0; i < 20; ++i) {
    m.hdr.seq = m.cmd_seq = i;
    inbox.deliver(Topic::Ack, messages::encode(m, buffer), i);
  }
  for (std::int32_t i = 4; i < 20; ++i) {
    ASSERT_TRUE(inbox.take(Topic::Ack, letter));
    ASSERT_EQ(messages::decode(std::span<const std::byte>(letter.data), m), messages::Flaw::None);
    EXPECT_EQ(m.cmd_seq, i);
  }
  EXPECT_FALSE(inbox.take(Topic::Ack, letter));
}

// --- liveness ---

TEST(EyebotLiveness, ANewSessionIsARestartOnceTheOldOneIsSilent) {
  Liveness alive;
  EXPECT_EQ(alive.note(1, 100 * kMs), Sender::Current);
  EXPECT_FALSE(alive.settled(399 * kMs));
  EXPECT_TRUE(alive.settled(400 * kMs));
  EXPECT_EQ(alive.note(2, 200 * kMs), Sender::Other);
  EXPECT_TRUE(alive.contested(200 * kMs));
  EXPECT_EQ(alive.note(2, 399 * kMs), Sender::Other);
  EXPECT_EQ(alive.note(2, 400 * kMs), Sender::Restarted);
  EXPECT_FALSE(alive.contested(400 * kMs));
  EXPECT_FALSE(alive.settled(600 * kMs));
  EXPECT_EQ(alive.note(1, 150 * kMs), Sender::Other);  // it lay in the inbox
  EXPECT_EQ(alive.note(2, 410 * kMs), Sender::Current);
  EXPECT_EQ(alive.restarts(), 1U);
}

TEST(EyebotLiveness, TheOneThatWasThereFirstStaysTheRobot) {
  Liveness alive;
  (void)alive.note(1, 0);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_FALSE(alive.namesakes(20 * i * kMs)) << i;
    EXPECT_EQ(alive.note(2, (20 * i - 10) * kMs), Sender::Other);
    EXPECT_EQ(alive.note(1, 20 * i * kMs), Sender::Current);
  }
  EXPECT_TRUE(alive.namesakes(61 * kMs));
  EXPECT_FALSE(alive.namesakes(4 * kS));
  EXPECT_EQ(alive.session(), 1);
  EXPECT_EQ(alive.restarts(), 0U);
  EXPECT_EQ(alive.others(), 3U);
}

TEST(EyebotLiveness, AStartThatWasReplacedComesBackOnlyWhenTheOtherIsLost) {
  Liveness alive;
  (void)alive.note(1, 0);
  (void)alive.note(2, 500 * kMs);
  EXPECT_EQ(alive.note(1, 2400 * kMs), Sender::Other);
  EXPECT_EQ(alive.note(1, 2500 * kMs), Sender::Restarted);
  EXPECT_EQ(alive.session(), 1);
}

TEST(EyebotLiveness, ThePulseHasThePeriodThatIsPromisedWithinReason) {
  Liveness alive;
  EXPECT_EQ(alive.pulse(0), Pulse::Never);
  alive.note_heartbeat(1000, 0);
  EXPECT_EQ(alive.pulse(3 * kS), Pulse::Beating);
  EXPECT_EQ(alive.pulse(3 * kS + 1), Pulse::Lost);  // three periods are longer than two seconds
  alive.note_heartbeat(-5, 10 * kS);
  EXPECT_EQ(alive.pulse(10 * kS + 61 * kMs), Pulse::Stale);
  EXPECT_EQ(alive.next_change(10 * kS + 61 * kMs), 12 * kS + 1);
  alive.note_heartbeat(std::numeric_limits<std::int32_t>::max(), 20 * kS);
  EXPECT_EQ(alive.pulse(26 * kS + 1), Pulse::Lost);
}

// --- orders ---

messages::Ack answer(std::int32_t session, std::int32_t seq, std::int8_t result = messages::Ack::OK) {
  messages::Ack m{};
  m.cmd_session = session;
  m.cmd_seq = seq;
  m.result = result;
  return m;
}

TEST(EyebotOrders, TakeOnlyTheAnswerToWhatTheySaid) {
  ModeOrders orders;
  EXPECT_FALSE(orders.take(answer(5, 0), 5, 0));
  orders.want(Action::Arm, 0.0F, 0);
  EXPECT_FALSE(orders.take(answer(5, 0), 5, 0));  // not said yet
  ASSERT_TRUE(orders.due(0));
  EXPECT_FALSE(orders.take(answer(6, 0), 5, kMs));  // another hub's
  EXPECT_FALSE(orders.take(answer(5, 1), 5, kMs));
  EXPECT_EQ(orders.take(answer(5, 0), 5, 3 * kMs), Action::Arm);
  EXPECT_FALSE(orders.take(answer(5, 0), 5, 4 * kMs));  // doubled
  EXPECT_EQ(orders.last(Action::Arm).outcome, Outcome::Done);
  EXPECT_EQ(orders.statistics().round_trips.largest_ns(), 3 * kMs);
}

TEST(EyebotOrders, ANewOneReplacesTheOneThatIsOut) {
  ModeOrders orders;
  orders.want(Action::TakeOff, 0.5F, 0);
  ASSERT_TRUE(orders.due(0));
  orders.want(Action::Hover, 0.0F, 10 * kMs);
  const auto said = orders.due(10 * kMs);
  ASSERT_TRUE(said);
  EXPECT_EQ(said->action, Action::Hover);
  EXPECT_EQ(said->seq, 1);
  EXPECT_FALSE(orders.take(answer(5, 0), 5, 20 * kMs));
}

TEST(EyebotOrders, OneThatWasRefusedIsGivenAgainAfterASecond) {
  ModeOrders orders;
  orders.want(Action::Arm, 0.0F, 0);
  ASSERT_TRUE(orders.due(0));
  ASSERT_TRUE(orders.take(answer(5, 0, messages::Ack::REJECTED_SOURCE), 5, 0));
  EXPECT_EQ(orders.last(Action::Arm).outcome, Outcome::RejectedSource);
  orders.want(Action::Arm, 0.0F, 999 * kMs);
  EXPECT_FALSE(orders.due(999 * kMs));
  orders.want(Action::Arm, 0.0F, kS);
  EXPECT_TRUE(orders.due(kS));
}

TEST(EyebotOrders, AFailSafeWhoseCauseLastedIsClearedAFifthOfASecondLater) {
  ModeOrders orders;
  orders.want(Action::ClearFailsafe, 0.0F, 0);
  ASSERT_TRUE(orders.due(0));
  ASSERT_TRUE(orders.take(answer(5, 0, messages::Ack::FAILED), 5, 0));
  orders.want(Action::ClearFailsafe, 0.0F, 199 * kMs);
  EXPECT_FALSE(orders.due(199 * kMs));
  orders.want(Action::ClearFailsafe, 0.0F, 200 * kMs);
  EXPECT_TRUE(orders.due(200 * kMs));
}

TEST(EyebotOrders, AnUnknownResultIsAFailure) {
  ModeOrders orders;
  orders.want(Action::Arm, 0.0F, 0);
  ASSERT_TRUE(orders.due(0));
  ASSERT_TRUE(orders.take(answer(5, 0, 100), 5, 0));
  EXPECT_EQ(orders.last(Action::Arm).outcome, Outcome::Failed);
}

}  // namespace
}  // namespace tandem::bridges::eyebot
