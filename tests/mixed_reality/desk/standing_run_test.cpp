// A run that is held, paused, looked over before it begins, and whose robots are replaced: fake robots, fake time.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <thread>

#include "mixed_reality/desk/preflight.hpp"
#include "tests/core/scenes.hpp"
#include "tests/mixed_reality/fake_robot.hpp"
#include "tests/mixed_reality/time/fake_time.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
const std::atomic<bool> kGoOn{false};

class StandingRun : public testing::Test {
 protected:
  void open(core::Scene scene) {
    for (core::RobotItem& item : scene.scenario.robots) {
      item.bridge = core::BridgeConfig{"fake:" + item.id, 0.5, {}, 7};
      item.bridge->connect_s = 3.0;
      bodies_[item.id].pose = core::Pose::at(item.placement.p_W[0], item.placement.p_W[1], item.placement.yaw_rad);
    }
    made_ = core::make(scene);
    ASSERT_TRUE(made_.world) << made_.all_problems();
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
  void stand(double for_s) {
    const hal::TimeNs began_ns = time_.now_ns();
    ASSERT_TRUE(session_->stand_by([&] { return hal::to_seconds(time_.now_ns() - began_ns) >= for_s; }, kGoOn).ok());
  }
  static const PreflightRow* row(const PreflightRows& rows, const std::string& about, const std::string& check) {
    for (const PreflightRow& r : rows) {
      if (r.about == about && r.check == check) return &r;
    }
    return nullptr;
  }
  bool moved(const std::string& id, hal::TimeNs since_ns, hal::TimeNs until_ns) {
    return std::ranges::any_of(bodies_[id].received, [&](const auto& r) {
      return r.at_ns > since_ns && r.at_ns < until_ns && (r.wheels.left_m_s != 0.0 || r.wheels.right_m_s != 0.0);
    });
  }

  FakeTime time_{7'000'000'000};
  std::map<std::string, FakeBody> bodies_;
  MixedOptions options_;
  std::string log_;
  core::MadeWorld made_;
  std::unique_ptr<MixedSession> session_;
};

core::Scene drive() {
  core::Scene scene(4.0, "drive");
  scene.param("left", "0.05").param("right", "0.05");
  return scene;
}

TEST_F(StandingRun, TimeStandsStillWhileItIsPausedAndSoDoRealRobotsButNotTheirConversation) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0);
  hal::TimeNs until_ns = 0;
  options_.while_paused = [&] {
    if (time_.now_ns() < until_ns) return;
    EXPECT_TRUE(session_->go_on().ok());
  };
  open(scene);
  ASSERT_TRUE(session_->connect(kGoOn).ok());
  hal::TimeNs paused_ns = 0;
  std::uint64_t ticks = 0;
  ASSERT_TRUE(session_
                  ->run(40, kGoOn,
                        [&](core::World& world) {
                          ++ticks;
                          if (world.tick() != 20) return;
                          session_->pause();
                          paused_ns = time_.now_ns();
                          until_ns = paused_ns + 3000 * kMs;
                        })
                  .ok());
  EXPECT_EQ(ticks, 40U);
  EXPECT_TRUE(moved("ep0", 0, paused_ns));
  EXPECT_FALSE(moved("ep0", paused_ns, until_ns));
  EXPECT_TRUE(moved("ep0", until_ns + 400 * kMs, time_.now_ns())) << "it settles, and drives again";
  const auto& received = bodies_["ep0"].received;
  EXPECT_GT(std::ranges::count_if(received, [&](const auto& r) { return r.at_ns > paused_ns && r.at_ns < until_ns; }),
            20);
  EXPECT_EQ(session_->report().pace.deadline_misses, 0U);
  EXPECT_EQ(session_->report().robots[0].counts.ticks_driving + session_->report().robots[0].counts.ticks_held, 40U);
}

TEST_F(StandingRun, HeldAtTheStartNoTickIsDoneUntilSomebodyStartsIt) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0);
  int looks = 0;
  options_.hold = true;
  options_.while_paused = [&] {
    EXPECT_EQ(session_->world().tick(), 0);
    EXPECT_EQ(session_->status()[0].state, "waiting for the start");
    if (++looks != 100) return;
    EXPECT_TRUE(session_->go_on().ok());
  };
  open(scene);
  ASSERT_TRUE(session_->connect(kGoOn).ok());
  ASSERT_TRUE(session_->run(10, kGoOn).ok());
  EXPECT_EQ(looks, 100);
  EXPECT_EQ(session_->world().tick(), 10);
}

TEST_F(StandingRun, AnotherRobotTakesThePlaceAndStandsUntilItIsArmed) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0);
  open(scene);
  ASSERT_TRUE(session_->connect(kGoOn).ok());
  bodies_["spare"].pose = core::Pose::at(0.5, 0.5, 1.0);
  bodies_["spare"].health_when_up = LinkHealth::Connecting;
  hal::TimeNs replaced_ns = 0, armed_ns = 0;
  ASSERT_TRUE(
      session_
          ->run(120, kGoOn,
                [&](core::World& world) {
                  if (world.tick() == 20) {
                    replaced_ns = time_.now_ns();
                    EXPECT_TRUE(session_->replace("ep0", {"spare", "fake:spare", {}, bodies_["spare"].pose}).ok());
                    EXPECT_FALSE(session_->replace("ep0", {"other", "fake:other", {}, {}}).ok());
                  }
                  if (world.tick() == 30) {
                    EXPECT_EQ(session_->status()[0].state, "being replaced");
                    EXPECT_EQ(session_->status()[0].coming, "spare");
                    bodies_["spare"].health_when_up = LinkHealth::Active;
                  }
                  if (world.tick() == 60) {
                    EXPECT_EQ(session_->status()[0].state, "waits to be armed");
                    EXPECT_EQ(session_->status()[0].device, "spare");
                    EXPECT_TRUE(session_->arm("ep0").ok());
                    armed_ns = time_.now_ns();
                  }
                })
          .ok())
      << log_;
  EXPECT_TRUE(moved("ep0", 0, replaced_ns));
  EXPECT_FALSE(moved("ep0", replaced_ns, time_.now_ns()));
  EXPECT_FALSE(moved("spare", 0, armed_ns));
  EXPECT_TRUE(moved("spare", armed_ns, time_.now_ns()));
  const core::Pose twin = session_->world().space().pose(session_->world().space().find_robot("ep0"));
  EXPECT_LT(std::hypot(twin.x_m - bodies_["spare"].pose.x_m, twin.y_m - bodies_["spare"].pose.y_m), 0.01);
  ASSERT_EQ(session_->report().replacements.size(), 1U);
  EXPECT_EQ(session_->report().replacements[0].after, "spare");
  for (auto& [id, body] : bodies_) EXPECT_TRUE(body.stands()) << id;
}

TEST_F(StandingRun, ARobotThatNeverComesLeavesTheOldOneStandingUntilItIsArmed) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0);
  std::size_t joined = 0, left_out = 0;
  options_.on_joined = [&](const bridges::RobotBridge&) -> hal::Status {
    ++joined;
    return {};
  };
  options_.on_left_out = [&](const bridges::RobotBridge&) { ++left_out; };
  open(scene);
  ASSERT_TRUE(session_->connect(kGoOn).ok());
  bodies_["spare"].link_up = false;
  hal::TimeNs armed_ns = 0;
  ASSERT_TRUE(
      session_
          ->run(100, kGoOn,
                [&](core::World& world) {
                  if (world.tick() == 20) {
                    EXPECT_TRUE(session_->replace("ep0", {"spare", "fake:spare", {}, {}}).ok());
                  }
                  if (world.tick() == 59) {
                    EXPECT_EQ(session_->status()[0].state, "waits to be armed");
                    EXPECT_EQ(session_->status()[0].device, "ep0");
                  }
                  if (world.tick() == 60) {
                    EXPECT_NE(log_.find("is not replaced: 'spare' on fake:spare did not answer"), std::string::npos)
                        << log_;
                    EXPECT_TRUE(bodies_["ep0"].stands());
                    EXPECT_TRUE(session_->arm("ep0").ok());
                    armed_ns = time_.now_ns();
                  }
                })
          .ok());
  EXPECT_TRUE(moved("ep0", armed_ns, time_.now_ns()));
  session_->shut_down();
  EXPECT_EQ(joined, 1U);
  EXPECT_EQ(left_out, 1U) << "no guardian waits for a robot that was never there";
  EXPECT_EQ(log_.find("did not confirm its stop"), std::string::npos) << log_;
  EXPECT_TRUE(session_->report().replacements.empty());
}

TEST_F(StandingRun, ARobotThatDidNotComeMayBeSwitchedOnAndTriedAgain) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0);
  open(scene);
  ASSERT_TRUE(session_->connect(kGoOn).ok());
  bodies_["spare"].link_up = false;
  bool again = false;
  std::atomic<bool> stop{false};
  ASSERT_TRUE(session_
                  ->run(200'000, stop,
                        [&](core::World& world) {
                          if (world.tick() == 20) {
                            EXPECT_TRUE(session_->replace("ep0", {"spare", "fake:spare", {}, {}}).ok());
                          }
                          // Its link is closed by another thread, in true time: asked again until that is done.
                          if (world.tick() >= 60 && !again) {
                            const hal::Status status = session_->replace("ep0", {"spare", "fake:spare", {}, {}});
                            again = status.ok();
                            if (again) {
                              bodies_["spare"].link_up = true;
                            } else {
                              EXPECT_NE(status.error().message.find("try again"), std::string::npos)
                                  << status.error().message;
                              std::this_thread::sleep_for(std::chrono::milliseconds(1));
                            }
                          }
                          if (session_->status()[0].device == "spare") stop = true;
                        })
                  .ok())
      << log_;
  EXPECT_EQ(session_->status()[0].device, "spare");
}

TEST_F(StandingRun, PreflightFindsWhatIsInTheWayAndMovesNothing) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0).robot("ep1", 1.0, 0.0).robot("ep2", 1.082, 0.0);
  bodies_["ep0"].link_up = false;
  open(scene);
  stand(2.0);
  const PreflightRows rows = look_over(*session_);
  ASSERT_NE(row(rows, "robot ep0", "link"), nullptr);
  EXPECT_EQ(row(rows, "robot ep0", "link")->finding, Finding::Fail);
  EXPECT_EQ(row(rows, "robot ep0", "link")->found, "fake:ep0: cable out");
  EXPECT_EQ(row(rows, "robot ep0", "link")->advice, "is it switched on?");
  EXPECT_EQ(row(rows, "robot ep1", "link")->finding, Finding::Ok);
  EXPECT_EQ(row(rows, "robot ep1", "firmware")->found, "fake");
  ASSERT_NE(row(rows, "robot ep1", "apart"), nullptr);
  EXPECT_EQ(row(rows, "robot ep1", "apart")->finding, Finding::Warn);
  EXPECT_EQ(worst_of(rows), Finding::Fail);
  for (const char* id : {"ep0", "ep1", "ep2"}) EXPECT_FALSE(moved(id, 0, time_.now_ns())) << id;
}

TEST_F(StandingRun, FirstMotionTurnsOneRobotAndBackAndTellsOneThatDoesNotTurn) {
  core::Scene scene = drive();
  scene.robot("ep0", -1.0, 0.0).robot("ep1", 1.0, 0.0);
  open(scene);
  stand(1.0);
  const PreflightRows good = try_motion(*session_, "ep0", kGoOn);
  ASSERT_EQ(good.size(), 1U);
  EXPECT_EQ(good[0].finding, Finding::Ok) << good[0].found << good[0].advice;
  EXPECT_TRUE(moved("ep0", 0, time_.now_ns()));
  EXPECT_FALSE(moved("ep1", 0, time_.now_ns()));
  EXPECT_NEAR(bodies_["ep0"].pose.heading_rad(), 0.0, 0.1) << "and back";
  EXPECT_TRUE(bodies_["ep0"].stands());
  bodies_["ep1"].health_when_up = LinkHealth::Suspect;
  const PreflightRows bad = try_motion(*session_, "ep1", kGoOn);
  ASSERT_EQ(bad.size(), 1U);
  EXPECT_EQ(bad[0].finding, Finding::Fail);
  EXPECT_NE(bad[0].found.find("it may not drive: link suspect"), std::string::npos) << bad[0].found;
  EXPECT_FALSE(moved("ep1", 0, time_.now_ns()));
}

}  // namespace
}  // namespace tandem::mixed_reality
