// Whole runs with the e-puck's bridge and the firmware emulator on pseudo-terminals, in real time. What is believed is
// what the emulated robots say they did.
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <gtest/gtest.h>
#include <mutex>
#include <numbers>
#include <thread>
#include <unistd.h>

#include "bridges/emulation/event_log.hpp"
#include "bridges/epuck/bridge.hpp"
#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/robot/epuck.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/settings/bridge_request.hpp"
#include "tests/bridges/catalog.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::mixed_reality {
namespace {

namespace emulator = bridges::epuck_emulator;
const std::atomic<bool> kGoOn{false};
const double kDiameter_m = 2.0 * hal::epuck::kind().body.radius_m;

/// An emulated e-puck on a pseudo-terminal, from its making to its end.
class EmulatedEpuck {
 public:
  struct Wheels {
    hal::TimeNs at_ns;
    std::int64_t left, right;  // steps a second, as received
  };

  EmulatedEpuck(const std::string& name, const bridges::BodyPose& start) : body_(start) {
    options_.link = "pty:" + testing::TempDir() + "tandem_" + std::to_string(getpid()) + "_" + name;
    options_.firmware = "gctronic";
    options_.body = &body_;
    options_.events = [this](hal::TimeNs at, std::string_view event, const bridges::EventFields& fields) {
      if (event != "wheels") return;
      Wheels wheels{at, 0, 0};
      for (const bridges::EventField& f : fields) {
        if (f.name == "left") wheels.left = std::get<std::int64_t>(f.value);
        if (f.name == "right") wheels.right = std::get<std::int64_t>(f.value);
      }
      const std::lock_guard lock(mutex_);
      wheels_.push_back(wheels);
    };
    options_.ready = [this](const std::string& path) {
      const std::lock_guard lock(mutex_);
      path_ = path;
      ready_.notify_all();
    };
    thread_ = std::thread([this] { status_ = emulator::run(options_, stop_); });
    std::unique_lock lock(mutex_);
    ready_.wait_for(lock, std::chrono::seconds(20), [this] { return !path_.empty(); });
  }
  ~EmulatedEpuck() { switch_off(); }

  void switch_off() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::string path() {
    const std::lock_guard lock(mutex_);
    return path_;
  }
  std::vector<Wheels> wheels() {
    const std::lock_guard lock(mutex_);
    return wheels_;
  }
  /// After `switch_off`.
  const bridges::BodyPose& pose() const { return body_.pose(); }
  const hal::Status& status() const { return status_; }

 private:
  emulator::KinematicBody body_;
  emulator::Options options_;
  std::atomic<bool> stop_{false};
  hal::Status status_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::string path_;
  std::vector<Wheels> wheels_;
  std::thread thread_;
};

/// A link that the test cuts: nothing goes through, and nobody is told.
class CutLink final : public bridges::ByteLink {
 public:
  CutLink(std::unique_ptr<bridges::ByteLink> inner, const std::atomic<bool>& cut)
      : inner_(std::move(inner)), cut_(cut) {}
  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept override {
    return cut_ ? bytes.size() : inner_->write(bytes, budget_ns);
  }
  bridges::Received read(std::span<std::uint8_t> buffer) noexcept override {
    const bridges::Received received = inner_->read(buffer);
    return cut_ ? bridges::Received{} : received;
  }
  bool wait(hal::TimeNs timeout_ns) noexcept override { return inner_->wait(timeout_ns); }
  bridges::LinkState state() const noexcept override { return inner_->state(); }
  bridges::LinkStatistics statistics() const noexcept override { return inner_->statistics(); }
  std::string name() const override { return inner_->name(); }

 private:
  std::unique_ptr<bridges::ByteLink> inner_;
  const std::atomic<bool>& cut_;
};

core::ControllerConfig config_of(const std::string& controller, const std::string& library) {
  return core::Scene(1.0, controller, library).scenario.controllers[0];
}

/// Four real e-pucks in one run: one meets a virtual robot, one is cut off for a while, one's controller throws, one is
/// avoided by a simulated robot. Run once; the tests look at what was left of it.
class FourRealEpucks : public testing::Test {
 protected:
  static constexpr hal::Tick kTicks = 100;
  static constexpr hal::Tick kCutAt = 30, kMendedAt = 55;

  static void SetUpTestSuite() {
    core::Scene scene(6.0, "obstacle_avoidance", "obstacle_avoidance");
    scene.scenario.ticks_per_second = 20;
    auto& controllers = scene.scenario.controllers;
    controllers.push_back(config_of("drive", "test_controllers"));
    controllers[1].params.attributes = {{"left", "0.1", 0}, {"right", "0.1", 0}};
    controllers.push_back(config_of("thrower", "test_controllers"));
    controllers.push_back(config_of("drive", "test_controllers"));
    const auto robot = [&](const std::string& id, double x_m, double y_m, std::size_t controller, bool is_real) {
      scene.robot(id, x_m, y_m);
      core::RobotItem& item = scene.scenario.robots.back();
      item.controller = controller;
      if (!is_real) return;
      auto& epuck = robots_[id];
      epuck = std::make_unique<EmulatedEpuck>(id, bridges::BodyPose{x_m, y_m, 0.0});
      item.bridge = core::BridgeConfig{"serial:" + epuck->path(), 0.5, {}, 1};
    };
    robot("meets", -2.0, -1.5, 0, true);
    robot("dummy", -1.85, -1.495, 3, false);
    robot("is_cut", -2.0, -0.5, 1, true);
    robot("throws", -2.0, 0.5, 2, true);
    robot("avoided", -2.0, 1.5, 3, true);
    robot("comes", -2.25, 1.505, 0, false);

    made_ = core::make(scene);
    ASSERT_TRUE(made_.world) << made_.all_problems();
    MixedOptions options;
    auto session = MixedSession::make(std::move(made_.world), &make_robot, time_, options);
    ASSERT_TRUE(session.ok()) << session.error().message;
    const hal::Status connected = session.value()->connect(kGoOn);
    ASSERT_TRUE(connected.ok()) << connected.error().message;
    const hal::Status ran = session.value()->run(kTicks, kGoOn, [&session](core::World& world) {
      if (world.tick() == kCutAt) cut_ = true;
      if (world.tick() == kMendedAt) cut_ = false;
      if (world.tick() > kMendedAt) (void)session.value()->rearm("is_cut");  // where the machine made it a long outage
      const core::Space& space = world.space();
      nearest_m_ = std::min(nearest_m_,
                            distance(space.pose(space.find_robot("comes")), space.pose(space.find_robot("avoided"))));
      if (world.tick() == kMendedAt - 1) held_while_cut_ = space.halted(space.find_robot("is_cut"));
    });
    ASSERT_TRUE(ran.ok()) << ran.error().message;
    report_ = session.value()->report();
    end_of_comes_ = session.value()->world().space().pose(session.value()->world().space().find_robot("comes"));
    session.value().reset();
    for (auto& [id, epuck] : robots_) epuck->switch_off();
  }
  static void TearDownTestSuite() { robots_.clear(); }

  static bridges::MadeBridge make_robot(const bridges::BridgeRequest& request) {
    if (request.robot != "is_cut") return make_bridge(test::bridges(), request, {});
    bridges::epuck::BridgeSettings settings;
    bridges::apply(request, settings);
    settings.link = request.link;
    settings.driver.timing = bridges::epuck::timing_for(request.link);
    const auto opener = bridges::epuck::epuck_link(request.link);
    if (!opener.ok()) return opener.error();
    const auto open = [inner_opener = opener.value().open]() -> hal::Result<std::unique_ptr<bridges::ByteLink>> {
      auto inner = inner_opener();
      if (!inner.ok()) return inner.error();
      return std::unique_ptr<bridges::ByteLink>(std::make_unique<CutLink>(std::move(inner).value(), cut_));
    };
    return std::unique_ptr<bridges::RobotBridge>(
        std::make_unique<bridges::epuck::EpuckBridge>(std::move(settings), open));
  }
  static double distance(const core::Pose& a, const core::Pose& b) { return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m); }
  static const RealRobotReport& report_of(const std::string& id) {
    return *std::find_if(report_.robots.begin(), report_.robots.end(),
                         [&](const RealRobotReport& r) { return r.id == id; });
  }
  static bool was_told_to_drive(const std::string& id) {
    const auto wheels = robots_[id]->wheels();
    return std::any_of(wheels.begin(), wheels.end(), [](const auto& w) { return w.left != 0 || w.right != 0; });
  }

  static inline std::map<std::string, std::unique_ptr<EmulatedEpuck>> robots_;
  static inline std::atomic<bool> cut_{false};
  static inline MonotonicTime time_;
  static inline core::MadeWorld made_;
  static inline MixedReport report_;
  static inline core::Pose end_of_comes_;
  static inline double nearest_m_ = 10.0;
  static inline bool held_while_cut_ = false;
};

TEST_F(FourRealEpucks, AllStandAtTheEndAndHaveConfirmedIt) {
  ASSERT_EQ(report_.robots.size(), 4U);
  for (const RealRobotReport& r : report_.robots) EXPECT_TRUE(r.stop_confirmed) << r.id;
  for (auto& [id, epuck] : robots_) {
    EXPECT_TRUE(epuck->status().ok());
    const auto wheels = epuck->wheels();
    ASSERT_FALSE(wheels.empty()) << id;
    EXPECT_EQ(wheels.back().left, 0) << id;
    EXPECT_EQ(wheels.back().right, 0) << id;
  }
  EXPECT_TRUE(was_told_to_drive("meets"));
  EXPECT_TRUE(was_told_to_drive("is_cut"));
}

TEST_F(FourRealEpucks, OneTurnsAwayFromAVirtualRobotThatItsOwnSensorsCannotSee) {
  const auto wheels = robots_["meets"]->wheels();
  EXPECT_TRUE(std::any_of(wheels.begin(), wheels.end(), [](const auto& w) { return w.left != w.right; }));
  EXPECT_GT(std::fabs(robots_["meets"]->pose().heading_rad), 0.2);
  EXPECT_GT(std::hypot(robots_["meets"]->pose().x_m + 1.85, robots_["meets"]->pose().y_m + 1.495), kDiameter_m - 0.005);
}

TEST_F(FourRealEpucks, ASimulatedRobotSeesOneAndDoesNotTouchIt) {
  EXPECT_GT(nearest_m_, kDiameter_m);
  EXPECT_LT(nearest_m_, kDiameter_m + 0.1);
  EXPECT_GT(std::fabs(end_of_comes_.y_m - 1.505), 0.005);
}

TEST_F(FourRealEpucks, TwinsAreWhereTheRobotsAre) {
  for (const char* id : {"meets", "throws", "avoided"}) {
    const bridges::BodyPose& truth = robots_[id]->pose();
    EXPECT_NEAR(report_of(id).pose.x_m, truth.x_m, 0.02) << id;
    EXPECT_NEAR(report_of(id).pose.y_m, truth.y_m, 0.02) << id;
    EXPECT_EQ(report_of(id).poses_rejected, 0U) << id;
  }
}

TEST_F(FourRealEpucks, TheOneThatWasCutOffIsHeldAndGetsUnderWayAgainFromZero) {
  EXPECT_TRUE(held_while_cut_);
  const RealRobotReport& report = report_of("is_cut");
  EXPECT_GE(report.counts.stops, 1U);
  EXPECT_EQ(report.counts.rearms, report.counts.stops + 1);
  EXPECT_TRUE(report.driving) << report.state;
  EXPECT_GE(report.conversation.resynchronised, 1U);
  // From every standstill the speed grows in small steps: 0.25 m/s2 in the 50 ms of a tick, doubled for a tick that
  // came late.
  const auto largest_step = static_cast<std::int64_t>(2.0 * 0.25 * 0.05 / (0.041 * std::numbers::pi / 1000)) + 2;
  const auto wheels = robots_["is_cut"]->wheels();
  for (std::size_t i = 1; i < wheels.size(); ++i) {
    EXPECT_LE(wheels[i].left - wheels[i - 1].left, largest_step) << i;
  }
  const bool again = std::any_of(wheels.begin(), wheels.end(), [](const auto& w) { return w.left > 700; });
  EXPECT_TRUE(again);
}

TEST_F(FourRealEpucks, TheOneWhoseControllerThrowsNeverMovesAgain) {
  EXPECT_EQ(report_of("throws").state, "controller failed");
  EXPECT_FALSE(report_of("throws").driving);
  EXPECT_LT(robots_["throws"]->pose().x_m, -2.0 + 0.05);
}

TEST_F(FourRealEpucks, TheLedgerAddsUp) {
  EXPECT_EQ(report_.pace.step.count(), static_cast<std::uint64_t>(kTicks));
  EXPECT_GT(report_of("meets").conversation.answers, 50U);
}

TEST(RealEpuck, AHangingHubIsStoppedByItsOwnBridge) {
  EmulatedEpuck epuck("hangs", {});
  core::Scene scene(6.0, "drive");
  scene.scenario.ticks_per_second = 20;
  scene.param("left", "0.1").param("right", "0.1").robot("ep0", 0.0, 0.0);
  scene.scenario.robots[0].bridge = core::BridgeConfig{"serial:" + epuck.path(), 0.3, {}, 1};
  core::MadeWorld made = core::make(scene);
  ASSERT_TRUE(made.world) << made.all_problems();
  MonotonicTime time;
  auto session = MixedSession::make(
      std::move(made.world),
      [](const bridges::BridgeRequest& request) { return make_bridge(test::bridges(), request, {}); }, time, {});
  ASSERT_TRUE(session.ok()) << session.error().message;
  ASSERT_TRUE(session.value()->connect(kGoOn).ok());
  EmulatedEpuck::Wheels before{}, during{};
  ASSERT_TRUE(session.value()
                  ->run(30, kGoOn,
                        [&](core::World& world) {
                          if (world.tick() != 25) return;
                          before = epuck.wheels().back();
                          // Hangs until the robot stands; were it never stopped, the test would run into its limit.
                          do {
                            time.sleep_until(time.now_ns() + 10 * hal::kNsPerMs, kGoOn);
                            during = epuck.wheels().back();
                          } while (during.left != 0 || during.right != 0);
                        })
                  .ok());
  EXPECT_GT(before.left, 0);
  EXPECT_GE(during.at_ns - before.at_ns, 250 * hal::kNsPerMs);
  EXPECT_GE(session.value()->report().pace.skipped_slots, 3U);
}

TEST(RealEpuck, SaysWhatIsWrongWhenNobodyIsThere) {
  core::Scene scene(6.0, "drive");
  scene.robot("ep0", 0.0, 0.0);
  scene.scenario.robots[0].bridge = core::BridgeConfig{"serial:/dev/no_such_device", 0.5, {}, 1};
  scene.scenario.robots[0].bridge->connect_s = 0.1;
  scene.scenario.robots[0].bridge->stop_s = 0.02;
  core::MadeWorld made = core::make(scene);
  MonotonicTime time;
  MixedOptions options;
  auto session = MixedSession::make(
      std::move(made.world),
      [](const bridges::BridgeRequest& request) { return make_bridge(test::bridges(), request, {}); }, time, options);
  ASSERT_TRUE(session.ok()) << session.error().message;
  const hal::Status connected = session.value()->connect(kGoOn);
  ASSERT_FALSE(connected.ok());
  EXPECT_NE(connected.error().message.find("'ep0' on serial:/dev/no_such_device"), std::string::npos)
      << connected.error().message;
}

}  // namespace
}  // namespace tandem::mixed_reality
