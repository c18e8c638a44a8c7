#include "validate/closed_forms.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

namespace tandem::validate {
namespace {

double form(const std::string& name, const std::vector<std::pair<std::string, double>>& figures) {
  Given given;
  for (const auto& [figure, value] : figures) given.set(figure, value);
  return closed_form(name, given).value();
}

/// A mass that a force moves, by steps so small that its way is known to a micrometre.
struct Stepped {
  double way = 0.0, speed = 0.0;
  template <class Force>
  void go(double seconds, Force&& acceleration) {
    constexpr double kStep_s = 1e-5;
    for (double t = 0.0; t < seconds; t += kStep_s) {
      const double before = speed;
      speed += kStep_s * acceleration(speed);
      if (before > 0.0 && speed < 0.0) speed = 0.0;
      way += 0.5 * kStep_s * (before + speed);
    }
  }
};

TEST(ClosedForms, AreWhatSmallStepsLeadTo) {
  EXPECT_NEAR(form("fall", {{"z", 3.0}, {"v", 0.0}, {"g", 9.81}, {"t", 0.6}}), 3.0 - 0.5 * 9.81 * 0.36, 1e-12);
  Stepped sliding{0.0, 1.0};
  sliding.go(2.0, [](double v) { return v > 0.0 ? -0.3 * 9.81 : 0.0; });
  EXPECT_NEAR(form("slide", {{"v", 1.0}, {"mu", 0.3}, {"g", 9.81}}), sliding.way, 1e-4);
  Stepped starting;
  starting.go(2.0, [](double v) { return v < 0.3 ? 1.5 / 1.6 : 0.0; });
  EXPECT_NEAR(form("start", {{"v", 0.3}, {"m", 1.6}, {"force", 1.5}, {"t", 2.0}}), starting.way, 1e-4);
}

TEST(ClosedForms, OfFlightAreWhatSmallStepsLeadTo) {
  constexpr double kDrag = 0.4, kG = 9.81, kLag_s = 0.05;
  Stepped gathering;
  gathering.go(2.0, [&](double v) { return v < 1.0 ? 3.0 - kDrag * v : 0.0; });
  EXPECT_NEAR(form("flight", {{"v", 1.0}, {"a", 3.0}, {"drag", kDrag}, {"t", 2.0}}), gathering.way, 1e-4);
  Stepped rising;
  rising.go(1.0, [&](double v) { return 0.2 * kG - kDrag * v; });
  EXPECT_NEAR(form("thrust", {{"thrust", 1.2}, {"g", kG}, {"drag", kDrag}, {"lag", 0.0}, {"t", 1.0}}), rising.way,
              1e-4);
  Stepped late;
  double thrust = 1.0;
  late.go(1.0, [&](double) {
    thrust += (1.2 - thrust) / kLag_s * 1e-5;
    return (thrust - 1.0) * kG;
  });
  EXPECT_NEAR(form("thrust", {{"thrust", 1.2}, {"g", kG}, {"drag", 0.0}, {"lag", kLag_s}, {"t", 1.0}}), late.way, 1e-4);
  EXPECT_NEAR(form("lean", {{"pitch", M_PI / 4}, {"g", kG}, {"drag", 0.0}, {"t", 2.0}}), 2.0 * kG, 1e-9);
}

TEST(ClosedForms, HoldASlopeUpToTheAngleOfFriction) {
  const double angle = std::atan(0.5);
  EXPECT_EQ(form("slope", {{"angle", angle - 1e-6}, {"mu", 0.5}, {"g", 9.81}, {"t", 1.0}}), 0.0);
  EXPECT_GT(form("slope", {{"angle", angle + 1e-6}, {"mu", 0.5}, {"g", 9.81}, {"t", 1.0}}), 0.0);
  EXPECT_NEAR(form("slope", {{"angle", M_PI / 2}, {"mu", 0.5}, {"g", 9.81}, {"t", 1.0}}), 9.81 / 2, 1e-9);
}

TEST(ClosedForms, KeepTheMomentumOfACollision) {
  // Without a gap a body of equal mass takes half of the speed, and a quarter of the way.
  EXPECT_NEAR(form("collision", {{"v", 1.0}, {"mu", 0.1}, {"g", 10.0}, {"gap", 0.0}, {"m1", 1.0}, {"m2", 1.0}}),
              0.25 * form("slide", {{"v", 1.0}, {"mu", 0.1}, {"g", 10.0}}), 1e-12);
}

TEST(ClosedForms, CloseACircle) {
  const double around_s = 2.0 * M_PI / (0.05 / 0.14);
  const PlanarPlace back = arc(0.1, 0.15, 0.14, around_s);
  EXPECT_NEAR(back.x_m, 0.0, 1e-12);
  EXPECT_NEAR(back.y_m, 0.0, 1e-12);
  const PlanarPlace half = arc(0.1, 0.15, 0.14, 0.5 * around_s);
  EXPECT_NEAR(half.y_m, 2.0 * 0.125 / (0.05 / 0.14), 1e-12);  // to the left
  EXPECT_EQ(arc(0.1, 0.1, 0.14, 3.0).y_m, 0.0);
}

TEST(ClosedForms, NameWhatIsMissing) {
  EXPECT_FALSE(closed_form("levitation", {}).ok());
  EXPECT_FALSE(closed_form("slide", {}).ok());
}

}  // namespace
}  // namespace tandem::validate
