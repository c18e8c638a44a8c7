#include "mixed_reality/desk/desk.hpp"

#include <gtest/gtest.h>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;

DeskWord word(std::string command, std::string who, hal::TimeNs at_ns, std::string robot = "*") {
  return {std::move(command), std::move(robot), std::move(who), at_ns};
}

TEST(Desk, TheLastWordCountsAndWhoseIsTakenBackIsNamed) {
  Desk desk;
  EXPECT_EQ(desk.admit(word("pause", "anna", 0), 0).value(), "");
  EXPECT_EQ(desk.admit(word("play", "ben", 800 * kMs), 800 * kMs).value(),
            "this takes back 'pause' of 'anna', 0.8 s ago");
  EXPECT_EQ(desk.admit(word("pause", "ben", 900 * kMs), 900 * kMs).value(), "") << "one's own word";
  EXPECT_EQ(desk.admit(word("play", "anna", 5000 * kMs), 5000 * kMs).value(), "") << "long ago";
  EXPECT_EQ(desk.admit(word("halt", "anna", 5100 * kMs, "ep0"), 5100 * kMs).value(), "");
  EXPECT_EQ(desk.admit(word("release", "ben", 5200 * kMs, "ep1"), 5200 * kMs).value(), "") << "another robot";
  const DeskStatus status = desk.status();
  EXPECT_EQ(status.turned_back, 1U);
  EXPECT_EQ(status.said.at("anna"), 3U);
  EXPECT_EQ(status.said.at("ben"), 3U);
  EXPECT_EQ(status.last->command, "release");
}

TEST(Desk, NobodyArmsAtOnceAfterAnothersEmergencyStopNorByAnEarlierWord) {
  Desk desk;
  desk.note_stop(word("estop", "anna", 1000 * kMs));
  const auto early = desk.admit(word("arm", "ben", 1300 * kMs), 1300 * kMs);
  ASSERT_FALSE(early.ok());
  EXPECT_NE(early.error().message.find("'anna' has stopped all real robots 0.3 s ago"), std::string::npos)
      << early.error().message;
  EXPECT_TRUE(desk.admit(word("arm", "anna", 1350 * kMs), 1350 * kMs).ok()) << "her own stop";
  EXPECT_FALSE(desk.admit(word("arm", "anna", 900 * kMs), 1400 * kMs).ok())
      << "said before the stop, carried out after";
  EXPECT_TRUE(desk.admit(word("arm", "ben", 2100 * kMs), 2100 * kMs).ok());
  EXPECT_EQ(desk.status().refused, 2U);
}

}  // namespace
}  // namespace tandem::mixed_reality
