// An eye-bot's devices in a whole world: echoes, lights, camera on its head, scanner, acceleration, messages; and what
// it and foot-bots see and hear of one another across engines.
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "core/random/random.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "tests/core/eyebots.hpp"
#include "tests/core/watchers.hpp"

namespace tandem::core {
namespace {

namespace eb = hal::eyebot;
constexpr double kPi = std::numbers::pi;

MadeWorld made(const Scene& scene, const WorldOptions& options = {}) {
  auto world = make(scene, options);
  EXPECT_TRUE(world.world) << world.all_problems();
  if (world.world) world->start();
  return world;
}

// --- altimeter ---

TEST(Altimeter, TellsHowFarItIsToGroundAndCeiling) {
  auto world = made(eyebot_scene().flyer("e", 0, 0, 1.25));
  world->step();
  const auto& port = reading<hal::Altimeter>(world, "e");
  EXPECT_EQ(port.validity, hal::Validity::Fresh);
  EXPECT_NEAR(static_cast<double>(port.ground_m), 1.25, 1e-6);
  EXPECT_NEAR(static_cast<double>(port.ceiling_m), 3.0 - 1.25 - eb::kind().body.height_m, 1e-6);
}

TEST(Altimeter, SeesObjectsAndRobotsBeneathAndAbove) {
  Scene scene = eyebot_scene();
  scene.box(1, 0, 0.4, 0.4, 0.3, 0.5).cylinder(-1, 0, 0.3);
  scene.flyer("over_box", 1, 0, 1.0).flyer("beside_box", 1.4, 1.5, 1.0).flyer("over_can", -1.1, 0, 1.2);
  scene.flyer("low", 0, 2, 0.5).flyer("high", 0.2, 2, 1.5).flyer("aside", 0.5, -2, 1.5).flyer("far", 0, -2, 0.5);
  auto world = made(scene);
  steps(world, 2);
  const auto ground = [&](const char* id) { return static_cast<double>(reading<hal::Altimeter>(world, id).ground_m); };
  EXPECT_NEAR(ground("over_box"), 0.5, 1e-6);
  EXPECT_NEAR(ground("beside_box"), 1.0, 1e-6);
  EXPECT_NEAR(ground("over_can"), 0.7, 1e-6);
  EXPECT_NEAR(ground("high"), 1.5 - 0.5 - eb::kind().body.height_m, 1e-6);
  EXPECT_NEAR(static_cast<double>(reading<hal::Altimeter>(world, "low").ceiling_m),
              1.5 - 0.5 - eb::kind().body.height_m, 1e-6);
  EXPECT_NEAR(ground("aside"), 1.5, 1e-6) << "the other's rim is not beneath its middle";
}

TEST(Altimeter, HasNoEchoFromFarAway) {
  Scene scene = eyebot_scene();
  scene.scenario.arena_size[2] = 40.0;
  scene.scenario.arena_center[2] = 20.0;
  auto world = made(scene.flyer("e", 0, 0, eb::kind().part<hal::AltimeterPart>()->range_m + 0.1)
                        .flyer("near", 2, 0, eb::kind().part<hal::AltimeterPart>()->range_m - 0.1));
  world->step();
  EXPECT_LT(reading<hal::Altimeter>(world, "e").ground_m, 0.0F);
  EXPECT_LT(reading<hal::Altimeter>(world, "e").ceiling_m, 0.0F);
  EXPECT_GT(reading<hal::Altimeter>(world, "near").ground_m, 5.0F);
}

// --- noise ---

TEST(EyeBotNoise, ScattersAroundTheTruth) {
  Scene scene = eyebot_scene();
  for (const char* device : {"altimeter", "flight_state", "pan_tilt_encoder", "accelerometer"})
    choose(scene, device, hal::Role::Sensor, "noisy");
  choose(scene, "flight_task", hal::Role::Actuator, "noisy");
  auto world = made(scene.flyer("e", 0, 0, 1.0));
  double sum[4] = {};
  double squares[4] = {};
  constexpr int kTicks = 2000;
  for (int i = 0; i < kTicks; ++i) {
    world->step();
    const double off[4] = {static_cast<double>(reading<hal::Altimeter>(world, "e").ground_m) - 1.0,
                           reading<hal::FlightState>(world, "e").velocity[1],
                           reading<hal::PanTiltEncoder>(world, "e").tilt_rad,
                           static_cast<double>(reading<hal::Accelerometer>(world, "e").force_m_s2[2]) - 9.81};
    for (int k = 0; k < 4; ++k) {
      sum[k] += off[k];
      squares[k] += off[k] * off[k];
    }
  }
  const double wanted[4] = {0.01, 0.02, 0.01 / std::sqrt(3.0), 0.2};
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(std::sqrt(squares[k] / kTicks), wanted[k], 0.1 * wanted[k]) << k;
    EXPECT_NEAR(sum[k] / kTicks, 0.0, 0.1 * wanted[k]) << k;
  }
}

TEST(EyeBotNoise, SendersSeemToBeAboveOrBelow) {
  Scene scene = eyebot_scene();
  choose(scene, "range_and_bearing", hal::Role::Sensor, "noisy");
  auto world = made(scene.flyer("e", 0, 0, 1.0).flyer("sender", 2.0, 0, 1.0));
  command<hal::RangeAndBearingSend>(world, "sender").sending = true;
  double squares[3] = {};
  int heard = 0;
  for (int i = 0; i < 2000; ++i) {
    world->step();
    const auto& port = reading<hal::RangeAndBearing>(world, "e");
    if (port.count == 0) continue;  // one in a hundred is lost
    ++heard;
    squares[0] += std::pow(static_cast<double>(port.range_m[0]) - 2.0, 2);
    squares[1] += std::pow(2.0 * static_cast<double>(port.bearing_rad[0]), 2);
    squares[2] += std::pow(2.0 * static_cast<double>(port.elevation_rad[0]), 2);
  }
  EXPECT_NEAR(heard, 1980, 30);
  for (const double s : squares) EXPECT_NEAR(std::sqrt(s / heard), 0.01, 1e-3);
}

TEST(EyeBotNoise, LeansAndHeadsErrToo) {
  Scene scene = eyebot_scene();
  choose(scene, "quadrotor_attitude", hal::Role::Actuator, "noisy");
  choose(scene, "pan_tilt", hal::Role::Actuator, "noisy");
  auto world = made(scene.flyer("e", 0, 0, 1.5));
  command<hal::QuadrotorAttitude>(world, "e").set(0, 0, 0, 1);
  steps(world, 100);
  EXPECT_NE(pose_of(world, "e").x_m, 0.0);
  EXPECT_NEAR(pose_of(world, "e").x_m, 0.0, 0.2);
  EXPECT_NE(reading<hal::PanTiltEncoder>(world, "e").pan_rad, 0.0);
  EXPECT_NEAR(reading<hal::PanTiltEncoder>(world, "e").pan_rad, 0.0, 0.05);
}

// --- lights, and the camera on its head ---

/// One eye-bot that looks from (0, 0, 1.5), and another that shines from somewhere.
MadeWorld pair(double x_m, double y_m, double z_m) {
  return made(eyebot_scene().flyer("e", 0, 0, 1.5).flyer("lamp", x_m, y_m, z_m));
}
void look(const MadeWorld& world, double pan_rad, double tilt_rad) {
  command<hal::PanTiltDrive>(world, "e") = {{}, pan_rad, tilt_rad, false};
  steps(world, 55);  // half a turn a second, then one more to see
}
std::uint32_t seen(const MadeWorld& world) {
  world->step();
  return reading<hal::PerspectiveCamera>(world, "e").count;
}

TEST(EyeBotLeds, TheLowerRingIsSeenFromBeneathAndTheUpperFromBeside) {
  const auto counts = [](double x_m, double y_m, double z_m, double pan, double tilt) {
    auto world = pair(x_m, y_m, z_m);
    look(world, pan, tilt);
    std::array<std::uint32_t, 3> found{};
    command<hal::RingLeds>(world, "lamp").set_all(hal::kRed);
    found[0] = seen(world);
    command<hal::RingLeds>(world, "lamp").set_all(hal::kBlack);
    command<hal::UpperRingLeds>(world, "lamp").set_all(hal::kGreen);
    found[1] = seen(world);
    command<hal::UpperRingLeds>(world, "lamp").set_all(hal::kBlack);
    command<hal::CameraLed>(world, "lamp").set(hal::kBlue);
    found[2] = seen(world);
    return found;
  };
  // Beside, 2 m ahead and as high: the near half of the upper ring, nothing of what shines down.
  const auto beside = counts(2.0, 0.0, 1.5, 0.0, kPi / 2);
  EXPECT_EQ(beside[0], 0U);
  EXPECT_GE(beside[1], 6U);
  EXPECT_LE(beside[1], 8U);
  EXPECT_EQ(beside[2], 0U);
}

TEST(EyeBotLeds, WhoStandsBeneathSeesAllThatShinesDown) {
  // A foot-bot's camera looks up.
  Scene scene = camera_scene();
  add_footbot(scene, "below", 0, 0);
  scene.engine("particle3d");
  add_eyebot_kit(scene);
  scene.flyer("above", 0, 0, 1.2);
  auto world = made(scene);
  const auto count = [&] {
    steps(world, 2);
    return reading<hal::PerspectiveCamera>(world, "below").count;
  };
  EXPECT_EQ(count(), 0U);
  command<hal::RingLeds>(world, "above").set_all(hal::kRed);
  EXPECT_EQ(count(), 16U);
  command<hal::RingLeds>(world, "above").set_all(hal::kBlack);
  command<hal::UpperRingLeds>(world, "above").set_all(hal::kGreen);
  EXPECT_EQ(count(), 0U);
  command<hal::CameraLed>(world, "above").set(hal::kBlue);
  ASSERT_EQ(count(), 1U);
  EXPECT_EQ(reading<hal::PerspectiveCamera>(world, "below").color(0), hal::kBlue);
}

TEST(PanTilt, TurnsAsFastAsItCanAndNoFarther) {
  auto world = made(eyebot_scene().flyer("e", 0, 0, 1));
  command<hal::PanTiltDrive>(world, "e") = {{}, 2.0, 3.0, true};
  world->step();  // the command is clamped after it
  const double step_rad = eb::kind().part<hal::HeadPart>()->turn_rad_s / 50.0;
  for (int i = 1; i <= 10; ++i) {
    world->step();
    EXPECT_NEAR(reading<hal::PanTiltEncoder>(world, "e").pan_rad, (i + 1) * step_rad, 1e-12);
  }
  EXPECT_EQ(world->incidents().commands_clamped, 1U);
  steps(world, 100);
  EXPECT_NEAR(reading<hal::PanTiltEncoder>(world, "e").pan_rad, 2.0, 1e-12);
  EXPECT_NEAR(reading<hal::PanTiltEncoder>(world, "e").tilt_rad, kPi / 2, 1e-12);
  // The shorter way round: from 2 rad to -2 rad it is through straight back.
  command<hal::PanTiltDrive>(world, "e").pan_rad = -2.0;
  world->step();
  EXPECT_GT(reading<hal::PanTiltEncoder>(world, "e").pan_rad, 2.0);
}

TEST(PanTilt, WhatItLooksAtIsInTheMiddleOfTheImage) {
  // Straight down, ahead and down, to the left and level, behind and down.
  const double from_m = 1.5;
  const struct {
    double x_m, y_m, z_m;
  } places[] = {{0, 0, 0.05}, {1.0, 0, 0.5}, {0, 1.5, 1.5 - 0.2}, {-1.0, -0.5, 0.3}};
  for (const auto& at : places) {
    Scene scene = eyebot_scene();
    scene.cylinder(at.x_m, at.y_m, 0.05);
    scene.scenario.objects.back().size[2] = at.z_m;
    add_led(scene, {0, 0, at.z_m + 0.003}, {9, 8, 7});
    auto world = made(scene.flyer("e", 0, 0, from_m));
    const double pan = at.x_m == 0 && at.y_m == 0 ? 0.0 : std::atan2(at.y_m, at.x_m);
    const double tilt = std::atan2(std::hypot(at.x_m, at.y_m), from_m - at.z_m - 0.003);
    look(world, pan, tilt);
    const auto& image = reading<hal::PerspectiveCamera>(world, "e");
    ASSERT_EQ(image.count, 1U) << at.x_m;
    EXPECT_NEAR(image.x_px[0], 0.5F * static_cast<float>(image.width_px), 0.1F);
    EXPECT_NEAR(image.y_px[0], 0.5F * static_cast<float>(image.height_px), 0.1F);
    EXPECT_EQ(image.color(0), (hal::Rgb{9, 8, 7}));
    look(world, pan, tilt > 0.8 ? 0.0 : kPi / 2);
    EXPECT_EQ(reading<hal::PerspectiveCamera>(world, "e").count, 0U) << "out of its field of view";
  }
}

TEST(PanTilt, WhatIsInBetweenHidesWhatIsBehind) {
  for (const bool wall : {false, true}) {
    Scene scene = eyebot_scene();
    if (wall) scene.box(1.0, 0, 0.1, 1.0, 0.0, 2.5);
    auto world = made(scene.flyer("e", 0, 0, 1.5).flyer("lamp", 2, 0, 1.5));
    command<hal::UpperRingLeds>(world, "lamp").set_all(hal::kRed);
    look(world, 0.0, kPi / 2);
    EXPECT_EQ(reading<hal::PerspectiveCamera>(world, "e").count > 0, !wall);
  }
}

TEST(PanTilt, AFrontCameraHangsInNoHead) {
  Scene scene = eyebot_scene();
  scene.flyer("e", 0, 0, 1.5).flyer("lamp", 2, 0, 1.5);
  scene.parts([](hal::RobotKind& kind) { kind.part<hal::CameraPart>()->in_front = true; });
  auto world = made(scene);
  command<hal::UpperRingLeds>(world, "lamp").set_all(hal::kRed);
  look(world, kPi, 0.0);
  EXPECT_GT(reading<hal::PerspectiveCamera>(world, "e").count, 0U);
}

// --- what it shares with other robots ---

TEST(EyeBotScanner, MeasuresAllAround) {
  Scene scene = eyebot_scene();
  scene.box(2.0, 0, 0.2, 6.0, 0.0, 2.5).flyer("e", 0, 0, 1.0).flyer("other", 0, 1.5, 0.8);
  auto world = made(scene);
  command<hal::ScannerDrive>(world, "e").go_to(0.0);
  steps(world, 3);
  const auto& port = reading<hal::DistanceScanner>(world, "e");
  ASSERT_EQ(port.samples, 1U);
  EXPECT_NEAR(static_cast<double>(port.distance(0, 0)), 1.9, 1e-5);
  EXPECT_NEAR(static_cast<double>(port.distance(1, 0)), 1.5 - eb::kind().body.radius_m, 1e-5);
  EXPECT_EQ(port.distance(2, 0), static_cast<float>(eb::kind().part<hal::ScannerPart>()->heads[0].max_m));
  EXPECT_TRUE(port.sees_nothing(3, 0));
  command<hal::ScannerDrive>(world, "e").turn(kPi);
  steps(world, 10);
  EXPECT_NEAR(static_cast<double>(port.turn_rad), 10 * kPi / 50, 1e-5);
}

TEST(EyeBotAccelerometer, FeelsGravityAndWhatSpeedsItUp) {
  auto world = made(eyebot_scene("particle3d_exact").flyer("e", 0, 0, 1.0, kPi / 2));
  steps(world, 5);
  const auto& force = reading<hal::Accelerometer>(world, "e").force_m_s2;
  EXPECT_NEAR(force[2], 9.81F, 1e-5F);
  command<hal::QuadrotorSpeed>(world, "e").set(0.0, 0.1, 0.0, 0.4);
  world->step();
  EXPECT_NEAR(force[0], 5.0F, 0.05F) << "0.1 m/s within 20 ms, straight ahead";
  EXPECT_NEAR(force[1], 0.0F, 0.05F);
  EXPECT_NEAR(reading<hal::Gyroscope>(world, "e").rate_rad_s[2], 0.4F, 1e-5F);
  world->step();
  EXPECT_NEAR(force[0], 0.0F, 1e-4F);
}

TEST(EyeBotRangeAndBearing, BodiesInSpaceAreInTheWay) {
  // On one slanted line: who is in the middle hides the farthest from one another; who is above the line does not.
  for (const double above_m : {0.0, 0.8}) {
    Scene scene = eyebot_scene();
    scene.flyer("a", -1, 0, 0.5).flyer("middle", 0, 0, 0.9 + above_m).flyer("b", 1, 0, 1.3);
    auto world = made(scene);
    for (const char* id : {"a", "b"}) {
      auto& send = command<hal::RangeAndBearingSend>(world, id);
      send.sending = true;
      send.size = 1;
    }
    steps(world, 3);
    const auto& heard = reading<hal::RangeAndBearing>(world, "a");
    EXPECT_EQ(heard.count, above_m > 0.0 ? 1U : 0U);
    if (heard.count == 0) continue;
    EXPECT_NEAR(static_cast<double>(heard.range_m[0]), std::hypot(2.0, 0.8), 1e-5);
    EXPECT_NEAR(static_cast<double>(heard.elevation_rad[0]), std::atan2(0.8, 2.0), 1e-5);
  }
}

/// 1: the line between two boards passes through a body; 0: it does not; -1: it is a matter of 2 mm.
int blocked(const std::vector<Vec3>& bases, std::size_t from, std::size_t to) {
  const auto board = [&](std::size_t i, std::size_t axis) {
    return bases[i][axis] + (axis == 2 ? eb::kind().part<hal::RangeAndBearingPart>()->height_m : 0);
  };
  constexpr int kSamples = 1500;
  bool near = false;
  for (int s = 1; s < kSamples; ++s) {
    Vec3 p{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = board(from, axis) + (board(to, axis) - board(from, axis)) * s / kSamples;
    for (std::size_t k = 0; k < bases.size(); ++k) {
      if (k == from || k == to) continue;
      const double aside_m = std::hypot(p[0] - bases[k][0], p[1] - bases[k][1]) - eb::kind().body.radius_m;
      const double outside_m =
          std::max({aside_m, bases[k][2] - p[2], p[2] - (bases[k][2] + eb::kind().body.height_m - 0.005)});
      if (outside_m < -0.002) return 1;
      near = near || outside_m < 0.002;
    }
  }
  return near ? -1 : 0;
}

TEST(EyeBotRangeAndBearing, HearsExactlyThoseInReachAndInSight) {
  // A cloud, looser and then so dense that more are near than are tested one by one.
  for (const auto& [size_m, count] : {std::pair{4.5, 60}, std::pair{5.0, 180}}) {
    Scene scene = eyebot_scene("particle3d", 8.0);
    scene.scenario.arena_size[2] = 12.0;
    scene.scenario.arena_center[2] = 6.0;
    std::vector<Vec3> bases;
    for (std::uint32_t n = 0; bases.size() < static_cast<std::size_t>(count); ++n) {
      const auto bits = draw(5, n, Stream::Placement, 0);
      const Vec3 p{size_m * (to_unit(bits[0]) - 0.5), size_m * (to_unit(bits[1]) - 0.5), 0.5 + 8.0 * to_unit(bits[2])};
      const bool free = std::none_of(bases.begin(), bases.end(), [&](const Vec3& o) {
        return std::hypot(p[0] - o[0], p[1] - o[1]) < 0.55 && std::fabs(p[2] - o[2]) < 0.6;
      });
      if (!free) continue;
      scene.flyer("e" + std::to_string(bases.size()), p[0], p[1], p[2]);
      bases.push_back(p);
    }
    auto world = made(scene);
    for (std::size_t i = 0; i < bases.size(); ++i) {
      auto& send = command<hal::RangeAndBearingSend>(world, "e" + std::to_string(i));
      send.sending = true;
      send.size = 1;
    }
    steps(world, 2);
    int sure = 0;
    for (std::size_t i = 0; i < bases.size(); i += 7) {
      std::size_t least = 0;
      std::size_t most = 0;
      for (std::size_t k = 0; k < bases.size(); ++k) {
        const double range_m =
            std::hypot(bases[i][0] - bases[k][0], bases[i][1] - bases[k][1], bases[i][2] - bases[k][2]);
        if (k == i || range_m > eb::kind().part<hal::RangeAndBearingPart>()->range_m + 1e-6) continue;
        const int in_the_way = blocked(bases, i, k);
        least += in_the_way == 0 ? 1 : 0;
        most += in_the_way == 1 ? 0 : 1;
      }
      const auto& heard = reading<hal::RangeAndBearing>(world, "e" + std::to_string(i));
      EXPECT_GE(heard.count + heard.dropped, least) << i;
      EXPECT_LE(heard.count + heard.dropped, most) << i;
      sure += least == most ? 1 : 0;
      for (std::size_t k = 1; k < heard.count; ++k) EXPECT_GE(heard.range_m[k], heard.range_m[k - 1]);
    }
    EXPECT_GT(sure, count / 14) << "most are no matter of millimetres";
  }
}

// --- mixed swarms ---

class MixedSwarm : public testing::TestWithParam<std::string> {};

TEST_P(MixedSwarm, SeesAndHearsAcrossEngines) {
  Scene scene = camera_scene();
  scene.scenario.engines.clear();
  scene.scenario.controllers.front().sensors.push_back({"range_and_bearing", "default", {}});
  scene.engine("dynamics2d");
  ControllerConfig& ground = scene.scenario.controllers.front();
  ground.label = "puppet";
  ground.sensors.clear();
  ground.actuators.clear();
  Scene kit = footbot_scene();
  ground.sensors = kit.scenario.controllers.back().sensors;
  ground.actuators = kit.scenario.controllers.back().actuators;
  add_footbot(scene, "fb", 0.4, 0.0);
  if (GetParam().starts_with("dynamics3d")) {
    // An engine of its own for the space above: its region lies beside that of the plane.
    scene.scenario.engines.front().sides = {{-3, -3, "", 1}, {0.9, -3, "", 1}, {0.9, 3, "", 1}, {-3, 3, "", 1}};
    add_engine(scene, GetParam());
    for (const auto& [x, y] : {std::pair{0.9, -3.0}, {3.0, -3.0}, {3.0, 3.0}, {0.9, 3.0}}) scene.side(x, y);
  } else {
    add_engine(scene, GetParam());
  }
  add_eyebot_kit(scene);
  const double x_m = GetParam().starts_with("dynamics3d") ? 1.5 : 0.0;
  scene.flyer("e", x_m, 0.0, 1.2);
  auto world = made(scene);
  command<hal::RingLeds>(world, "fb").set(hal::footbot::kind().part<hal::LedsPart>()->beacon_led(), hal::kBlue);
  for (const char* id : {"fb", "e"}) {
    auto& send = command<hal::RangeAndBearingSend>(world, id);
    send.sending = true;
    send.size = 2;
    send.payload[0] = static_cast<std::uint8_t>(id[0]);
  }
  const double down_m = 1.2 - hal::footbot::kind().part<hal::LedsPart>()->mounts.back().z_m;
  command<hal::PanTiltDrive>(world, "e") = {{}, x_m > 0.4 ? kPi : 0.0, std::atan2(std::fabs(0.4 - x_m), down_m), false};
  steps(world, 30);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  const auto& image = reading<hal::PerspectiveCamera>(world, "e");
  ASSERT_EQ(image.count, 1U);
  EXPECT_EQ(image.color(0), hal::kBlue);
  EXPECT_NEAR(image.x_px[0], 320.0F, 1.0F);
  EXPECT_NEAR(image.y_px[0], 240.0F, 1.0F);
  const double up_m = 1.2 + eb::kind().part<hal::RangeAndBearingPart>()->height_m -
                      hal::footbot::kind().part<hal::RangeAndBearingPart>()->height_m;
  const auto& from_below = reading<hal::RangeAndBearing>(world, "e");
  ASSERT_EQ(from_below.count, 1U);
  EXPECT_EQ(from_below.message(0)[0], 'f');
  EXPECT_NEAR(static_cast<double>(from_below.elevation_rad[0]), -std::atan2(up_m, std::fabs(0.4 - x_m)), 1e-3);
  const auto& from_above = reading<hal::RangeAndBearing>(world, "fb");
  ASSERT_EQ(from_above.count, 1U);
  EXPECT_EQ(from_above.message(0)[0], 'e');
  EXPECT_NEAR(static_cast<double>(from_above.range_m[0]), std::hypot(0.4 - x_m, up_m), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Ways, MixedSwarm, testing::ValuesIn(ways_to_fly()), [](const auto& way) { return way.param; });

TEST(MixedSwarmThreads, TheSameBitsForAnyNumber) {
  std::uint64_t first = 0;
  for (const std::int64_t threads : {1, 2, 4}) {
    Scene scene = footbot_scene("dynamics2d", 8.0);
    scene.scenario.arena_size[2] = 4.0;
    scene.scenario.arena_center[2] = 2.0;
    for (int i = 0; i < 20; ++i) add_footbot(scene, "f" + std::to_string(i), -3 + 1.4 * (i % 5), -3 + 1.4 * (i / 5));
    scene.engine("particle3d").split("2x2");
    add_eyebot_kit(scene);
    for (auto* list : {&scene.scenario.controllers.back().sensors, &scene.scenario.controllers.back().actuators}) {
      for (DeviceChoice& choice : *list) {
        if (!choice.device.ends_with("leds") && !choice.device.ends_with("_led")) choice.implementation = "noisy";
      }
    }
    for (int i = 0; i < 20; ++i)
      scene.flyer("e" + std::to_string(i), -3 + 1.4 * (i % 5), -3 + 1.4 * (i / 5), 0.5 + i % 3);
    WorldOptions options;
    options.threads = threads;
    auto world = made(scene, options);
    for (int i = 0; i < 20; ++i) {
      const std::string e = "e" + std::to_string(i);
      const std::string f = "f" + std::to_string(i);
      command<hal::WheelSpeeds>(world, f).set(0.1, 0.01 * i);
      command<hal::RingLeds>(world, f).set_all(hal::kRed);
      command<hal::RingLeds>(world, e).set_all(hal::kGreen);
      command<hal::RangeAndBearingSend>(world, f).sending = command<hal::RangeAndBearingSend>(world, e).sending = true;
      command<hal::FlightTask>(world, e).order = static_cast<hal::FlightOrder>(i % 4);
      command<hal::QuadrotorSpeed>(world, e).set(0.1 * std::cos(i), 0.1 * std::sin(i), 0.0, 0.1);
      command<hal::PanTiltDrive>(world, e) = {{}, 0.3 * i, 0.1 * i, false};
      command<hal::ScannerDrive>(world, e).turn(1.0);
    }
    steps(world, 40);
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
    if (threads == 1) first = world->state_hash();
    EXPECT_EQ(world->state_hash(), first) << threads;
  }
}

}  // namespace
}  // namespace tandem::core
