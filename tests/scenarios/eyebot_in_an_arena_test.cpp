// The firmware of an emulated eye-bot with the body of a simulated one, in time that the test turns by hand.
#include <cmath>
#include <gtest/gtest.h>

#include "app/catalog.hpp"
#include "app/real/simulated_body.hpp"
#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/eyebot_emulator/eyebot.hpp"
#include "tests/bridges/eyebot_emulator/hand_written.hpp"
#include "tests/core/eyebots.hpp"

namespace tandem {
namespace {

namespace emulator = bridges::eyebot_emulator;
namespace wire = bridges::eyebot_emulator::hand_written;
using emulator::Action;
using emulator::Mode;

constexpr std::int32_t kHub = 4711;

const bridges::EmulatorType& eyebot_emulator() {
  return *app::catalog().find<bridges::EmulatorType>("eyebot");
}

core::Scene hall(const std::string& engine) {
  core::Scene scene = core::eyebot_scene(engine);
  core::ControllerConfig& config = scene.scenario.controllers.back();
  config.label = "eyebot_puppet";
  config.library = "puppet";
  scene.robot("me", 0, 0, 0).robot("other", 1, 0, 0);
  for (core::RobotItem& item : scene.scenario.robots) {
    item.kind = "eye-bot";
    item.controller = scene.scenario.controllers.size() - 1;
  }
  return scene;
}

/// Hub, firmware and world, a tick at a time.
class Flight : public testing::TestWithParam<std::string> {
 protected:
  Flight() : world(core::make(hall(GetParam()))) {}

  void SetUp() override {
    ASSERT_TRUE(world.world) << world.all_problems();
    const auto found = app::SimulatedBody::find(*world.world, eyebot_emulator(), "me");
    ASSERT_TRUE(found.ok()) << found.error().message;
    me = found.value();
    body_link.emplace(*world.world, me, ports);
    world->set_external(&*body_link);
    world->start();
    world->step();
    firmware.emplace(options(), body, bridges::EventSink{});
    firmware->power_on(0, 0);
    pass(0.2);
  }
  static emulator::Eyebot::Options options() {
    emulator::Eyebot::Options o;
    o.clock_synced = false;
    return o;
  }

  wire::Head head() { return {0, seq_++, kHub}; }
  void order(Action action) {
    firmware->receive("eyebot/eb0/cmd/mode", wire::mode(head(), static_cast<int>(action)), now());
  }
  hal::TimeNs now() const { return hal::time_of_tick(world->tick(), world->ticks_per_second()); }
  void pass(double seconds) {
    const auto ticks = std::lround(seconds * static_cast<double>(world->ticks_per_second()));
    for (long i = 0; i < ticks; ++i) {
      if (i % 10 == 0) firmware->receive("hub/lab/heartbeat", wire::hub_heartbeat(head()), now());
      firmware->run_until(now());
      world->step();
    }
  }
  Mode mode() const { return firmware->supervisor().mode(); }
  std::array<double, 3> p() const { return world->space().port<hal::Positioning>(me)->p_WB; }

  core::MadeWorld world;
  bridges::SharedPorts ports{emulator::body_ports()};
  emulator::PortBody body{ports};
  core::RobotId me;
  std::optional<app::SimulatedBody> body_link;
  std::optional<emulator::Eyebot> firmware;

 private:
  std::int32_t seq_ = 0;
};

TEST_P(Flight, TakesTheSimulatedBodyUpAndAboutAndDown) {
  EXPECT_EQ(mode(), Mode::Idle);
  order(Action::Arm);
  order(Action::TakeOff);
  pass(5.0);
  EXPECT_EQ(mode(), Mode::Hover);
  EXPECT_NEAR(p()[2], 1.0, 0.1);
  firmware->receive("eyebot/eb0/cmd/position", wire::position(head(), {.x = -1.0, .y = 1.0, .z = 1.5}), now());
  pass(8.0);
  EXPECT_EQ(mode(), Mode::Position);
  EXPECT_NEAR(p()[0], -1.0, 0.05);
  EXPECT_NEAR(p()[1], 1.0, 0.05);
  EXPECT_NEAR(p()[2], 1.5, 0.05);
  firmware->receive("eyebot/eb0/cmd/velocity", wire::velocity(head(), 0.5, 0.0, 0.0, 0.0, 1000), now());
  pass(0.9);
  EXPECT_NEAR(firmware->senses().v_WB[0], 0.5, 0.1);
  pass(2.0);
  EXPECT_EQ(mode(), Mode::Hover);
  order(Action::Land);
  pass(10.0);
  EXPECT_EQ(mode(), Mode::Idle);
  EXPECT_NEAR(p()[2], 0.0, 0.05);
}

TEST_P(Flight, HangsTheSimulatedBodyOnTheCeiling) {
  order(Action::Arm);
  order(Action::TakeOff);
  pass(5.0);
  order(Action::Attach);
  pass(6.0);
  EXPECT_EQ(mode(), Mode::Attached);
  EXPECT_NEAR(p()[2], 3.0 - hal::eyebot::kind().body.height_m, 0.1);
  order(Action::Detach);
  pass(5.0);
  EXPECT_EQ(mode(), Mode::Hover);
  EXPECT_LT(p()[2], 3.0 - hal::eyebot::kind().body.height_m - 0.2);
}

TEST_P(Flight, GivesTheFirmwareWhatTheBodySenses) {
  pass(0.5);
  const emulator::BodySenses& senses = firmware->senses();
  EXPECT_NEAR(senses.ground_m, 0.0, 0.02);
  EXPECT_NEAR(senses.ceiling_m, 3.0 - hal::eyebot::kind().body.height_m, 0.05);
  // The other robot stands a metre ahead: the nearest rays are those at +-7.5 degrees.
  EXPECT_LT(senses.distance_m[0], 0.7);
  EXPECT_LT(senses.distance_m[23], 0.7);
  EXPECT_TRUE(senses.on_ground);
  ASSERT_TRUE(senses.charge);
  EXPECT_GT(*senses.charge, 0.9);
}

TEST_P(Flight, ShowsTheFirmwaresLights) {
  wire::Writer leds("cmd/leds", head());
  leds.i8(1);
  for (int i = 0; i < 99; ++i) leds.i8(i);
  firmware->receive("eyebot/eb0/cmd/leds", leds.bytes, now());
  pass(0.1);
  EXPECT_EQ(world->space().port<hal::RingLeds>(me)->color(1), (hal::Rgb{3, 4, 5}));
  EXPECT_EQ(world->space().port<hal::UpperRingLeds>(me)->color(1), hal::kBlack) << "not switched on";
}

INSTANTIATE_TEST_SUITE_P(Engines, Flight, testing::Values("particle3d", "dynamics3d"));

TEST(AnEyebotsBody, IsOneOfTheArenas) {
  const core::MadeWorld world = core::make(hall("particle3d"));
  ASSERT_TRUE(world.world) << world.all_problems();
  const auto first = app::SimulatedBody::find(*world.world, eyebot_emulator(), "");
  ASSERT_TRUE(first.ok()) << first.error().message;
  EXPECT_EQ(world->space().find_robot("me"), first.value());
  const auto missing = app::SimulatedBody::find(*world.world, eyebot_emulator(), "nobody");
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message.find("'nobody'"), std::string::npos);
}

}  // namespace
}  // namespace tandem
