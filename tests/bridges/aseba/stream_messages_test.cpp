#include "bridges/aseba/stream_messages.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <vector>

#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::aseba {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr hal::TimeNs kMs = hal::kNsPerMs;

struct Rig {
  explicit Rig(std::size_t capacity = 65536) {
    auto [near, other] = MemoryLink::make_pair([this] { return now; }, capacity);
    far = std::move(other);
    link = std::make_unique<StreamMessages>(std::move(near), StreamSettings{}, [this] { return now; });
  }
  Bytes read() const {
    Bytes all(65536);
    std::size_t n = 0;
    while (const std::size_t more = far->read(std::span(all).subspan(n)).size) n += more;
    all.resize(n);
    return all;
  }
  void pass(hal::TimeNs time) {
    now += time;
    MessageView view;
    link->receive(view);
  }
  hal::TimeNs now = 1000 * kMs;
  std::unique_ptr<MemoryLink> far;
  std::unique_ptr<StreamMessages> link;
};

TEST(StreamMessages, SendsTheRecordedBytes) {
  const Rig rig;
  EXPECT_TRUE(rig.link->send(0xA011, Bytes{5, 0}));
  EXPECT_EQ(rig.read(), (Bytes{0x02, 0x00, 0x00, 0x00, 0x11, 0xA0, 0x05, 0x00}));
  EXPECT_TRUE(rig.link->send(0xA00B, Bytes{1, 0, 0, 0, 4, 0}));
  EXPECT_EQ(rig.read(), (Bytes{0x06, 0x00, 0x00, 0x00, 0x0B, 0xA0, 0x01, 0x00, 0x00, 0x00, 0x04, 0x00}));
  EXPECT_EQ(rig.link->statistics().sent, 2U);
}

TEST(StreamMessages, ReadsTheRecordedBytesHoweverTheyAreCut) {
  const Bytes stream = {0x02, 0x00, 0x01, 0x00, 0x0C, 0x90, 0x05, 0x00, 0x0A, 0x00, 0x01, 0x00,
                        0x05, 0x90, 0x22, 0x00, 0x02, 0x00, 0xD4, 0xFE, 0x4D, 0x00, 0x00, 0x00};
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    const Rig rig;
    std::vector<std::pair<std::uint16_t, Bytes>> got;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      rig.far->write(std::span(stream).subspan(at, std::min(piece, stream.size() - at)), 0);
      MessageView view;
      while (rig.link->receive(view)) got.push_back({view.type, {view.payload.begin(), view.payload.end()}});
    }
    ASSERT_EQ(got.size(), 2U);
    EXPECT_EQ(got[0].first, 0x900C);
    EXPECT_EQ(got[1].first, 0x9005);
    EXPECT_EQ(got[1].second.size(), 10U);
  }
}

TEST(StreamMessages, IsGoneWhenTheStreamMakesNoSense) {
  const Rig too_long;
  too_long.far->write(Bytes{0x06, 0x02, 0x01, 0x00, 0x05, 0x90}, 0);
  MessageView view;
  EXPECT_FALSE(too_long.link->receive(view));
  EXPECT_EQ(too_long.link->state(), Carrier::Gone);
  EXPECT_EQ(too_long.link->statistics().broken_in, 1U);

  const Rig half_word;
  half_word.far->write(Bytes{0x03, 0x00, 0x01, 0x00, 0x05, 0x90}, 0);
  EXPECT_FALSE(half_word.link->receive(view));
  EXPECT_EQ(half_word.link->state(), Carrier::Gone);

  const Rig text;
  text.far->write(Bytes{0x03, 0x00, 0x01, 0x00, 0x01, 0x90, 1, 0, 0}, 0);
  EXPECT_TRUE(text.link->receive(view));
  EXPECT_EQ(text.link->state(), Carrier::Up);
}

TEST(StreamMessages, IsGoneWhenAMessageDoesNotEnd) {
  Rig rig;
  rig.far->write(Bytes{0x02, 0x00, 0x01}, 0);
  rig.pass(499 * kMs);
  rig.pass(kMs);
  EXPECT_EQ(rig.link->state(), Carrier::Up);
  rig.pass(kMs);
  EXPECT_EQ(rig.link->state(), Carrier::Gone);
}

TEST(StreamMessages, IsGoneWhenThePeerHangsUpAndSaysWhatItStillSaid) {
  Rig rig;
  rig.far->write(Bytes{0x00, 0x00, 0x01, 0x00, 0x04, 0x90}, 0);
  rig.far.reset();
  MessageView view;
  EXPECT_TRUE(rig.link->receive(view));
  EXPECT_FALSE(rig.link->receive(view));
  EXPECT_EQ(rig.link->state(), Carrier::Gone);
  EXPECT_FALSE(rig.link->send(1, {}));
}

TEST(StreamMessages, KeepsMessagesWholeWhereThePeerTakesThemInPieces) {
  Rig rig(5);
  EXPECT_TRUE(rig.link->send(1, Bytes{1, 2, 3, 4}));
  EXPECT_TRUE(rig.link->send(2, Bytes{5, 6}));
  Bytes all = rig.read();
  for (int i = 0; i < 10; ++i) {
    rig.pass(kMs);
    const Bytes more = rig.read();
    all.insert(all.end(), more.begin(), more.end());
  }
  EXPECT_EQ(all, (Bytes{4, 0, 0, 0, 1, 0, 1, 2, 3, 4, 2, 0, 0, 0, 2, 0, 5, 6}));
  EXPECT_EQ(rig.link->statistics().sent, 2U);
}

TEST(StreamMessages, ForgetsWhatHasNotBegunWhenCleared) {
  Rig rig(5);
  rig.link->send(1, Bytes{1, 2, 3, 4});
  rig.link->send(2, Bytes{5, 6});
  rig.link->clear();
  rig.link->send(3, Bytes{});
  Bytes all = rig.read();
  for (int i = 0; i < 10; ++i) {
    rig.pass(kMs);
    const Bytes more = rig.read();
    all.insert(all.end(), more.begin(), more.end());
  }
  EXPECT_EQ(all, (Bytes{4, 0, 0, 0, 1, 0, 1, 2, 3, 4, 0, 0, 0, 0, 3, 0}));
  EXPECT_EQ(rig.link->statistics().dropped, 1U);
}

TEST(StreamMessages, LetsNoOldCommandFireLate) {
  Rig rig(6);
  rig.link->send(1, Bytes{});  // fills the way to the peer
  rig.link->send(2, Bytes{});
  rig.pass(301 * kMs);
  EXPECT_EQ(rig.link->statistics().dropped, 1U);
  EXPECT_EQ(rig.link->state(), Carrier::Up);
  rig.read();
  rig.pass(kMs);
  EXPECT_TRUE(rig.read().empty());

  // Half a message cannot be taken back: the link is given up.
  rig.link->send(3, Bytes{1, 2});
  rig.pass(301 * kMs);
  EXPECT_EQ(rig.link->state(), Carrier::Gone);
}

TEST(StreamMessages, ReadsBackWhatItSends) {
  EXPECT_TRUE(rc::check([](const std::vector<std::pair<std::uint16_t, Bytes>>& messages) {
    auto [a, b] = MemoryLink::make_pair(monotonic_ns, 1 << 20);
    StreamMessages from(std::move(a), {.source = 3});
    StreamMessages to(std::move(b));
    for (auto [type, payload] : messages) {
      if (payload.size() % 2 != 0) payload.push_back(0);
      RC_ASSERT(from.send(type, payload));
      MessageView view;
      RC_ASSERT(to.receive(view));
      RC_ASSERT(view.type == type);
      RC_ASSERT(view.source == 3);
      RC_ASSERT(std::ranges::equal(view.payload, payload));
    }
  }));
}

}  // namespace
}  // namespace tandem::bridges::aseba
