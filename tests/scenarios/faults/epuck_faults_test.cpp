// E-pucks among faults: driver, line and stock firmware, and the stop of the guardian, in virtual time.
#include <gtest/gtest.h>

#include "bridges/epuck/driver.hpp"
#include "bridges/epuck/stop.hpp"
#include "bridges/epuck_emulator/firmware.hpp"
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

class TestedEpuck final : public TestedRobot {
 public:
  TestedEpuck(std::size_t number, std::uint64_t seed)
      : firmware_({.variant = static_cast<emulator::Variant>(seed % 4)}, body_,
                  [number](TimeNs at, std::string_view event, const bridges::EventFields& fields) {
                    if (traced()) trace("ep" + std::to_string(number), at, bridges::to_json(at, event, fields));
                  }),
        driver_(settings(number)),
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
    if (link_->state() == bridges::LinkState::Open) return;
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
    for (std::size_t i = 0; i < received.size; ++i) stop_.on_byte(buffer[i], received.at_ns);
    if (guard_link_->state() == bridges::LinkState::HungUp) guard_link_.reset();
    return stop_.confirmed();
  }
  void end_guarding(TimeNs) override { guard_link_.reset(); }

 private:
  static bridge::DriverSettings settings(std::size_t number) {
    bridge::DriverSettings s;
    s.robot.id = "ep" + std::to_string(number);
    return s;
  }

  TimedBody body_;
  emulator::Firmware firmware_;
  ByteLine line_{firmware_};
  bridge::EpuckDriver driver_;
  const hal::Light& light_;
  hal::WheelSpeeds& wheels_;
  std::unique_ptr<bridges::ByteLink> link_;
  bool wanted_ = false;
  TimeNs reopen_ns_ = 0;
  bridge::StopProcedure stop_;
  std::unique_ptr<bridges::ByteLink> guard_link_;
  TimeNs guard_open_ns_ = 0;
};

TEST(Faults, LeaveNoEpuckMoving) {
  Kind kind;
  kind.choices = kChoices;
  kind.make = [](std::size_t number, std::uint64_t seed) { return std::make_unique<TestedEpuck>(number, seed); };
  EXPECT_EQ(play_all(kind, 100), "");
}

}  // namespace
}  // namespace tandem::faults
