// Who is that robot? E-pucks, Thymios, foot-bots and eye-bots that are switched off, exchanged, renumbered, in virtual
// time.
#include <deque>
#include <gtest/gtest.h>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/epuck/driver.hpp"
#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot_emulator/eyebot.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "bridges/footbot_emulator/bus.hpp"
#include "bridges/footbot_emulator/footbot.hpp"
#include "bridges/thymio/driver.hpp"
#include "hal/device/flight.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/memory_bus.hpp"
#include "tests/bridges/thymio/thymio_line.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/faults/byte_line.hpp"
#include "tests/scenarios/identities/identity_story.hpp"

namespace tandem::identities {
namespace {

std::function<void(double)> by_wheels(bridges::RobotBridge& bridge) {
  return [wheels = &bridge.robot().actuator<hal::WheelSpeeds>()](double speed_m_s) { wheels->set(speed_m_s, 0.05); };
}

/// Open ground.
template <class Interface, class Senses, class Command>
class OpenGround : public Interface {
 public:
  Senses sense(TimeNs) override { return {}; }
  void actuate(TimeNs, const Command& command) override { command_ = command; }
  bool moves() const { return command_.left_m_s != 0.0 || command_.right_m_s != 0.0; }

 private:
  Command command_;
};

// --- e-pucks on a serial port ---

namespace epuck = bridges::epuck;
namespace epuck_emulator = bridges::epuck_emulator;

class EpuckBody final : public Body {
 public:
  explicit EpuckBody(epuck_emulator::Variant variant) : firmware_({.variant = variant}, ground_, {}) {
    firmware_.power_on(0);
  }
  void live(TimeNs now, bool on, int /*part_off*/) override {
    if (!on && now >= next_reset_) {
      firmware_.reset(now, "off");  // it never gets as far as its greeting
      next_reset_ = now + 50 * kMs;
    }
    line_.live(now);
  }
  bool moves() const override { return ground_.moves(); }
  faults::ByteLine& line() { return line_; }

 private:
  OpenGround<epuck_emulator::EmulatedBody, epuck_emulator::BodySenses, epuck_emulator::BodyCommand> ground_;
  epuck_emulator::Firmware firmware_;
  faults::ByteLine line_{firmware_};
  TimeNs next_reset_ = 0;
};

/// An open serial port: what hangs on it may change.
class Port final : public bridges::ByteLink {
 public:
  std::size_t write(std::span<const std::uint8_t> bytes, TimeNs budget_ns) noexcept override {
    return end ? end->write(bytes, budget_ns) : bytes.size();
  }
  bridges::Received read(std::span<std::uint8_t> buffer) noexcept override {
    return end ? end->read(buffer) : bridges::Received{};
  }
  bool wait(TimeNs) noexcept override { return false; }
  bridges::LinkState state() const noexcept override { return bridges::LinkState::Open; }
  bridges::LinkStatistics statistics() const noexcept override { return {}; }
  std::string name() const override { return "port"; }

  std::unique_ptr<bridges::ByteLink> end;
};

class EpuckSide final : public DriverSide<EpuckSide, epuck::EpuckRobot> {
 public:
  explicit EpuckSide(std::array<EpuckBody*, 2> bodies) : driver_(epuck::DriverSettings{}), bodies_(bodies) {}

  void lead_to(int robot, TimeNs) override {
    robot_ = robot;
    if (port_) port_->end = robot < 0 ? nullptr : bodies_[static_cast<std::size_t>(robot)]->line().open();
  }
  void hang_up(TimeNs now) override {
    port_.reset();
    driver_.link_gone(now);
  }
  void open(const std::string& device, TimeNs) override {
    port_ = std::make_unique<Port>();
    note_open(device);
  }
  void pump(TimeNs now) override {
    if (port_) driver_.pump(*port_, now);
  }
  bridges::RobotIdentity who() const {
    bridges::RobotIdentity all = reached_;
    driver_.identify(all);
    return all;
  }
  std::uint64_t stop_version() const noexcept override { return reached_.session + driver_.session().epoch(); }

 private:
  friend bridges::DriverBridge<EpuckSide, epuck::EpuckRobot>;
  void run() {}
  bridges::Interruptions interruptions() const noexcept {
    const epuck::SessionStatistics& s = driver_.session().statistics();
    return {s.handshakes, s.restarts};
  }
  void after_command(TimeNs now) { pump(now); }

  epuck::EpuckDriver driver_;
  std::array<EpuckBody*, 2> bodies_;
  std::unique_ptr<Port> port_;
  int robot_ = -1;
};

TEST(Identities, NoEpuckMovesThatIsNotProvedToBeTheArmedOne) {
  const auto make = [](std::uint64_t seed) {
    Rig rig;
    std::array<EpuckBody*, 2> bodies{};
    for (std::size_t i = 0; i < 2; ++i) {
      // Both may have one firmware: then nothing but the port and the absence tells them apart.
      const auto variant = static_cast<epuck_emulator::Variant>((seed + i * (seed / 4 % 2)) % 4);
      auto body = std::make_unique<EpuckBody>(variant);
      bodies[i] = body.get();
      rig.bodies[i] = std::move(body);
    }
    auto side = std::make_unique<EpuckSide>(bodies);
    rig.hub = side.get();
    rig.bridge = std::move(side);
    rig.drive = by_wheels(*rig.bridge);
    return rig;
  };
  EXPECT_EQ(play_all(make, 30), "");
}

// --- robots of ASEBA nodes ---

namespace aseba = bridges::aseba;
namespace thymio = bridges::thymio;
namespace thymio_emulator = bridges::thymio_emulator;

class ThymioBody final : public Body {
 public:
  ThymioBody() : robot_({}, ground_, {}) { robot_.power_on(0); }
  void live(TimeNs now, bool on, int /*part_off*/) override {
    if (!on && now >= next_reset_) {
      robot_.restart(now, "off");
      next_reset_ = now + 50 * kMs;
    }
    line_.live(now);
  }
  bool moves() const override { return ground_.moves(); }
  std::unique_ptr<aseba::MessageLink> attach() { return std::make_unique<thymio::ThymioLine::End>(line_); }

 private:
  OpenGround<thymio_emulator::EmulatedBody, thymio_emulator::BodySenses, thymio_emulator::BodyCommand> ground_;
  thymio_emulator::Thymio robot_;
  thymio::ThymioLine line_{robot_};
  TimeNs next_reset_ = 0;
};

/// An open line: which robot is at its end may change.
class MessagePort final : public bridges::aseba::MessageLink {
 public:
  bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override {
    return up && (!end || end->send(type, payload));
  }
  bool receive(bridges::aseba::MessageView& view) noexcept override { return up && end && end->receive(view); }
  bool wait(TimeNs) noexcept override { return false; }
  void clear() noexcept override {}
  bridges::aseba::Carrier state() const noexcept override {
    return up ? bridges::aseba::Carrier::Up : bridges::aseba::Carrier::Down;
  }
  bridges::aseba::MessageLinkStatistics statistics() const noexcept override { return {}; }
  std::string name() const override { return "port"; }

  bool up = false;
  std::unique_ptr<bridges::aseba::MessageLink> end;
};

template <class Parts, class NodeBody>
class NodeSide final : public DriverSide<NodeSide<Parts, NodeBody>, typename Parts::Robot> {
 public:
  NodeSide(typename Parts::Settings settings, std::array<NodeBody*, 2> bodies)
      : driver_(std::move(settings), port_), bodies_(bodies) {}

  void lead_to(int robot, TimeNs) override {
    port_.end.reset();
    if (robot >= 0) port_.end = bodies_[static_cast<std::size_t>(robot)]->attach();
  }
  void hang_up(TimeNs) override { port_.up = false; }
  void open(const std::string& device, TimeNs) override {
    port_.up = true;
    this->note_open(device);
  }
  void pump(TimeNs now) override { driver_.pump(now); }
  bridges::RobotIdentity who() const {
    bridges::RobotIdentity all = this->reached_;
    driver_.wiring().identify(all);
    return all;
  }
  std::uint64_t stop_version() const noexcept override {
    return this->reached_.session + driver_.wiring().rest_version();
  }

 private:
  friend bridges::DriverBridge<NodeSide, typename Parts::Robot>;
  void run() {}
  bridges::Interruptions interruptions() const noexcept {
    const auto& s = driver_.statistics();
    return {s.link_stops + s.watchdog_stops + s.restarts, s.restarts};
  }

  MessagePort port_;
  aseba::NodeDriver<Parts> driver_;
  std::array<NodeBody*, 2> bodies_;
};

template <class Parts, class NodeBody>
Rig node_rig(const typename Parts::Settings& settings) {
  Rig rig;
  std::array<NodeBody*, 2> bodies{};
  for (std::size_t i = 0; i < 2; ++i) {
    auto body = std::make_unique<NodeBody>();
    bodies[i] = body.get();
    rig.bodies[i] = std::move(body);
  }
  auto side = std::make_unique<NodeSide<Parts, NodeBody>>(settings, bodies);
  rig.hub = side.get();
  rig.bridge = std::move(side);
  rig.drive = by_wheels(*rig.bridge);
  return rig;
}

TEST(Identities, NoThymioMovesThatIsNotProvedToBeTheArmedOne) {
  EXPECT_EQ(play_all([](std::uint64_t) { return node_rig<thymio::ThymioParts, ThymioBody>({}); }, 30), "");
}

namespace footbot = bridges::footbot;
namespace footbot_emulator = bridges::footbot_emulator;

class FootbotBody final : public Body {
 public:
  FootbotBody() : robot_({}, ground_, {}) { robot_.power_on(0); }
  void live(TimeNs now, bool on, int part_off) override {
    now_ = now;
    robot_.run_until(now);
    for (std::size_t i = 0; i < footbot_emulator::kModules; ++i) {
      const bool off = !on || part_off == static_cast<int>(i);
      if (std::exchange(off_[i], off) != off) robot_.set_missing(footbot_emulator::Place{i}, off, now);
    }
    for (bridges::CanFrame in; robots_end_->receive(in);) {
      const footbot_emulator::Frame frame{static_cast<std::uint16_t>(in.id), in.size, in.data};
      free_at_ = std::max(free_at_, now) + footbot_emulator::duration_ns(frame);
      to_robot_.push_back({frame, free_at_});
    }
    for (; !to_robot_.empty() && to_robot_.front().at <= now; to_robot_.pop_front())
      robot_.receive(to_robot_.front().frame, to_robot_.front().at);
    robot_.run_until(now);
    robot_.take_sent(sent_);
    for (const footbot_emulator::TimedFrame& f : sent_)
      (void)robots_end_->send(bridges::make_frame(f.frame.id, std::span(f.frame.data).first(f.frame.size)));
    sent_.clear();
  }
  bool moves() const override { return robot_.command().left_m_s != 0.0 || robot_.command().right_m_s != 0.0; }
  int parts() const override { return 2; }  // its motors' modules
  std::unique_ptr<aseba::MessageLink> attach() {
    static const aseba::CanMessagesSettings kUsual;
    return std::make_unique<aseba::CanMessages>(bus_.attach(), kUsual, [this] { return now_; });
  }

 private:
  class Ground final : public footbot_emulator::EmulatedBody {
   public:
    footbot_emulator::BodySenses sense(TimeNs) override { return {}; }
    void actuate(TimeNs, const footbot_emulator::BodyCommand&) override {}
    std::vector<footbot_emulator::Heard> take_heard() override { return {}; }
  };
  TimeNs now_ = 0, free_at_ = 0;
  std::array<bool, footbot_emulator::kModules> off_{};
  Ground ground_;
  footbot_emulator::Footbot robot_;
  bridges::MemoryBus bus_{[this] { return now_; }};
  std::unique_ptr<bridges::CanLink> robots_end_ = bus_.attach();
  std::deque<footbot_emulator::TimedFrame> to_robot_;
  std::vector<footbot_emulator::TimedFrame> sent_;
};

TEST(Identities, NoFootbotMovesThatIsNotProvedToBeTheArmedOne) {
  footbot::DriverSettings settings;
  hal::Problems problems;
  auto map = footbot::read_footbot_map(std::string(test::kSourceDir) + "/configs/footbot_map.xml", problems);
  ASSERT_TRUE(map);
  settings.map = std::move(*map);
  const auto make = [&](std::uint64_t) { return node_rig<footbot::FootbotParts, FootbotBody>(settings); };
  EXPECT_EQ(play_all(make, 30), "");
}

// --- eye-bots ---

namespace eyebot = bridges::eyebot;
namespace eyebot_emulator = bridges::eyebot_emulator;

constexpr TimeNs kUnix = 1'700'000'000 * kSecond;
TimeNs g_unix_ns = kUnix;
TimeNs unix_clock() noexcept {
  return g_unix_ns;
}

class EyebotBody final : public Body {
 public:
  explicit EyebotBody(std::int32_t session)
      : session_(session),
        robot_({.session = session}, body_,
               [this](TimeNs, std::string_view event, const bridges::EventFields& fields) { note(event, fields); }) {
    robot_.power_on(0, kUnix / 1000);
  }
  void live(TimeNs now, bool on, int /*part_off*/) override {
    if (!on && now >= next_reset_) {
      robot_.restart(++session_, now);  // it never gets as far as its first word
      next_reset_ = now + 50 * kMs;
    }
    robot_.run_until(now);
    sent_.clear();
    robot_.take_sent(sent_);
  }
  bool moves() const override {
    using enum eyebot_emulator::Mode;
    const eyebot_emulator::Mode mode = robot_.supervisor().mode();
    return mode == TakeOff || mode == Position || mode == Attaching || mode == Detaching ||
           (mode == Velocity && told_m_s_ != 0.0);
  }
  eyebot_emulator::Eyebot& robot() { return robot_; }
  /// What it has said since it lived last.
  const std::vector<eyebot_emulator::Datagram>& said() const { return sent_; }

 private:
  void note(std::string_view event, const bridges::EventFields& fields) {
    if (event != "command") return;
    bool accepted = false;
    for (const bridges::EventField& field : fields) {
      if (field.name == "verdict") accepted = std::get<std::string>(field.value) == "ok";
      if (field.name == "x" && accepted) told_m_s_ = std::get<double>(field.value);
    }
  }

  std::int32_t session_;
  eyebot_emulator::PointBody body_;
  double told_m_s_ = 0.0;  // by the last velocity that it accepted
  eyebot_emulator::Eyebot robot_;
  std::vector<eyebot_emulator::Datagram> sent_;
  TimeNs next_reset_ = 0;
};

class EyebotSide final : public DriverSide<EyebotSide, eyebot::EyebotRobot>, private eyebot::Outbox {
 public:
  explicit EyebotSide(std::array<EyebotBody*, 2> bodies) : driver_(settings(), inbox_, *this), bodies_(bodies) {}

  void lead_to(int robot, TimeNs) override { robot_ = robot; }
  void hang_up(TimeNs) override {
    open_ = false;
    driver_.link_gone();
  }
  void open(const std::string& device, TimeNs) override {
    open_ = true;
    note_open(device);
  }
  bool deafen(bool deaf) override {
    deaf_ = deaf;
    return true;
  }
  void pump(TimeNs now) override {
    now_ = now;
    g_unix_ns = kUnix + now;
    if (EyebotBody* const body = reached(); body != nullptr) {
      for (const eyebot_emulator::Datagram& d : body->said()) {
        if (const auto topic = eyebot::topic_of("eb0", d.channel)) inbox_.deliver(*topic, d.data, now);
      }
    }
    driver_.pump(now);
  }
  bridges::RobotIdentity who() const {
    bridges::RobotIdentity all = reached_;
    if (driver_.liveness().pulse(now_) != eyebot::Pulse::Never) all.name = driver_.settings().name;
    return all;
  }
  std::uint64_t stop_version() const noexcept override {
    return reached_.session + (driver_.liveness().pulse(now_) != eyebot::Pulse::Never ? 1 : 0);
  }

 private:
  friend bridges::DriverBridge<EyebotSide, eyebot::EyebotRobot>;
  static eyebot::DriverSettings settings() {
    eyebot::DriverSettings s;
    s.robot.id = s.name = "eb0";
    s.hub = "lab";
    s.session = 4711;
    s.unix_clock = &unix_clock;
    return s;
  }
  EyebotBody* reached() const { return open_ && robot_ >= 0 ? bodies_[static_cast<std::size_t>(robot_)] : nullptr; }
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override {
    EyebotBody* const body = reached();
    if (body != nullptr && !deaf_) body->robot().receive(channel, data, now_);
    return open_;
  }
  void run() {}
  void before_latch(TimeNs now) { driver_.pump(now); }
  bridges::Interruptions interruptions() const noexcept {
    const eyebot::DriverStatistics& s = driver_.statistics();
    return {s.link_stops + s.watchdog_stops, driver_.liveness().restarts() + s.saved_itself};
  }

  eyebot::Inbox inbox_;
  eyebot::EyebotDriver driver_;
  std::array<EyebotBody*, 2> bodies_;
  int robot_ = -1;
  bool open_ = false, deaf_ = false;
  TimeNs now_ = 0;
};

TEST(Identities, NoEyebotMovesThatIsNotProvedToBeTheArmedOne) {
  const auto make = [](std::uint64_t) {
    Rig rig;
    std::array<EyebotBody*, 2> bodies{};
    for (std::size_t i = 0; i < 2; ++i) {
      auto body = std::make_unique<EyebotBody>(static_cast<std::int32_t>(1000 + 1'000'000 * i));
      bodies[i] = body.get();
      rig.bodies[i] = std::move(body);
    }
    auto side = std::make_unique<EyebotSide>(bodies);
    rig.hub = side.get();
    bridges::RobotBridge& bridge = *side;
    rig.bridge = std::move(side);
    rig.drive = [&task = bridge.robot().actuator<hal::FlightTask>(),
                 &speed = bridge.robot().actuator<hal::QuadrotorSpeed>(),
                 &flight = bridge.robot().sensor<hal::FlightState>(), ticks = 0](double speed_m_s) mutable {
      // An order counts when it is new: after a restart it is to be given again.
      const bool grounded = flight.phase == hal::FlightPhase::Landed || flight.phase == hal::FlightPhase::Off;
      task.order = grounded && ++ticks % 5 != 0 ? hal::FlightOrder::TakeOff : hal::FlightOrder::Fly;
      speed.set(speed_m_s, 0.0, 0.0, 0.0);
    };
    return rig;
  };
  EXPECT_EQ(play_all(make, 30), "");
}

}  // namespace
}  // namespace tandem::identities
