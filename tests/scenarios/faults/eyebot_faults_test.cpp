// Eye-bots among faults: driver, messages and firmware, and the stop of the guardian, in virtual time.
#include <cmath>
#include <gtest/gtest.h>

#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot_emulator/faults.hpp"
#include "bridges/eyebot_emulator/point_body.hpp"
#include "hal/device/flight.hpp"
#include "tests/scenarios/faults/run_story.hpp"

namespace tandem::faults {
namespace {

namespace emulator = bridges::eyebot_emulator;
namespace bridge = bridges::eyebot;
using bridges::LinkHealth;

constexpr double kAloft_s = 6.0;  // from a start on the ground to flying
constexpr TimeNs kUnix = 1'700'000'000 * kSecond;

constexpr std::array<FaultChoice, 16> kChoices = {{
    {.text = "silent"},
    {.text = "deaf"},
    {.text = "silent=state"},
    {.text = "silent=heartbeat"},
    {.text = "deaf=cmd/velocity"},
    {.text = "deaf=heartbeat"},
    {.text = "drop=%P", .most = 0.3},
    {.text = "lose=%P", .most = 0.3},
    {.text = "double=%P", .most = 0.2},
    {.text = "swap=%P", .most = 0.2},
    {.text = "repeat=%P", .most = 0.2},
    {.text = "overtake=%P", .most = 0.2},
    {.text = "delay=%T", .most = 0.06},
    {.text = "lag=%T", .most = 0.06},
    {.text = "truncate=%P", .most = 0.2},
    {.text = "restart", .lasts = false, .recovery_s = kAloft_s},
}};

/// The clock that shows the date, on the hub's machine. One robot's hub at a time speaks.
thread_local TimeNs hub_unix_ns = kUnix;
TimeNs hub_unix() noexcept {
  return hub_unix_ns;
}

/// Open sky; the light tells the time.
class TimedBody final : public emulator::EmulatedBody {
 public:
  emulator::BodySenses sense(TimeNs now) override {
    emulator::BodySenses senses = point_.sense(now);
    senses.light.fill(light_at(now));
    return senses;
  }
  void actuate(TimeNs now, const emulator::BodyCommand& command) override { point_.actuate(now, command); }
  std::vector<emulator::Heard> take_heard() override { return point_.take_heard(); }

 private:
  emulator::PointBody point_;
};

/// The air between a robot and whoever speaks to it: a hub or its guardian.
class Air {
 public:
  std::deque<emulator::Datagram> to_robot, to_hub;
  TimeNs now = 0;
};

class Mouth final : public bridge::Outbox {
 public:
  explicit Mouth(Air& air) : air_(air) {}
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override {
    air_.to_robot.push_back({channel, {data.begin(), data.end()}, air_.now});
    return true;
  }

 private:
  Air& air_;
};

class TestedEyebot final : public TestedRobot {
 public:
  TestedEyebot(std::size_t number, std::uint64_t)
      : name_("eb" + std::to_string(number)),
        robot_({.name = name_}, body_,
               [this](TimeNs at, std::string_view event, const bridges::EventFields& fields) {
                 log(name_, at, bridges::to_json(at, event, fields));
               }),
        driver_(settings(), inbox_, mouth_),
        light_(driver_.robot().sensor<hal::Light>()),
        flight_(driver_.robot().sensor<hal::FlightState>()),
        task_(driver_.robot().actuator<hal::FlightTask>()),
        speed_(driver_.robot().actuator<hal::QuadrotorSpeed>()) {
    robot_.power_on(0, kUnix / 1000);
  }

  void begin_faults(const std::vector<std::string>& texts, std::uint64_t seed, TimeNs now) override {
    std::vector<emulator::Fault> faults;
    for (const std::string& text : texts) faults.push_back(emulator::kFaults.parse(text).value());
    plan_ = emulator::FaultPlan(std::move(faults), seed);
    plan_.begin(now);
  }

  void live(TimeNs now) override {
    air_.now = now;
    hub_unix_ns = kUnix + now + jumped_ns_;
    while (const auto change = plan_.next_change(now)) emulator::apply(*change, robot_, ++session_);
    std::vector<emulator::Datagram> passing;
    for (const emulator::Datagram& message : air_.to_robot) plan_.to_robot(message, passing);
    air_.to_robot.clear();
    for (emulator::Datagram& message : passing) arriving_.push_back(std::move(message));
    for (; !arriving_.empty() && arriving_.front().at <= now; arriving_.pop_front()) {
      robot_.receive(arriving_.front().channel, arriving_.front().data, arriving_.front().at);
    }
    robot_.run_until(now);
    std::vector<emulator::Datagram> sent;
    robot_.take_sent(sent);
    passing.clear();
    for (const emulator::Datagram& message : sent) plan_.to_hub(message, passing);
    for (emulator::Datagram& message : passing) air_.to_hub.push_back(std::move(message));
    for (; !air_.to_hub.empty() && air_.to_hub.front().at <= now; air_.to_hub.pop_front()) {
      const emulator::Datagram& message = air_.to_hub.front();
      const auto topic = bridge::topic_of(name_, message.channel);
      if (topic && open_) inbox_.deliver(*topic, message.data, now);
      if (topic && guardian_) guardian_->inbox.deliver(*topic, message.data, now);
    }
  }

  /// As somebody told it: what it does to hover at a place, to land and to take off is its own.
  Speed speed() const override {
    const emulator::Mode mode = robot_.supervisor().mode();
    if (mode != emulator::Mode::Velocity && mode != emulator::Mode::Position) return {};
    const emulator::BodyCommand& c = robot_.command();
    const double v = std::hypot(c.velocity_m_s[0], c.velocity_m_s[1]);
    return {v, v};
  }
  std::string state() const override {
    const emulator::Supervisor& s = robot_.supervisor();
    return std::string(bridge::state_name(driver_.state())) + ", " + driver_.trouble() + "; " +
           std::string(name_of(s.mode())) + ", " + std::string(name_of(s.failsafe())) + ", controlled by " +
           std::to_string(s.controller()) + ", " + std::to_string(speed().greatest) + " m/s";
  }

  void open_link(TimeNs) override {
    open_ = true;
    if (turns_ > 1) driver_.skip_ahead(2 * kTurn);  // its guardian has spoken in between
  }
  void close_link(TimeNs) override { open_ = false; }
  void latch(hal::Tick tick, TimeNs now) override {
    driver_.pump(now);
    driver_.latch(tick, now);
  }
  void command(double speed_m_s) override {
    const bool grounded = flight_.phase == hal::FlightPhase::Landed || flight_.phase == hal::FlightPhase::Off;
    // An order counts when it is new: after a restart it is to be given again.
    task_.order = grounded && ++grounded_ticks_ % 5 != 0 ? hal::FlightOrder::TakeOff : hal::FlightOrder::Fly;
    speed_.set(speed_m_s, 0.0, 0.0, 0.0);
  }
  void commit(TimeNs now) override { driver_.commit(now); }
  void pump(TimeNs now) override {
    if (open_) driver_.pump(now);
  }
  void stop(TimeNs now) override { driver_.stop(now); }
  bool at_rest() const override { return driver_.at_rest(); }
  void end(TimeNs now) override { driver_.stop(now); }
  bool ended() const override { return driver_.at_rest(); }
  LinkHealth health() const override {
    switch (driver_.state()) {
      case bridge::RobotState::Active:
        return LinkHealth::Active;
      case bridge::RobotState::Suspect:
        return LinkHealth::Suspect;
      default:
        return LinkHealth::Lost;
    }
  }
  std::uint64_t interruptions() const override {
    return driver_.statistics().saved_itself + driver_.liveness().restarts();
  }
  const hal::Light& light() const override { return light_; }

  void jump_clock(TimeNs by) override { jumped_ns_ += by; }

  void begin_guarding(TimeNs now, bool hub_is_gone) override {
    // As its stopper does: numbers newer than the hub's, and than those of a stopper before.
    guardian_.emplace(settings(), static_cast<std::int32_t>(kTurn * turns_ + now / (10 * kMs)), hub_is_gone, air_);
  }
  bool guard(TimeNs now) override {
    Guardian& g = *guardian_;
    if (g.begun_ns < 0) {
      g.begun_ns = now;
      g.driver.stop(now);
    } else {
      g.driver.pump(now);
    }
    if (g.land && g.driver.status().known && (g.driver.at_rest() || now - g.begun_ns >= 2 * kSecond))
      g.driver.land(now);
    return g.driver.status().known && (g.land ? g.driver.landed() : g.driver.at_rest());
  }
  void end_guarding(TimeNs) override {
    guardian_.reset();
    turns_ += 2;
  }

 private:
  bridge::DriverSettings settings() const {
    bridge::DriverSettings s;
    s.robot.id = s.name = name_;
    s.hub = "lab";
    s.session = 0x1234;
    s.unix_clock = &hub_unix;
    return s;
  }
  struct Guardian {
    Guardian(bridge::DriverSettings s, std::int32_t seq, bool to_land, Air& air)
        : mouth(air), driver(ours(std::move(s), seq), inbox, mouth), land(to_land) {}
    static bridge::DriverSettings ours(bridge::DriverSettings s, std::int32_t seq) {
      s.first_seq = seq;
      s.controlled = true;
      return s;
    }
    bridge::Inbox inbox;
    Mouth mouth;
    bridge::EyebotDriver driver;
    bool land;
    TimeNs begun_ns = -1;
  };
  static constexpr std::uint32_t kTurn = 500'000'000;

  std::string name_;
  TimedBody body_;
  emulator::Eyebot robot_;
  emulator::FaultPlan plan_{{}, 1};
  std::int32_t session_ = 1;
  std::deque<emulator::Datagram> arriving_;
  Air air_;
  bridge::Inbox inbox_;
  Mouth mouth_{air_};
  bridge::EyebotDriver driver_;
  const hal::Light& light_;
  const hal::FlightState& flight_;
  hal::FlightTask& task_;
  hal::QuadrotorSpeed& speed_;
  int grounded_ticks_ = 0;
  TimeNs jumped_ns_ = 0;
  std::uint32_t turns_ = 1;  // of guardians so far
  bool open_ = false;
  std::optional<Guardian> guardian_;
};

TEST(Faults, LeaveNoEyebotMoving) {
  Kind kind;
  kind.name = "eyebot";
  kind.choices = kChoices;
  kind.land_ns = 6 * kSecond;
  kind.make = [](std::size_t number, std::uint64_t seed) { return std::make_unique<TestedEyebot>(number, seed); };
  kind.start_ns = 8 * kSecond;
  kind.step_ns = 10 * kMs;
  kind.fresh_ns = 300 * kMs;
  EXPECT_EQ(play_all(kind, 100), "");
}

}  // namespace
}  // namespace tandem::faults
