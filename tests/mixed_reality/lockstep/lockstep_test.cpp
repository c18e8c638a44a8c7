#include "mixed_reality/lockstep/lockstep.hpp"

#include <chrono>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mutex>
#include <thread>

#include "bridges/link/tcp_link.hpp"
#include "bridges/peer/peer_side.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/scenes.hpp"

namespace tandem::mixed_reality {
namespace {

namespace peer = bridges::peer;
using bridges::ByteLink;
using bridges::Endpoint;
using bridges::TcpLink;
using testing::HasSubstr;

/// The controller of a scene's first configuration, behind a hub's robot.
class SceneController final : public peer::PeerController {
 public:
  SceneController(const peer::RobotMessage& robot, const core::Scene& scene, hal::PluginLoader& loader)
      : robot_(robot, *test::catalog().find<hal::RobotKind>("e-puck"), test::catalog().all<hal::PortType>()) {
    const core::ControllerConfig& config = scene.scenario.controllers[0];
    type_ = loader.controller(config.library, config.label).value();
    core::Problems problems;
    core::ElementReader reader(config.params, problems);
    params_ = type_->read_params(reader);
    memory_.resize(type_->size / sizeof(std::max_align_t) + 1);
    type_->construct(memory_.data(), robot_, params_.get());
  }
  ~SceneController() override { type_->destroy(memory_.data()); }
  peer::PeerRobot& robot() noexcept override { return robot_; }
  bool step(hal::Tick, std::string& why) override {
    hal::StepFault fault;
    const std::uint8_t runs = 0;
    const bool good =
        type_->step_row(reinterpret_cast<std::byte*>(memory_.data()), type_->size, 0, 1, &runs, fault) == 1;
    why = fault.message;
    return good;
  }

 private:
  peer::PeerRobot robot_;
  const hal::ControllerType* type_ = nullptr;
  std::shared_ptr<const void> params_;
  std::vector<std::max_align_t> memory_;
};

Endpoint endpoint_of(const std::string& address) {
  return bridges::parse_endpoint("tcp", address.substr(4)).value();
}

/// A peer on a thread of its own, until the hub says End.
class Peer {
 public:
  /// `cut_at`: a tick after whose answer the connection is cut, once.
  Peer(const std::string& address, const std::string& robot, const core::Scene& scene, hal::PluginLoader& loader,
       std::uint64_t cut_at = 0)
      : thread_([this, at = endpoint_of(address), robot, &scene, &loader, cut_at] {
          peer::PeerSide side(
              robot, [&](const peer::RobotMessage& told) -> hal::Result<std::unique_ptr<peer::PeerController>> {
                try {
                  return std::unique_ptr<peer::PeerController>(std::make_unique<SceneController>(told, scene, loader));
                } catch (const std::exception& e) {
                  return hal::Error{e.what()};
                }
              });
          std::unique_ptr<ByteLink> link;
          bool cut = cut_at == 0;
          while (!side.ended() && !stop_) {
            if (link == nullptr) {
              auto opened = TcpLink::connect(at);
              if (!opened.ok()) {  // the hub is gone; another may come
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
                continue;
              }
              link = std::move(opened).value();
              side.link_opened();
            }
            side.pump(*link, bridges::monotonic_ns());
            if (!cut && side.counts().ticks >= cut_at) {
              cut = true;
              link.reset();
            } else if (link->state() != bridges::LinkState::Open) {
              link.reset();
            } else {
              link->wait(20 * hal::kNsPerMs);
            }
          }
          const std::lock_guard lock(mutex_);
          if (side.ended()) ended_ = side.ended()->text;
          counts_ = side.counts();
        }) {}
  ~Peer() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::string ended() {
    if (thread_.joinable()) thread_.join();
    return ended_;
  }
  peer::PeerCounts counts() {
    (void)ended();
    return counts_;
  }

 private:
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::string ended_;
  peer::PeerCounts counts_;
  std::thread thread_;  // the last, for it uses the others
};

/// A peer that says what the test says.
class ScriptedPeer {
 public:
  ScriptedPeer(const std::string& address, const std::string& robot) {
    link_ = TcpLink::connect(endpoint_of(address)).value();
    say(peer::MessageType::Hello, peer::bytes_of(peer::Hello{robot, {}, -1, peer::kVersion}));
  }
  void say(peer::MessageType type, const std::vector<std::uint8_t>& payload) {
    (void)link_->write(peer::frame_of(type, payload), hal::kNsPerSecond);
  }
  void say_garbage() {
    std::vector<std::uint8_t> frame = peer::frame_of(peer::MessageType::Commands, std::vector<std::uint8_t>(20, 'T'));
    frame[12] ^= 1;
    (void)link_->write(frame, hal::kNsPerSecond);
  }
  /// The payload of the next message of that type; nothing: none came within 5 s.
  std::optional<std::vector<std::uint8_t>> hear(peer::MessageType type) {
    for (const hal::TimeNs end = bridges::monotonic_ns() + 5 * hal::kNsPerSecond; bridges::monotonic_ns() < end;) {
      while (const auto frame = reader_.next()) {
        if (frame->type == type) return std::vector(frame->payload.begin(), frame->payload.end());
      }
      link_->wait(20 * hal::kNsPerMs);
      std::array<std::uint8_t, 4096> buffer;
      const auto got = link_->read(buffer);
      reader_.push(std::span(buffer).first(got.size));
    }
    return std::nullopt;
  }

 private:
  std::unique_ptr<ByteLink> link_;
  peer::FrameReader reader_;
};

core::Scene scene_of(const std::string& controller, std::int64_t robots,
                     const std::string& library = "test_controllers") {
  core::Scene scene(3.0, controller, library);
  scene.walls().cylinder(0.2, 0.3, 0.1).robots(robots, 1.2);
  return scene;
}

core::Scene& with_peers(core::Scene& scene) {
  scene.scenario.time_mode = core::TimeMode::Lockstep;
  scene.scenario.lockstep.listen = "0";
  scene.scenario.lockstep.timeout_s = 20.0;
  scene.scenario.robots.back().peer = core::PeerConfig{"", 3};
  return scene;
}

class LockstepOfTests : public testing::Test {
 protected:
  /// A hub of the scene, which is to have peers.
  void open(const core::Scene& scene) {
    made_ = core::make(scene);
    ASSERT_TRUE(made_.world) << made_.all_problems();
    LockstepOptions options;
    options.stop = &stop_;
    options.copy_of = copy_of_;
    options.log = hal::Log([this](hal::Severity, std::string_view text) { log_ += std::string(text) + "\n"; });
    auto run = LockstepRun::make(*made_.world, options);
    ASSERT_TRUE(run.ok()) << run.error().message;
    run_ = std::move(run).value();
  }
  Peer& join(const core::Scene& scene, const std::string& robot = "", std::uint64_t cut_at = 0) {
    peers_.push_back(std::make_unique<Peer>(run_->address(), robot, scene, *made_.loader, cut_at));
    return *peers_.back();
  }
  core::World& world() { return *made_.world; }

  core::MadeWorld made_;
  std::function<std::optional<peer::ControllerCopy>(core::World&, core::RobotId)> copy_of_;
  std::atomic<bool> stop_{false};
  std::string log_;
  std::unique_ptr<LockstepRun> run_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

struct Case {
  std::string controller;
  std::int64_t peers;
};

class EqualToSimulation : public LockstepOfTests, public testing::WithParamInterface<Case> {};

TEST_P(EqualToSimulation, TickByTick) {
  core::Scene scene = scene_of(GetParam().controller, GetParam().peers);
  const auto pure = core::make(scene);
  with_peers(scene);
  open(scene);
  for (std::int64_t i = 0; i < GetParam().peers; ++i) join(scene);
  ASSERT_TRUE(run_->connect().ok());
  world().start();
  pure.world->start();
  for (int tick = 0; tick < 100; ++tick) {
    if (tick == 40) {  // somebody holds a robot, and lets it go
      for (core::World* w : {&world(), pure.world.get()}) w->space().set_halted(w->space().robot(0), true);
    }
    if (tick == 50) {
      for (core::World* w : {&world(), pure.world.get()}) w->space().set_halted(w->space().robot(0), false);
    }
    pure.world->step();
    ASSERT_TRUE(world().step());
    ASSERT_EQ(world().state(), core::RunState::Running) << world().failure();
    ASSERT_EQ(world().state_hash(), pure.world->state_hash()) << "tick " << tick;
  }
  EXPECT_EQ(world().incidents().first(), pure.world->incidents().first());
  EXPECT_EQ(world().incidents().commands_clamped, pure.world->incidents().commands_clamped);
  run_->finish(false, "done");
  for (auto& p : peers_) EXPECT_EQ(p->ended(), "done");
}

INSTANTIATE_TEST_SUITE_P(Lockstep, EqualToSimulation,
                         testing::Values(Case{"shown", 1}, Case{"everything", 4}, Case{"thrower", 2},
                                         Case{"careless", 2}, Case{"shown", 20}),
                         [](const auto& p) { return p.param.controller + std::to_string(p.param.peers); });

class Lockstep : public LockstepOfTests {};

/// A peer that says which controller it runs, or does not.
void agree_as(ScriptedPeer& scripted, const std::optional<peer::ControllerCopy>& copy) {
  const auto robot = peer::read_robot(*scripted.hear(peer::MessageType::Robot));
  scripted.say(peer::MessageType::Ready, peer::bytes_of(peer::Ready{robot.value().session, {}, {}, copy}));
}

TEST_F(Lockstep, RefusesAPeerWithAnotherController) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene).scenario.lockstep.timeout_s = 1.0;
  peer::ControllerCopy hubs, peers;
  hubs.label = peers.label = "shown";
  hubs.library = {"libshown.so", "11"};
  peers.library = {"libshown.so", "22"};
  copy_of_ = [&](core::World&, core::RobotId) { return hubs; };
  open(scene);
  ScriptedPeer other(run_->address(), "ep0");
  std::string said;
  std::thread agree([&] {
    agree_as(other, peers);
    if (const auto end = other.hear(peer::MessageType::End)) said = peer::read_farewell(*end).value().text;
  });
  EXPECT_FALSE(run_->connect().ok());
  agree.join();
  EXPECT_THAT(said, HasSubstr("another controller: the peer runs libshown.so with sha256 22, the hub has"));
  EXPECT_THAT(said, HasSubstr("<peers controllers=\"any\">"));
  EXPECT_THAT(run_->report().peers[0].controller->differs, HasSubstr("sha256 22"));
  EXPECT_FALSE(run_->report().peers[0].ready);
}

TEST_F(Lockstep, TakesAnotherControllerWhereTheFileSaysSoAndOneThatTellsNothing) {
  core::Scene scene = scene_of("shown", 2);
  with_peers(scene).scenario.lockstep.any_controller = true;
  peer::ControllerCopy hubs, peers;
  hubs.library = {"libshown.so", "11"};
  peers.library = {"libshown.so", "22"};
  copy_of_ = [&](core::World&, core::RobotId) { return hubs; };
  open(scene);
  ScriptedPeer other(run_->address(), "ep0"), silent(run_->address(), "ep1");
  std::thread agree([&] {
    agree_as(other, peers);
    agree_as(silent, std::nullopt);
  });
  EXPECT_TRUE(run_->connect().ok());
  agree.join();
  EXPECT_THAT(log_, HasSubstr("peer of robot 'ep0' runs another controller: the peer runs libshown.so with sha256 22"));
  const LockstepReport report = run_->report();
  EXPECT_TRUE(report.peers[0].ready && report.peers[1].ready);
  EXPECT_THAT(report.peers[1].controller->not_compared, HasSubstr("does not tell"));
}

TEST_F(Lockstep, LetsPeersThatHaveNotBegunGoToAnotherRun) {
  core::Scene scene = scene_of("shown", 1);
  const auto pure = core::make(scene);
  with_peers(scene);
  open(scene);
  Peer& moved = join(scene);
  ASSERT_TRUE(run_->connect().ok());
  // The next hub listens where the first one did, as after `tandem preflight`.
  scene.scenario.lockstep.listen = run_->address().substr(4);
  run_->let_go();
  run_.reset();
  const core::MadeWorld before = std::move(made_);  // its libraries are the peer's, too
  open(scene);
  ASSERT_TRUE(run_->connect().ok());
  core::run(*pure.world, 20);
  core::run(world(), 20);
  EXPECT_EQ(world().state_hash(), pure.world->state_hash()) << world().failure();
  run_->finish(false, "done");
  EXPECT_EQ(moved.ended(), "done");
  EXPECT_EQ(moved.counts().ticks, 20);
}

TEST_F(Lockstep, GoesOnWhereALinkWasLost) {
  core::Scene scene = scene_of("shown", 2);
  const auto pure = core::make(scene);
  with_peers(scene);
  open(scene);
  Peer& cut = join(scene, "ep0", 7);
  join(scene, "ep1");
  ASSERT_TRUE(run_->connect().ok());
  core::run(*pure.world, 30);
  core::run(world(), 30);
  EXPECT_EQ(world().state_hash(), pure.world->state_hash()) << world().failure();
  run_->finish(false, "done");
  EXPECT_EQ(cut.counts().links, 2);
  EXPECT_EQ(cut.counts().ticks, 30);
}

TEST_F(Lockstep, NamesWithinASecondWhoIsMissingAndFailsInTheEnd) {
  core::Scene scene = scene_of("shown", 2);
  with_peers(scene).scenario.lockstep.timeout_s = 1.6;
  open(scene);
  join(scene, "ep1");
  const hal::Status connected = run_->connect();
  ASSERT_FALSE(connected.ok());
  EXPECT_THAT(connected.error().message,
              HasSubstr("peers are missing after 1.6 s: robot 'ep0' (nobody has connected)"));
  EXPECT_THAT(log_,
              testing::ContainsRegex("waiting for peers for [01].?[0-9]? s: robot 'ep0' .nobody has connected.\n"));
}

TEST_F(Lockstep, SimulatesWhoIsMissingWhereTheFileSaysSo) {
  core::Scene scene = scene_of("shown", 2);
  const auto pure = core::make(scene);
  with_peers(scene).scenario.lockstep.timeout_s = 1.0;
  scene.scenario.lockstep.simulate_missing = true;
  open(scene);
  join(scene, "ep1");
  ASSERT_TRUE(run_->connect().ok());
  EXPECT_THAT(log_, HasSubstr("robot 'ep0' is simulated from tick 0 on: its peer is missing after 1 s"));
  core::run(*pure.world, 30);
  core::run(world(), 30);
  EXPECT_EQ(world().state_hash(), pure.world->state_hash());
  EXPECT_EQ(run_->report().peers[0].state, "simulated");
}

TEST_F(Lockstep, EndsWhileItWaitsWhenItIsTold) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene);
  open(scene);
  ScriptedPeer mute(run_->address(), "ep0");
  std::thread agree([&] {
    const auto robot = peer::read_robot(*mute.hear(peer::MessageType::Robot));
    mute.say(peer::MessageType::Ready, peer::bytes_of(peer::Ready{robot.value().session, {}, {}}));
    EXPECT_TRUE(mute.hear(peer::MessageType::Tick));
    stop_ = true;
  });
  ASSERT_TRUE(run_->connect().ok());
  world().start();
  EXPECT_FALSE(world().step());
  agree.join();
  EXPECT_EQ(world().tick(), 0) << "given up half way";
  EXPECT_EQ(world().state(), core::RunState::Running);
}

TEST_F(Lockstep, FailsByNameWhenNoAnswerComes) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene).scenario.lockstep.timeout_s = 1.8;
  open(scene);
  ScriptedPeer mute(run_->address(), "ep0");
  std::thread agree([&] {
    const auto robot = peer::read_robot(*mute.hear(peer::MessageType::Robot));
    mute.say(peer::MessageType::Ready, peer::bytes_of(peer::Ready{robot.value().session, {}, {}}));
  });
  ASSERT_TRUE(run_->connect().ok());
  agree.join();
  world().start();
  EXPECT_FALSE(world().step());
  EXPECT_EQ(world().state(), core::RunState::Failed);
  EXPECT_THAT(world().failure(),
              HasSubstr("peers did not answer at tick 0 within 1.8 s: robot 'ep0' (at tcp:127.0.0.1:"));
  EXPECT_THAT(log_, testing::ContainsRegex("waiting at tick 0 for [01].?[0-9]? s: robot 'ep0'"));
  EXPECT_GE(run_->report().peers[0].asked_again, 1U) << "bytes may have been lost";
}

TEST_F(Lockstep, CountsAnswersThatComeTwiceOrForAnotherTick) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene);
  open(scene);
  ScriptedPeer odd(run_->address(), "ep0");
  std::thread talk([&] {
    const auto robot = peer::read_robot(*odd.hear(peer::MessageType::Robot)).value();
    peer::Ready ready{robot.session, {}, {}};
    for (const peer::PortName& port : robot.ports) ready.takes.push_back(port);
    odd.say(peer::MessageType::Ready, peer::bytes_of(ready));
    const peer::RowForm wheels(hal::port_type<hal::WheelSpeeds>());
    const auto answer = [&](hal::Tick tick) {
      std::vector<std::uint8_t> payload;
      peer::append_tick(payload, tick, 0);
      hal::WheelSpeeds command;
      command.set(0.02, 0.03);
      wheels.pack(&command, payload);
      odd.say(peer::MessageType::Commands, payload);
    };
    odd.hear(peer::MessageType::Tick);
    answer(5);  // was never asked
    odd.say_garbage();
    answer(0);
    odd.hear(peer::MessageType::Tick);
    answer(0);  // once more
    answer(1);
    odd.hear(peer::MessageType::Tick);
    answer(2);
    odd.hear(peer::MessageType::End);
  });
  ASSERT_TRUE(run_->connect().ok());
  world().start();
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(world().step()) << world().failure();
  const PartnerReport report = run_->report().peers[0];
  run_->finish(false, "done");
  talk.join();
  EXPECT_EQ(report.wrong_tick, 1U);
  EXPECT_EQ(report.doubled, 1U);
  EXPECT_EQ(report.garbled, 1U);
  EXPECT_EQ(report.ticks, 3U);
  EXPECT_THAT(log_, HasSubstr("peer of robot 'ep0' answered tick 5, at tick 0: left out"));
  EXPECT_EQ(world().space().port<hal::WheelSpeeds>(world().space().robot(0))->right_m_s, 0.03);
}

TEST_F(Lockstep, RefusesWhoDoesNotFit) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene).scenario.lockstep.timeout_s = 1.0;
  open(scene);
  const core::Scene other = scene_of("everything", 1);
  Peer& stranger = join(scene, "ep7");
  Peer& misfit = join(other, "ep0");
  EXPECT_FALSE(run_->connect().ok());
  EXPECT_THAT(stranger.ended(), HasSubstr("no robot 'ep7' waits for a peer here; there are: ep0"));
  EXPECT_THAT(misfit.ended(), HasSubstr("does not take it"));
  EXPECT_THAT(log_, HasSubstr("a peer at tcp:127.0.0.1:"));
}

TEST_F(Lockstep, RefusesAnotherFormOfAPort) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene).scenario.lockstep.timeout_s = 1.5;
  open(scene);
  ScriptedPeer old(run_->address(), "ep0");
  std::thread talk([&] {
    const auto robot = peer::read_robot(*old.hear(peer::MessageType::Robot)).value();
    old.say(peer::MessageType::Ready,
            peer::bytes_of(
                peer::Ready{robot.session, {{hal::Role::Actuator, "differential_steering", "0123456789abcdef"}}, {}}));
    const auto end = peer::read_farewell(*old.hear(peer::MessageType::End));
    EXPECT_TRUE(end.value().error);
    EXPECT_THAT(end.value().text, HasSubstr("has another form (0123456789abcdef) than the hub's"));
  });
  EXPECT_FALSE(run_->connect().ok());
  talk.join();
}

TEST_F(Lockstep, RefusesAControllerThatBeginsInTheMiddle) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene);
  open(scene);
  {
    Peer& first = join(scene, "ep0");
    ASSERT_TRUE(run_->connect().ok());
    world().start();
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(world().step());
    (void)first;
    peers_.clear();  // it is gone
  }
  Peer& second = join(scene, "ep0");
  std::thread stop([&] {
    EXPECT_THAT(second.ended(), HasSubstr("robot 'ep0' is at tick 5: a controller that begins now does not know"));
    stop_ = true;
  });
  EXPECT_FALSE(world().step());
  stop.join();
}

TEST_F(Lockstep, LetsThePeerOfARemovedRobotGo) {
  core::Scene scene = scene_of("shown", 2);
  const auto pure = core::make(scene);
  with_peers(scene);
  open(scene);
  Peer& gone = join(scene, "ep0");
  join(scene, "ep1");
  ASSERT_TRUE(run_->connect().ok());
  for (core::World* w : {&world(), pure.world.get()}) {
    w->start();
    for (int i = 0; i < 3; ++i) w->step();
    w->space().remove_robot(w->space().find_robot("ep0"));
    for (int i = 0; i < 3; ++i) w->step();
  }
  EXPECT_EQ(world().state_hash(), pure.world->state_hash());
  EXPECT_EQ(gone.ended(), "robot 'ep0' was removed from the run");
  EXPECT_EQ(run_->report().peers[0].state, "removed");
}

TEST_F(Lockstep, CannotGoBack) {
  core::Scene scene = scene_of("shown", 1);
  with_peers(scene);
  open(scene);
  join(scene, "ep0");
  ASSERT_TRUE(run_->connect().ok());
  world().start();
  ASSERT_TRUE(world().step());
  EXPECT_THAT(world().snapshot().error().message, HasSubstr("peers take part"));
  EXPECT_THAT(world().reset(3).error().message, HasSubstr("peers take part"));
}

}  // namespace
}  // namespace tandem::mixed_reality
