#include "mixed_reality/session/mixed_session.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <stdexcept>

#include "tests/core/scenes.hpp"
#include "tests/mixed_reality/fake_robot.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const double kDiameter_m = 2.0 * hal::epuck::kind().body.radius_m;
const std::atomic<bool> kGoOn{false};

/// Makes the robot with this id a real one.
core::Scene& real(core::Scene& scene, const std::string& id) {
  for (core::RobotItem& item : scene.scenario.robots) {
    if (item.id == id) item.bridge = core::BridgeConfig{"fake:" + id, 0.5, {}, 7};
  }
  return scene;
}

class MixedRun : public testing::Test {
 protected:
  void open(const core::Scene& scene) {
    made_ = core::make(scene);
    ASSERT_TRUE(made_.world) << made_.all_problems();
    for (const core::RobotItem& item : scene.scenario.robots) {
      if (!item.bridge) continue;
      const double heading_rad = item.placement.yaw_rad;
      bodies_[item.id].pose = {item.placement.p_W[0], item.placement.p_W[1], 0.0, std::cos(heading_rad),
                               std::sin(heading_rad)};
    }
    options_.log = hal::Log([this](hal::Severity, std::string_view text) { log_ += std::string(text) + "\n"; });
    auto session = MixedSession::make(
        std::move(made_.world),
        [this](const bridges::BridgeRequest& request) -> bridges::MadeBridge {
          return std::unique_ptr<bridges::RobotBridge>(std::make_unique<FakeRobot>(bodies_[request.robot]));
        },
        time_, options_);
    ASSERT_TRUE(session.ok()) << session.error().message;
    session_ = std::move(session).value();
  }
  void connect() {
    const hal::Status status = session_->connect(kGoOn);
    ASSERT_TRUE(status.ok()) << status.error().message;
  }
  void run(hal::Tick ticks, const std::function<void(core::World&)>& after_tick = {}) {
    connect();
    const hal::Status status = session_->run(ticks, kGoOn, after_tick);
    ASSERT_TRUE(status.ok()) << status.error().message;
  }
  core::Pose pose(const std::string& id) const {
    return session_->world().space().pose(session_->world().space().find_robot(id));
  }
  static double distance(const core::Pose& a, const core::Pose& b) { return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m); }
  void expect_all_stand() {
    for (auto& [id, body] : bodies_) {
      EXPECT_TRUE(body.stands()) << id;
      ASSERT_FALSE(body.received.empty());
      EXPECT_EQ(body.received.back().wheels.left_m_s, 0.0) << id;
    }
  }
  bool has_driven(const std::string& id) {
    const auto& received = bodies_[id].received;
    return std::any_of(received.begin(), received.end(), [](const auto& r) { return r.wheels.left_m_s != 0.0; });
  }

  FakeTime time_{7'000'000'000};
  std::map<std::string, FakeBody> bodies_;
  MixedOptions options_;
  std::string log_;
  core::MadeWorld made_;
  std::unique_ptr<MixedSession> session_;
};

core::Scene drive(double left_m_s, double right_m_s) {
  core::Scene scene(4.0, "drive");
  scene.param("left", std::to_string(left_m_s)).param("right", std::to_string(right_m_s));
  return scene;
}

TEST_F(MixedRun, StepsInRealTimeOnAnAbsoluteScheduleAndStopsTheRobotAtTheEnd) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0);
  open(real(scene, "ep0"));
  time_.oversleep_ns = 70'000;
  connect();
  const hal::TimeNs began = time_.now_ns();
  hal::TimeNs last_tick = 0;
  ASSERT_TRUE(session_->run(100, kGoOn, [&](core::World&) { last_tick = time_.now_ns(); }).ok());
  EXPECT_EQ(last_tick, began + 99 * 100 * kMs + 70'000);
  const MixedReport report = session_->report();
  EXPECT_EQ(report.pace.ticks, 100U);
  EXPECT_EQ(report.pace.deadline_misses, 0U);
  ASSERT_EQ(report.robots.size(), 1U);
  EXPECT_EQ(report.robots[0].state, "driving");
  EXPECT_EQ(report.robots[0].link, "fake:ep0");
  EXPECT_TRUE(report.robots[0].stop_confirmed);
  EXPECT_EQ(report.robots[0].counts.ticks_driving + report.robots[0].counts.ticks_held, 100U);
  EXPECT_GT(bodies_["ep0"].pose.x_m, -0.6);
  expect_all_stand();
}

TEST_F(MixedRun, TheLedgerTellsHowOldReadingsWereAndWhichCameTooLate) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0);
  open(real(scene, "ep0"));
  run(100, [&](core::World& world) {
    bodies_["ep0"].link_up = world.tick() < 40 || world.tick() >= 60;
    if (world.tick() == 80) time_.pass(130 * kMs);  // longer than a tick: the next one begins late
  });
  const RobotLedger ledger = session_->report().robots.at(0).ledger;
  EXPECT_EQ(ledger.ticks, 100U);
  EXPECT_GE(ledger.late_readings, 19U);
  EXPECT_LE(ledger.late_readings, 22U);
  EXPECT_NEAR(static_cast<double>(ledger.age_median_ns), 100e6, 7e6) << "sampled when it was told something";
  EXPECT_GE(ledger.age_largest_ns, 2000 * kMs);
  EXPECT_EQ(ledger.late_commands, 0U) << "each tick's command leaves at its begin";
  EXPECT_GE(ledger.command_largest_ns, 29 * kMs);
  ASSERT_TRUE(ledger.newest_age_ns);
  EXPECT_EQ(session_->status().at(0).ledger.late_readings, ledger.late_readings);
}

TEST_F(MixedRun, TheTwinIsWhereTheRealRobotIsInEveryTick) {
  core::Scene scene = drive(0.06, 0.03);
  scene.robot("ep0", -0.5, 0.3, 1.0);
  open(real(scene, "ep0"));
  run(200, [&](core::World&) {
    bodies_["ep0"].move_to(time_.now_ns());
    ASSERT_LT(distance(pose("ep0"), bodies_["ep0"].pose), 1e-9);
    ASSERT_NEAR(pose("ep0").heading_rad(), bodies_["ep0"].pose.heading_rad(), 1e-9);
  });
}

TEST_F(MixedRun, CommandsAreSentInTheTickInWhichTheyWereGivenNotAfterTheWait) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0);
  open(real(scene, "ep0"));
  std::size_t heard = 0;
  run(20, [&](core::World&) {
    EXPECT_GT(bodies_["ep0"].received.size(), heard);
    heard = bodies_["ep0"].received.size();
    EXPECT_EQ(bodies_["ep0"].received.back().at_ns, time_.now_ns());
  });
}

TEST_F(MixedRun, TheRealRobotSeesAVirtualRobotInItsWayAndTurns) {
  core::Scene alone(4.0, "obstacle_avoidance", "obstacle_avoidance");
  alone.robot("ep0", 0.0, 0.0);
  open(real(alone, "ep0"));
  run(60);
  EXPECT_NEAR(bodies_["ep0"].pose.y_m, 0.0, 1e-9);  // nothing there: straight on
  EXPECT_GT(bodies_["ep0"].pose.x_m, 0.3);

  session_.reset();
  bodies_.clear();
  core::Scene met(4.0, "obstacle_avoidance", "obstacle_avoidance");
  met.robot("ep0", 0.0, 0.0);
  met.scenario.controllers.push_back(drive(0.0, 0.0).scenario.controllers[0]);
  met.robot("dummy", 0.3, 0.005);
  met.scenario.robots.back().controller = 1;
  open(real(met, "ep0"));
  double nearest = 1.0;
  run(60, [&](core::World&) { nearest = std::min(nearest, distance(bodies_["ep0"].pose, pose("dummy"))); });
  EXPECT_GT(nearest, kDiameter_m);
  EXPECT_LT(nearest, kDiameter_m + 0.1);  // it did come to see it
  EXPECT_GT(std::fabs(bodies_["ep0"].pose.y_m), 0.02);
  EXPECT_NEAR(distance(pose("dummy"), {0.3, 0.005, 0.0, 1.0, 0.0}), 0.0, 1e-9);
}

TEST_F(MixedRun, TheRealRobotSeesARealThingThatTheSimulationKnowsNothingOf) {
  core::Scene scene(4.0, "obstacle_avoidance", "obstacle_avoidance");
  scene.robot("ep0", 0.0, 0.0);
  open(real(scene, "ep0"));
  bodies_["ep0"].real_proximity_m = 0.01;  // boxed in
  run(60);
  EXPECT_NE(bodies_["ep0"].pose.heading_rad(), 0.0);  // it turns on the spot
  EXPECT_NEAR(bodies_["ep0"].pose.x_m, 0.0, 1e-9);
}

TEST_F(MixedRun, SimulatedRobotsSeeTheTwinAndAvoidIt) {
  core::Scene scene(4.0, "obstacle_avoidance", "obstacle_avoidance");
  scene.robot("sim", -0.4, 0.003);
  scene.scenario.controllers.push_back(drive(0.0, 0.0).scenario.controllers[0]);
  scene.robot("ep0", 0.0, 0.0);
  scene.scenario.robots.back().controller = 1;
  open(real(scene, "ep0"));
  double nearest = 1.0;
  run(100, [&](core::World&) { nearest = std::min(nearest, distance(pose("sim"), bodies_["ep0"].pose)); });
  EXPECT_GT(nearest, kDiameter_m);
  EXPECT_LT(nearest, kDiameter_m + 0.1);
  EXPECT_GT(std::fabs(pose("sim").y_m), 0.02);
}

TEST_F(MixedRun, ASimulatedRobotThatSeesNothingBumpsIntoTheTwinAndDoesNotMoveIt) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("sim", -0.3, 0.0);
  scene.scenario.controllers.push_back(drive(0.0, 0.0).scenario.controllers[0]);
  scene.robot("ep0", 0.0, 0.0);
  scene.scenario.robots.back().controller = 1;
  open(real(scene, "ep0"));
  run(60, [&](core::World&) {
    ASSERT_GT(distance(pose("sim"), pose("ep0")), kDiameter_m - 0.002);
    ASSERT_EQ(pose("ep0").x_m, 0.0);
  });
  EXPECT_LT(distance(pose("sim"), pose("ep0")), kDiameter_m + 0.002);
}

TEST_F(MixedRun, ALinkThatIsCutHoldsTheRobotAndTheRestGoesOn) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -1.5, 0.0).robot("ep1", -1.5, 0.5).robot("sim", -1.5, 1.0);
  real(scene, "ep0");
  open(real(scene, "ep1"));
  hal::Tick tick = 0;
  std::size_t heard_before_cut = 0;
  run(100, [&](core::World& world) {
    ++tick;
    if (tick == 30) {
      bodies_["ep0"].link_up = false;
      heard_before_cut = bodies_["ep0"].received.size();
    }
    if (tick == 48) bodies_["ep0"].link_up = true;
    if (tick == 45) {
      EXPECT_TRUE(world.space().halted(world.space().find_robot("ep0")));
      EXPECT_FALSE(world.space().halted(world.space().find_robot("ep1")));
    }
  });
  const auto& received = bodies_["ep0"].received;
  double last = 0.0;
  for (std::size_t i = heard_before_cut; i < received.size(); ++i) {
    EXPECT_LE(received[i].wheels.left_m_s - last, 0.25 * 0.1 + 1e-12) << "it jumps when the link is back";
    last = received[i].wheels.left_m_s;
  }
  const MixedReport report = session_->report();
  EXPECT_EQ(report.robots[0].counts.stops, 1U);
  EXPECT_EQ(report.robots[0].state, "driving");
  EXPECT_EQ(report.robots[1].counts.stops, 0U);
  EXPECT_EQ(report.robots[1].counts.ticks_driving, 97U);  // all but the time to settle
  EXPECT_NEAR(pose("sim").x_m, -1.5 + 0.1 * 9.9, 1e-9);
  EXPECT_NE(log_.find("robot 'ep0' at 3 s: link lost (cable out)"), std::string::npos) << log_;
  expect_all_stand();
}

TEST_F(MixedRun, AControllerThatThrowsStopsItsRobotForGood) {
  core::Scene scene(4.0, "thrower");
  scene.robot("ep0", 0.0, 0.0);
  open(real(scene, "ep0"));
  run(30);
  const MixedReport report = session_->report();
  EXPECT_EQ(report.robots[0].state, "controller failed");
  EXPECT_FALSE(report.robots[0].driving);
  EXPECT_EQ(session_->world().incidents().controllers_thrown, 1U);
  expect_all_stand();
}

TEST_F(MixedRun, CommandsThatAreNoNumbersNeverReachTheRobot) {
  core::Scene scene(4.0, "careless");
  scene.robot("ep0", 0.0, 0.0);
  open(real(scene, "ep0"));
  run(40);
  EXPECT_TRUE(has_driven("ep0"));
  for (const auto& r : bodies_["ep0"].received) {
    EXPECT_TRUE(std::isfinite(r.wheels.left_m_s) && std::isfinite(r.wheels.right_m_s));
    EXPECT_LE(std::fabs(r.wheels.left_m_s), hal::epuck::kind().drive()->max_speed_m_s + 1e-12);
  }
}

TEST_F(MixedRun, AnInterruptionStopsEveryRobot) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0).robot("ep1", 0.5, 0.0);
  real(scene, "ep0");
  open(real(scene, "ep1"));
  connect();
  std::atomic<bool> stop{false};
  ASSERT_TRUE(session_->run(0, stop, [&](core::World& w) { stop = w.tick() == 25; }).ok());
  EXPECT_EQ(session_->world().tick(), 25);
  EXPECT_TRUE(has_driven("ep0") && has_driven("ep1"));
  expect_all_stand();
}

TEST_F(MixedRun, AnExceptionOnTheWayStopsEveryRobot) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0);
  open(real(scene, "ep0"));
  connect();
  EXPECT_THROW((void)session_->run(0, kGoOn,
                                   [](core::World& w) {
                                     if (w.tick() == 25) throw std::runtime_error("disk full");
                                   }),
               std::runtime_error);
  EXPECT_FALSE(bodies_["ep0"].stands());
  session_.reset();
  EXPECT_TRUE(has_driven("ep0"));
  expect_all_stand();
}

TEST_F(MixedRun, AWorldThatFailsStopsEveryRobotAndSaysWhy) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0).robot("runaway", 1.6, 0.0);
  open(real(scene, "ep0"));
  connect();
  const hal::Status status = session_->run(0, kGoOn);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("runaway"), std::string::npos) << status.error().message;
  EXPECT_TRUE(has_driven("ep0"));
  expect_all_stand();
}

TEST_F(MixedRun, ARobotThatDoesNotConfirmItsStopIsNamed) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0);
  open(real(scene, "ep0"));
  bodies_["ep0"].confirms_stops = false;
  run(10);
  EXPECT_FALSE(session_->report().robots[0].stop_confirmed);
  EXPECT_NE(log_.find("'ep0' on fake:ep0 did not confirm its stop: switch it off by hand"), std::string::npos) << log_;
}

TEST_F(MixedRun, DoesNotBeginBeforeEveryRobotAnswersAndNamesThoseThatDoNot) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0).robot("ep1", 0.5, 0.0);
  real(scene, "ep0");
  open(real(scene, "ep1"));
  bodies_["ep1"].link_up = false;
  const hal::TimeNs began = time_.now_ns();
  const hal::Status status = session_->connect(kGoOn);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message,
            "real robots did not answer: 'ep1' on fake:ep1 within 15 s (cable out; is it switched on?)");
  EXPECT_GE(time_.now_ns() - began, 15'000 * kMs);
  EXPECT_EQ(session_->world().tick(), 0);
  bodies_["ep1"].link_up = true;
  EXPECT_TRUE(session_->connect(kGoOn).ok());
  EXPECT_FALSE(has_driven("ep0"));
}

TEST_F(MixedRun, ARobotThatIsNotThereIsSimulatedWhereItsBridgeSaysSo) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0).robot("ep1", 0.0, 0.5);
  real(scene, "ep0");
  real(scene, "ep1");
  scene.scenario.robots[1].bridge->if_missing = core::IfMissing::Simulate;
  scene.scenario.robots[1].bridge->connect_s = 3.0;
  std::vector<const bridges::RobotBridge*> left_out;
  options_.on_left_out = [&](const bridges::RobotBridge& bridge) { left_out.push_back(&bridge); };
  open(scene);
  bodies_["ep1"].link_up = false;
  const hal::TimeNs began = time_.now_ns();
  run(50);
  EXPECT_GE(time_.now_ns() - began, 3'000 * kMs);
  EXPECT_EQ(left_out.size(), 1U);
  EXPECT_NE(log_.find("'ep1' on fake:ep1 is not there, and is simulated: cable out"), std::string::npos) << log_;
  EXPECT_NEAR(pose("ep1").x_m, 0.05 * 4.9, 1e-9);  // as any simulated robot
  ASSERT_EQ(session_->report().robots.size(), 1U);
  EXPECT_EQ(session_->report().robots[0].id, "ep0");
  EXPECT_TRUE(has_driven("ep0"));
  EXPECT_TRUE(bodies_["ep1"].received.empty());
}

TEST_F(MixedRun, ARobotThatIsNotThereIsWaitedForWhereItsBridgeSaysSo) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0);
  real(scene, "ep0");
  scene.scenario.robots[0].bridge->if_missing = core::IfMissing::Wait;
  open(scene);
  bodies_["ep0"].link_up = false;
  std::atomic<bool> stop{false};
  time_.on_sleep = [&](hal::TimeNs now_ns) {
    if (now_ns > 60'000 * kMs) bodies_["ep0"].link_up = true;
  };
  EXPECT_TRUE(session_->connect(stop).ok());
  EXPECT_GT(time_.now_ns(), 60'000 * kMs);
}

TEST_F(MixedRun, OneActionReArmsAllThatAreProvedAndOthersAreReArmedByTheirNames) {
  core::Scene scene = drive(0.05, 0.05);
  for (int i = 0; i < 4; ++i) {
    const std::string id = "ep" + std::to_string(i);
    scene.robot(id, -1.0, 0.5 * i - 0.75);
    real(scene, id);
  }
  std::uint64_t freezes = 0;
  options_.freezes = [&freezes] { return freezes; };
  open(scene);
  int wrong = 0;
  run(160, [&](core::World& world) {
    const hal::Tick tick = world.tick();
    bodies_["ep1"].link_up = tick < 10 || tick >= 32;  // 2.2 s
    if (tick == 20) ++bodies_["ep2"].session;
    if (tick == 20) bodies_["ep3"].name = "another one";
    if (tick == 20) ++bodies_["ep3"].session;
    if (tick == 36) freezes = 1;
    if (tick > 40 && tick <= 60) wrong += bodies_["ep0"].stands() ? 0 : 1;
    if (tick == 60) {
      EXPECT_TRUE(session_->rearm("*").ok());
    }
    if (tick > 70) wrong += bodies_["ep0"].stands() ? 1 : 0;
    if (tick > 40 && tick <= 100) {
      for (const char* id : {"ep1", "ep2", "ep3"}) wrong += bodies_[id].stands() ? 0 : 1;
    }
    if (tick == 90) {
      const hal::Status all = session_->rearm("*");
      EXPECT_FALSE(all.ok());
      if (!all.ok()) {
        EXPECT_NE(all.error().message.find("'ep1': was away for long"), std::string::npos) << all.error().message;
        EXPECT_NE(all.error().message.find("name: 'fake' was armed, 'another one' answers"), std::string::npos)
            << all.error().message;
      }
    }
    if (tick == 100) {
      for (const char* id : {"ep1", "ep2", "ep3"}) EXPECT_TRUE(session_->rearm(id).ok()) << id;
    }
    if (tick > 115) {
      for (const char* id : {"ep1", "ep2", "ep3"}) wrong += bodies_[id].stands() ? 1 : 0;
    }
  });
  EXPECT_EQ(wrong, 0);
}

TEST_F(MixedRun, ARobotThatRestartedWaitsForThePersonWhoReArmsIt) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", 0.0, 0.0);
  real(scene, "ep0");
  scene.scenario.robots[0].bridge->rearm = "operator";
  std::atomic<bool> rearm{false};
  options_.rearm_asked = &rearm;
  open(scene);
  bool stood = true;
  run(100, [&](core::World& world) {
    bodies_["ep0"].stopped_itself = world.tick() == 20;
    if (world.tick() > 25 && world.tick() <= 60) stood = stood && bodies_["ep0"].stands();
    rearm = world.tick() == 60;
  });
  EXPECT_TRUE(stood);
  EXPECT_EQ(session_->report().robots[0].state, "driving");
  EXPECT_EQ(session_->report().robots[0].counts.stops, 1U);
}

TEST_F(MixedRun, AnEmergencyStopBetweenTwoTicksStandsTheRobotsWithin20MsUntilTheyAreArmed) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0).robot("ep1", -1.0, 0.5).robot("ep2", -1.0, -0.5);
  real(scene, "ep0");
  open(real(scene, "ep1"));
  connect();
  hal::TimeNs asked_ns = 0;
  time_.on_sleep = [&](hal::TimeNs now_ns) {
    if (asked_ns != 0 || session_->world().tick() != 50) return;
    asked_ns = now_ns;
    session_->emergency_stop();
  };
  double driven_by_simulated_m = 0.0;
  const hal::Status done = session_->run(150, kGoOn, [&](core::World& world) {
    if (world.tick() > 50 && world.tick() <= 100) {
      for (const RealRobotStatus& robot : session_->status()) {
        EXPECT_EQ(robot.state, "emergency stop; waits to be armed") << world.tick();
        EXPECT_TRUE(robot.emergency_stopped);
        EXPECT_FALSE(robot.driving);
      }
    }
    if (world.tick() == 50) driven_by_simulated_m = pose("ep2").x_m;
    if (world.tick() == 90) driven_by_simulated_m = pose("ep2").x_m - driven_by_simulated_m;
    if (world.tick() != 100) return;
    EXPECT_FALSE(session_->arm("ep2").ok());
    EXPECT_FALSE(session_->rearm("ep0").ok());
    EXPECT_TRUE(session_->arm("ep0").ok());
    EXPECT_FALSE(session_->arm("ep0").ok());
  });
  ASSERT_TRUE(done.ok()) << done.error().message;
  ASSERT_NE(asked_ns, 0);
  for (const std::string id : {"ep0", "ep1"}) {
    hal::TimeNs stopped_ns = 0, drives_again_ns = 0;
    for (const FakeBody::Received& command : bodies_[id].received) {
      if (command.at_ns < asked_ns) continue;
      if (stopped_ns == 0 && command.wheels.left_m_s == 0.0) stopped_ns = command.at_ns;
      if (stopped_ns != 0 && drives_again_ns == 0 && command.wheels.left_m_s != 0.0) drives_again_ns = command.at_ns;
    }
    EXPECT_LE(stopped_ns - asked_ns, 20 * kMs) << id;
    if (id == "ep0")
      EXPECT_GT(drives_again_ns - asked_ns, 5 * hal::kNsPerSecond) << "armed at tick 100";
    else
      EXPECT_EQ(drives_again_ns, 0) << "nobody armed it";
  }
  EXPECT_NEAR(driven_by_simulated_m, 0.2, 0.01) << "simulated robots go on";
}

TEST_F(MixedRun, TellsWhereARealRobotIsByEachSourceAndHowOldItsReadingsAre) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0);
  open(real(scene, "ep0"));
  run(20, [&](core::World& world) {
    if (world.tick() != 10) return;
    const std::vector<RealRobotStatus> all = session_->status();
    ASSERT_EQ(all.size(), 1U);
    EXPECT_EQ(all[0].id, "ep0");
    EXPECT_TRUE(all[0].driving) << all[0].state;
    ASSERT_EQ(all[0].places.size(), 2U);
    EXPECT_EQ(all[0].places[0].source, "odometry");
    EXPECT_NEAR(all[0].places[0].age_s, 0.1, 0.001) << "of the tick before";
    EXPECT_NEAR(all[0].places[1].pose.x_m - all[0].places[0].pose.x_m, 0.005, 0.001) << "carried on for a tick";
  });
}

TEST_F(MixedRun, AStallOfTheHubIsCountedAndDoesNotMoveTheTwinFromTheRobot) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0);
  open(real(scene, "ep0"));
  run(60, [&](core::World& world) {
    if (world.tick() == 30) time_.pass(2'000 * kMs);
  });
  const MixedReport report = session_->report();
  EXPECT_EQ(report.pace.skipped_slots, 19U);
  EXPECT_EQ(report.pace.deadline_misses, 1U);
  EXPECT_EQ(report.robots[0].poses_rejected, 0U);
  bodies_["ep0"].move_to(time_.now_ns());
  EXPECT_NEAR(report.robots[0].pose.x_m, bodies_["ep0"].pose.x_m, 0.0051);  // the last tick's, at the end of that tick
}

TEST_F(MixedRun, AfterGuardiansHaveStoppedTheRobotsTheyWaitForTheirRearm) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0);
  std::uint64_t freezes = 0;
  options_.freezes = [&freezes] { return freezes; };
  real(scene, "ep0");
  scene.scenario.robots[0].bridge->rearm = "after 2 s";
  open(scene);
  run(60, [&](core::World& world) {
    if (world.tick() == 30) freezes = 1;  // shorter than a tick's delay that it would notice itself
    if (world.tick() >= 31 && world.tick() < 50) {
      EXPECT_TRUE(bodies_["ep0"].stands()) << world.tick();
    }
  });
  const MixedReport report = session_->report();
  EXPECT_EQ(report.robots[0].state, "driving");
  EXPECT_EQ(report.robots[0].counts.stops, 1U);
  ASSERT_GE(report.robots[0].incidents.size(), 3U);
  EXPECT_NE(report.robots[0].incidents[2].find("hub was frozen"), std::string::npos) << report.robots[0].incidents[2];
}

TEST_F(MixedRun, ARobotThatIsHeldFastWhileItsWheelsTurnIsStoppedAndDrivesOnWhenItIsFree) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -1.5, 0.0);
  real(scene, "ep0");
  scene.scenario.robots[0].tracker = core::TrackerConfig{"positioning", {}, 8};
  scene.scenario.robots[0].bridge->rearm = "after 0.5 s";
  bodies_["ep0"].tells_place = true;
  open(scene);
  FakeBody& body = bodies_["ep0"];
  int stood = -1;
  run(120, [&](core::World& world) {
    body.held_fast = world.tick() >= 50 && stood < 0;
    EXPECT_TRUE(world.tick() != 50 || !body.stands());
    if (world.tick() > 50 && stood < 0 && body.stands()) stood = static_cast<int>(world.tick());
  });
  EXPECT_GT(stood, 50);
  EXPECT_LE(stood, 71) << "two spans of a second";
  const MixedReport report = session_->report();
  EXPECT_EQ(report.robots[0].state, "driving");
  EXPECT_EQ(report.robots[0].counts.stops, 1U);
  EXPECT_NE(log_.find("wheels and pose differ"), std::string::npos) << log_;
  EXPECT_LT(distance(report.robots[0].pose, body.pose), 0.03);
  // One that goes by its wheels alone cannot know.
  EXPECT_GT(body.left_m, body.pose.x_m + 1.5 + 0.05);
}

TEST_F(MixedRun, NoRobotDrivesOnceNobodyGuardsThem) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -1.0, 0.0);
  bool guarded = true;
  options_.guarded = [&guarded] { return guarded; };
  open(real(scene, "ep0"));
  run(60, [&](core::World& world) {
    EXPECT_TRUE(world.tick() != 30 || !bodies_["ep0"].stands());
    guarded = world.tick() < 30;
    EXPECT_TRUE(world.tick() <= 31 || bodies_["ep0"].stands()) << world.tick();
  });
  const MixedReport report = session_->report();
  EXPECT_EQ(report.robots[0].state, "guardian gone");
  EXPECT_EQ(report.robots[0].counts.stops, 1U);
}

TEST_F(MixedRun, RobotsThatAreDrivenAtOneAnotherStopApartAndAreCounted) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -0.3, 0.0);
  scene.robot("ep1", 0.3, 0.0, std::numbers::pi);
  real(scene, "ep0");
  open(real(scene, "ep1"));
  run(100, [&](core::World&) {
    for (auto& [id, body] : bodies_) body.move_to(time_.now_ns());
    ASSERT_GE(distance(bodies_["ep0"].pose, bodies_["ep1"].pose), kDiameter_m);
  });
  EXPECT_LT(distance(bodies_["ep0"].pose, bodies_["ep1"].pose), kDiameter_m + 0.03);
  for (const RealRobotReport& robot : session_->report().robots) {
    EXPECT_GT(robot.counts.barrier.changed_ticks, 10U);
    EXPECT_NEAR(robot.counts.barrier.most_m_s, 0.1, 0.02);
    EXPECT_EQ(robot.counts.stops, 0U);
  }
  EXPECT_GT(session_->status()[0].held_back_m_s, 0.05);
}

TEST_F(MixedRun, NobodyIsAvoidedWhereTheFileSaysSo) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -0.2, 0.0);
  scene.robot("ep1", 0.2, 0.0, std::numbers::pi);
  scene.scenario.safety.avoid = core::Avoid::Nobody;
  real(scene, "ep0");
  open(real(scene, "ep1"));
  double nearest_m = 1.0;
  run(50, [&](core::World&) { nearest_m = std::min(nearest_m, distance(bodies_["ep0"].pose, bodies_["ep1"].pose)); });
  EXPECT_LT(nearest_m, kDiameter_m);
}

TEST_F(MixedRun, ARealRobotAvoidsWhatIsVirtualIfAsked) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -0.3, 0.0);
  scene.robot("sim", 0.3, 0.0, std::numbers::pi);
  scene.scenario.safety.avoid = core::Avoid::All;
  open(real(scene, "ep0"));
  run(60, [&](core::World&) {
    if (has_driven("ep0") && distance(pose("ep0"), pose("sim")) < kDiameter_m + 0.03) {
      EXPECT_LT(bodies_["ep0"].wheels.left_m_s, 0.1);
    }
  });
  EXPECT_LT(bodies_["ep0"].pose.x_m, 0.0) << "it did not drive through it";
}

TEST_F(MixedRun, ARobotThatIsPushedIntoAKeepOutIsAnIncidentAndLeavesItOnly) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", 0.0, 0.0);
  scene.scenario.safety.keep_outs.push_back(
      {"pillar", {{0.3, -0.2}, {0.6, -0.2}, {0.6, 0.2}, {0.3, 0.2}}, 0.0, 1.0, 0.0, 0});
  open(real(scene, "ep0"));
  FakeBody& body = bodies_["ep0"];
  run(150, [&](core::World& world) {
    body.move_to(time_.now_ns());
    if (world.tick() == 60) {
      EXPECT_LE(body.pose.x_m, 0.3 - 0.5 * kDiameter_m);
      EXPECT_GT(body.pose.x_m, 0.3 - 0.5 * kDiameter_m - 0.03);
    }
    if (world.tick() <= 60 || world.tick() > 66) return;
    body.left_m += 0.01;  // its wheels roll with it
    body.right_m += 0.01;
    body.pose.x_m += 0.01;
  });
  EXPECT_NE(log_.find("deep in the keep-out 'pillar' at (0.2"), std::string::npos) << log_;
  EXPECT_EQ(session_->report().robots[0].counts.barrier.trespasses, 1U);
  EXPECT_LT(body.pose.x_m, 0.34) << "it drives no deeper";
}

TEST_F(MixedRun, RefusesARobotThatCannotBeMadeOrFollowed) {
  core::Scene scene = drive(0.0, 0.0);
  scene.robot("ep0", 0.0, 0.0);
  real(scene, "ep0");
  core::MadeWorld made = core::make(scene);
  const auto failing = [](const bridges::BridgeRequest&) -> bridges::MadeBridge { return hal::Error{"no such link"}; };
  auto session = MixedSession::make(std::move(made.world), failing, time_, options_);
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().message, "scene:7: error: robot 'ep0': no such link");

  scene.scenario.robots[0].tracker = core::TrackerConfig{"crystal_ball", {}, 8};
  made = core::make(scene);
  const auto making = [this](const bridges::BridgeRequest&) -> bridges::MadeBridge {
    return std::unique_ptr<bridges::RobotBridge>(std::make_unique<FakeRobot>(bodies_["ep0"]));
  };
  session = MixedSession::make(std::move(made.world), making, time_, options_);
  ASSERT_FALSE(session.ok());
  EXPECT_NE(session.error().message.find("no tracker 'crystal_ball'"), std::string::npos) << session.error().message;
}

}  // namespace
}  // namespace tandem::mixed_reality
