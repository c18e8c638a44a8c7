// The proof: the very same controller object decides alike in a simulation and through bridge, wire and firmware.
#include <cmath>
#include <gtest/gtest.h>

#include "app/catalog.hpp"
#include "app/real/bridged_controller.hpp"
#include "app/real/simulated_body.hpp"
#include "app/real/wired_peer.hpp"
#include "bridges/wired/wired_line.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "mixed_reality/lockstep/lockstep.hpp"
#include "tests/core/scenes.hpp"

namespace tandem {
namespace {

/// Controller, bridge, serial line and firmware of one e-puck, in time that the test turns by hand.
class LockStepRobot final : public core::ExternalRobots {
 public:
  LockStepRobot(const core::World& world, core::RobotId robot, const hal::ControllerType& type, const void* params,
                const std::string& firmware)
      : wired_(bridges::wired::make_wired_epuck({.robot = "me", .what = firmware}).value()),
        body_link_(world, robot, wired_->body()),
        controller_(type, wired_->robot(), params, 10, hal::Log()) {}

  hal::Status connect() { return wired_->connect(); }
  void latch(core::World&) override {}
  void after_sense(core::World& world) override {
    body_link_.after_sense(world);
    wired_->sense(world.tick());
    std::string why;
    EXPECT_TRUE(controller_.step(why)) << why;
    wired_->act();
  }
  void after_filter(core::World& world) override { body_link_.after_filter(world); }

  bridges::BridgedRobot& robot() { return wired_->robot(); }
  std::string trouble() const { return wired_->trouble(); }

 private:
  std::unique_ptr<bridges::WiredRobot> wired_;
  app::SimulatedBody body_link_;
  app::BridgedController controller_;
};

/// A room with a box and three other robots; "me" is driven by `controller`.
core::Scene room(const std::string& controller, const std::string& library, const std::string& velocity) {
  core::Scene scene(1.2, "epuck_diffusion", "epuck_diffusion");
  scene.param("velocity", velocity).walls().box(0.25, 0.2, 0.15, 0.1, 0.6).cylinder(-0.3, 0.25, 0.06);
  scene.robot("me", 0, 0, 0.3).robot("a", -0.2, -0.2, 1.0).robot("b", 0.3, -0.1, 2.0).robot("c", 0.0, 0.35, 4.0);
  core::ControllerConfig mine = scene.scenario.controllers[0];
  mine.id = "mine";
  mine.label = controller;
  mine.library = library;
  if (controller == "puppet") mine.params.attributes.clear();
  scene.scenario.controllers.push_back(mine);
  scene.scenario.robots[0].controller = 1;
  return scene;
}

/// The robot that the same controller would drive in a pure simulation: its readings are the simulator's own.
class SimulatedRobot final : public hal::Robot {
 public:
  std::string_view id() const noexcept override { return "me"; }
  const hal::RobotKind& kind() const noexcept override { return hal::epuck::kind(); }
  std::uint64_t run_seed() const noexcept override { return 0; }

  hal::Proximity proximity;
  hal::WheelSpeeds wheels;

 protected:
  void* take(const hal::PortType& type) override {
    if (type.name == hal::Proximity::kName) return &proximity;
    if (type.name == hal::WheelSpeeds::kName) return &wheels;
    throw hal::DeviceError("no such device");
  }
};

constexpr double kReadingQuantum_m = 5e-4;  // what one count of the converter is worth, anywhere on the infrared curve

/// Whether readings that differ by the quantum can tip the diffusion controller's decision (see its header): the sum of
/// the closenesses is near its threshold, or points nearly ahead, or nearly along the border of the free direction.
bool on_the_edge(const hal::Proximity& exact) {
  const double slack = 8 * kReadingQuantum_m / hal::epuck::kind().part<hal::ProximityPart>()->range_m;
  double x = 0.0;
  double y = 0.0;
  for (std::size_t i = 0; i < exact.count; ++i) {
    x += static_cast<double>(exact.closeness(i)) *
         std::cos(hal::epuck::kind().part<hal::ProximityPart>()->mounts[i].bearing_rad);
    y += static_cast<double>(exact.closeness(i)) *
         std::sin(hal::epuck::kind().part<hal::ProximityPart>()->mounts[i].bearing_rad);
  }
  return std::fabs(std::hypot(x, y) - 0.1) < slack || std::fabs(y) < slack ||
         std::fabs(std::fabs(y) + x * std::tan(7.5 * M_PI / 180)) < slack;
}

class SameDecisions : public testing::TestWithParam<std::string> {};

TEST_P(SameDecisions, InSimulationAndThroughTheWire) {
  auto world = core::make(room("puppet", "puppet", "5 cm/s"));
  ASSERT_TRUE(world.world) << world.all_problems();
  const auto type = world.loader->controller("epuck_diffusion", "epuck_diffusion");
  ASSERT_TRUE(type.ok());
  core::Problems problems;
  core::ElementReader reader(world->scenario().controllers[0].params, problems);
  const auto params = type.value()->read_params(reader);
  SimulatedRobot direct;
  app::BridgedController controller(*type.value(), direct, params.get(), 10, hal::Log());

  const core::RobotId me = world->space().find_robot("me");
  LockStepRobot bridged(*world.world, me, *type.value(), params.get(), GetParam());
  const hal::Status connected = bridged.connect();
  ASSERT_TRUE(connected.ok()) << connected.error().message;
  world->set_external(&bridged);

  world->start();
  int turns = 0;
  int edges = 0;
  constexpr int kTicks = 3000;
  for (int tick = 0; tick < kTicks; ++tick) {
    world->step();
    ASSERT_EQ(world->state(), core::RunState::Running) << world->failure();
    direct.proximity = *world->space().port<hal::Proximity>(me);
    std::string why;
    ASSERT_TRUE(controller.step(why)) << why;

    const auto* read = static_cast<const hal::Proximity*>(bridged.robot().require(hal::port_type<hal::Proximity>()));
    for (std::size_t i = 0; i < 8; ++i) {
      ASSERT_NEAR(direct.proximity.distance_m[i], read->distance_m[i], kReadingQuantum_m)
          << "tick " << tick << " sensor " << i;
    }
    const hal::WheelSpeeds& through = bridged.robot().port<hal::WheelSpeeds>();
    if (through.left_m_s != direct.wheels.left_m_s || through.right_m_s != direct.wheels.right_m_s) {
      ++edges;
      ASSERT_TRUE(on_the_edge(direct.proximity))
          << "tick " << tick << ": " << hal::to_text(hal::port_type<hal::Proximity>(), &direct.proximity);
    }
    if (through.left_m_s != through.right_m_s) ++turns;
    // What the motors do: 10,000 / a whole number of 0.1 ms a step on version 1, so up to 4 % beside the command at
    // this speed.
    const auto* driven = world->space().port<hal::WheelSpeeds>(me);
    ASSERT_NEAR(driven->left_m_s, through.left_m_s, 0.04 * 0.05) << "tick " << tick;
    ASSERT_NEAR(driven->right_m_s, through.right_m_s, 0.04 * 0.05) << "tick " << tick;
  }
  EXPECT_GT(turns, kTicks / 20);  // it did meet things
  EXPECT_LT(turns, kTicks / 2);   // and did drive
  EXPECT_LT(edges, kTicks / 50);
  EXPECT_EQ(bridged.trouble(), "");
}

INSTANTIATE_TEST_SUITE_P(Firmwares, SameDecisions, testing::Values("gctronic", "btcom", "epuck2"));

/// A run in lock-step in which "me" is driven through its bridge and firmware.
struct EmulatedRun {
  EmulatedRun(core::Scene scene, const std::string& firmware) {
    scene.scenario.time_mode = core::TimeMode::Lockstep;
    scene.scenario.robots[0].peer = core::PeerConfig{"emulated:" + firmware, 3};
    made = core::make(scene);
    mixed_reality::LockstepOptions options;
    options.make_emulated = [](core::World& world, core::RobotId robot, const std::string& what) {
      return app::make_wired_peer(app::catalog(), world, robot, what, hal::Log());
    };
    auto run = mixed_reality::LockstepRun::make(*made.world, options);
    EXPECT_TRUE(run.ok()) << run.error().message;
    lockstep = std::move(run).value();
    const hal::Status connected = lockstep->connect();
    EXPECT_TRUE(connected.ok()) << connected.error().message;
    made.world->start();
  }
  core::MadeWorld made;
  std::unique_ptr<mixed_reality::LockstepRun> lockstep;
};

class EmulatedInLockstep : public testing::TestWithParam<std::string> {};

TEST_P(EmulatedInLockstep, IsTheSimulationToTheRoundingOfTheWire) {
  core::Scene scene = room("epuck_diffusion", "epuck_diffusion", "5 cm/s");
  scene.param("velocity", "5 cm/s");
  const auto pure = core::make(scene);
  ASSERT_TRUE(pure.world) << pure.all_problems();
  EmulatedRun emulated(scene, GetParam()), again(scene, GetParam());
  pure.world->start();
  const core::RobotId me = pure->space().find_robot("me");
  double way_m = 0.0;
  bool apart = false;
  for (int tick = 0; tick < 300; ++tick) {
    const core::Pose before = pure->space().pose(me);
    pure.world->step();
    ASSERT_TRUE(emulated.made.world->step());
    ASSERT_TRUE(again.made.world->step());
    ASSERT_EQ(emulated.made.world->state_hash(), again.made.world->state_hash()) << "tick " << tick;
    const core::Pose a = pure->space().pose(me), b = emulated.made.world->space().pose(me);
    way_m += std::hypot(a.x_m - before.x_m, a.y_m - before.y_m);
    // Until rounding tips a decision: the motors' speeds are up to 4 % beside the command.
    const auto* command = pure->space().port<hal::WheelSpeeds>(me);
    const auto* driven = emulated.made.world->space().port<hal::WheelSpeeds>(me);
    apart = apart || std::fabs(command->left_m_s - driven->left_m_s) > 0.04 * 0.05 + 1e-6 ||
            std::fabs(command->right_m_s - driven->right_m_s) > 0.04 * 0.05 + 1e-6;
    if (apart) {
      EXPECT_GT(tick, 20) << "a decision was tipped at once";
      continue;
    }
    ASSERT_LT(std::hypot(a.x_m - b.x_m, a.y_m - b.y_m), 0.001 + 0.05 * way_m) << "tick " << tick;
  }
  EXPECT_EQ(emulated.lockstep->report().peers[0].state, "in step");
  EXPECT_EQ(emulated.lockstep->report().peers[0].ticks, 300U);
}

INSTANTIATE_TEST_SUITE_P(Firmwares, EmulatedInLockstep, testing::Values("gctronic", "btcom", "epuck2"));

}  // namespace
}  // namespace tandem
