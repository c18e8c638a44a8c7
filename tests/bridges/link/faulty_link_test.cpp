#include "tests/bridges/link/faulty_link.hpp"

#include <array>
#include <gmock/gmock.h>
#include <vector>

#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr hal::TimeNs kMs = hal::kNsPerMs;

/// A faulty link, the clean far end, and the clock of both.
struct Rig {
  explicit Rig(const Faults& faults) {
    auto [a, b] = MemoryLink::make_pair([this] { return now; });
    far = std::move(b);
    near = std::make_unique<FaultyLink>(std::move(a), faults, [this] { return now; });
  }
  static Bytes read_all(ByteLink& link) {
    Bytes all;
    std::array<std::uint8_t, 64> buffer;
    for (Received r = link.read(buffer); r.size > 0; r = link.read(buffer))
      all.insert(all.end(), buffer.begin(), buffer.begin() + r.size);
    return all;
  }
  hal::TimeNs now = 0;
  std::unique_ptr<MemoryLink> far;
  std::unique_ptr<FaultyLink> near;
};

Bytes sequence(std::size_t n) {
  Bytes bytes(n);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

TEST(FaultyLink, PassesEverythingWhenNothingIsWrong) {
  Rig rig({});
  rig.near->write(sequence(200), 0);
  EXPECT_EQ(Rig::read_all(*rig.far), sequence(200));
  rig.far->write(sequence(100), 0);
  EXPECT_EQ(Rig::read_all(*rig.near), sequence(100));
}

TEST(FaultyLink, DoesTheSameForTheSameSeedHoweverTheBytesAreCut) {
  const Faults faults{.seed = 7, .loss = 0.1, .corruption = 0.1};
  Rig whole(faults);
  Rig pieces(faults);
  whole.near->write(sequence(3000), 0);
  for (const std::uint8_t byte : sequence(3000)) pieces.near->write(Bytes{byte}, 0);
  const Bytes through = Rig::read_all(*whole.far);
  EXPECT_EQ(through, Rig::read_all(*pieces.far));
  EXPECT_NEAR(static_cast<double>(through.size()), 2700.0, 100.0);

  Rig other({.seed = 8, .loss = 0.1, .corruption = 0.1});
  other.near->write(sequence(3000), 0);
  EXPECT_NE(through, Rig::read_all(*other.far));
}

TEST(FaultyLink, FlipsOneBitOfACorruptedByte) {
  Rig rig({.corruption = 1.0});
  rig.near->write(Bytes(256, 0), 0);
  const Bytes through = Rig::read_all(*rig.far);
  ASSERT_EQ(through.size(), 256U);
  for (const std::uint8_t byte : through) EXPECT_EQ(__builtin_popcount(byte), 1);
}

TEST(FaultyLink, HoldsBytesBackAndStampsThemWhenTheyAreLetThrough) {
  Rig rig({.delay_ns = 20 * kMs});
  rig.far->write(Bytes{1, 2}, 0);
  rig.now = 19 * kMs;
  EXPECT_TRUE(Rig::read_all(*rig.near).empty());
  rig.now = 25 * kMs;
  std::array<std::uint8_t, 8> buffer;
  const Received received = rig.near->read(buffer);
  EXPECT_EQ(received.size, 2U);
  EXPECT_EQ(received.at_ns, 20 * kMs);

  rig.near->write(Bytes{9}, 0);
  EXPECT_TRUE(Rig::read_all(*rig.far).empty());
  rig.now = 45 * kMs;
  rig.near->wait(0);
  EXPECT_EQ(Rig::read_all(*rig.far), Bytes{9});
}

TEST(FaultyLink, KeepsTheOrderUnderJitter) {
  Rig rig({.delay_ns = kMs, .jitter_ns = 50 * kMs});
  for (std::size_t i = 0; i < 100; ++i) {
    rig.far->write(Bytes{static_cast<std::uint8_t>(i)}, 0);
    rig.now += kMs;
  }
  rig.now += 100 * kMs;
  EXPECT_EQ(Rig::read_all(*rig.near), sequence(100));
}

TEST(FaultyLink, IsCutDuringWholeSlotsAndComesBack) {
  Rig rig({.seed = 3, .cut = 0.5, .cut_slot_ns = 10 * kMs});
  int cut = 0;
  for (int slot = 0; slot < 200; ++slot) {
    rig.now = slot * 10 * kMs;
    const LinkState at_start = rig.near->state();
    rig.now += 9 * kMs;
    EXPECT_EQ(rig.near->state(), at_start);
    if (at_start == LinkState::HungUp) {
      ++cut;
      EXPECT_EQ(rig.near->write(Bytes{1}, 0), 0U);
      rig.far->write(Bytes{2}, 0);
      EXPECT_TRUE(Rig::read_all(*rig.near).empty());
    } else {
      rig.far->write(Bytes{3}, 0);
      EXPECT_EQ(Rig::read_all(*rig.near), Bytes{3});
    }
  }
  EXPECT_GT(cut, 60);
  EXPECT_LT(cut, 140);
}

}  // namespace
}  // namespace tandem::bridges
