#include "hal/filter.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <rapidcheck.h>

namespace tandem::hal {
namespace {

WheelSpeeds speeds(double left, double right) {
  WheelSpeeds w;
  w.set(left, right);
  return w;
}

TEST(Filter, PassesWhatIsWithinTheLimit) {
  WheelSpeeds w = speeds(0.1, -0.05);
  EXPECT_EQ(filter(w, 0.1), FilterResult::Passed);
  EXPECT_EQ(w.left_m_s, 0.1);
  EXPECT_EQ(w.right_m_s, -0.05);
}

TEST(Filter, ClampsBothWheelsByTheSameFactor) {
  WheelSpeeds w = speeds(-0.4, 0.2);
  EXPECT_EQ(filter(w, 0.1), FilterResult::Clamped);
  EXPECT_DOUBLE_EQ(w.left_m_s, -0.1);
  EXPECT_DOUBLE_EQ(w.right_m_s, 0.05);
}

TEST(Filter, StopsWhatIsNotFinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (WheelSpeeds w :
       {speeds(kNan, 0.0), speeds(0.0, kNan), speeds(kInf, 0.0), speeds(0.01, -kInf), speeds(kNan, kInf)}) {
    EXPECT_EQ(filter(w, 0.1), FilterResult::NotFinite);
    EXPECT_EQ(w.left_m_s, 0.0);
    EXPECT_EQ(w.right_m_s, 0.0);
  }
}

TEST(Filter, NeverLeavesMoreThanTheLimitAndKeepsTheCurve) {
  EXPECT_TRUE(rc::check([](double left, double right) {
    WheelSpeeds w = speeds(left, right);
    const FilterResult result = filter(w, 0.128);
    RC_ASSERT(std::fabs(w.left_m_s) <= 0.128 * (1.0 + 1e-15));
    RC_ASSERT(std::fabs(w.right_m_s) <= 0.128 * (1.0 + 1e-15));
    if (result == FilterResult::Passed) RC_ASSERT(w.left_m_s == left && w.right_m_s == right);
    if (result == FilterResult::Clamped && std::fabs(left) > 1e-200 && std::fabs(right) > 1e-200) {
      const double before = left / right;
      if (std::isnormal(before) && std::fabs(w.right_m_s) > 1e-200)
        RC_ASSERT(std::fabs(w.left_m_s / w.right_m_s - before) <= 1e-12 * std::fabs(before));
    }
  }));
}

TEST(Filter, ALimitOfZeroStops) {
  WheelSpeeds w = speeds(0.1, 0.1);
  EXPECT_EQ(filter(w, 0.0), FilterResult::Clamped);
  EXPECT_EQ(w.left_m_s, 0.0);
}

}  // namespace
}  // namespace tandem::hal
