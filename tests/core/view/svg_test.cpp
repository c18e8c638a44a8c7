#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "core/view/drawing.hpp"
#include "tests/core/view/well_formed.hpp"

namespace tandem::core {
namespace {

Drawing small_arena() {
  Drawing d;
  d.title = "diffusion, seed 7, t = 60 s";
  d.min_x_m = -1.0;
  d.min_y_m = -0.5;
  d.max_x_m = 1.0;
  d.max_y_m = 0.5;
  hal::Appearance look;
  look.lamps = {{{0.035, 0.0, 0.0}}, {{0.0, -0.035, 0.0}}};
  d.kinds.push_back({"e-puck", 0.035, look});
  return d;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++n;
  return n;
}

TEST(Svg, IsWellFormedWithEverythingInIt) {
  Drawing d = small_arena();
  d.title = "a <b> & \"c\"";
  d.robots = {{0.1, 0.2, 0.5, 0, 0, 2, true}, {-0.4, 0.3, -2.0, 0, 0, 0, false}};
  d.lit = {{0, hal::kRed}, {1, hal::kBlue}};
  d.real = {{1, "ep<0>", "link lost"}};
  d.objects = {{.id = "box", .y_m = 0.45, .half_x_m = 1.0, .half_y_m = 0.05},
               {.kind = Object::Kind::Cylinder, .id = "post", .x_m = 0.5, .radius_m = 0.1}};
  d.lights = {{"lamp", 0.8, -0.4}};
  d.floor = [](double x, double) { return x < 0.0 ? 0.0 : 1.0; };
  const std::string svg = to_svg(d);
  EXPECT_EQ(why_not_well_formed(svg), "");
  EXPECT_NE(svg.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(svg.find("ep&lt;0&gt;: link lost"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(Svg, AnEmptyArenaIsWellFormedToo) {
  Drawing d = small_arena();
  EXPECT_EQ(why_not_well_formed(to_svg(d)), "");
}

TEST(Svg, PutsARobotInItsPlaceWithNorthUpAndItsHeadingCounterClockwise) {
  Drawing d = small_arena();
  d.robots = {{0.25, -0.125, std::numbers::pi / 2.0, 0, 0, 0, false}};
  const std::string svg = to_svg(d, {.size_px = 1000});
  // 1000 px for 2 m; the group's y axis points up, its origin is half an arena below the top edge.
  EXPECT_NE(svg.find("translate(528 302) scale(500 -500)"), std::string::npos) << svg;
  EXPECT_NE(svg.find("<use href=\"#kind0\" transform=\"translate(0.25 -0.125) rotate(90)\"/>"), std::string::npos)
      << svg;
}

TEST(Svg, ShowsLitLedsWhereTheyAreMountedInTheirColour) {
  Drawing d = small_arena();
  d.robots = {{0.0, 0.0, 0.0, 0, 0, 2, false}};
  d.lit = {{0, hal::kRed}, {1, {0, 128, 255}}};
  const std::string svg = to_svg(d);
  EXPECT_EQ(count(svg, "class=\"led\""), 2U);
  EXPECT_NE(svg.find("cx=\"0.035\" cy=\"0\" r=\"0.0084\" fill=\"#ff0000\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("cx=\"0\" cy=\"-0.035\" r=\"0.0084\" fill=\"#0080ff\""), std::string::npos) << svg;
}

TEST(Svg, TurnsLinksAndLampsWithTheirJointAndFillsALinkThatHoldsSomething) {
  Drawing d = small_arena();
  hal::Appearance look;
  look.joints = {{.name = "turret"}};
  look.links = {{.name = "gripper",
                 .low_m = {0.06, -0.01, 0.0},
                 .high_m = {0.12, 0.01, 0.0},
                 .held = {"gripper", "joint"},
                 .joint = 0}};
  look.lamps = {{.at_m = {0.09, 0.0, 0.0}, .joint = 0}};
  d.kinds = {{"foot-bot", 0.085, look}};
  d.robots = {{0.0, 0.0, 0.0, 0, 0, 1, false, 0.0, 0}, {0.5, 0.0, 0.0, 0, 1, 0, false, 0.0, 2}};
  d.values = {std::numbers::pi / 2.0, 0.0, -std::numbers::pi / 4.0, 1.0};
  d.lit = {{0, hal::kRed}};
  const std::string svg = to_svg(d);
  EXPECT_EQ(why_not_well_formed(svg), "");
  EXPECT_EQ(count(svg, "class=\"gripper\""), 2U);
  const std::size_t first = svg.find("class=\"turret\" transform=\"rotate(90)\"");
  const std::size_t second = svg.find("class=\"turret\" transform=\"rotate(-45)\"");
  ASSERT_NE(first, std::string::npos) << svg;
  ASSERT_NE(second, std::string::npos) << svg;
  const std::size_t led = svg.find("class=\"led\"");
  EXPECT_TRUE(first < led && led < second && svg.find("</g>", first) > led) << "the LED turns, too";
  EXPECT_NE(svg.find("fill=\"#ffffff\"", first), std::string::npos);
  EXPECT_EQ(svg.find("fill=\"#ffffff\"", second), std::string::npos) << "the second one holds something";
}

TEST(Svg, TheLegendCountsKindsRealRobotsStoppedOnesAndLights) {
  Drawing d = small_arena();
  d.kinds.push_back({"foot-bot", 0.085, {}});
  for (int i = 0; i < 1'234; ++i) d.robots.push_back({0.0, 0.0, 0.0, 0, 0, 0, i < 3});
  d.robots.push_back({0.0, 0.0, 0.0, 1, 0, 0, false});
  d.real = {{0, "a", ""}, {5, "b", "pose stale"}};
  d.lights = {{"lamp"}};
  const std::string svg = to_svg(d);
  for (const char* entry :
       {">1,234 × e-puck<", ">1 × foot-bot<", ">2 real<", ">1 real in trouble<", ">3 stopped<", ">1 × light<"}) {
    EXPECT_EQ(count(svg, entry), 1U) << entry;
  }
  EXPECT_EQ(count(svg, ">obstacle<"), 0U);
}

TEST(Svg, HoldsTheFloorAsAnImageAsFineAsFloorOrPage) {
  Drawing d = small_arena();
  d.floor = [](double x, double) { return x < 0.0 ? 0.0 : 1.0; };
  const auto samples = [&d](double pixels_per_m, int size_px) {
    std::size_t asked = 0;
    Drawing counted = d;
    counted.floor_pixels_per_m = pixels_per_m;
    counted.floor = [&asked](double, double) { return asked++ > 0 ? 1.0 : 0.0; };
    const std::string svg = to_svg(counted, {.size_px = size_px});
    EXPECT_EQ(count(svg, "href=\"data:image/png;base64,"), 1U);
    return asked;
  };
  EXPECT_EQ(samples(200.0, 1000), 400U * 200U) << "an arena of 2 m x 1 m";
  EXPECT_EQ(samples(2000.0, 1000), 1000U * 500U);
  EXPECT_NE(to_svg(d).find("transform=\"translate(-1 0.5) scale(1 -1)\" width=\"2\" height=\"1\""), std::string::npos);
}

TEST(Svg, HasTitleLegendAndAxesAsAskedFor) {
  Drawing d = small_arena();
  d.robots = {{0.25, 0.0, 0.0, 0, 0, 0, false}};
  const std::string bare = to_svg(d, {.title = false, .legend = false});
  EXPECT_EQ(why_not_well_formed(bare), "");
  EXPECT_EQ(bare.find("e-puck<"), std::string::npos);
  EXPECT_EQ(bare.find("class=\"scale\""), std::string::npos);
  EXPECT_EQ(count(bare, "<text"), 0U);
  EXPECT_LT(svg_height_px(d, {.title = false, .legend = false}), svg_height_px(d, {}) - 80);
  const std::string axes = to_svg(d, {.size_px = 1000, .axes = true});
  const auto y_of = [&axes](const std::string& words) {
    const std::size_t at = axes.rfind("y=\"", axes.find(">" + words + "<"));
    return std::stod(axes.substr(at + 3));
  };
  const std::size_t frame = axes.find("fill=\"none\" stroke=\"#22272e\"");
  const double bottom = std::stod(axes.substr(axes.rfind("height=\"", frame) + 8)) +
                        std::stod(axes.substr(axes.rfind(" y=\"", frame) + 4));
  EXPECT_GT(y_of("x in m"), bottom + 15.0) << "beneath the numbers, outside of the arena";
}

TEST(Svg, TellsWhatLampsPathsAndHeightsAre) {
  Drawing d = small_arena();
  d.lit = {{0, hal::kRed}, {1, {250, 10, 10}}, {0, hal::kBlue}};
  d.robots = {{0.25, 0.0, 0.0, 0, 0, 2, false, 0.8}, {-0.5, 0.25, 0.0, 0, 2, 1, false, 1.2}};
  d.trail_points = {{0.0, 0.0}, {0.125, 0.0}};
  d.trails = {{0, 0, 2}};
  const std::string svg = to_svg(d, {.trails_s = 10.0});
  EXPECT_EQ(why_not_well_formed(svg), "");
  for (const char* entry : {">1 with red LEDs<", ">1 with blue LEDs<", ">flying at 0.8 m to 1.2 m<",
                            ">path of the last 10 s<", ">0.8 m<", ">1.2 m<"})
    EXPECT_EQ(count(svg, entry), 1U) << entry;
}

TEST(Svg, DrawsCrowdsAsDotsInTheColourOfTheirLeds) {
  Drawing d = small_arena();
  d.lit = {{0, hal::kRed}};
  for (int i = 0; i < 100'000; ++i)
    d.robots.push_back({0.001 * (i % 1000), 0.0, 0.0, 0, 0, i % 2 == 0 ? 1U : 0U, false});
  d.real = {{7, "ep7", ""}};
  const std::string svg = to_svg(d);
  EXPECT_EQ(why_not_well_formed(svg), "");
  EXPECT_EQ(count(svg, "h.0001"), 100'000U);
  EXPECT_EQ(count(svg, "<path stroke=\"#ff0000\""), 25U);
  EXPECT_EQ(count(svg, "<use "), 1U);  // the real one, in full
  EXPECT_LT(svg.size(), 3'000'000U);
}

TEST(Svg, ShowsIdsAxesAndTrailsWhenTheyAreAskedFor) {
  Drawing d = small_arena();
  d.robots = {{0.25, 0.0, 0.0, 0, 0, 0, false}, {-0.5, 0.25, 0.0, 0, 0, 0, false}};
  d.ids = {"ep<0>", "ep1"};
  d.trail_points = {{0.0, 0.0}, {0.125, 0.0}};
  d.trails = {{0, 0, 2}};
  const std::string svg = to_svg(d, {.size_px = 1000, .axes = true});
  EXPECT_EQ(why_not_well_formed(svg), "");
  EXPECT_NE(svg.find(">ep&lt;0&gt;<"), std::string::npos);
  EXPECT_NE(svg.find("points=\"0,0 0.125,0 0.25,0\""), std::string::npos) << "the trail ends at the robot";
  for (const char* number : {">-1<", ">-0.5<", ">0<", ">0.5<", ">1<"}) EXPECT_GE(count(svg, number), 1U) << number;
  EXPECT_EQ(count(svg, ">0.5<"), 2U) << "at both axes";
  EXPECT_EQ(count(to_svg(d), "class=\"axes\""), 0U);
}

TEST(Svg, ShowsAndCountsOnlyWhatLiesInTheChosenRegion) {
  Drawing d = small_arena();
  d.robots = {{0.25, 0.0, 0.0, 0, 0, 0, false}, {-0.5, 0.25, 0.0, 0, 0, 0, false}};
  d.ids = {"ep0", "ep1"};
  d.floor = [](double x, double) { return x < 0.25 ? 0.0 : 1.0; };
  const std::string svg = to_svg(d, {.size_px = 1000, .region = PictureLook::Area{0.0, -0.25, 0.5, 0.25}});
  EXPECT_EQ(why_not_well_formed(svg), "");
  EXPECT_NE(svg.find(">1 × e-puck<"), std::string::npos);
  EXPECT_NE(svg.find(">ep0<"), std::string::npos);
  EXPECT_EQ(svg.find(">ep1<"), std::string::npos);
  EXPECT_NE(svg.find(">50 cm × 50 cm<"), std::string::npos);
  EXPECT_NE(svg.find("scale(2000 -2000)"), std::string::npos);
  EXPECT_EQ(count(svg, "class=\"floor\""), 1U);
}

TEST(Svg, OfAKeptFloorIsTheSame) {
  Drawing d = small_arena();
  d.floor = [](double x, double y) { return 0.5 + 0.5 * std::sin(7.0 * x) * std::cos(5.0 * y); };
  for (const PictureLook& look : {PictureLook{}, PictureLook{.region = PictureLook::Area{-0.3, -0.3, 1.5, 0.1}}}) {
    Drawing kept = d;
    keep_floor(kept, look);
    EXPECT_EQ(to_svg(kept, look), to_svg(d, look));
  }
}

TEST(Svg, HasTheHeightThatIsAskedFor) {
  Drawing d = small_arena();
  EXPECT_NE(to_svg(d).find("height=\"" + std::to_string(svg_height_px(d, {})) + "\""), std::string::npos);
  EXPECT_NE(to_svg(d, {.height_px = 777}).find("height=\"777\""), std::string::npos);
}

TEST(Svg, AScaleBarHasARoundLengthAndIsDrawnToScale) {
  EXPECT_DOUBLE_EQ(round_length(0.5), 0.5);
  EXPECT_DOUBLE_EQ(round_length(0.49), 0.2);
  EXPECT_DOUBLE_EQ(round_length(10.0), 10.0);
  EXPECT_DOUBLE_EQ(round_length(9.99), 5.0);
  EXPECT_DOUBLE_EQ(round_length(0.001), 0.001);
  for (double limit = 1e-3; limit < 1e4; limit *= 1.07) {
    const double length = round_length(limit);
    EXPECT_LE(length, limit * (1.0 + 1e-9));
    EXPECT_GT(length, 0.399 * limit);
  }
  EXPECT_EQ(length_text(20.0), "20 m");
  EXPECT_EQ(length_text(1.0), "1 m");
  EXPECT_EQ(length_text(0.5), "50 cm");
  EXPECT_EQ(length_text(0.005), "5 mm");
  const std::string svg = to_svg(small_arena(), {.size_px = 1000});  // 2 m: a quarter is 50 cm, 250 px
  EXPECT_NE(svg.find("M28.5 578H278.5"), std::string::npos) << svg;
  EXPECT_NE(svg.find(">50 cm<"), std::string::npos);
  EXPECT_NE(svg.find(">2 m × 1 m<"), std::string::npos);
}

}  // namespace
}  // namespace tandem::core
