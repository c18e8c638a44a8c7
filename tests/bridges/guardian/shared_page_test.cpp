#include "bridges/guardian/shared_page.hpp"

#include <gtest/gtest.h>

namespace tandem::bridges::guardian {
namespace {

bool is_guardians(const SharedPage& page) {
  return page.turn.load() % 2 == 1;
}

TEST(Turn, IsGivenBack) {
  SharedPage page;
  page.take_turn();
  EXPECT_TRUE(is_guardians(page));
  page.give_turn(page.turn);
  EXPECT_FALSE(is_guardians(page));
  EXPECT_NE(page.turn, 0U) << "links that were open before are not written to";
}

// A hub that takes its guardian for frozen ends the turn; the guardian may wake up between its look and that.
TEST(Turn, IsTheGuardiansWhenItWokeUpSinceTheHubLooked) {
  for (const bool had_it : {false, true}) {
    SharedPage page;
    if (had_it) page.take_turn();
    const std::uint32_t seen = page.turn;
    page.take_turn();
    page.give_turn(seen);
    EXPECT_TRUE(is_guardians(page)) << had_it;
  }
}

TEST(Turn, IsTheHubsWhenOnlyItsLinksAreWithdrawn) {
  SharedPage page;
  page.withdraw_links();
  EXPECT_FALSE(is_guardians(page));
  EXPECT_NE(page.turn, 0U);
  page.take_turn();
  page.withdraw_links();
  EXPECT_TRUE(is_guardians(page));
}

}  // namespace
}  // namespace tandem::bridges::guardian
