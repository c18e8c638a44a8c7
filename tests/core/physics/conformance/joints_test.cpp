// What every engine promises of each kind of joint that its traits say it has: what it holds, limits, motors,
// reactions.
#include "tests/core/physics/conformance/engines.hpp"

namespace tandem::core {
namespace {

/// One kind of joint in one kind of engine.
struct Case {
  std::string engine;
  JointKind joint;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const KnownEngine* engine : test::catalog().all<KnownEngine>()) {
    for (const JointKind joint : {JointKind::Fixed, JointKind::Turning, JointKind::Sliding}) {
      if (engine->traits.has(bit(joint))) all.push_back({std::string(engine->kind), joint});
    }
  }
  return all;
}

std::string name_of_case(const testing::TestParamInfo<Case>& info) {
  return info.param.engine + "_" + words_of(bit(info.param.joint));
}

/// Two boxes on a line, 2 cm apart, so that their masses are all that joints work against; the engine's ground where it
/// has one to rub on is left without friction.
class Joints : public testing::TestWithParam<Case> {
 protected:
  void make_world(double mass_a_kg = 0.2, double mass_b_kg = 0.2) {
    Scene s(4.0);
    const bool plane = test::engine_traits(GetParam().engine).plane;
    s.engine(GetParam().engine, "",
             plane ? std::vector<Element::Attribute>{{"box_linear_friction", "0", 100}, {"friction", "0", 100}}
                   : std::vector<Element::Attribute>{{"default_friction", "0", 100}});
    s.box(-0.06, 0, 0.1, 0.1, 0.0, 0.1).movable(mass_a_kg).box(0.06, 0, 0.1, 0.1, 0.0, 0.1).movable(mass_b_kg);
    world_ = make(s);
    ASSERT_TRUE(world_.world) << world_.all_problems();
    world_->start();
  }
  Space& space() { return world_->space(); }
  JointId join(JointForm form, const std::array<double, 3>& p_W = {0.0, 0.0, 0.05}) {
    form.kind = GetParam().joint;
    const auto joint = space().join(space().object(0), space().object(1), p_W, form);
    EXPECT_TRUE(joint.ok()) << joint.error().message;
    return joint.ok() ? joint.value() : JointId{};
  }
  const Object& box(std::size_t i) { return space().objects()[i]; }
  double speed_x(std::size_t i) { return space().object_velocity(space().object(i)).v_m_s[0]; }
  void push(std::size_t i, const Velocity& velocity) {
    ASSERT_TRUE(space().set_object_velocity(space().object(i), velocity).ok());
  }
  double heading_rad(std::size_t i) { return std::atan2(box(i).sin_h, box(i).cos_h); }
  bool slides() const { return GetParam().joint == JointKind::Sliding; }
  bool turns() const { return GetParam().joint == JointKind::Turning; }

  MadeWorld world_;
};

TEST_P(Joints, LeaveTheOneFreedomThatTheirKindSays) {
  make_world();
  const JointId joint = join({.axis = {1.0, 0.0, 0.0}});
  push(1, {.v_m_s = {0.1, 0.1, 0.0}, .w_rad_s = {0.0, 0.0, 1.0}});
  steps(world_, 5);
  const double apart_m = std::hypot(box(1).x_m - box(0).x_m, box(1).y_m - box(0).y_m);
  const double between_rad = turned_rad(heading_rad(0), heading_rad(1));
  if (slides())
    EXPECT_GT(space().place(joint), 0.02);
  else
    EXPECT_NEAR(apart_m, 0.12, turns() ? 0.02 : 2e-3);
  if (turns()) {
    EXPECT_GT(std::fabs(between_rad), 0.1);
    EXPECT_NEAR(space().place(joint), between_rad, 1e-9);
  } else {
    EXPECT_NEAR(between_rad, 0.0, 0.02);
  }
  // Across the axis nothing gives way.
  const double across_m =
      -std::sin(heading_rad(0)) * (box(1).x_m - box(0).x_m) + std::cos(heading_rad(0)) * (box(1).y_m - box(0).y_m);
  if (!turns()) {
    EXPECT_NEAR(across_m, 0.0, 2e-3);
  }
}

TEST_P(Joints, PassOnWhatActsOnEitherBody) {
  make_world(0.2, 0.3);
  (void)join({.axis = {0.0, 1.0, 0.0}});
  push(0, {.v_m_s = {0.2, 0.0, 0.0}, .w_rad_s = {}});
  steps(world_, 1);
  // Both go on with their common momentum, whichever was pushed.
  for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(speed_x(i), 0.08, 0.01) << i;
  const double momentum = 0.2 * speed_x(0) + 0.3 * speed_x(1);
  EXPECT_NEAR(momentum, 0.04, 1e-3);
}

TEST_P(Joints, MotorsReachTheirSpeedAndPushBothBodiesAlike) {
  if (!slides() && !turns()) GTEST_SKIP() << "nothing moves";
  make_world(0.2, 0.4);
  const double most = slides() ? 0.5 : 0.02;
  const double speed = slides() ? 0.06 : 0.5;
  const JointId joint = join({.axis = {1.0, 0.0, 0.0}, .motor_most = most, .motor_speed = speed});
  steps(world_, 10);
  const double before = space().place(joint);
  steps(world_, 5);
  EXPECT_NEAR((space().place(joint) - before) / 0.5, speed, 0.03 * speed);
  if (slides()) {
    EXPECT_NEAR(0.2 * speed_x(0) + 0.4 * speed_x(1), 0.0, 1e-4);  // neither has anything else to push against
  }
  ASSERT_TRUE(space().drive(joint, 0.0).ok());
  steps(world_, 5);
  const double stopped = space().place(joint);
  steps(world_, 5);
  EXPECT_NEAR(space().place(joint), stopped, slides() ? 1e-3 : 5e-3);
}

TEST_P(Joints, MotorsAreNoStrongerThanTheyAre) {
  if (!slides()) GTEST_SKIP() << "measured along a line";
  make_world(0.2, 0.2);
  const JointId joint = join({.axis = {1.0, 0.0, 0.0}, .motor_most = 0.002, .motor_speed = 1.0});
  steps(world_, 10);
  // Each is pushed with 2 mN for a second.
  EXPECT_NEAR(speed_x(1), 0.01, 5e-4);
  EXPECT_NEAR(speed_x(0), -0.01, 5e-4);
  EXPECT_NEAR(space().place(joint), 0.01, 2e-3);
}

TEST_P(Joints, StopAtTheirLimits) {
  if (!slides() && !turns()) GTEST_SKIP() << "nothing moves";
  const double low = slides() ? -0.012 : -0.1;
  const double high = slides() ? 0.05 : 0.3;
  for (const double way : {1.0, -1.0}) {
    make_world();
    JointForm form{.axis = {1.0, 0.0, 0.0}, .limited = true, .low = low, .high = high};
    form.motor_most = slides() ? 0.3 : 0.02;
    form.motor_speed = way * (slides() ? 0.1 : 0.6);
    const JointId joint = join(form);
    steps(world_, 30);
    EXPECT_NEAR(space().place(joint), way > 0 ? high : low, slides() ? 2e-3 : 0.04) << way;
    EXPECT_NEAR(slides() ? speed_x(1) : space().object_velocity(space().object(1)).w_rad_s[2], 0.0, 5e-3) << way;
  }
}

TEST_P(Joints, OfABadFormAreRefused) {
  make_world();
  const auto error = [&](const JointForm& form) {
    const auto joint = space().join(space().object(0), space().object(1), {}, form);
    return joint.ok() ? std::string() : joint.error().message;
  };
  EXPECT_NE(error({.kind = JointKind::Sliding, .axis = {1.0, 1.0, 0.0}}).find("length 1"), std::string::npos);
  EXPECT_NE(error({.limited = true, .low = 1.0, .high = 0.0}).find("lower one first"), std::string::npos);
  EXPECT_NE(error({.kind = JointKind::Turning, .limited = true, .low = -4.0, .high = 0.0}).find("half a turn"),
            std::string::npos);
  EXPECT_NE(error({.motor_most = -1.0}).find("motor"), std::string::npos);
  const std::string lifted = error({.kind = JointKind::Sliding, .axis = {0.0, 0.0, 1.0}});
  const bool plane = test::engine_traits(GetParam().engine).plane;
  EXPECT_EQ(lifted.find("keeps bodies on the ground; use dynamics3d") != std::string::npos, plane) << lifted;
}

INSTANTIATE_TEST_SUITE_P(Physics, Joints, testing::ValuesIn(cases()), name_of_case);

// --- lifts ---

class Lifting : public testing::TestWithParam<std::string> {};

std::vector<std::string> kinds_that_lift() {
  std::vector<std::string> kinds;
  for (const KnownEngine* engine : test::catalog().all<KnownEngine>()) {
    if (!engine->traits.plane && engine->traits.has(bit(JointKind::Sliding))) kinds.emplace_back(engine->kind);
  }
  return kinds;
}

TEST_P(Lifting, AMotorRaisesALoadToItsLimitAndHoldsItThere) {
  Scene s(4.0);
  s.engine(GetParam());
  s.box(0, 0, 0.2, 0.2, 0.0, 0.1).movable(2.0).box(0.14, 0, 0.06, 0.06, 0.0, 0.06).movable(0.1);
  auto world = make(s);
  ASSERT_TRUE(world.world) << world.all_problems();
  Space& space = world->space();
  const auto lift = space.join(space.object(0), space.object(1), {0.11, 0.0, 0.03},
                               {.kind = JointKind::Sliding,
                                .axis = {0.0, 0.0, 1.0},
                                .limited = true,
                                .low = 0.0,
                                .high = 0.08,
                                .motor_most = 3.0,
                                .motor_speed = 0.02});
  ASSERT_TRUE(lift.ok()) << lift.error().message;
  world->start();
  steps(world, 20);
  EXPECT_NEAR(space.objects()[1].z_low_m, 0.04, 0.01);  // solvers that iterate leave it a little fast
  steps(world, 60);
  EXPECT_NEAR(space.objects()[1].z_low_m, 0.08, 2e-3);
  EXPECT_NEAR(space.place(lift.value()), 0.08, 2e-3);
  EXPECT_NEAR(space.objects()[0].z_low_m, 0.0, 1e-3);
  ASSERT_TRUE(space.drive(lift.value(), -0.02).ok());
  steps(world, 60);
  EXPECT_NEAR(space.objects()[1].z_low_m, 0.0, 2e-3);
}

TEST_P(Lifting, AMotorThatIsTooWeakLeavesTheLoadOnTheGround) {
  Scene s(4.0);
  s.engine(GetParam());
  s.box(0, 0, 0.2, 0.2, 0.0, 0.1).movable(2.0).box(0.14, 0, 0.06, 0.06, 0.0, 0.06).movable(0.4);
  auto world = make(s);
  Space& space = world->space();
  ASSERT_TRUE(space
                  .join(space.object(0), space.object(1), {0.11, 0.0, 0.03},
                        {.kind = JointKind::Sliding, .axis = {0.0, 0.0, 1.0}, .motor_most = 3.0, .motor_speed = 0.02})
                  .ok());
  world->start();
  steps(world, 30);
  EXPECT_NEAR(space.objects()[1].z_low_m, 0.0, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Physics, Lifting, testing::ValuesIn(kinds_that_lift()), name_of_kind);

// --- engines without ---

TEST(JointTraits, WhereAnEngineLacksAJointTheMessageNamesThoseThatHaveIt) {
  for (const KnownEngine* engine : test::catalog().all<KnownEngine>()) {
    if (engine->traits.joints != 0 || !engine->traits.plane) continue;
    Scene s(4.0);
    auto world = make(s.engine(std::string(engine->kind)).robot("a", 0, 0).robot("b", 0.2, 0));
    ASSERT_TRUE(world.world) << world.all_problems();
    Space& space = world->space();
    const auto joint = space.join(space.find_robot("a"), space.find_robot("b"), {0.1, 0, 0.02});
    ASSERT_FALSE(joint.ok());
    EXPECT_NE(joint.error().message.find("has no joints, but fixed ones are needed; use dynamics2d, dynamics3d"),
              std::string::npos)
        << joint.error().message;
  }
}

}  // namespace
}  // namespace tandem::core
