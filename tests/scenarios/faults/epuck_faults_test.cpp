// E-pucks among faults: driver, line and stock firmware, or the e-puck2's radio, and the stop of the guardian, in
// virtual time.
#include <gtest/gtest.h>

#include "bridges/epuck/driver.hpp"
#include "bridges/epuck/stopper.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
#include "bridges/epuck_emulator/radio.hpp"
#include "hal/device/wheels.hpp"
#include "tests/scenarios/faults/byte_line.hpp"
#include "tests/scenarios/faults/run_story.hpp"

namespace tandem::faults {
namespace {

namespace emulator = bridges::epuck_emulator;
namespace bridge = bridges::epuck;
using bridges::LinkHealth;

constexpr TimeNs kReopen = 100 * kMs;

// A round of the stop that was damaged is said again after up to half a second.
constexpr std::array<FaultChoice, 11> kChoices = {{
    {.text = "silent"},
    {.text = "deaf"},
    {.text = "garbage", .damages = true, .repeat_s = 0.5},
    {.text = "drop=%P", .most = 0.3, .damages = true, .repeat_s = 0.5},
    {.text = "corrupt=%P", .most = 0.2, .damages = true, .repeat_s = 0.5},
    {.text = "double=%P", .most = 0.2, .damages = true, .repeat_s = 0.5},
    {.text = "delay=%T", .most = 0.06},
    {.text = "hangup"},
    {.text = "drop=%P", .most = 0.02, .damages = true, .repeat_s = 0.5},
    {.text = "reset", .lasts = false, .recovery_s = 0.2},
    {.text = "truncate", .lasts = false, .recovery_s = 0.2},
}};

/// Open ground; the light tells the time.
class TimedBody final : public emulator::EmulatedBody {
 public:
  emulator::BodySenses sense(TimeNs now) override {
    emulator::BodySenses senses;
    senses.light.fill(light_at(now));
    return senses;
  }
  void actuate(TimeNs, const emulator::BodyCommand& command) override { command_ = command; }
  const emulator::BodyCommand& command() const noexcept { return command_; }

 private:
  emulator::BodyCommand command_;
};

/// `Line` carries what driver and robot say; `Stop` is what the guardian says.
template <class Line, class Stop>
class TestedEpuck final : public TestedRobot {
 public:
  TestedEpuck(std::size_t number, emulator::Variant variant, bridge::WireForm wire)
      : firmware_({.variant = variant}, body_,
                  [this, number](TimeNs at, std::string_view event, const bridges::EventFields& fields) {
                    log("ep" + std::to_string(number), at, bridges::to_json(at, event, fields));
                  }),
        driver_(settings(number, wire)),
        light_(driver_.robot().sensor<hal::Light>()),
        wheels_(driver_.robot().actuator<hal::WheelSpeeds>()) {
    firmware_.power_on(0);
  }

  void begin_faults(const std::vector<std::string>& faults, std::uint64_t seed, TimeNs now) override {
    line_.begin_faults(faults, seed, now);
  }
  void live(TimeNs now) override { line_.live(now); }
  Speed speed() const override {
    const double left = std::abs(body_.command().left_m_s), right = std::abs(body_.command().right_m_s);
    return {std::min(left, right), std::max(left, right)};
  }
  std::string state() const override {
    return std::string(bridge::state_name(driver_.state())) + ", " + driver_.session().trouble() + "; wheels " +
           std::to_string(body_.command().left_m_s) + " " + std::to_string(body_.command().right_m_s) +
           (link_ ? "" : "; no link");
  }

  void open_link(TimeNs now) override {
    wanted_ = true;
    reopen_ns_ = now;
    pump(now);
  }
  void close_link(TimeNs now) override {
    wanted_ = false;
    link_.reset();
    driver_.link_gone(now);
  }
  void latch(hal::Tick tick, TimeNs now) override { driver_.latch(tick, now); }
  void command(double speed_m_s) override { wheels_.set(speed_m_s, speed_m_s); }
  void commit(TimeNs now) override {
    driver_.commit(now);
    pump(now);
  }
  void pump(TimeNs now) override {
    if (!link_ && wanted_ && now >= reopen_ns_) {
      link_ = line_.open();
      reopen_ns_ = now + kReopen;
    }
    if (!link_) return;
    driver_.pump(*link_, now);
    if (link_->state() == bridges::LinkState::Open && !driver_.wants_new_link()) return;
    link_.reset();
    driver_.link_gone(now);
    reopen_ns_ = now + kReopen;
  }
  void stop(TimeNs now) override {
    driver_.stop(now);
    pump(now);
  }
  bool at_rest() const override { return driver_.at_rest(); }
  void end(TimeNs now) override {
    driver_.shut_down(now);
    pump(now);
  }
  bool ended() const override { return driver_.idle(); }
  LinkHealth health() const override {
    switch (driver_.state()) {
      case bridge::SessionState::Active:
        return LinkHealth::Active;
      case bridge::SessionState::Suspect:
        return LinkHealth::Suspect;
      default:
        return LinkHealth::Lost;
    }
  }
  std::uint64_t interruptions() const override { return driver_.session().statistics().restarts; }
  const hal::Light& light() const override { return light_; }

  void begin_guarding(TimeNs now, bool) override {
    guard_link_.reset();
    stop_.begin(now);
    guard_open_ns_ = now;
  }
  bool guard(TimeNs now) override {
    if (stop_.confirmed()) return true;
    if (!guard_link_ && now >= guard_open_ns_) {
      guard_link_ = line_.open();
      guard_open_ns_ = now + 50 * kMs;
      if (guard_link_) stop_.begin(now);
    }
    if (!guard_link_) return false;
    bridge::Packet out;
    stop_.poll(now, out);
    if (!out.bytes().empty()) guard_link_->write(out.bytes(), 0);
    std::array<std::uint8_t, 256> buffer;
    const bridges::Received received = guard_link_->read(buffer);
    stop_.on_bytes(std::span(buffer).first(received.size), received.at_ns);
    if (guard_link_->state() == bridges::LinkState::HungUp || stop_.wants_new_link()) guard_link_.reset();
    return stop_.confirmed();
  }
  void end_guarding(TimeNs) override { guard_link_.reset(); }

 private:
  static bridge::DriverSettings settings(std::size_t number, bridge::WireForm wire) {
    bridge::DriverSettings s;
    s.wire = wire;
    s.robot.id = "ep" + std::to_string(number);
    return s;
  }

  TimedBody body_;
  emulator::Firmware firmware_;
  Line line_{firmware_};
  bridge::EpuckDriver driver_;
  const hal::Light& light_;
  hal::WheelSpeeds& wheels_;
  std::unique_ptr<bridges::ByteLink> link_;
  bool wanted_ = false;
  TimeNs reopen_ns_ = 0;
  Stop stop_{bridge::StopTiming{}};
  std::unique_ptr<bridges::ByteLink> guard_link_;
  TimeNs guard_open_ns_ = 0;
};

// --- over an e-puck2's radio: TCP loses, doubles and changes nothing; what does not pass waits ---

constexpr std::array<FaultChoice, 5> kRadioChoices = {{
    {.text = "silent"},  // both ways: the robot is out of reach
    {.text = "hangup"},
    {.text = "delay=%T", .most = 0.06},
    {.text = "reset", .lasts = false, .recovery_s = 0.4},
    {.text = "truncate", .lasts = false, .recovery_s = 0.4, .repeat_s = 0.5},
}};

/// TCP between a host and the radio. Who opens it last is heard: whoever was before has hung up, by the system's hand
/// or the guardian's.
class RadioLine {
 public:
  explicit RadioLine(emulator::Firmware& firmware) : firmware_(firmware), radio_(firmware) {}

  void begin_faults(const std::vector<std::string>& texts, std::uint64_t seed, TimeNs now) {
    std::vector<emulator::Fault> faults;
    for (const std::string& text : texts) faults.push_back(emulator::kFaults.parse(text).value());
    plan_ = std::make_unique<emulator::FaultPlan>(std::move(faults), seed);
    plan_->begin(now);
  }
  void live(TimeNs now) {
    now_ = now;
    apply_faults(now);
    if (!out_of_reach()) {
      for (const std::uint8_t byte : to_robot_) radio_.receive(byte, now);
      to_robot_.clear();
    }
    radio_.run_until(now);
    sent_.clear();
    radio_.take_sent(now, sent_);
    const TimeNs delay = plan_ ? plan_->delay_ns(now) : 0;
    for (const auto& s : sent_)
      to_host_.push_back({s.byte, std::max(now + delay, to_host_.empty() ? 0 : to_host_.back().at)});
    for (; !out_of_reach() && !to_host_.empty() && to_host_.front().at <= now; to_host_.pop_front())
      arrived_.push_back(to_host_.front().byte);
  }
  std::unique_ptr<bridges::ByteLink> open() {
    if (hung_up_ || out_of_reach()) return nullptr;
    connect();
    return std::make_unique<End>(*this);
  }

 private:
  class End final : public bridges::ByteLink {
   public:
    explicit End(RadioLine& line) : line_(line), number_(line.connections_) {}
    std::size_t write(std::span<const std::uint8_t> bytes, TimeNs) noexcept override {
      if (state() != bridges::LinkState::Open) return 0;
      line_.to_robot_.insert(line_.to_robot_.end(), bytes.begin(), bytes.end());
      return bytes.size();
    }
    bridges::Received read(std::span<std::uint8_t> buffer) noexcept override {
      bridges::Received got;
      got.at_ns = line_.now_;
      while (state() == bridges::LinkState::Open && got.size < buffer.size() && !line_.arrived_.empty()) {
        buffer[got.size++] = line_.arrived_.front();
        line_.arrived_.pop_front();
      }
      return got;
    }
    bool wait(TimeNs) noexcept override { return !line_.arrived_.empty(); }
    bridges::LinkState state() const noexcept override {
      return line_.connections_ == number_ ? bridges::LinkState::Open : bridges::LinkState::HungUp;
    }
    bridges::LinkStatistics statistics() const noexcept override { return {}; }
    std::string name() const override { return "virtual radio"; }

   private:
    RadioLine& line_;
    int number_;
  };

  void connect() {
    ++connections_;
    to_robot_.clear();
    to_host_.clear();
    arrived_.clear();
    radio_.new_host();
  }
  bool out_of_reach() const { return plan_ && plan_->active(emulator::FaultKind::Silent, now_); }
  void apply_faults(TimeNs now) {
    while (plan_) {
      const auto change = plan_->next_change(now);
      if (!change) return;
      if (change->fault->kind == emulator::FaultKind::Reset) {
        firmware_.reset(change->at, "fault");  // the radio starts anew as well
        connect();
      }
      if (change->fault->kind == emulator::FaultKind::Truncate) radio_.cut_next_answer();
      if (change->fault->kind != emulator::FaultKind::Hangup) continue;
      hung_up_ = change->begins;
      connect();
    }
  }

  emulator::Firmware& firmware_;
  emulator::Radio radio_;
  std::unique_ptr<emulator::FaultPlan> plan_;
  std::deque<std::uint8_t> to_robot_, arrived_;
  std::deque<emulator::SentByte> to_host_;
  std::vector<emulator::SentByte> sent_;
  TimeNs now_ = 0;
  bool hung_up_ = false;
  int connections_ = 0;
};

Kind on_a_serial_line() {
  Kind kind;
  kind.name = "epuck_serial";
  kind.choices = kChoices;
  kind.make = [](std::size_t number, std::uint64_t seed) {
    return std::make_unique<TestedEpuck<ByteLine, bridge::SerialStop>>(number, static_cast<emulator::Variant>(seed % 4),
                                                                       bridge::WireForm::Serial);
  };
  return kind;
}

TEST(Faults, LeaveNoEpuckMoving) {
  EXPECT_EQ(play_all(on_a_serial_line(), 100), "");
}

// Stories with kChoices as they are: a robot at rest is told to stop anew, and a byte of it is doubled or flipped.
TEST(Faults, DoNotLetAHubThatEndsTakeAnEpuckForRestingWhoseNewStopIsDamaged) {
  for (const std::uint64_t seed : {2899U, 3918U, 4194U}) EXPECT_EQ(play_one(on_a_serial_line(), seed), "");
}

TEST(Faults, LeaveNoEpuck2MovingThatIsReachedOverItsRadio) {
  Kind kind;
  kind.name = "epuck_radio";
  kind.choices = kRadioChoices;
  kind.make = [](std::size_t number, std::uint64_t) {
    return std::make_unique<TestedEpuck<RadioLine, bridge::WifiStop>>(number, emulator::Variant::Epuck2,
                                                                      bridge::WireForm::Wifi);
  };
  EXPECT_EQ(play_all(kind, 100), "");
}

}  // namespace
}  // namespace tandem::faults
