// Boxes that are tilted from the start: slopes, and what slides down them.
#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/ring_sensors.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/unit.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::core {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kSlope_rad = 0.4;
constexpr double kThick_m = 0.1;

/// A slope that falls towards +x, with a block on its middle; friction between them as given. Stepped `ticks` times.
struct OnSlope {
  OnSlope(double friction, int ticks, std::int64_t per_second) : scene(4.0) {
    scene.engine("dynamics3d", "", {{"default_friction", hal::format_number(friction), 100}});
    scene.scenario.ticks_per_second = per_second;
    scene.scenario.arena_size[2] = 4.0;
    scene.box(0.0, 0.0, 3.0, 0.6, 0.0, kThick_m);
    scene.scenario.objects.back().placement.p_W[2] = 1.0;
    scene.scenario.objects.back().placement.pitch_rad = kSlope_rad;
    // The middle of the base turns about itself: the block's base lies a thickness above it along the slope's normal.
    const double up_m = kThick_m + 1e-4;
    scene.box(up_m * std::sin(kSlope_rad), 0.0, 0.1, 0.1, 0.0, 0.05).movable(0.3);
    scene.scenario.objects.back().placement.p_W[2] = 1.0 + up_m * std::cos(kSlope_rad);
    scene.scenario.objects.back().placement.pitch_rad = kSlope_rad;
    scene.robot("far", -1.5, 1.5).wheels(0, 0);
    world = make(scene);
    if (!world.world) throw std::runtime_error(world.all_problems());
    from_m = block().x_m;
    for (int i = 0; i < ticks; ++i) world->step();
  }
  const Object& block() { return world->space().objects()[1]; }
  const Motion& motion() { return world->space().stores().object_motion[1]; }

  Scene scene;
  MadeWorld world;
  double from_m = 0.0;
};

TEST(Dynamics3dSlope, ABlockSlidesAsTheClosedFormHasIt) {
  for (const double friction : {0.0, 0.1, 0.25}) {
    OnSlope slope(friction, 100, 200);
    constexpr double kTime_s = 0.5;
    const double along_m_s2 = kGravity_m_s2 * (std::sin(kSlope_rad) - friction * std::cos(kSlope_rad));
    const double way_m = 0.5 * along_m_s2 * kTime_s * kTime_s;
    EXPECT_NEAR((slope.block().x_m - slope.from_m) / std::cos(kSlope_rad), way_m, 0.04 * way_m) << friction;
    EXPECT_NEAR(slope.motion().v_m_s[2], -along_m_s2 * kTime_s * std::sin(kSlope_rad), 0.04 * along_m_s2) << friction;
    const auto& q = slope.motion().q_WB;
    EXPECT_NEAR(2.0 * (q[0] * q[2] - q[3] * q[1]), std::sin(kSlope_rad), 0.01) << "it lies on the slope";
  }
}

TEST(Dynamics3dSlope, ABlockStaysWhereFrictionHoldsIt) {
  OnSlope slope(1.2 * std::tan(kSlope_rad), 1000, 50);
  EXPECT_NEAR(slope.block().x_m, slope.from_m, 2e-3);
}

TEST(Dynamics3dSlope, ATiltedBoxThatNothingHoldsFallsOnItsSide) {
  Scene scene(4.0);
  scene.engine("dynamics3d");
  scene.box(0, 0, 0.1, 0.1, 0.0, 0.4).movable(0.3).robot("far", -1.5, 1.5).wheels(0, 0);
  scene.scenario.objects.back().placement.p_W[2] = 0.05;
  scene.scenario.objects.back().placement.pitch_rad = 0.6;  // beyond atan(0.1 / 0.4)
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  for (int i = 0; i < 100; ++i) world->step();
  const auto& q = world->space().stores().object_motion[0].q_WB;
  EXPECT_NEAR(1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]), 0.0, 0.02);
  EXPECT_GT(world->space().objects()[0].x_m, 0.1);
}

/// Rays see the face of the slope where it is at their height; the closed form knows nothing of the sensor's code.
TEST(Dynamics3dSlope, RaysMeetIt) {
  for (const bool movable : {false, true}) {
    Scene scene(4.0, "everything");
    scene.engine("dynamics3d");
    // Its lower face meets the floor at x = 0.3; the upper face falls towards the robot.
    constexpr double kLong_m = 1.0;
    constexpr double kThin_m = 0.002;
    scene.box(0.3 + 0.5 * kLong_m * std::cos(kSlope_rad), 0.0, kLong_m, 1.0, 0.0, kThin_m);
    if (movable) scene.movable(50.0);
    ObjectItem& ramp = scene.scenario.objects.back();
    ramp.placement.p_W[2] = 0.5 * kLong_m * std::sin(kSlope_rad);
    ramp.placement.pitch_rad = -kSlope_rad;
    scene.robot("a", 0.26, 0.0);
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    world->step();
    const hal::ProximityPart& part = *hal::epuck::kind().part<hal::ProximityPart>();
    double face_m = 0.3 + (part.mounts[0].z_m - kThin_m / std::cos(kSlope_rad)) / std::tan(kSlope_rad);
    if (movable) {  // it has begun to fall
      const Object& fallen = world->space().objects()[0];
      const auto& q = world->space().stores().object_motion[0].q_WB;
      const double angle_rad = -2.0 * std::atan2(q[2], q[0]);
      EXPECT_LT(angle_rad, kSlope_rad - 0.01);
      const double above_m = 0.5 * (fallen.z_low_m + fallen.z_high_m) + 0.5 * kThin_m / std::cos(angle_rad);
      face_m = fallen.x_m - (above_m - part.mounts[0].z_m) / std::tan(angle_rad);
    }
    const Pose pose = world->space().pose(world->space().robot(0));
    const auto& port = *world->space().port<hal::Proximity>(world->space().robot(0));
    for (const std::size_t ray : {std::size_t{0}, std::size_t{7}}) {
      const double wanted_m = (face_m - pose.x_m - part.mounts[ray].x_m) / std::cos(part.mounts[ray].bearing_rad);
      ASSERT_LT(wanted_m, 0.1);
      EXPECT_NEAR(port.distance_m[ray], wanted_m, 1e-5) << movable << ray;
    }
    EXPECT_FLOAT_EQ(port.distance_m[3], 0.1F) << "looks away";
  }
}

TEST(Dynamics3dSlope, WhatOverlapsItIsRefusedAndNothingElse) {
  const auto refused = [](const auto& add) {
    Scene scene(4.0);
    scene.engine("dynamics3d");
    scene.scenario.arena_size[2] = 4.0;
    // From (-0.5, 0.1) to (0.5, 0.1 + tan 0.4) seen from the side, and 1 cm thick.
    scene.box(0.0, 0.0, 1.0 / std::cos(kSlope_rad), 1.0, 0.0, 0.01);
    scene.scenario.objects.back().placement.p_W[2] = 0.1 + 0.5 * std::tan(kSlope_rad);
    scene.scenario.objects.back().placement.pitch_rad = -kSlope_rad;
    scene.robot("far", -1.5, 1.5);
    add(scene);
    return make(scene).all_problems().find("overlaps box 'box0'") != std::string::npos;
  };
  const auto box_at = [&](double z_m) {
    return refused([&](Scene& scene) {
      scene.box(0.0, 0.0, 0.1, 0.1, 0.0, 0.05).movable(0.3);
      scene.scenario.objects.back().placement.p_W[2] = z_m;
    });
  };
  const double middle_m = 0.1 + 0.5 * std::tan(kSlope_rad);
  const double edge_m = 0.05 * std::tan(kSlope_rad);  // how far an edge of the box is above or below the middle
  EXPECT_FALSE(box_at(middle_m - edge_m - 0.05 - 1e-6)) << "below it";
  EXPECT_TRUE(box_at(middle_m - edge_m - 0.05 + 1e-6));
  EXPECT_TRUE(box_at(middle_m + edge_m + 0.01 / std::cos(kSlope_rad) - 1e-6));
  EXPECT_FALSE(box_at(middle_m + edge_m + 0.01 / std::cos(kSlope_rad) + 1e-6)) << "above it";
  const double face_m = -0.5 + (hal::epuck::kind().body.height_m - 0.1) / std::tan(kSlope_rad);
  const double rim_m = hal::epuck::kind().body.radius_m;
  const auto robot_at = [&](double x_m) { return refused([&](Scene& scene) { scene.robot("a", x_m, 0.0); }); };
  EXPECT_FALSE(robot_at(std::max(face_m, -0.5) + rim_m + 1e-3)) << "it stands below";
}

TEST(Dynamics3dSlope, OtherEnginesRefuseItWithItsLine) {
  for (const char* engine : {"kinematics2d", "dynamics2d"}) {
    Scene scene(4.0);
    scene.engine(engine).box(1.0, 0.0, 0.5, 0.5).robot("a", 0, 0);
    scene.scenario.objects.back().placement.pitch_rad = 0.5;
    scene.scenario.objects.back().line = 42;
    auto world = make(scene);
    EXPECT_FALSE(world.world);
    EXPECT_NE(world.all_problems().find("scene:42: error: 'box0' is tilted"), std::string::npos)
        << world.all_problems();
  }
}

}  // namespace
}  // namespace tandem::core
