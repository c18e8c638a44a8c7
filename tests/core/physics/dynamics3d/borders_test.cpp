// Bodies that pass from one solver to another.
#include "tests/core/physics/dynamics3d/by_hand.hpp"

namespace tandem::core {
namespace {

void two_halves(ByHand& hand) {
  hand.region(west_half());
  hand.region(east_half());
}

TEST(Dynamics3dBorders, ARobotDrivesAcrossAsIfThereWereNone) {
  ByHand split;
  ByHand whole;
  two_halves(split);
  for (ByHand* hand : {&split, &whole}) hand->robot(-0.3, -0.1, 0.3, 0.1, 0.098);
  for (int i = 0; i < 80; ++i) {
    split.tick();
    whole.tick();
    ASSERT_EQ(split.state(), whole.state()) << i;
  }
  EXPECT_EQ(split.bodies().region[0], 1);
}

TEST(Dynamics3dBorders, AnObjectFliesAcrossWithItsSpeedAndSpin) {
  ByHand split;
  ByHand whole;
  two_halves(split);
  for (ByHand* hand : {&split, &whole}) {
    hand->block(-0.5, 0.02, 1.0, 0.1, 0.06, 0.05, 0.3, 0.2);
    hand->object_motion().v_m_s = {0.8, 0.05, 2.0};
    hand->object_motion().w_rad_s = {0.3, -0.2, 1.5};
  }
  for (int i = 0; i < 9; ++i) {
    split.tick();
    whole.tick();
    const std::vector<double> a = split.state();
    const std::vector<double> b = whole.state();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], 1e-9) << i << " " << k;
  }
  EXPECT_EQ(split.stores().object_region[0], 1);
}

TEST(Dynamics3dBorders, ABoxSlidesAcrossAndRests) {
  ByHand split({}, {child("floor", {{"friction", "0.2", 4}})});
  ByHand whole({}, {child("floor", {{"friction", "0.2", 4}})});
  two_halves(split);
  for (ByHand* hand : {&split, &whole}) {
    hand->block(-0.1, 0, 0, 0.1, 0.1, 0.05, 0.3);
    hand->object_motion().v_m_s = {1.0, 0.0, 0.0};
  }
  split.ticks(30);
  whole.ticks(30);
  EXPECT_NEAR(split.object().x_m, whole.object().x_m, 1e-3);
  EXPECT_GT(split.object().x_m, 0.05);
  EXPECT_EQ(split.stores().object_region[0], 1);
}

TEST(Dynamics3dBorders, TwoThatMeetOverTheBorderOverlapNoMoreThanInOneRegion) {
  ByHand hand;
  two_halves(hand);
  hand.robot(-0.2, 0, 0, 0.1288, 0.1288);
  hand.robot(0.2, 0, M_PI, 0.1288, 0.1288);
  for (int i = 0; i < 60; ++i) {
    hand.tick();
    ASSERT_LE(2 * kRadius_m - (hand.bodies().x_m[1] - hand.bodies().x_m[0]), 2e-3) << i;
  }
  EXPECT_NEAR(hand.bodies().x_m[1] - hand.bodies().x_m[0], 2 * kRadius_m, 2e-3);
}

}  // namespace
}  // namespace tandem::core
