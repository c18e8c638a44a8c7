// ASEBA's own reading of its CAN fragments: asebaswitch (Debian package aseba) joins vcan0 to TCP; asebadump prints
// what comes through, asebacmd sends. Runs in the guest that in_guest.sh makes.
#include <gmock/gmock.h>
#include <thread>
#include <vector>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/aseba/message_link_text.hpp"
#include "tests/bridges/can/guest_process.hpp"

namespace tandem::bridges::aseba {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::unique_ptr<MessageLink> open_link(const std::string& text) {
  const auto opener = message_link_opener(text);
  EXPECT_TRUE(opener.ok());
  for (int i = 0; i < 500; ++i) {
    auto link = opener.value()();
    if (link.ok()) return std::move(link).value();
    if (i == 499) ADD_FAILURE() << link.error().message;
    ::usleep(20'000);
  }
  return nullptr;
}

struct Whole {
  std::uint16_t type;
  Bytes payload;
  bool operator==(const Whole&) const = default;
};

/// Serves `sender` meanwhile: what is beyond its burst leaves with later calls.
std::vector<Whole> receive(MessageLink& link, std::size_t count, MessageLink& sender) {
  std::vector<Whole> all;
  const hal::TimeNs end = monotonic_ns() + 20 * hal::kNsPerSecond;
  MessageView view;
  while (all.size() < count && monotonic_ns() < end) {
    if (link.receive(view)) {
      all.push_back({view.type, {view.payload.begin(), view.payload.end()}});
    } else {
      sender.wait(0);
      link.wait(5 * hal::kNsPerMs);
    }
  }
  return all;
}

class Switch : public testing::Test {
 protected:
  Switch() : switch_("asebaswitch -p 33333 can:if=vcan0") {}
  void SetUp() override {
    if (::access("/usr/bin/asebaswitch", X_OK) != 0) GTEST_SKIP() << "asebaswitch is missing; apt-get install aseba";
    tcp_ = open_link("tcp:127.0.0.1:33333");
    can_ = open_link("can:vcan0");
    ASSERT_NE(tcp_, nullptr) << switch_.output();
    ASSERT_NE(can_, nullptr);
    EXPECT_TRUE(passes_on(*tcp_, *can_)) << switch_.output();
    EXPECT_TRUE(passes_on(*can_, *tcp_)) << switch_.output();
  }
  /// The switch accepts a connection before it serves it: what is sent first may be lost. All that was sent has come.
  static bool passes_on(MessageLink& from, MessageLink& to) {
    for (std::uint8_t i = 0; i < 100; ++i) {
      EXPECT_TRUE(from.send(kProbe, Bytes{i, 0}));
      MessageView view;
      for (const hal::TimeNs end = monotonic_ns() + 300 * hal::kNsPerMs; monotonic_ns() < end;) {
        if (to.receive(view) && view.type == kProbe && view.payload[0] == i) return true;
        from.wait(0);
        to.wait(5 * hal::kNsPerMs);
      }
    }
    return false;
  }
  static constexpr std::uint16_t kProbe = 7;  // a user message
  Background switch_;
  std::unique_ptr<MessageLink> tcp_;
  std::unique_ptr<MessageLink> can_;
};

TEST_F(Switch, PassesMessagesOfEveryLengthBothWays) {
  for (MessageLink* from : {tcp_.get(), can_.get()}) {
    MessageLink& to = from == tcp_.get() ? *can_ : *tcp_;
    std::vector<Whole> sent;
    for (std::size_t words = 0; words <= kMostWords; words = words < 12 ? words + 1 : words + 41) {
      Bytes payload(2 * words);
      for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::uint8_t>(i * 7 + words);
      sent.push_back({static_cast<std::uint16_t>(words), payload});
    }
    sent.push_back({258, Bytes(kMostPayload, 0xA5)});
    for (const Whole& message : sent) {
      // One at a time: the switch has short queues, and drops what does not fit.
      ASSERT_TRUE(from->send(message.type, message.payload));
      const auto got = receive(to, 1, *from);
      ASSERT_EQ(got.size(), 1U) << "message of " << message.payload.size() << " bytes from " << from->name()
                                << "; the switch says: " << switch_.output();
      EXPECT_EQ(got[0], message);
    }
  }
}

TEST_F(Switch, HasItsOwnDumpUnderstandWhatWeSend) {
  Background dump("stdbuf -oL asebadump \"tcp:host=127.0.0.1;port=33333\"");
  const auto send = [&] { EXPECT_TRUE(can_->send(0xA00C, Bytes{3, 0, 35, 0, 0xD4, 0xFE, 77, 0, 9, 0})); };
  EXPECT_TRUE(dump.says_after(send, "set variables from 0 : dest 3 start 35, variables vector of size 3"))
      << dump.output();
  EXPECT_TRUE(can_->send(5, Bytes{0xD4, 0xFE, 77, 0, 9, 0, 0xFF, 0x7F}));
  EXPECT_TRUE(dump.says("user message from 0 : user message of size 4 : -300   77    9 32767")) << dump.output();
}

TEST_F(Switch, PassesOnWhatAsebacmdSays) {
  EXPECT_EQ(shell("asebacmd -t \"tcp:127.0.0.1;33333\" usermsg 5 1 2 3 4 5 | sed /^$/d"), "");
  const auto got = receive(*can_, 1, *tcp_);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0], (Whole{5, {1, 0, 2, 0, 3, 0, 4, 0, 5, 0}}));
}

}  // namespace
}  // namespace tandem::bridges::aseba
