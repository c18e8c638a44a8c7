// What a person on a terminal is told of many real robots.
#include "app/outputs/robot_lines.hpp"

#include <gmock/gmock.h>

#include "app/outputs/roll_lines.hpp"

namespace tandem::app {
namespace {

using core::Presence;
using core::RollRow;
using hal::Severity;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string ep(int i) {
  return "ep" + std::to_string(i);
}

TEST(RobotLines, WhatIsTheSameOfManyIsOneLine) {
  RobotLines lines;
  for (int i = 0; i < 20; ++i) lines.take(Severity::Info, "e-puck '" + ep(i) + "': active, stock, 1.2", 0.01 * i);
  lines.take(Severity::Warning, "robot 'ep3' at 1.2 s: link lost (no answer)", 0.2);
  lines.take(Severity::Warning, "robot 'ep4' at 1.4 s: link lost (no answer)", 0.2);
  EXPECT_THAT(lines.due(0.25), IsEmpty()) << "more of them may come";
  EXPECT_THAT(lines.due(0.6), ElementsAre("e-pucks ep0 to ep19: active, stock, 1.2",
                                          "robots ep3, ep4 at 1.2 to 1.4 s: link lost (no answer)"));
}

TEST(RobotLines, OneLineAndLinesAboutNoRobotStayAsTheyAre) {
  RobotLines lines;
  const std::vector<std::string> texts = {"robot 'ep0' at 12.3 s: its twin stands in 'wall', 14 mm deep at 0.41, 0.2",
                                          "this computer's clock is not synchronised",
                                          "robot 'ep0' on serial:a did not confirm its stop: switch it off by hand"};
  for (const std::string& text : texts) lines.take(Severity::Warning, text, 0.0);
  EXPECT_THAT(lines.due(1.0), testing::ElementsAreArray(texts));
}

TEST(RobotLines, StopsAreToldHoweverMuchWasSaidBefore) {
  RobotLines lines;
  double now_s = 0.0;
  std::size_t told = 0;
  for (int i = 0; i < 500; ++i, now_s += 0.1) {  // a flood of information, and of one link that comes and goes
    lines.take(Severity::Info, "robot 'ep1' says " + std::to_string(i), now_s);
    lines.take(Severity::Warning, "robot 'ep1' at " + std::to_string(i) + " s: link suspect", now_s);
    told += lines.due(now_s).size();
  }
  EXPECT_LE(told, RobotLines::kInfos + RobotLines::kWarnings + 26);
  EXPECT_GT(lines.left_out(), 400U);
  lines.take(Severity::Warning, "robot 'ep7' at 51 s: link lost (deaf)", now_s);
  std::string all;
  for (int i = 0; i < 60; ++i, now_s += 0.1) {
    for (const std::string& line : lines.due(now_s)) all += line + "\n";
  }
  EXPECT_THAT(all, HasSubstr("robot 'ep7' at 51 s: link lost (deaf)"));
}

TEST(RollLines, NameEveryRobotWhateverTheWidth) {
  std::vector<RollRow> rows;
  for (int i = 0; i < 40; ++i) rows.push_back({ep(2 * i), Presence::Drives, ""});
  for (int i = 0; i < 12; ++i) rows.push_back({"tail" + std::to_string(3 * i), Presence::MayMove, "link lost"});
  for (const std::size_t columns : {0UL, 20UL, 40UL, 80UL}) {
    const auto lines = roll_lines(rows, columns);
    std::string all;
    for (const std::string& line : lines) {
      EXPECT_TRUE(columns == 0 || line.size() <= columns) << line;
      all += line + " ";
    }
    EXPECT_EQ(all.find("12 NOT"), 0U) << "first who may still move";
    for (const RollRow& row : rows) EXPECT_THAT(all, HasSubstr(row.id)) << columns;
  }
}

TEST(RollLines, AreToldWhereThereIsNoTerminalWheneverWhatIsUrgentChanges) {
  RollTeller teller;
  std::vector<RollRow> rows = {{"ep0", Presence::Drives, ""}, {"ep1", Presence::Drives, ""}};
  EXPECT_THAT(teller.look(rows, 0.0), IsEmpty());
  rows[1] = {"ep1", Presence::MayMove, "link lost"};
  EXPECT_THAT(teller.look(rows, 0.1), ElementsAre("real robots: NOT REACHED, AND NOT KNOWN TO REST: ep1 (link lost)"));
  rows[0] = {"ep0", Presence::WaitsForPerson, "battery was low; waits to be re-armed"};
  EXPECT_THAT(teller.look(rows, 0.5), IsEmpty()) << "not more often than once a second";
  EXPECT_THAT(teller.look(rows, 1.2), testing::SizeIs(2)) << "but then";
  rows[0] = {"ep0", Presence::Drives, ""};
  rows[1] = {"ep1", Presence::Drives, ""};
  EXPECT_THAT(teller.look(rows, 2.5), ElementsAre("all real robots are reached, and none waits for a person"));
}

}  // namespace
}  // namespace tandem::app
