#include "bridges/link/permitted_link.hpp"

#include <array>
#include <gtest/gtest.h>

#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges {
namespace {

constexpr std::array<std::uint8_t, 3> kBytes = {1, 2, 3};

class Permitted : public testing::Test {
 protected:
  Permitted()
      : open_(permitted(
            [this]() -> hal::Result<std::unique_ptr<ByteLink>> {
              auto [near, far] = MemoryLink::make_pair();
              far_ = std::move(far);
              return std::unique_ptr<ByteLink>(std::move(near));
            },
            SendPermit(turn_))) {}
  std::size_t heard() {
    std::array<std::uint8_t, 16> buffer{};
    return far_->read(buffer).size;
  }
  std::atomic<std::uint32_t> turn_{0};
  std::unique_ptr<ByteLink> far_;
  LinkOpener open_;
};

TEST_F(Permitted, LinkPassesEverythingAsLongAsItIsOurTurn) {
  const auto link = open_().value();
  EXPECT_EQ(link->write(kBytes, 0), 3U);
  EXPECT_EQ(heard(), 3U);
  far_->write(kBytes, 0);
  EXPECT_TRUE(link->wait(0));
  std::array<std::uint8_t, 16> buffer{};
  EXPECT_EQ(link->read(buffer).size, 3U);
  EXPECT_EQ(link->state(), LinkState::Open);
}

TEST_F(Permitted, LinkHasHungUpForGoodOnceTheTurnWasTakenFromUs) {
  const auto link = open_().value();
  for (const std::uint32_t turn : {1U, 2U, 3U, 4U}) {
    turn_ = turn;
    EXPECT_EQ(link->state(), LinkState::HungUp);
    EXPECT_EQ(link->write(kBytes, 0), 0U);
    far_->write(kBytes, 0);
    EXPECT_FALSE(link->wait(0));
    std::array<std::uint8_t, 16> buffer{};
    EXPECT_EQ(link->read(buffer).size, 0U);
  }
  EXPECT_EQ(heard(), 0U);
  EXPECT_EQ(link->statistics().bytes_refused, 12U);
}

TEST_F(Permitted, LinkIsNotOpenedInTheGuardiansTurnAndAgainInOurs) {
  turn_ = 1;
  const auto refused = open_();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "this program was frozen, and its guardian process is stopping the robot");
  EXPECT_EQ(far_, nullptr);
  turn_ = 2;
  EXPECT_EQ(open_().value()->write(kBytes, 0), 3U);
}

TEST_F(Permitted, LinkThatWasBeingOpenedWhenTheTurnWasTakenIsOfNoUse) {
  const auto slow = permitted(
      [this]() -> hal::Result<std::unique_ptr<ByteLink>> {
        turn_ = 2;
        auto [near, far] = MemoryLink::make_pair();
        far_ = std::move(far);
        return std::unique_ptr<ByteLink>(std::move(near));
      },
      SendPermit(turn_));
  const auto link = slow().value();
  EXPECT_EQ(link->state(), LinkState::HungUp);
  EXPECT_EQ(link->write(kBytes, 0), 0U);
}

TEST(SendPermit, IsNotGrantedToAThreadThatWakesUpBeforeTheHeartOfItsHub) {
  const std::atomic<std::uint32_t> turn{4};
  std::atomic<std::uint32_t> beat_ms{0};
  const SendPermit permit(turn, {&beat_ms, 400});
  EXPECT_TRUE(permit.granted_since(4)) << "no heart has begun to beat";
  beat_ms = hal::boottime_ms();
  EXPECT_TRUE(permit.granted_since(4));
  beat_ms = hal::boottime_ms() - 60'000;
  EXPECT_FALSE(permit.granted());
  EXPECT_FALSE(permit.granted_since(4));
  beat_ms = hal::boottime_ms() + 60'000;  // the clock's words wrap: a little ahead is fresh
  EXPECT_TRUE(permit.granted_since(4));
}

TEST(SendPermit, IsAlwaysGrantedWhereThereIsNoGuardian) {
  const SendPermit permit;
  EXPECT_FALSE(permit.real());
  EXPECT_TRUE(permit.granted());
  EXPECT_TRUE(permit.granted_since(permit.turn()));
}

}  // namespace
}  // namespace tandem::bridges
