#include "bridges/footbot_emulator/bus.hpp"

#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using testing::ElementsAre;

std::vector<std::string> all_by(Bus& bus, hal::TimeNs now) {
  std::vector<std::string> all;
  while (const auto passed = bus.next(now)) all.push_back(to_text(passed->frame.frame));
  return all;
}

TEST(Bus, LetsTheLowestIdentifierGoFirst) {
  Bus bus(3);
  bus.send(0, {frame("301#0C900500")}, 0);
  bus.send(1, {frame("102#00"), frame("002#01"), frame("202#02")}, 0);
  bus.send(2, {frame("103#00"), frame("203#01")}, 0);
  EXPECT_THAT(all_by(bus, 10 * kMs), ElementsAre("102#00", "002#01", "103#00", "202#02", "203#01", "301#0C900500"));
}

TEST(Bus, IsOccupiedWhileAFramePasses) {
  Bus bus(1);
  bus.occupied_until(kMs);
  bus.send(0, {frame("301#"), frame("301#")}, 0);
  EXPECT_EQ(bus.next_at(), kMs + 55'000);
  EXPECT_FALSE(bus.next(kMs + 54'999));
  EXPECT_EQ(bus.next(kMs + 55'000)->frame.at, kMs + 55'000);
  EXPECT_EQ(bus.next(2 * kMs)->frame.at, kMs + 110'000);
  EXPECT_FALSE(bus.next_at());
}

TEST(Bus, WaitsForWhoIsReady) {
  Bus bus(2);
  bus.send(0, {frame("101#")}, 2 * kMs);
  bus.send(1, {frame("302#")}, kMs);
  EXPECT_THAT(all_by(bus, 3 * kMs), ElementsAre("302#", "101#"));
}

TEST(Bus, ForgetsWhatASenderCanNoLongerSay) {
  Bus bus(2);
  bus.send(0, {frame("301#")}, 0);
  bus.send(1, {frame("302#")}, 0);
  bus.clear(0);
  EXPECT_THAT(all_by(bus, kMs), ElementsAre("302#"));
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
