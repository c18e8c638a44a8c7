// <safety>: fences, keep-outs, zones, and robots that start where they may not be.
#include <gmock/gmock.h>

#include "tests/core/config/reading.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A real e-puck (radius 35 mm, height 86 mm) on line 6, and <safety> with these areas from line 8 on.
Outcome read_with(const std::string& areas, const std::string& position = "0,0,0", const std::string& attributes = "") {
  Parts parts;
  parts.things = "<e-puck id=\"ep\"><body position=\"" + position +
                 R"("/><controller config="w"/><bridge link="pty:ep0"/></e-puck>)";
  parts.rest = "<safety " + attributes + ">\n" + areas + "\n</safety>";
  return read(parts.text());
}

TEST(Safety, FencesKeepOutsAndZonesAreRead) {
  const Outcome out = read_with(
      R"(<fence id="floor" points="-1,-1 1,-1 1,1 -1,100cm" height="0.5"/>
<keep_out id="table" points="0.5,0.5 0.8,0.5 0.8,0.8" from="0.2" to="0.4"/>
<zone id="slow" points="0,0 0.5,0 0.5,0.5" max_speed="5 cm/s"/>)",
      "0,0,0", R"(avoid="all" apart="2cm" latency="80 ms")");
  const SafetyConfig& safety = out.good().safety;
  EXPECT_EQ(safety.avoid, Avoid::All);
  EXPECT_EQ(safety.apart_m, 0.02);
  EXPECT_EQ(safety.latency_s, 0.08);
  ASSERT_EQ(safety.fences.size(), 1U);
  EXPECT_EQ(safety.fences[0].corners.at(3), (Point2{-1.0, 1.0}));
  EXPECT_EQ(safety.fences[0].to_m, 0.5);
  ASSERT_EQ(safety.keep_outs.size(), 1U);
  EXPECT_EQ(safety.keep_outs[0].from_m, 0.2);
  EXPECT_EQ(safety.keep_outs[0].to_m, 0.4);
  ASSERT_EQ(safety.zones.size(), 1U);
  EXPECT_EQ(safety.zones[0].max_speed_m_s, 0.05);
  EXPECT_EQ(out.problems.size(), 0U) << out.text();
}

TEST(Safety, WithoutItRealRobotsKeepFromOneAnother) {
  EXPECT_EQ(read(Parts().text()).good().safety.avoid, Avoid::Real);
}

TEST(Safety, AnAreaThatIsNoneIsToldWithItsLine) {
  EXPECT_THAT(read_with(R"(<fence points="0,0 1,1 1,0 0,1"/>)").text(),
              HasSubstr("file.xml:9: error: <fence points>: the sides from corners 1 and 3 cross or touch"));
  EXPECT_THAT(read_with(R"(<fence points="0,0 1,1"/>)").text(), HasSubstr("at least three corners"));
  EXPECT_THAT(read_with(R"(<keep_out points="0,0 1,1 2"/>)").text(), HasSubstr("'2' must be two lengths"));
  EXPECT_THAT(read_with(R"(<keep_out points="0,0 nan,1 2,2"/>)").text(), HasSubstr("'nan,1' must be two lengths"));
  EXPECT_THAT(read_with(R"(<fence/>)").text(), HasSubstr("<fence> needs the attribute 'points'"));
  EXPECT_THAT(read_with(R"(<zone points="0,0 1,0 1,1"/>)").text(), HasSubstr("<zone> needs the attribute 'max_speed'"));
  EXPECT_THAT(read_with(R"(<keep_out points="0,0 1,0 1,1" from="1" to="0.5"/>)").text(),
              HasSubstr("<keep_out to>: must be above 'from'"));
  EXPECT_THAT(read_with(R"(<fance points="0,0 1,0 1,1"/>)").text(), HasSubstr("fence"));
  EXPECT_THAT(read_with("<zone id=\"a\" points=\"0,0 1,0 1,1\" max_speed=\"1\"/>\n"
                        "<keep_out id=\"a\" points=\"1,1 1.5,1 1.5,1.5\"/>")
                  .text(),
              HasSubstr("a second area 'a'; the first is on line 9"));
}

TEST(Safety, ARealRobotStartsInTheFenceWithItsWholeBody) {
  const std::string fence = R"(<fence id="floor" points="-1,-1 1,-1 1,1 -1,1" height="0.2"/>)";
  EXPECT_EQ(read_with(fence, "0.96,0,0").text(), "");
  EXPECT_THAT(read_with(fence, "0.97,0,0").text(),
              HasSubstr("file.xml:6: error: robot 'ep' starts outside of the fence 'floor' (line 9)"));
  EXPECT_THAT(read_with(fence, "1.5,0,0").text(), HasSubstr("starts outside of the fence"));
  EXPECT_THAT(read_with(fence, "0,0,0.15").text(), HasSubstr("starts above the fence 'floor'"));
}

TEST(Safety, ARealRobotStartsInNoKeepOutButMayStartUnderOne) {
  const std::string pillar = R"(<keep_out id="pillar" points="0.1,-0.1 0.3,-0.1 0.3,0.1 0.1,0.1")";
  EXPECT_EQ(read_with(pillar + "/>", "0.06,0,0").text(), "");
  EXPECT_THAT(read_with(pillar + "/>", "0.07,0,0").text(),
              HasSubstr("file.xml:6: error: robot 'ep' starts in the keep-out 'pillar' (line 9)"));
  EXPECT_THAT(read_with(pillar + "/>", "0.2,0,0").text(), HasSubstr("starts in the keep-out"));
  EXPECT_EQ(read_with(pillar + R"( from="0.1"/>)", "0.2,0,0").text(), "");
}

TEST(Safety, AreasWithoutIdsAreNumbered) {
  const Outcome out = read_with(
      "<zone points=\"0,0 1,0 1,1\" max_speed=\"1\"/>\n<zone id=\"a\" points=\"0,0 1,0 1,1\" "
      "max_speed=\"1\"/>\n<zone points=\"0,0 1,0 1,1\" max_speed=\"1\"/>");
  EXPECT_EQ(out.good().safety.zones.at(0).id, "zone");
  EXPECT_EQ(out.good().safety.zones.at(2).id, "zone 2");
}

TEST(Safety, SaysSoWhereNoRobotIsReal) {
  Parts parts;
  parts.rest = R"(<safety avoid="all"/>)";
  const Outcome out = read(parts.text());
  EXPECT_TRUE(out.scenario);
  EXPECT_THAT(out.text(), HasSubstr("<safety> has no effect: no robot has a <bridge>"));
}

}  // namespace
}  // namespace tandem::core
