#include "bridges/aseba/fragments.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <vector>

#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges::aseba {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr hal::TimeNs kMs = hal::kNsPerMs;

Bytes counting(std::size_t n) {
  Bytes bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + 1);
  return bytes;
}

std::vector<CanFrame> cut(std::uint16_t source, std::uint16_t type, const Bytes& payload, hal::TimeNs at = 0) {
  std::vector<CanFrame> frames;
  for (std::size_t i = 0; i < frames_for(payload.size()); ++i) {
    frames.push_back(fragment(source, type, payload, i));
    frames.back().at_ns = at;
  }
  return frames;
}

struct Whole {
  std::uint16_t source, type;
  Bytes payload;
  bool operator==(const Whole&) const = default;
};

std::vector<Whole> put_together(Assembler& assembler, const std::vector<CanFrame>& frames) {
  std::vector<Whole> all;
  for (const CanFrame& frame : frames) {
    if (const auto m = assembler.push(frame)) {
      all.push_back({m->source, m->type, {m->payload.begin(), m->payload.end()}});
    }
  }
  return all;
}

void expect_frame(const CanFrame& frame, std::uint32_t id, const Bytes& data) {
  EXPECT_TRUE(same_on_wire(frame, make_frame(id, data))) << std::hex << frame.id << " for " << id;
}

// The examples of the protocol: bytes on the bus.
TEST(Fragments, AreThoseOfTheProtocol) {
  const auto list = cut(0, 0xA011, {0x05, 0x00});
  ASSERT_EQ(list.size(), 1U);
  expect_frame(list[0], 0x300, {0x11, 0xA0, 0x05, 0x00});

  const auto one = cut(0, 0xA00C, {0x01, 0x00, 0x22, 0x00, 0x1E, 0x00});
  ASSERT_EQ(one.size(), 1U);
  expect_frame(one[0], 0x300, {0x0C, 0xA0, 0x01, 0x00, 0x22, 0x00, 0x1E, 0x00});

  const auto two = cut(0, 0xA00C, {0x01, 0x00, 0x23, 0x00, 0xD4, 0xFE, 0x4D, 0x00});
  ASSERT_EQ(two.size(), 2U);
  expect_frame(two[0], 0x100, {0x0C, 0xA0, 0x01, 0x00, 0x23, 0x00, 0xD4, 0xFE});
  expect_frame(two[1], 0x200, {0x4D, 0x00});

  const auto description = cut(1, 0x9000, {0x0A, 0x6C, 0x65, 0x66, 0x74, 0x2D, 0x6D, 0x6F, 0x74, 0x6F, 0x72, 0x04, 0x00,
                                           0x00, 0x04, 0x20, 0x00, 0xC8, 0x00, 0x06, 0x00, 0x01, 0x00, 0x08, 0x00});
  ASSERT_EQ(description.size(), 4U);
  expect_frame(description[0], 0x101, {0x00, 0x90, 0x0A, 0x6C, 0x65, 0x66, 0x74, 0x2D});
  expect_frame(description[1], 0x001, {0x6D, 0x6F, 0x74, 0x6F, 0x72, 0x04, 0x00, 0x00});
  expect_frame(description[2], 0x001, {0x04, 0x20, 0x00, 0xC8, 0x00, 0x06, 0x00, 0x01});
  expect_frame(description[3], 0x201, {0x00, 0x08, 0x00});
}

TEST(Assembler, PutsEveryLengthTogether) {
  Assembler assembler;
  for (std::size_t n = 0; n <= kMostPayload; ++n) {
    const Bytes payload = counting(n);
    const auto got = put_together(assembler, cut(77, 0x1234, payload));
    ASSERT_EQ(got, (std::vector<Whole>{{77, 0x1234, payload}})) << n;
  }
  EXPECT_EQ(frames_for(kMostPayload), kMostFrames);
  EXPECT_EQ(assembler.open_messages(), 0U);
}

TEST(Assembler, KeepsSourcesApart) {
  Assembler assembler;
  const auto a = cut(1, 0x9005, counting(40));
  const auto b = cut(2, 0x9005, counting(35));
  std::vector<CanFrame> mixed;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mixed.push_back(a[i]);
    if (i < b.size()) mixed.push_back(b[i]);
  }
  const auto got = put_together(assembler, mixed);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(assembler.statistics().messages, 2U);
}

TEST(Assembler, DropsAMessageWhoseStartOrStopIsLost) {
  const auto frames = cut(3, 0x9005, counting(40));
  const auto next = cut(3, 0x9005, counting(30));
  {
    Assembler assembler;
    std::vector<CanFrame> some(frames.begin() + 1, frames.end());
    EXPECT_TRUE(put_together(assembler, some).empty());
    EXPECT_EQ(assembler.statistics().stray_normal, frames.size() - 2);
    EXPECT_EQ(assembler.statistics().stray_stop, 1U);
  }
  {
    Assembler assembler;
    std::vector<CanFrame> some(frames.begin(), frames.end() - 1);
    some.insert(some.end(), next.begin(), next.end());
    const auto got = put_together(assembler, some);
    ASSERT_EQ(got.size(), 1U);
    EXPECT_EQ(got[0].payload, counting(30));
    EXPECT_EQ(assembler.statistics().lost_stop, 1U);
  }
}

TEST(Assembler, DropsAnOpenMessageWhenASmallOneComes) {
  Assembler assembler;
  auto frames = cut(3, 0x9005, counting(40));
  frames.pop_back();
  frames.push_back(cut(3, 0x900C, {5, 0})[0]);
  const auto got = put_together(assembler, frames);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].type, 0x900C);
  EXPECT_EQ(assembler.statistics().lost_stop, 1U);
  EXPECT_EQ(assembler.open_messages(), 0U);
}

TEST(Assembler, ShowsALostMiddleInTheLength) {
  Assembler assembler;
  auto frames = cut(3, 0x9005, counting(40));
  frames.erase(frames.begin() + 2);
  const auto got = put_together(assembler, frames);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].payload.size(), 32U);
}

TEST(Assembler, RefusesMessagesThatGrowTooLong) {
  Assembler assembler;
  auto frames = cut(3, 0x9005, counting(kMostPayload));
  const CanFrame middle = frames[1];
  frames.insert(frames.begin() + 1, middle);
  EXPECT_TRUE(put_together(assembler, frames).empty());
  EXPECT_EQ(assembler.statistics().too_long, 1U);
  EXPECT_EQ(assembler.statistics().stray_stop, 1U);
}

TEST(Assembler, CountsFramesThatCannotBe) {
  Assembler assembler;
  CanFrame extended = cut(3, 0x900C, {5, 0})[0];
  extended.extended = true;
  CanFrame remote = extended;
  remote.extended = false;
  remote.remote = true;
  const CanFrame high = make_frame(0x400, counting(8));
  CanFrame oversized = make_frame(0x303, counting(8));
  oversized.size = 9;
  EXPECT_TRUE(put_together(assembler, {extended, remote, high, oversized}).empty());
  EXPECT_EQ(assembler.statistics().foreign, 4U);
  EXPECT_TRUE(put_together(assembler, {make_frame(0x303, counting(1)), make_frame(0x103, counting(7))}).empty());
  EXPECT_TRUE(put_together(assembler, {make_frame(0x103, counting(8)), make_frame(0x003, counting(7))}).empty());
  EXPECT_TRUE(put_together(assembler, {make_frame(0x103, counting(8)), make_frame(0x203, {})}).empty());
  EXPECT_EQ(assembler.statistics().bad_length, 4U);
  EXPECT_EQ(assembler.open_messages(), 0U);
}

TEST(Assembler, GivesUpMessagesThatDoNotGoOn) {
  Assembler assembler;
  const auto frames = cut(3, 0x9005, counting(40), 5 * kMs);
  assembler.push(frames[0]);
  assembler.expire(105 * kMs);
  EXPECT_EQ(assembler.open_messages(), 1U);
  assembler.expire(106 * kMs);
  EXPECT_EQ(assembler.open_messages(), 0U);
  EXPECT_EQ(assembler.statistics().timed_out, 1U);
  // The same without a call of `expire`: the late frame itself shows it.
  assembler.push(frames[0]);
  CanFrame late = frames[1];
  late.at_ns = 200 * kMs;
  assembler.push(late);
  EXPECT_EQ(assembler.statistics().timed_out, 2U);
  EXPECT_EQ(assembler.statistics().stray_normal, 1U);
}

TEST(Assembler, TakesTheClosingFrameForTheEndOfABrokenMessage) {
  Assembler assembler;
  auto frames = cut(0, 0xA00C, counting(20));
  frames.pop_back();
  frames.push_back(closing_frame(0));
  const auto whole = cut(0, 0xA00C, counting(14));
  frames.insert(frames.end(), whole.begin(), whole.end());
  const auto got = put_together(assembler, frames);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].payload.size(), 16U);
  EXPECT_EQ(got[1].payload, counting(14));
}

TEST(Assembler, PutsAnyMixOfSourcesTogether) {
  EXPECT_TRUE(rc::check([](const std::vector<std::tuple<std::uint8_t, std::uint16_t, Bytes>>& messages) {
    std::vector<std::vector<CanFrame>> waiting(kNodeIds);
    std::vector<std::vector<Whole>> expected(kNodeIds);
    std::size_t left = 0;
    for (const auto& [source, type, payload] : messages) {
      for (const CanFrame& f : cut(source, type, payload)) waiting[source].push_back(f);
      expected[source].push_back({source, type, payload});
    }
    for (const auto& w : waiting) left += w.size();
    // Frames of one source stay in order, sources take turns by chance.
    Assembler assembler;
    std::vector<std::vector<Whole>> got(kNodeIds);
    std::vector<std::size_t> next(kNodeIds);
    const auto order = *rc::gen::container<std::vector<std::uint8_t>>(left, rc::gen::arbitrary<std::uint8_t>());
    for (std::size_t i = 0; i < left; ++i) {
      std::size_t source = order[i];
      while (next[source] == waiting[source].size()) source = (source + 1) % kNodeIds;
      if (const auto m = assembler.push(waiting[source][next[source]++])) {
        got[source].push_back({m->source, m->type, {m->payload.begin(), m->payload.end()}});
      }
    }
    RC_ASSERT(got == expected);
    RC_ASSERT(assembler.open_messages() == 0U);
  }));
}

TEST(Assembler, AccountsForEveryFrameItIsGiven) {
  EXPECT_TRUE(rc::check([](const std::vector<std::tuple<std::uint16_t, std::uint8_t, bool>>& raw) {
    Assembler assembler;
    std::size_t delivered = 0;
    for (const auto& [id, size, extended] : raw) {
      CanFrame frame = make_frame(id % 0x410U, counting(8));
      if (id % 3 != 0) frame.id &= 0x303U;  // few sources, so that messages meet
      frame.size = static_cast<std::uint8_t>(size % 3 == 0 ? size % 10 : 8);
      frame.extended = extended && size % 8 == 0;
      if (const auto m = assembler.push(frame)) {
        ++delivered;
        RC_ASSERT(m->payload.size() <= kMostPayload);
        RC_ASSERT(m->source < 256);
      }
    }
    RC_ASSERT(assembler.statistics().frames == raw.size());
    RC_ASSERT(assembler.statistics().messages == delivered);
    const std::size_t open = assembler.open_messages();
    const std::uint64_t before = assembler.statistics().timed_out;
    assembler.clear();
    RC_ASSERT(assembler.statistics().timed_out == before + open);
    RC_ASSERT(assembler.open_messages() == 0U);
  }));
}

}  // namespace
}  // namespace tandem::bridges::aseba
