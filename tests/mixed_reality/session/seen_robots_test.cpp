// Real robots whose links are swapped, or that obey late, in whole runs; the verdicts are the bodies' own.
#include <cmath>
#include <gtest/gtest.h>

#include "mixed_reality/session/mixed_session.hpp"
#include "tests/core/scenes.hpp"
#include "tests/mixed_reality/fake_robot.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::mixed_reality {
namespace {

using core::Presence;
using core::RollRow;

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const std::atomic<bool> kGoOn{false};

/// A camera without noise, which sees each body under the name of its tag whenever it is asked.
class Camera final : public bridges::Tracker {
 public:
  /// `tags`: of bodies that wear another one than their own.
  Camera(const std::map<std::string, FakeBody>& bodies, const std::map<std::string, std::string>& tags, FakeTime& time)
      : bodies_(bodies), tags_(tags), time_(time) {}
  hal::Status start() override { return {}; }
  std::size_t take(std::span<bridges::Sighting> into) noexcept override {
    std::size_t count = 0;
    for (const auto& [name, body] : bodies_) {
      const auto other = tags_.find(name);
      bridges::Sighting seen;
      (void)seen.set_name(other == tags_.end() ? name : other->second);
      seen.received_ns = time_.now_ns();
      seen.p_m = {body.pose.x_m, body.pose.y_m, 0.0};
      seen.heading_rad = body.pose.heading_rad();
      into[count++] = seen;
    }
    return count;
  }
  bridges::TrackerReport report() const override { return {}; }

 private:
  const std::map<std::string, FakeBody>& bodies_;
  const std::map<std::string, std::string>& tags_;
  FakeTime& time_;
};

class SeenRobots : public testing::Test {
 protected:
  /// `behind[id]`: the body at the other end of that robot's link; its own where it is not named.
  void open(core::Scene& scene, std::map<std::string, std::string> behind = {}) {
    for (core::RobotItem& item : scene.scenario.robots) {
      item.bridge = core::BridgeConfig{"fake:" + item.id, 0.5, {}, 7};
      if (!rearm_.empty()) item.bridge->rearm = rearm_;
      const double heading_rad = item.placement.yaw_rad;
      bodies_[item.id].pose = {item.placement.p_W[0], item.placement.p_W[1], 0.0, std::cos(heading_rad),
                               std::sin(heading_rad)};
    }
    made_ = core::make(scene);
    ASSERT_TRUE(made_.world) << made_.all_problems();
    options_.log = hal::Log([this](hal::Severity, std::string_view text) { log_ += std::string(text) + "\n"; });
    options_.make_tracker = [this](const core::TrackerItem&) -> bridges::MadeTracker {
      return std::unique_ptr<bridges::Tracker>(std::make_unique<Camera>(bodies_, tags_, time_));
    };
    auto session = MixedSession::make(
        std::move(made_.world),
        [this, behind](const bridges::BridgeRequest& request) -> bridges::MadeBridge {
          const auto other = behind.find(request.robot);
          FakeBody& body = bodies_[other == behind.end() ? request.robot : other->second];
          return std::unique_ptr<bridges::RobotBridge>(std::make_unique<FakeRobot>(body));
        },
        time_, options_);
    ASSERT_TRUE(session.ok()) << session.error().message;
    session_ = std::move(session).value();
  }
  void run(hal::Tick ticks, const std::function<void(core::World&)>& after_tick) {
    const hal::Status connected = session_->connect(kGoOn);
    ASSERT_TRUE(connected.ok()) << connected.error().message;
    const hal::Status done = session_->run(ticks, kGoOn, after_tick);
    ASSERT_TRUE(done.ok()) << done.error().message;
  }
  const RealRobotReport& report_of(const std::string& id) {
    report_ = session_->report();
    return *std::find_if(report_.robots.begin(), report_.robots.end(), [&](const auto& r) { return r.id == id; });
  }

  FakeTime time_{7'000'000'000};
  std::map<std::string, FakeBody> bodies_;
  std::map<std::string, std::string> tags_;  ///< of bodies that wear another one than their own
  MixedOptions options_;
  std::string rearm_;  ///< of all; empty: the default
  std::string log_;
  core::MadeWorld made_;
  std::unique_ptr<MixedSession> session_;
  MixedReport report_;
};

core::Scene drive(double left_m_s, double right_m_s) {
  core::Scene scene(6.0, "drive");
  scene.param("left", std::to_string(left_m_s)).param("right", std::to_string(right_m_s));
  return scene;
}

void watch(core::Scene& scene) {
  core::TrackerItem camera;
  camera.kind = "fake";
  camera.id = "cam";
  scene.scenario.trackers.push_back(camera);
}

TEST_F(SeenRobots, WhoseLinksAreSwappedAreStoppedAndNamedBeforeEitherHasDrivenThirtyCentimetres) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -2.0, 0.0).robot("ep1", 0.0, 1.0).robot("ep2", 0.0, -1.0);
  watch(scene);
  open(scene, {{"ep0", "ep1"}, {"ep1", "ep0"}});
  const auto space_of = [this]() -> core::Space& { return session_->world().space(); };
  run(150, [&](core::World&) {  // ep1's link alone moves anything, and ep2's
    space_of().set_halted(space_of().find_robot("ep0"), true, core::HaltOwner::Operator);
  });
  EXPECT_NE(log_.find("their links seem to be swapped"), std::string::npos) << log_;
  for (const std::string id : {"ep0", "ep1"}) {
    EXPECT_LE(std::fabs(bodies_[id].left_m), 0.3) << id;
    EXPECT_TRUE(bodies_[id].stands()) << id;
    EXPECT_NE(log_.find("'" + id + "'"), std::string::npos) << id;
  }
  EXPECT_EQ(report_of("ep1").state, "links seem to be swapped; waits to be re-armed");
  EXPECT_EQ(report_of("ep2").state, "driving") << "it has nothing to do with that";
  EXPECT_GT(bodies_["ep2"].left_m, 1.0);
}

TEST_F(SeenRobots, WhoTellOneNameAndAreExchangedAtTheirPortsForASecondAreFoundByTheirMotion) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -2.0, 0.0).robot("ep1", 0.0, 1.0);
  watch(scene);
  open(scene);
  FakeBody &a = bodies_["ep0"], &b = bodies_["ep1"];
  double back_at_m = 0.0;
  run(250, [&](core::World& world) {
    // ep0 alone is driven when both are back.
    world.space().set_halted(world.space().find_robot("ep1"), world.tick() >= 60, core::HaltOwner::Operator);
    if (world.tick() == 60) a.link_up = b.link_up = false;
    if (world.tick() == 70) {  // each with its tag; their wheels' counters go on, as if they told nothing
      std::swap(a.pose, b.pose);
      a.wheels = b.wheels = {};
      tags_ = {{"ep0", "ep1"}, {"ep1", "ep0"}};
      a.link_up = b.link_up = true;
      back_at_m = a.left_m;
    }
  });
  EXPECT_GT(a.left_m, back_at_m) << "nothing else told them apart";
  EXPECT_LE(a.left_m, back_at_m + 0.3);
  EXPECT_TRUE(a.stands());
  EXPECT_NE(report_of("ep0").state, "driving") << log_;
}

TEST_F(SeenRobots, WhoSlipAgainAndAgainDriveOnByTheirPolicy) {
  core::Scene scene = drive(0.1, 0.1);
  scene.robot("ep0", -2.5, 0.0);
  watch(scene);
  rearm_ = "after 0.5 s";
  open(scene);
  int held_times = 0;
  bool held = false;
  FakeBody& body = bodies_["ep0"];
  run(400, [&](core::World& world) {
    const bool hold = world.tick() % 70 >= 40 && world.tick() < 300;
    if (hold && !held) ++held_times;
    held = hold;
    body.held_fast = hold;
    body.pose.y_m += 1e-4 * (static_cast<double>(world.tick() % 3) - 1.0);  // pictures are never alike
  });
  EXPECT_GE(held_times, 4);
  EXPECT_EQ(report_of("ep0").state, "driving") << log_;
  EXPECT_GE(report_of("ep0").counts.stops, 3U);
}

TEST_F(SeenRobots, WhoIsPutSomewhereElseWaitsForAPersonAtOnce) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -2.0, 0.0);
  watch(scene);
  rearm_ = "after 0.5 s";
  open(scene);
  FakeBody& body = bodies_["ep0"];
  double rolled_m = 0.0;
  run(200, [&](core::World& world) {
    if (world.tick() == 60) {
      body.pose.y_m += 0.4;
      rolled_m = body.left_m;
    }
  });
  EXPECT_TRUE(body.stands());
  EXPECT_LE(body.left_m, rolled_m + 0.05) << "it has not driven on by itself";
  EXPECT_EQ(report_of("ep0").state, "moved by something else; waits to be re-armed");
}

TEST_F(SeenRobots, WhoDrivesWhenItsLinkBreaksIsNotKnownToRestUntilItStandsAndAnswers) {
  core::Scene scene = drive(0.05, 0.05);
  scene.robot("ep0", -2.0, 0.0).robot("ep1", -2.0, 1.0).robot("ep2", -2.0, -1.0);
  open(scene);
  std::map<std::string, std::vector<Presence>> seen;
  run(150, [&](core::World& world) {
    if (world.tick() == 40) bodies_["ep0"].link_up = false;  // deaf while it drives: it goes on
    if (world.tick() == 90) bodies_["ep0"].link_up = true;
    if (world.tick() == 60) session_->emergency_stop();
    if (world.tick() == 70) (void)session_->arm("ep2");
    for (const RollRow& row : session_->roll_call()) seen[row.id].push_back(row.presence);
  });
  EXPECT_EQ(seen["ep0"][30], Presence::Drives);
  EXPECT_EQ(seen["ep0"][50], Presence::MayMove);
  EXPECT_EQ(seen["ep0"][85], Presence::MayMove) << "an emergency stop that nobody hears changes nothing";
  EXPECT_NE(seen["ep0"][110], Presence::MayMove);
  EXPECT_EQ(seen["ep1"][69], Presence::WaitsForPerson);
  EXPECT_EQ(seen["ep2"][100], Presence::Drives);
}

class LateRobots : public SeenRobots, public testing::WithParamInterface<int> {};

/// Two robots, head-on; the bodies' own poses tell whether they touch.
TEST_P(LateRobots, DoNotTouchThoughTheyObeyLaterThanTheBarrierCountsOn) {
  for (int encounter = 0; encounter < 15; ++encounter) {
    bodies_.clear();
    log_.clear();
    const double speed_m_s = 0.07 + 0.004 * encounter;
    core::Scene scene = drive(speed_m_s, speed_m_s);
    const double half_m = 0.3 + 0.02 * encounter;
    scene.robot("ep0", -half_m, 0.0).robot("ep1", half_m, 0.002 * encounter);
    scene.scenario.robots[1].placement.yaw_rad = 3.14159265358979;
    open(scene);
    for (auto& [id, body] : bodies_) body.delay_ns = GetParam() * kMs;
    double nearest_m = 10.0;
    run(250, [&](core::World&) {
      const core::Pose &a = bodies_["ep0"].pose, &b = bodies_["ep1"].pose;
      nearest_m = std::min(nearest_m, std::hypot(a.x_m - b.x_m, a.y_m - b.y_m));
    });
    EXPECT_GT(nearest_m, 2.0 * hal::epuck::kind().body.radius_m) << "encounter " << encounter;
    EXPECT_LT(nearest_m, 0.25) << "they met";
    EXPECT_EQ(log_.find("after it is told to") != std::string::npos, GetParam() > 100) << log_;
    const double delay_s = report_of("ep0").counts.barrier.delay_s;
    if (GetParam() > 100) {
      EXPECT_GE(delay_s, 1e-3 * GetParam() - 0.01);
      EXPECT_LE(delay_s, 1e-3 * GetParam() + 0.1);
    }
    session_.reset();
  }
}
INSTANTIATE_TEST_SUITE_P(Delays, LateRobots, testing::Values(20, 220, 300));

}  // namespace
}  // namespace tandem::mixed_reality
