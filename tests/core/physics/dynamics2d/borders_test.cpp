// Bodies that pass from one solver to another, and contacts across the border between the two.
#include "tests/core/physics/dynamics2d/by_hand.hpp"

namespace tandem::core {
namespace {

void two_halves(FlatByHand& hand) {
  hand.region(west_half());
  hand.region(east_half());
}

TEST(Dynamics2dBorders, ARobotDrivesAcrossAsIfThereWereNone) {
  FlatByHand split;
  FlatByHand whole;
  two_halves(split);
  for (FlatByHand* hand : {&split, &whole}) hand->robot(-0.3, -0.1, 0.3, 0.1, 0.098);
  for (int i = 0; i < 80; ++i) {
    split.tick();
    whole.tick();
    ASSERT_EQ(split.state(), whole.state()) << i;
  }
  EXPECT_EQ(split.bodies().region[0], 1);
  EXPECT_GT(split.bodies().x_m[0], 0.3);
}

TEST(Dynamics2dBorders, AnObjectGlidesAcrossWithItsSpeedAndSpin) {
  FlatByHand split({{"box_linear_friction", "0.1", 0}, {"box_angular_friction", "0.001", 0}});
  FlatByHand whole({{"box_linear_friction", "0.1", 0}, {"box_angular_friction", "0.001", 0}});
  two_halves(split);
  for (FlatByHand* hand : {&split, &whole}) {
    hand->box(-0.25, 0.02, 0.1, 0.06, 0.3, 0.2);
    hand->object_motion().v_m_s = {0.4, 0.05, 0};
    hand->object_motion().w_rad_s = {0, 0, 1.5};
  }
  for (int i = 0; i < 40; ++i) {
    split.tick();
    whole.tick();
    ASSERT_NEAR(split.object().x_m, whole.object().x_m, 1e-5) << i;
    ASSERT_NEAR(split.object().y_m, whole.object().y_m, 1e-5) << i;
    ASSERT_NEAR(split.object().sin_h, whole.object().sin_h, 1e-5) << i;
    ASSERT_NEAR(split.object_motion().v_m_s[0], whole.object_motion().v_m_s[0], 1e-5) << i;
    ASSERT_NEAR(split.object_motion().w_rad_s[2], whole.object_motion().w_rad_s[2], 1e-4) << i;
  }
  EXPECT_EQ(split.stores().object_region[0], 1);
}

TEST(Dynamics2dBorders, TwoThatMeetHeadOnOverTheBorderOverlapNoMoreThanInOneRegion) {
  FlatByHand split;
  FlatByHand whole;
  two_halves(split);
  for (FlatByHand* hand : {&split, &whole}) {
    hand->robot(-0.2, 0, 0, 0.1288, 0.1288);
    hand->robot(0.2, 0, M_PI, 0.1288, 0.1288);
  }
  for (int i = 0; i < 60; ++i) {
    split.tick();
    whole.tick();
    for (std::size_t row = 0; row < 2; ++row)
      ASSERT_NEAR(split.bodies().x_m[row], whole.bodies().x_m[row], 1e-4) << row << " in tick " << i;
    ASSERT_LE(2 * kRadius_m - (split.bodies().x_m[1] - split.bodies().x_m[0]), 6e-4) << i;
  }
}

TEST(Dynamics2dBorders, ABoxIsPushedAcrossByARobotThatFollows) {
  FlatByHand split;
  FlatByHand whole;
  two_halves(split);
  for (FlatByHand* hand : {&split, &whole}) {
    hand->robot(-0.4, 0, 0, 0.1, 0.1);
    hand->box(-0.25, 0, 0.1, 0.2, 0.2);
  }
  for (int i = 0; i < 80; ++i) {
    const double last_m = split.object().x_m;
    split.tick();
    whole.tick();
    ASSERT_GE(split.object().x_m, last_m - 1e-5) << i;
    ASSERT_LE(split.object().x_m - last_m, 0.0105) << i;
    ASSERT_NEAR(split.object().x_m, whole.object().x_m, 2e-3) << i;
    ASSERT_NEAR(split.bodies().x_m[0], whole.bodies().x_m[0], 2e-3) << i;
  }
  EXPECT_EQ(split.bodies().region[0], 1);
  EXPECT_EQ(split.stores().object_region[0], 1);
}

TEST(Dynamics2dBorders, ABoxOnTheBorderIsPushedFromBothSides) {
  // Owned by the east, pushed eastwards by a robot of the west.
  FlatByHand hand;
  two_halves(hand);
  hand.box(0.051, 0, 0.1, 0.2, 0.2);
  hand.robot(-0.2, 0, 0, 0.1, 0.1);
  hand.ticks(40);
  EXPECT_GT(hand.object().x_m, 0.2);
  EXPECT_NEAR(hand.object().x_m - 0.05 - kRadius_m, hand.bodies().x_m[0], 2e-3);
}

}  // namespace
}  // namespace tandem::core
