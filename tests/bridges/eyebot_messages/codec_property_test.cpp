#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "bridges/eyebot_messages/codec.hpp"

namespace tandem::bridges::eyebot_messages {
namespace {

using Bytes = std::vector<std::byte>;

template <class Message>
Bytes encoded(const Message& message) {
  Bytes buffer(kMostBytes);
  const auto written = encode(message, buffer);
  return {written.begin(), written.end()};
}

float number() {
  return static_cast<float>(*rc::gen::inRange(-1000000, 1000000)) / 1024.0F;
}
Header header() {
  Header h{};
  h.utime = *rc::gen::arbitrary<std::int64_t>();
  h.seq = *rc::gen::arbitrary<std::int32_t>();
  h.session = *rc::gen::arbitrary<std::int32_t>();
  return h;
}
std::string text() {
  return *rc::gen::container<std::string>(rc::gen::inRange<char>(1, 127));
}

Rab some_rab() {
  Rab m{};
  m.hdr = header();
  m.pkt.resize(*rc::gen::inRange<std::size_t>(0, 20));
  m.n = static_cast<std::int32_t>(m.pkt.size());
  for (RabPacket& p : m.pkt) {
    p.sender = *rc::gen::arbitrary<std::int32_t>();
    p.range = number();
    p.bearing = number();
    p.elevation = number();
    p.data = *rc::gen::resize(127, rc::gen::arbitrary<std::vector<std::uint8_t>>());
    p.data.resize(std::min<std::size_t>(p.data.size(), 127));
    p.len = static_cast<std::int8_t>(p.data.size());
  }
  return m;
}
Status some_status() {
  Status m{};
  m.hdr = header();
  m.mode = *rc::gen::arbitrary<std::int8_t>();
  m.cmd_seq = *rc::gen::arbitrary<std::int32_t>();
  m.text = text();
  return m;
}
Blobs some_blobs() {
  Blobs m{};
  m.hdr = header();
  m.blob.resize(*rc::gen::inRange<std::size_t>(0, 100));
  m.n = static_cast<std::int32_t>(m.blob.size());
  for (Blob& b : m.blob) {
    b.x = number();
    b.range = number();
  }
  return m;
}

/// The same bytes after a way there and back: each member has come through.
template <class Message>
void comes_back(const Message& m) {
  const Bytes there = encoded(m);
  RC_ASSERT(!there.empty());
  Message back{};
  RC_ASSERT(decode<Message>(there, back) == Flaw::None);
  RC_ASSERT(encoded(back) == there);
}

TEST(EyebotCodecProperty, EveryMessageComesBackAsItWas) {
  EXPECT_TRUE(rc::check([] { comes_back(some_rab()); }));
  EXPECT_TRUE(rc::check([] { comes_back(some_status()); }));
  EXPECT_TRUE(rc::check([] { comes_back(some_blobs()); }));
}

/// Whatever is done to it: it is refused, or it is a message whose bytes these are.
template <class Message>
void survives_damage(Bytes bytes) {
  const auto places = *rc::gen::inRange<std::size_t>(1, 4);
  for (std::size_t i = 0; i < places; ++i) {
    bytes[*rc::gen::inRange<std::size_t>(8, bytes.size())] = static_cast<std::byte>(*rc::gen::inRange(0, 256));
  }
  const auto cut = *rc::gen::weightedOneOf<std::size_t>(
      {{3, rc::gen::just(bytes.size())}, {1, rc::gen::inRange<std::size_t>(0, bytes.size() + 20)}});
  bytes.resize(cut);
  Message m{};
  if (decode<Message>(bytes, m) != Flaw::None) return;
  const Bytes again = encoded(m);
  RC_ASSERT(again.size() == bytes.size());
}

TEST(EyebotCodecProperty, DamageIsNoticedOrHarmless) {
  EXPECT_TRUE(rc::check([] { survives_damage<Rab>(encoded(some_rab())); }));
  EXPECT_TRUE(rc::check([] { survives_damage<Status>(encoded(some_status())); }));
  EXPECT_TRUE(rc::check([] { survives_damage<Blobs>(encoded(some_blobs())); }));
}

template <class Message>
void refuses_noise() {
  Bytes bytes(8);
  const std::uint64_t type = fingerprint<Message>();
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::byte>(type >> (56 - 8 * i));
  for (const std::uint8_t b : *rc::gen::arbitrary<std::vector<std::uint8_t>>()) bytes.push_back(std::byte{b});
  Message m{};
  if (decode<Message>(bytes, m) == Flaw::None) RC_ASSERT(encoded(m).size() == bytes.size());
}

TEST(EyebotCodecProperty, NoiseBehindARightFingerprintDoesNoHarm) {
  EXPECT_TRUE(rc::check([] { refuses_noise<Rab>(); }));
  EXPECT_TRUE(rc::check([] { refuses_noise<Ack>(); }));
  EXPECT_TRUE(rc::check([] { refuses_noise<Image>(); }));
  EXPECT_TRUE(rc::check([] { refuses_noise<Heartbeat>(); }));
}

}  // namespace
}  // namespace tandem::bridges::eyebot_messages
