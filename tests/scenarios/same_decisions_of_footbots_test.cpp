// The very same controller object decides alike in a simulation and through bridge, bus and modules of a foot-bot.
#include <cmath>
#include <gtest/gtest.h>
#include <optional>

#include "app/real/bridged_controller.hpp"
#include "app/real/simulated_body.hpp"
#include "bridges/aseba/can_messages.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "bridges/footbot_emulator/body.hpp"
#include "bridges/footbot_emulator/footbot.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/memory_bus.hpp"
#include "tests/checkout.hpp"
#include "tests/core/scenes.hpp"

namespace tandem {
namespace {

namespace emulator = bridges::footbot_emulator;
namespace bridge = bridges::footbot;
namespace spec = hal::footbot;

constexpr hal::TimeNs kTick_ns = 100 * hal::kNsPerMs;
constexpr hal::TimeNs kHandshake_ns = 5 * hal::kNsPerSecond;

bridge::FootbotMap default_map() {
  hal::Problems problems;
  const auto map =
      bridges::footbot::read_footbot_map((std::string(test::kSourceDir) + "/configs/footbot_map.xml"), problems);
  for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
  return map.value_or(bridge::FootbotMap{});
}

/// Controller, bridge, CAN bus and modules of one foot-bot, in time that the test turns by hand.
class LockStepFootbot final : public core::ExternalRobots {
 public:
  LockStepFootbot(const core::World& world, core::RobotId robot, const hal::ControllerType& type, const void* params,
                  emulator::Protocol protocol)
      : body_link_(world, robot, ports_), modules_({.protocol = protocol}, body_, {}), driver_(settings(), messages_) {
    controller_.emplace(type, driver_.robot(), params, 10, hal::Log());
    modules_.power_on(0);
    while (now_ < kHandshake_ns) {
      driver_.latch(0, now_);
      driver_.commit(now_);
      elapse(kTick_ns);
    }
  }

  void latch(core::World&) override {}

  void after_sense(core::World& world) override {
    body_link_.after_sense(world);
    now_ = std::max(now_, kHandshake_ns + world.tick() * kTick_ns);
    driver_.commit(now_);  // asks for the readings of this instant; the commands are those of the last tick
    elapse(40 * hal::kNsPerMs);
    driver_.latch(world.tick(), now_);
    std::string why;
    EXPECT_TRUE(controller_->step(why)) << why;
    driver_.commit(now_);
    elapse(40 * hal::kNsPerMs);
  }

  void after_filter(core::World& world) override { body_link_.after_filter(world); }

  bridge::FootbotDriver& driver() { return driver_; }

 private:
  static bridge::DriverSettings settings() {
    bridge::DriverSettings s;
    s.map = default_map();
    s.robot.id = "me";
    s.robot.origin_ns = kHandshake_ns;
    return s;
  }

  /// Both ends of the bus live for a while.
  void elapse(hal::TimeNs duration_ns) {
    const hal::TimeNs end = now_ + duration_ns;
    for (; now_ < end; now_ += hal::kNsPerMs / 4) {
      driver_.pump(now_);
      bridges::CanFrame in;
      while (robots_end_->receive(in)) {
        emulator::Frame frame{static_cast<std::uint16_t>(in.id), in.size, in.data};
        modules_.receive(frame, now_);
      }
      modules_.run_until(now_);
      std::vector<emulator::TimedFrame> sent;
      modules_.take_sent(sent);
      for (const emulator::TimedFrame& f : sent) {
        (void)robots_end_->send(bridges::make_frame(f.frame.id, std::span(f.frame.data).first(f.frame.size)));
      }
    }
  }

  hal::TimeNs now_ = 0;
  bridges::MemoryBus bus_{[this] { return now_; }};
  std::unique_ptr<bridges::CanLink> robots_end_ = bus_.attach();
  bridges::SharedPorts ports_{emulator::body_ports()};
  emulator::PortBody body_{ports_};
  app::SimulatedBody body_link_;
  emulator::Footbot modules_;
  bridges::aseba::CanMessages messages_{bus_.attach(), {}, [this] { return now_; }};
  bridge::FootbotDriver driver_;
  std::optional<app::BridgedController> controller_;
};

core::ControllerConfig config_of(const std::string& id, const std::string& label, const std::string& library) {
  core::ControllerConfig config;
  config.id = id;
  config.label = label;
  config.library = library;
  config.sensors.push_back({"proximity", "default", {}});
  config.actuators.push_back({"differential_steering", "default", {}});
  return config;
}

/// A room with a box, a cylinder and three other foot-bots; "me" is moved by a puppet.
core::Scene room() {
  core::Scene scene(2.4);
  scene.scenario.controllers = {config_of("others", "footbot_diffusion", "footbot_diffusion"),
                                config_of("mine", "footbot_puppet", "puppet")};
  scene.engine("kinematics2d").walls().box(0.6, 0.5, 0.3, 0.2, 0.6).cylinder(-0.6, 0.5, 0.12);
  scene.robot("me", 0, 0, 0.3).robot("a", -0.5, -0.5, 1.0).robot("b", 0.6, -0.3, 2.0).robot("c", 0.0, 0.7, 4.0);
  for (core::RobotItem& item : scene.scenario.robots) item.kind = "foot-bot";
  scene.scenario.robots[0].controller = 1;
  return scene;
}

/// The robot that the same controller would drive in a pure simulation: its readings are the simulator's own.
class SimulatedFootbot final : public hal::Robot {
 public:
  std::string_view id() const noexcept override { return "me"; }
  const hal::RobotKind& kind() const noexcept override { return spec::kind(); }
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

const double kReadingQuantum_m = spec::kind().part<hal::ProximityPart>()->range_m / 4096;
constexpr double kSpeedQuantum_m_s = 1.0 / (48312.0 * 0.005);
constexpr double kFloat_m = 1e-7;

/// Whether readings that differ by half a quantum can tip the controller's decision (see its source): the sum of the
/// closenesses is near its threshold, or points nearly ahead, or nearly along the border of what is behind.
bool on_the_edge(const hal::Proximity& exact) {
  const double slack_m = 24 * kReadingQuantum_m;
  double x_m = 0.0;
  double y_m = 0.0;
  for (std::size_t i = 0; i < exact.count; ++i) {
    const double close_m = spec::kind().part<hal::ProximityPart>()->range_m - static_cast<double>(exact.distance_m[i]);
    x_m += close_m * std::cos(spec::kind().part<hal::ProximityPart>()->mounts[i].bearing_rad);
    y_m += close_m * std::sin(spec::kind().part<hal::ProximityPart>()->mounts[i].bearing_rad);
  }
  const double free_m = 0.01 * spec::kind().part<hal::ProximityPart>()->range_m * 24;
  return std::fabs(std::hypot(x_m, y_m) - free_m) < slack_m || std::fabs(y_m) < slack_m ||
         std::fabs(std::fabs(y_m) + x_m * std::tan(7.5 * M_PI / 180)) < slack_m;
}

class SameDecisionsOfFootbots : public testing::TestWithParam<emulator::Protocol> {};

TEST_P(SameDecisionsOfFootbots, InSimulationAndThroughTheBus) {
  auto world = core::make(room());
  ASSERT_TRUE(world.world) << world.all_problems();
  const auto type = world.loader->controller("footbot_diffusion", "footbot_diffusion");
  ASSERT_TRUE(type.ok());
  hal::Problems problems;
  core::ElementReader reader(world->scenario().controllers[0].params, problems);
  const auto params = type.value()->read_params(reader);
  SimulatedFootbot direct;
  app::BridgedController controller(*type.value(), direct, params.get(), 10, hal::Log());

  const core::RobotId me = world->space().find_robot("me");
  LockStepFootbot bridged(*world.world, me, *type.value(), params.get(), GetParam());
  ASSERT_EQ(bridged.driver().state(), bridge::RobotState::Active) << bridged.driver().trouble();
  world->set_external(&bridged);
  const auto* read =
      static_cast<const hal::Proximity*>(bridged.driver().robot().require(hal::port_type<hal::Proximity>()));
  const auto* through =
      static_cast<const hal::WheelSpeeds*>(bridged.driver().robot().require(hal::port_type<hal::WheelSpeeds>()));

  world->start();
  int turns = 0;
  int edges = 0;
  bool apart = false;  // a decision was tipped, and the controllers remember different things
  constexpr int kTicks = 3000;
  for (int tick = 0; tick < kTicks; ++tick) {
    world->step();
    ASSERT_EQ(world->state(), core::RunState::Running) << world->failure();
    direct.proximity = *world->space().port<hal::Proximity>(me);
    std::string why;
    ASSERT_TRUE(controller.step(why)) << why;

    ASSERT_EQ(read->validity, hal::Validity::Fresh) << "tick " << tick;
    for (std::size_t i = 0; i < 24; ++i) {
      ASSERT_NEAR(direct.proximity.distance_m[i], read->distance_m[i], 0.5 * kReadingQuantum_m + kFloat_m)
          << "tick " << tick << " sensor " << i;
    }
    const bool differ = through->left_m_s != direct.wheels.left_m_s || through->right_m_s != direct.wheels.right_m_s;
    if (differ) {
      ++edges;
      ASSERT_TRUE(apart || on_the_edge(direct.proximity))
          << "tick " << tick << ": " << hal::to_text(hal::port_type<hal::Proximity>(), &direct.proximity);
      apart = true;
    }
    const auto straight = [](const hal::WheelSpeeds& w) { return w.left_m_s == w.right_m_s; };
    if (straight(*through) && straight(direct.wheels)) apart = false;
    if (!straight(*through)) ++turns;
    // What the motors do: whole pulses in each of their periods.
    const auto* driven = world->space().port<hal::WheelSpeeds>(me);
    ASSERT_NEAR(driven->left_m_s, through->left_m_s, 0.5 * kSpeedQuantum_m_s) << "tick " << tick;
    ASSERT_NEAR(driven->right_m_s, through->right_m_s, 0.5 * kSpeedQuantum_m_s) << "tick " << tick;
  }
  EXPECT_GT(turns, kTicks / 50);  // it did meet things
  EXPECT_LT(turns, kTicks / 2);   // and did drive
  EXPECT_LT(edges, kTicks / 100);
  EXPECT_EQ(bridged.driver().statistics().link_stops, 0U);
}

INSTANTIATE_TEST_SUITE_P(Protocols, SameDecisionsOfFootbots,
                         testing::Values(emulator::Protocol::V4, emulator::Protocol::V5));

}  // namespace
}  // namespace tandem
