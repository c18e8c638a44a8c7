// What slanted treels do to a way there and back, and the hook that writes it down.
#include <cmath>

#include "hal/robot/footbot.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/controllers/test_robot.hpp"

namespace tandem {
namespace {

/// A line of the log.
struct Line {
  double time_s, x_m, y_m, heading_rad, odometry_x_m, odometry_y_m, odometry_heading_rad;
};

std::vector<Line> shuttle(std::vector<std::string> overrides, std::uint64_t seed) {
  const std::string csv = test::temporary("shuttle.csv");
  overrides.push_back("loop_functions.output=" + csv);
  overrides.push_back("loop_functions.every=1");
  test::Experiment("footbot_shuttle.xml", overrides, test::seeded(seed)).run(100.0);
  std::ifstream in(csv);
  std::string text;
  std::getline(in, text);
  EXPECT_EQ(text, "time_s,id,x_m,y_m,heading_rad,odometry_x_m,odometry_y_m,odometry_heading_rad");
  std::vector<Line> lines;
  while (std::getline(in, text)) {
    for (char& c : text) c = c == ',' ? ' ' : c;
    std::istringstream cells(text);
    std::string id;
    Line l{};
    cells >> l.time_s >> id >> l.x_m >> l.y_m >> l.heading_rad >> l.odometry_x_m >> l.odometry_y_m >>
        l.odometry_heading_rad;
    EXPECT_TRUE(cells) << text;
    EXPECT_EQ(id, "fb");
    lines.push_back(l);
  }
  std::filesystem::remove(csv);
  return lines;
}

const std::string kTreels = "controllers.footbot_shuttle[shuttle].actuators.differential_steering";

TEST(Shuttle, StaysOnALineAndComesHomeWithTreelsThatAreAlike) {
  const auto lines = shuttle({kTreels + ".implementation=ideal"}, 1);
  ASSERT_EQ(lines.size(), 1000U);
  double farthest_m = -2.0;
  for (const Line& l : lines) {
    farthest_m = std::max(farthest_m, l.x_m);
    EXPECT_NEAR(l.y_m, 0.0, 0.01);
    EXPECT_NEAR(l.x_m, l.odometry_x_m, 1e-3);
    EXPECT_NEAR(l.y_m, l.odometry_y_m, 1e-3);
  }
  EXPECT_NEAR(farthest_m, 2.0, 0.02);
  EXPECT_NEAR(lines.back().x_m, -2.0, 0.02);
  EXPECT_NEAR(lines.back().heading_rad, 0.0, 0.01);
}

TEST(Shuttle, EndsElsewhereWithTreelsThatDrawToOneSideAndDoesNotNotice) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto lines = shuttle({}, seed);
    ASSERT_EQ(lines.size(), 1000U);
    // The heading turns by mu v / wheel base a second, to the left.
    const double mu = lines[299].heading_rad / (0.1 * 29.9) * hal::footbot::kind().drive()->wheel_base_m;
    EXPECT_GT(mu, 0.0);
    EXPECT_LT(mu, 0.0134 * 5.0);  // one in 270,000 is more
    // An arc: y = x^2 / (2 r) as long as that is small, r = wheel base / mu.
    const double along_m = lines[99].x_m + 2.0;
    EXPECT_NEAR(along_m, 1.0, 0.03);
    EXPECT_NEAR(lines[99].y_m, 0.5 * along_m * along_m * mu / hal::footbot::kind().drive()->wheel_base_m, 0.003);
    // After 4 m there and 4 m back the heading is off by both arcs' turns.
    EXPECT_NEAR(lines.back().heading_rad, 8.0 * mu / hal::footbot::kind().drive()->wheel_base_m, 0.03);
    EXPECT_GT(std::hypot(lines.back().x_m + 2.0, lines.back().y_m),
              7.0 * mu / hal::footbot::kind().drive()->wheel_base_m);
    for (const Line& l : lines) EXPECT_NEAR(l.odometry_y_m, 0.0, 0.01);
    EXPECT_NEAR(lines.back().odometry_x_m, -2.0, 0.02);
  }
}

TEST(Shuttle, InReverseComesHomeOnTheSameLineOrWithSlantedTreelsOnAnS) {
  const std::string kReverse = "controllers.footbot_shuttle[shuttle].params.reverse=true";
  const auto straight = shuttle({kReverse, kTreels + ".implementation=ideal"}, 1);
  for (const Line& l : straight) EXPECT_NEAR(l.y_m, 0.0, 1e-6);
  EXPECT_NEAR(straight.back().x_m, -2.0, 0.02);
  EXPECT_NEAR(straight[straight.size() / 2].x_m, 1.0, 0.2);

  const auto lines = shuttle({kReverse}, 1);
  const auto turned = std::find_if(lines.begin(), lines.end(), [](const Line& l) { return l.odometry_x_m >= 2.0; });
  ASSERT_NE(turned, lines.end());
  const double curvature = turned->heading_rad / 4.0;
  EXPECT_GT(curvature, 0.005);
  // It bends to its left all the time: y = k x^2 / 2 there, and back as far to the other side of where it looks.
  EXPECT_NEAR(turned->y_m, 0.5 * curvature * 16.0, 0.02 + std::pow(4.0 * curvature, 3));
  EXPECT_NEAR(lines.back().heading_rad, 2.0 * turned->heading_rad, 0.01);
  EXPECT_NEAR(lines.back().y_m, -curvature * 16.0, 0.02 + 4.0 * std::pow(4.0 * curvature, 3));
  EXPECT_NEAR(lines.back().odometry_y_m, 0.0, 1e-6);
}

TEST(ShuttlePlugin, SeesNoWorld) {
  test::expect_no_world_in(std::string(test::kBuildDir) + "/lib/libfootbot_shuttle.so");
}

}  // namespace
}  // namespace tandem
