// Robots on wheels that turn: constraints of wheels, axles and floor are solved well enough by themselves.
#include "hal/robot/footbot.hpp"
#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

constexpr double kSpeed_m_s = 0.1;

ByHand on_wheels(std::vector<Element::Attribute> more = {}) {
  more.push_back({"drive", "wheels", 1});
  return ByHand(more);
}

double heading_deg(ByHand& hand, std::size_t row) {
  return std::atan2(hand.bodies().sin_h[row], hand.bodies().cos_h[row]) * 180.0 / M_PI;
}

TEST(Dynamics3dWheels, DriveStraightOnAsTold) {
  for (const hal::RobotKind* kind : {&hal::epuck::kind(), &hal::footbot::kind()}) {
    ByHand hand = on_wheels();
    for (int i = 0; i < 4; ++i) hand.robot(0.0, i - 2.0, 0.0, kSpeed_m_s, kSpeed_m_s, *kind);
    hand.ticks(60);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(heading_deg(hand, i), 0.0, 0.1) << kind->name;
      EXPECT_NEAR(hand.bodies().y_m[i], static_cast<double>(i) - 2.0, 5e-4) << kind->name;
      EXPECT_NEAR(hand.bodies().x_m[i], 0.6, 6e-3) << kind->name;
    }
    EXPECT_LE(hand.accuracy().constraint_error_m_s, 1e-3);
    EXPECT_EQ(hand.accuracy().unsolved_sub_steps, 0U);
  }
}

TEST(Dynamics3dWheels, PushALoadAsFastAsTheyDrive) {
  for (const double mass_kg : {0.05, 0.1}) {
    ByHand hand = on_wheels();
    const hal::RobotKind& kind = hal::footbot::kind();
    hand.robot(0.0, 0.0, 0.0, kSpeed_m_s, kSpeed_m_s, kind);
    hand.block(kind.body.radius_m + 0.06, 0.0, 0.0, 0.1, 0.1, 0.1, mass_kg);
    hand.ticks(20);
    const double from_m = hand.object().x_m;
    hand.ticks(20);
    EXPECT_NEAR((hand.object().x_m - from_m) / 2.0, kSpeed_m_s, 0.02 * kSpeed_m_s) << mass_kg;
    EXPECT_EQ(hand.accuracy().unsolved_sub_steps, 0U);
  }
}

TEST(Dynamics3dWheels, WhatCannotBeSolvedAsWellAsAskedForIsCounted) {
  ByHand hand = on_wheels({{"solver_error", "1e-12", 1}});
  hand.robot(0.0, 0.0, 0.0, kSpeed_m_s, kSpeed_m_s);
  hand.ticks(2);
  EXPECT_GT(hand.accuracy().unsolved_sub_steps, 0U);
  EXPECT_GT(hand.accuracy().constraint_error_m_s, 1e-12);
}

/// Heaps far from one another are solved each for itself: what happens in one changes no bit in the other.
TEST(Dynamics3dWheels, PassesOfOneIslandAreNothingToAnother) {
  const auto end_of_box = [](bool crowd) {
    ByHand hand;
    hand.block(5.0, 5.0, 0.2, 0.1, 0.1, 0.1, 0.5, 0.3);
    if (crowd) {
      for (int i = 0; i < 30; ++i) hand.robot(-5.0 + 0.072 * (i % 6), -5.0 + 0.072 * (i / 6), i, kSpeed_m_s, 0.08);
    }
    hand.ticks(20);
    EXPECT_EQ(hand.accuracy().unsolved_sub_steps, 0U);
    return hand.z_m();
  };
  EXPECT_NEAR(end_of_box(true), end_of_box(false), 1e-9);
}

}  // namespace
}  // namespace tandem::core
