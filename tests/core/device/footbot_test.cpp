// The foot-bot's devices, in a whole world: closed forms, noise, and what is refused.
#include <cmath>
#include <complex>
#include <gmock/gmock.h>
#include <numbers>

#include "hal/angle.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

using hal::Role;
using testing::HasSubstr;

const double kR = hal::footbot::kind().body.radius_m;
constexpr double kPi = std::numbers::pi;

MadeWorld made(const Scene& scene, const WorldOptions& options = {}) {
  auto world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (world.world) world->start();
  return world;
}

Scene one(const std::string& engine = "dynamics2d") {
  Scene scene = footbot_scene(engine);
  add_footbot(scene, "fb", 0, 0);
  return scene;
}

// --- turret ---

TEST(Turret, TurnsWithTheCommandedSpeedAndStopsWhenOff) {
  auto world = made(one());
  command<hal::TurretDrive>(world, "fb").turn(0.5);
  steps(world, 10);
  EXPECT_NEAR(reading<hal::TurretEncoder>(world, "fb").angle_rad, 0.5, 1e-12);
  EXPECT_NEAR(reading<hal::TurretEncoder>(world, "fb").speed_rad_s, 0.5, 1e-6);
  command<hal::TurretDrive>(world, "fb").turn_off();
  steps(world, 5);
  EXPECT_NEAR(reading<hal::TurretEncoder>(world, "fb").angle_rad, 0.5, 1e-12);
  EXPECT_EQ(reading<hal::TurretEncoder>(world, "fb").speed_rad_s, 0.0F);
}

TEST(Turret, GoesToAnAngleTheShorterWayAndNoFasterThanItCan) {
  auto world = made(one());
  command<hal::TurretDrive>(world, "fb").go_to(0.9 * kPi);
  steps(world, 60);
  EXPECT_NEAR(reading<hal::TurretEncoder>(world, "fb").angle_rad, 0.9 * kPi, 1e-12);
  command<hal::TurretDrive>(world, "fb").go_to(-0.9 * kPi);  // 36 degrees through the back
  world->step();
  EXPECT_NEAR(reading<hal::TurretEncoder>(world, "fb").speed_rad_s,
              hal::footbot::kind().part<hal::TurretPart>()->turn_rad_s, 1e-6);
  steps(world, 3);
  EXPECT_NEAR(reading<hal::TurretEncoder>(world, "fb").angle_rad, -0.9 * kPi, 1e-12);
}

TEST(Turret, ClampsSpeedsAndIsOffAtWhatIsNoNumber) {
  auto world = made(one());
  command<hal::TurretDrive>(world, "fb").turn(100.0);
  world->step();  // filtered at the end of this tick
  const double before = reading<hal::TurretEncoder>(world, "fb").angle_rad;
  world->step();
  EXPECT_NEAR(hal::wrapped(reading<hal::TurretEncoder>(world, "fb").angle_rad - before),
              hal::footbot::kind().part<hal::TurretPart>()->turn_rad_s * 0.1, 1e-12);
  EXPECT_EQ(world->incidents().commands_clamped, 1U);
  command<hal::TurretDrive>(world, "fb").angle_rad = std::nan("");
  world->step();
  EXPECT_EQ(command<hal::TurretDrive>(world, "fb").mode, hal::TurretMode::Off);
  EXPECT_EQ(world->incidents().commands_not_finite, 1U);
  ASSERT_FALSE(world->incidents().first().empty());
  EXPECT_THAT(world->incidents().first()[0], HasSubstr("robot 'fb' commanded something that is not a finite number"));
}

TEST(Turret, NoiseIsCentredAndAsLargeAsAsked) {
  Scene scene = one();
  choose(scene, "turret", Role::Actuator, "default", {{"noise_std_dev", "0.1", 11}});
  choose(scene, "turret_encoder", Role::Sensor, "default", {{"noise_range", "0.02", 11}});
  auto world = made(scene);
  command<hal::TurretDrive>(world, "fb").turn(1.0);
  double sum = 0.0, squares = 0.0, error = 0.0, worst = 0.0;
  for (int i = 0; i < 4000; ++i) {
    world->step();
    const double turned = reading<hal::TurretEncoder>(world, "fb").speed_rad_s - 1.0F;
    sum += turned;
    squares += turned * turned;
    const Space& space = world->space();
    const double off =
        hal::wrapped(reading<hal::TurretEncoder>(world, "fb").angle_rad - space.turret_rad(space.find_robot("fb")));
    error += off;
    worst = std::max(worst, std::fabs(off));
  }
  EXPECT_NEAR(sum / 4000, 0.0, 0.006);
  EXPECT_NEAR(std::sqrt(squares / 4000), 0.1, 0.005);
  EXPECT_NEAR(error / 4000, 0.0, 0.0008);
  EXPECT_LE(worst, 0.02);
  EXPECT_GT(worst, 0.019);
}

// --- distance scanner ---

/// Distance along a ray from the axis of robot `self` by small steps: slow, plain, sharing no code with the sensor.
double marched(const Scene& scene, const MadeWorld& world, const std::string& self, double bearing, double most_m) {
  const Pose me = pose_of(world, self);
  const double angle = me.heading_rad() + bearing;
  for (double t = 0.0; t < most_m; t += 2e-5) {
    const double x = me.x_m + t * std::cos(angle);
    const double y = me.y_m + t * std::sin(angle);
    for (const RobotItem& item : scene.scenario.robots) {
      const Pose other = pose_of(world, item.id);
      if (item.id != self && std::hypot(x - other.x_m, y - other.y_m) <= kR) return t;
    }
    for (const ObjectItem& o : scene.scenario.objects) {
      const double rx = x - o.placement.p_W[0];
      const double ry = y - o.placement.p_W[1];
      const double yaw = o.placement.yaw_rad;
      if (o.shape == ShapeKind::Cylinder) {
        if (std::hypot(rx, ry) <= o.size[0]) return t;
      } else if (std::fabs(rx * std::cos(yaw) + ry * std::sin(yaw)) <= o.size[0] / 2 &&
                 std::fabs(ry * std::cos(yaw) - rx * std::sin(yaw)) <= o.size[1] / 2) {
        return t;
      }
    }
  }
  return most_m;
}

TEST(DistanceScanner, MeasuresAlongEveryHeadWhileItTurns) {
  Scene scene = footbot_scene("dynamics2d", 4.0);
  add_footbot(scene, "fb", -0.2, 0.1, 0.7);
  add_footbot(scene, "other", 0.4, 0.5);
  add_footbot(scene, "near", -0.35, 0.25);
  scene.box(1.0, -0.3, 0.3, 0.8, 0.4).cylinder(-0.3, -0.7, 0.2).cylinder(-1.5, 0.2, 0.1).walls();
  auto world = made(scene);
  command<hal::ScannerDrive>(world, "fb").turn(kPi);  // 30 turns a minute
  int seen = 0, nothing = 0;
  for (int tick = 0; tick < 20; ++tick) {
    world->step();
    const auto& port = reading<hal::DistanceScanner>(world, "fb");
    ASSERT_EQ(port.samples, 6U) << "60 a second, ten ticks a second";
    for (std::size_t head = 0; head < 4; ++head) {
      const auto& kind = hal::footbot::kind().part<hal::ScannerPart>()->heads[head];
      for (std::size_t k = 0; k < 6; ++k) {
        const double expected = std::max(marched(scene, world, "fb", port.angle(head, k), kind.max_m), kind.min_m);
        EXPECT_NEAR(port.distance(head, k), expected, 1e-4) << "head " << head << ", sample " << k;
        EXPECT_NEAR(std::remainder(static_cast<double>(port.angle(head, k)) - kind.bearing_rad -
                                       kPi * 0.1 * (tick + (static_cast<double>(k) + 1) / 6.0),
                                   2 * kPi),
                    0.0, 1e-5);
        seen += port.sees_nothing(head, k) ? 0 : 1;
        nothing += port.sees_nothing(head, k) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(seen, 100) << "the scene is no test otherwise";
  EXPECT_GT(nothing, 50);
}

TEST(DistanceScanner, InPositionModeMeasuresOnceWhereItStands) {
  Scene scene = one();
  scene.box(1.0, 0, 0.2, 2.0);
  auto world = made(scene);
  steps(world, 1);
  EXPECT_EQ(reading<hal::DistanceScanner>(world, "fb").count, 0U) << "off";
  command<hal::ScannerDrive>(world, "fb").go_to(-0.5 * kPi);  // turns head 1, for long distances, forward
  steps(world, 10);
  const auto& port = reading<hal::DistanceScanner>(world, "fb");
  EXPECT_EQ(port.samples, 1U);
  EXPECT_EQ(port.count, 4U);
  EXPECT_NEAR(port.turn_rad, -0.5 * kPi, 1e-6);
  EXPECT_NEAR(port.angle(1, 0), 0.0, 1e-6);
  EXPECT_NEAR(port.distance(1, 0), 0.9, 1e-5);
  EXPECT_TRUE(port.sees_nothing(3, 0));
  EXPECT_NEAR(port.distance(3, 0), 1.5, 1e-6);
  EXPECT_TRUE(port.sees_nothing(0, 0));
}

TEST(DistanceScanner, ReadsItsLeastWhereSomethingIsTooNear) {
  Scene scene = one();
  scene.box(0.2, 0, 0.1, 1.0);  // its face is 15 cm from the axis
  auto world = made(scene);
  command<hal::ScannerDrive>(world, "fb").go_to(-0.5 * kPi);
  steps(world, 10);
  EXPECT_TRUE(reading<hal::DistanceScanner>(world, "fb").too_near(1, 0));
  EXPECT_NEAR(reading<hal::DistanceScanner>(world, "fb").distance(1, 0), 0.2, 1e-6);
  command<hal::ScannerDrive>(world, "fb").go_to(0.0);
  steps(world, 10);
  EXPECT_NEAR(reading<hal::DistanceScanner>(world, "fb").distance(0, 0), 0.15, 1e-5);
}

TEST(DistanceScanner, DoesNotSeeWhatIsLowerThanItself) {
  Scene scene = one();
  scene.box(0.3, 0, 0.2, 1.0, 0.0, 0.1);
  auto world = made(scene);
  command<hal::ScannerDrive>(world, "fb").go_to(0.1);
  steps(world, 5);
  EXPECT_TRUE(reading<hal::DistanceScanner>(world, "fb").sees_nothing(0, 0));
}

TEST(DistanceScanner, NoiseIsCentredAndBounded) {
  Scene scene = one();
  scene.box(1.0, 0, 0.2, 2.0);
  choose(scene, "distance_scanner", Role::Sensor, "rot_z_only", {{"noise_range", "3", 11}});
  auto world = made(scene);
  command<hal::ScannerDrive>(world, "fb").go_to(-0.5 * kPi);
  steps(world, 10);
  double sum = 0.0, worst = 0.0;
  for (int i = 0; i < 3000; ++i) {
    world->step();
    const double error = static_cast<double>(reading<hal::DistanceScanner>(world, "fb").distance(1, 0)) - 0.9;
    sum += error;
    worst = std::max(worst, std::fabs(error));
  }
  EXPECT_NEAR(sum / 3000, 0.0, 0.001);
  EXPECT_LE(worst, 0.0301);
  EXPECT_GT(worst, 0.029);
}

// --- ground ---

TEST(FootbotGround, EachSensorReadsTheFloorBeneathIt) {
  Scene scene = footbot_scene();
  add_footbot(scene, "edge", 0, 0, 0.0);          // forward half over white
  add_footbot(scene, "turned", 0, 1, 0.5 * kPi);  // right half over white
  scene.field("floor", {{"source", "loop_functions", 5}});
  HookConfig hook;
  hook.library = "test_hooks";
  hook.label = "diary";  // white where x > 0, else black
  hook.options.attributes = {{"path", "/dev/null", 0}};
  scene.scenario.hooks.push_back(hook);
  auto world = made(scene);
  steps(world, 1);
  for (const std::string id : {"edge", "turned"}) {
    const auto& base = reading<hal::BaseGround>(world, id);
    const auto& motor = reading<hal::MotorGround>(world, id);
    ASSERT_EQ(base.count, 8U);
    ASSERT_EQ(motor.count, 4U);
    for (std::size_t k = 0; k < 8; ++k) {
      const hal::Mount& m = hal::footbot::kind().part<hal::BaseGroundPart>()->mounts[k];
      const double x = id == "edge" ? m.x_m : -m.y_m;
      if (std::fabs(x) > 0.01) {
        EXPECT_EQ(base.reflectance[k], x > 0.0 ? 1.0F : 0.0F) << id << " " << k;
      }
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const hal::Mount& m = hal::footbot::kind().part<hal::MotorGroundPart>()->mounts[k];
      const double x = id == "edge" ? m.x_m : -m.y_m;
      if (std::fabs(x) > 0.011) {
        EXPECT_EQ(motor.reflectance[k], x > 0.0 ? 1.0F : 0.0F) << id << " " << k;
      }
    }
  }
}

TEST(FootbotGround, TheTwoGroupsScatterOnTheirOwn) {
  Scene scene = one();
  choose(scene, "base_ground", Role::Sensor, "rot_z_only", {{"noise_level", "0.1", 11}});
  choose(scene, "motor_ground", Role::Sensor, "rot_z_only", {{"noise_level", "0.1", 11}});
  auto world = made(scene);
  double sum = 0.0, worst = 0.0;
  int equal = 0;
  for (int i = 0; i < 1000; ++i) {
    world->step();
    const auto& base = reading<hal::BaseGround>(world, "fb");
    const auto& motor = reading<hal::MotorGround>(world, "fb");
    for (std::size_t k = 0; k < 4; ++k) {
      sum += static_cast<double>(base.reflectance[k]) - 0.5;
      worst = std::max(worst, std::fabs(static_cast<double>(motor.reflectance[k]) - 0.5));
      equal += base.reflectance[k] == motor.reflectance[k] ? 1 : 0;
    }
  }
  EXPECT_NEAR(sum / 4000, 0.0, 0.005);
  EXPECT_LE(worst, 0.1 + 1e-6);
  EXPECT_GT(worst, 0.099);
  EXPECT_LT(equal, 5);
}

// --- proximity, light ---

TEST(FootbotRing, SeesAWallAheadWithItsTwoFrontSensors) {
  Scene scene = one();
  scene.box(0.2, 0, 0.1, 2.0);  // its face is at x = 0.15
  auto world = made(scene);
  steps(world, 1);
  const auto& port = reading<hal::Proximity>(world, "fb");
  ASSERT_EQ(port.count, 24U);
  const double bearing = 7.5 * kPi / 180.0;
  const double expected = 0.15 / std::cos(bearing) - kR;
  EXPECT_NEAR(port.distance_m[0], expected, 1e-6);
  EXPECT_NEAR(port.distance_m[23], expected, 1e-6);
  EXPECT_EQ(port.distance_m[6], port.range_m);
  EXPECT_EQ(port.distance_m[12], port.range_m);
}

TEST(FootbotRing, TheSensorThatFacesALampReadsMost) {
  Scene scene = one();
  LightItem lamp;
  lamp.id = "lamp";
  lamp.p_W = {0.0, 1.0, 0.5};
  lamp.intensity = 0.5;
  scene.scenario.lights.push_back(lamp);
  auto world = made(scene);
  steps(world, 1);
  const auto& port = reading<hal::Light>(world, "fb");
  ASSERT_EQ(port.count, 24U);
  const auto brightest = std::max_element(port.level.begin(), port.level.end()) - port.level.begin();
  EXPECT_TRUE(brightest == 5 || brightest == 6) << "at 82.5 and 97.5 degrees";
  EXPECT_EQ(port.level[18], 0.0F);
}

// --- wheels, odometry, inertia ---

TEST(FootbotWheels, OdometryReckonsACircleExactly) {
  auto world = made(one());
  command<hal::WheelSpeeds>(world, "fb").set(0.05, 0.07);
  steps(world, 100);
  const double turn = 0.02 / hal::footbot::kind().drive()->wheel_base_m * 10.0;
  const double radius = 0.06 / (0.02 / hal::footbot::kind().drive()->wheel_base_m);
  const auto& port = reading<hal::Odometry>(world, "fb");
  EXPECT_NEAR(port.x_m, radius * std::sin(turn), 1e-9);
  EXPECT_NEAR(port.y_m, radius * (1.0 - std::cos(turn)), 1e-9);
  EXPECT_NEAR(port.heading_rad, hal::wrapped(turn), 1e-9);
  EXPECT_NEAR(pose_of(world, "fb").x_m, port.x_m, 2e-3) << "the engine goes by chords";
}

TEST(FootbotWheels, OdometryErrorsAddUpLikeARandomWalk) {
  Scene scene = footbot_scene("dynamics2d", 12.0);
  for (int i = 0; i < 200; ++i) add_footbot(scene, "fb" + std::to_string(i), 0.5 * (i % 20) - 5, 0.5 * (i / 20) - 3);
  choose(scene, "odometry", Role::Sensor, "default", {{"dist_noise_range", "0.1", 11}});
  auto world = made(scene);
  steps(world, 100);
  double squares = 0.0;
  for (int i = 0; i < 200; ++i)
    squares += std::pow(reading<hal::Odometry>(world, "fb" + std::to_string(i)).heading_rad, 2);
  // A hundred draws of two uniform errors of +-1 mm over the wheel base.
  const double expected = std::sqrt(100 * 2 * 1e-6 / 3.0) / hal::footbot::kind().drive()->wheel_base_m;
  EXPECT_NEAR(std::sqrt(squares / 200), expected, 0.12 * expected);
}

/// Robots that all drive at one speed with the slanted treels: their drawn factors.
std::vector<double> slants(int robots, double speed_m_s, bool expect_left) {
  Scene scene = footbot_scene("dynamics2d", 30.0);
  for (int i = 0; i < robots; ++i)
    add_footbot(scene, "fb" + std::to_string(i), 0.5 * (i % 50) - 12, 0.5 * (i / 50) - 12);
  choose(scene, "differential_steering", Role::Actuator, "slanted");
  auto world = made(scene);
  for (int i = 0; i < robots; ++i) command<hal::WheelSpeeds>(world, "fb" + std::to_string(i)).set(speed_m_s, speed_m_s);
  steps(world, 5);
  std::vector<double> drawn;
  const Bodies& b = world->space().stores().bodies;
  for (int i = 0; i < robots; ++i) {
    const std::string id = "fb" + std::to_string(i);
    const std::size_t row = world->space().stores().row_of(world->space().find_robot(id));
    const double as_told = expect_left ? b.right_m_s[row] : b.left_m_s[row];
    const double drawn_to = expect_left ? b.left_m_s[row] : b.right_m_s[row];
    EXPECT_EQ(as_told, speed_m_s);
    drawn.push_back(drawn_to / speed_m_s - 1.0);
    const auto& encoders = reading<hal::WheelEncoders>(world, id);
    EXPECT_NEAR(encoders.left_m, encoders.right_m, 1e-12) << "the encoders see nothing of it";
    EXPECT_NEAR(encoders.right_m, 0.5 * speed_m_s, 1e-12);
    EXPECT_NEAR(encoders.left_m_s, speed_m_s, 1e-8);
    EXPECT_NEAR(encoders.right_m_s, speed_m_s, 1e-8);
    EXPECT_NEAR(reading<hal::Odometry>(world, id).heading_rad, 0.0, 1e-12);
  }
  return drawn;
}

TEST(SlantedTreels, AreDrawnFromARayleighDistributionGoingForwardAndBackward) {
  constexpr double kSigma = 0.0134;
  for (const bool backward : {false, true}) {
    std::vector<double> drawn = slants(1000, backward ? -0.1 : 0.1, backward);
    double sum = 0.0, squares = 0.0;
    for (const double d : drawn) {
      EXPECT_GE(d, 0.0) << "the right treel runs faster forward, the left one backward";
      sum += d;
      squares += d * d;
    }
    EXPECT_NEAR(sum / 1000, kSigma * std::sqrt(kPi / 2), 0.0007);
    EXPECT_NEAR(squares / 1000, 2 * kSigma * kSigma, 0.05 * 2 * kSigma * kSigma * 2);
    std::sort(drawn.begin(), drawn.end());
    EXPECT_NEAR(drawn[500], kSigma * std::sqrt(2 * std::log(2.0)), 0.0015) << "the median";
  }
}

/// A foot-bot with strongly slanted treels, and the factor that was drawn for it.
struct Slanted {
  MadeWorld world;
  double mu = 0.0;

  explicit Slanted(const std::string& engine = "dynamics2d") {
    Scene scene = footbot_scene(engine, 8.0);
    add_footbot(scene, "fb", 0, 0);
    choose(scene, "differential_steering", Role::Actuator, "slanted", {{"sigma", "0.05", 11}});
    world = made(scene);
    drive(0.1, 1);
    mu = world->space().state<HiddenRoll>(world->space().find_robot("fb"))->right_m_s / 0.1;
    drive(-0.1, 1);
    world->space().set_pose(world->space().find_robot("fb"), Pose::at(0.0, 0.0, 0.0));
  }
  void drive(double speed_m_s, int ticks) {
    command<hal::WheelSpeeds>(world, "fb").set(speed_m_s, speed_m_s);
    steps(world, ticks);
  }
  double turn_rad(double way_m) const { return mu * way_m / hal::footbot::kind().drive()->wheel_base_m; }
  double curvature() const { return mu / (hal::footbot::kind().drive()->wheel_base_m * (1.0 + 0.5 * mu)); }
  std::size_t row() const { return world.world->space().stores().row_of(world.world->space().find_robot("fb")); }
};

// A way of L by the encoders is an arc of L (1 + mu / 2) that turns the robot by a = mu L / b to its left, b its wheel
// base. So its curvature is k = mu / (b (1 + mu / 2)), and with places as complex numbers it ends at (e^ia - 1) / (i
// k).

TEST(SlantedTreels, DrawToTheLeftOfTheRobotForwardAndToItsRightBackward) {
  for (const double speed : {0.1, -0.1}) {
    Slanted robot;
    ASSERT_GT(robot.mu, 0.005);
    robot.drive(speed, 100);
    const Pose end = pose_of(robot.world, "fb");  // both together: an S through the start
    const double turn_rad = robot.turn_rad(1.0);
    EXPECT_NEAR(end.x_m, std::copysign(std::sin(turn_rad) / robot.curvature(), speed), 0.01);
    EXPECT_NEAR(end.y_m, std::copysign((1.0 - std::cos(turn_rad)) / robot.curvature(), speed), 0.01);
    EXPECT_NEAR(end.heading_rad(), turn_rad, 0.02 * turn_rad);
  }
}

TEST(SlantedTreels, LeadBackAlongAnotherArcThanThere) {
  for (const std::string engine : {"dynamics2d", "dynamics3d"}) {
    Slanted robot(engine);
    robot.drive(0.1, 100);
    robot.drive(-0.1, 100);
    // The second arc starts in the opposite direction, turned by a.
    const std::complex<double> i(0.0, 1.0);
    const std::complex<double> turn = std::exp(i * robot.turn_rad(1.0));
    const std::complex<double> arc = (turn - 1.0) / (i * robot.curvature());
    const std::complex<double> end = arc - turn * arc;
    const Pose pose = pose_of(robot.world, "fb");
    ASSERT_GT(std::abs(end), 0.04);
    EXPECT_NEAR(pose.x_m, end.real(), 0.02 * std::abs(end)) << engine;
    EXPECT_NEAR(pose.y_m, end.imag(), 0.02 * std::abs(end)) << engine;
    EXPECT_NEAR(pose.heading_rad(), 2.0 * robot.turn_rad(1.0), 0.04 * robot.turn_rad(1.0)) << engine;
  }
}

TEST(FootbotBody, GyroscopeAndAccelerometerFeelACircle) {
  for (const std::string engine : {"dynamics2d", "dynamics3d"}) {
    auto world = made(one(engine));
    command<hal::WheelSpeeds>(world, "fb").set(0.08, 0.12);
    steps(world, 30);
    const double turn = 0.04 / hal::footbot::kind().drive()->wheel_base_m;
    const auto& gyroscope = reading<hal::Gyroscope>(world, "fb");
    EXPECT_NEAR(gyroscope.rate_rad_s[2], turn, 0.02 * turn) << engine;
    EXPECT_NEAR(gyroscope.rate_rad_s[0], 0.0, 0.02) << engine;
    const auto& accelerometer = reading<hal::Accelerometer>(world, "fb");
    EXPECT_NEAR(accelerometer.force_m_s2[1], 0.1 * turn, 1e-6) << engine;
    EXPECT_NEAR(accelerometer.force_m_s2[2], 9.81, 1e-6) << engine;
  }
}

TEST(FootbotBody, GyroscopeNoiseIsAsLargeAsAsked) {
  Scene scene = one();
  choose(scene, "gyroscope", Role::Sensor, "default", {{"noise_level", "0.1", 11}});
  auto world = made(scene);
  double squares = 0.0;
  for (int i = 0; i < 2000; ++i) {
    world->step();
    for (const float rate : reading<hal::Gyroscope>(world, "fb").rate_rad_s)
      squares += static_cast<double>(rate) * static_cast<double>(rate);
  }
  EXPECT_NEAR(std::sqrt(squares / 6000), 0.1, 0.004);
}

TEST(FootbotBattery, DischargesByTimeAndByMotion) {
  Scene scene = one();
  scene.scenario.robots.back().battery = {"time_motion", 1.0, 1.0, 0.001, 0.1, 0.01};
  auto world = made(scene);
  command<hal::WheelSpeeds>(world, "fb").set(0.1, 0.1);
  steps(world, 101);  // the wheels turn from the first tick on, for the command was there before
  EXPECT_NEAR(reading<hal::Battery>(world, "fb").charge, 1.0 - 101 * 0.001 - 0.1 * 0.1 * 10.1, 1e-5);
}

// --- in all ---

TEST(FootbotDevices, NoisyOnesAllWorkTogetherAndAlikeForAnyNumberOfThreads) {
  std::uint64_t first = 0;
  for (const std::int64_t threads : {1, 2, 4}) {
    Scene scene = footbot_scene("dynamics2d", 8.0);
    for (int i = 0; i < 300; ++i) {
      add_footbot(scene, "fb" + std::to_string(i), 0.3 * (i % 20) - 3, 0.3 * (i / 20) - 2.2, 0.1 * i);
    }
    scene.cylinder(3, 3, 0.3).walls();
    ControllerConfig& config = scene.scenario.controllers.back();
    for (DeviceChoice& choice : config.sensors) choice.implementation = "noisy";
    for (DeviceChoice& choice : config.actuators) {
      if (choice.device != "leds") choice.implementation = "noisy";
    }
    WorldOptions options;
    options.threads = threads;
    auto world = made(scene, options);
    for (int i = 0; i < 300; ++i) {
      const std::string id = "fb" + std::to_string(i);
      command<hal::WheelSpeeds>(world, id).set(0.1, 0.05 + 0.0002 * i);
      command<hal::TurretDrive>(world, id).turn(0.01 * i - 1.0);
      command<hal::ScannerDrive>(world, id).turn(3.0);
      command<hal::GripperDrive>(world, id).lock();
    }
    steps(world, 40);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    int holding = 0;
    for (int i = 0; i < 300; ++i) holding += reading<hal::Gripper>(world, "fb" + std::to_string(i)).holding ? 1 : 0;
    EXPECT_GT(holding, 10) << "the scene is no test of grippers otherwise";
    if (first == 0) first = world->state_hash();
    EXPECT_EQ(world->state_hash(), first) << threads << " threads";
  }
}

TEST(FootbotDevices, BadOptionsAreErrorsWithTheirLine) {
  const struct {
    const char* device;
    Role role;
    Element::Attribute option;
  } kBad[] = {{"turret", Role::Actuator, {"noise_std_dev", "-1", 11}},
              {"gripper", Role::Actuator, {"failure_prob", "1.5", 11}},
              {"distance_scanner", Role::Sensor, {"noise_range", "-2", 11}},
              {"turret_encoder", Role::Sensor, {"noise_rang", "0.1", 11}},
              {"base_ground", Role::Sensor, {"noise_level", "2", 11}},
              {"gyroscope", Role::Sensor, {"noise_level", "much", 11}},
              {"odometry", Role::Sensor, {"dist_noise_range", "-0.1", 11}}};
  for (const auto& bad : kBad) {
    Scene scene = one();
    choose(scene, bad.device, bad.role, "default", {bad.option});
    const auto world = make(scene);
    EXPECT_FALSE(world.world) << bad.device;
    EXPECT_THAT(world.all_problems(), HasSubstr("scene:11: error: ")) << bad.device;
    EXPECT_THAT(world.all_problems(), HasSubstr(bad.option.name)) << bad.device;
  }
  Scene scene = one();
  choose(scene, "differential_steering", Role::Actuator, "slanted", {{"sigma", "-0.1", 11}});
  EXPECT_THAT(make(scene).all_problems(), HasSubstr("sigma"));
}

TEST(FootbotDevices, AnEpuckHasNoneOfThem) {
  Scene scene = one();
  scene.scenario.robots.back().kind = "e-puck";
  scene.scenario.controllers[0].line = 7;
  const auto world = make(scene);
  EXPECT_FALSE(world.world);
  for (const char* device : {"turret", "gripper", "distance_scanner", "base_ground", "motor_ground", "gyroscope"})
    EXPECT_THAT(world.all_problems(),
                HasSubstr("scene:7: error: the robot 'e-puck' has no device '" + std::string(device) +
                          "'; take it out of the controller configuration 'c"))
        << device;
}

// --- twins of real robots ---

/// Two real foot-bots and a simulated one, each in sight of the others, all within reach of their proximity sensors.
class AmongTwins : public testing::Test {
 protected:
  void SetUp() override {
    Scene scene = footbot_scene();
    add_footbot(scene, "r1", 0.0, 0.0);
    add_footbot(scene, "r2", 2.0 * kR + 0.04, 0.0);
    add_footbot(scene, "sim", 0.0, 2.0 * kR + 0.04);
    world_ = made(scene);
    for (const char* id : {"r1", "r2"}) world_->space().set_external(robot(id), true);
    for (const char* id : {"r1", "r2", "sim"}) command<hal::RangeAndBearingSend>(world_, id).say(7);
  }
  RobotId robot(const std::string& id) const { return world_.world->space().find_robot(id); }
  void sense_really(const std::string& id, std::uint8_t senses) { world_->space().set_real_senses(robot(id), senses); }
  /// Which sides see something.
  std::string seen_by(const std::string& id) const {
    const auto& port = reading<hal::Proximity>(world_, id);
    std::string sides;
    const auto seen = [&](std::size_t i) { return port.distance_m[i] < port.range_m; };
    if (seen(0) || seen(port.count - 1)) sides += "front ";
    if (seen(port.count / 4) || seen(port.count / 4 - 1)) sides += "left ";
    return sides;
  }
  MadeWorld world_;
};

TEST_F(AmongTwins, WithoutSensesOfItsOwnATwinSensesAll) {
  steps(world_, 2);
  EXPECT_EQ(seen_by("r1"), "front left ");
  EXPECT_EQ(reading<hal::RangeAndBearing>(world_, "r1").count, 2U);
}

TEST_F(AmongTwins, WhatTheRobotSensesItselfOfRealRobotsIsLeftOut) {
  for (const char* id : {"r1", "r2"}) sense_really(id, bit(RealSense::Proximity) | bit(RealSense::Messages));
  steps(world_, 2);
  EXPECT_EQ(seen_by("r1"), "left ");  // the simulated one
  EXPECT_EQ(reading<hal::RangeAndBearing>(world_, "r1").count, 1U);
  EXPECT_EQ(reading<hal::RangeAndBearing>(world_, "r2").count, 1U);
  EXPECT_EQ(seen_by("sim"), "");  // others are behind and to its right
  EXPECT_EQ(reading<hal::RangeAndBearing>(world_, "sim").count, 2U);
}

TEST_F(AmongTwins, MessagesBetweenRobotsOfWhichOneHasNoBoardAreRelayed) {
  sense_really("r1", bit(RealSense::Messages));
  steps(world_, 2);
  EXPECT_EQ(reading<hal::RangeAndBearing>(world_, "r1").count, 2U);
  EXPECT_EQ(reading<hal::RangeAndBearing>(world_, "r2").count, 2U);
}

TEST_F(AmongTwins, AScannerLeavesOutWhatTheRealOneSees) {
  command<hal::ScannerDrive>(world_, "r1").go_to(0.0);
  *world_->space().state<ScannerState>(robot("r1")) = {hal::ScannerMode::Position, 0.0, 0.0};
  steps(world_, 2);
  const auto& scan = reading<hal::DistanceScanner>(world_, "r1");
  ASSERT_EQ(scan.samples, 1U);
  EXPECT_FALSE(scan.sees_nothing(0, 0));
  EXPECT_FALSE(scan.sees_nothing(1, 0));
  sense_really("r1", bit(RealSense::Scanner));
  world_->step();
  EXPECT_TRUE(scan.sees_nothing(0, 0));   // ahead: the real one
  EXPECT_FALSE(scan.sees_nothing(1, 0));  // left: the simulated one
}

TEST_F(AmongTwins, MechanismsStandWhereTheyWerePutAndObeyNoCommand) {
  Space& space = world_->space();
  space.state<TurretState>(robot("r1"))->angle_rad = 0.7;
  space.state<GripState>(robot("r1"))->aperture_rad = 1.0;
  command<hal::TurretDrive>(world_, "r1").turn(1.0);
  steps(world_, 5);
  EXPECT_NEAR(reading<hal::TurretEncoder>(world_, "r1").angle_rad, 0.7, 1e-12);
  EXPECT_NEAR(space.turret_rad(robot("r1")), 0.7, 1e-12);
  EXPECT_FLOAT_EQ(reading<hal::Gripper>(world_, "r1").aperture_rad, 1.0F);
}

}  // namespace
}  // namespace tandem::core
