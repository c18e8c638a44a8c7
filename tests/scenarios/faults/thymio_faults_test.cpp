// Thymios among faults: driver, program and node, and the stop of the guardian, in virtual time.
#include <cmath>
#include <gtest/gtest.h>
#include <optional>

#include "bridges/aseba/node_stopper.hpp"
#include "bridges/thymio/driver.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/thymio/thymio_line.hpp"
#include "tests/scenarios/faults/run_story.hpp"

namespace tandem::faults {
namespace {

namespace emulator = bridges::thymio_emulator;
namespace bridge = bridges::thymio;
using bridges::LinkHealth;

constexpr std::array<FaultChoice, 9> kChoices = {{
    {.text = "silent"},
    {.text = "deaf"},
    {.text = "drop=%P", .most = 0.3},
    {.text = "lose=%P", .most = 0.3},
    {.text = "double=%P", .most = 0.2},
    {.text = "delay=%T", .most = 0.06},
    {.text = "hangup"},
    {.text = "restart", .lasts = false, .recovery_s = 0.4},
    {.text = "program", .lasts = false, .recovery_s = 0.3},
}};

/// Open ground; the floor tells the time.
class TimedBody final : public emulator::EmulatedBody {
 public:
  emulator::BodySenses sense(TimeNs now) override {
    emulator::BodySenses senses;
    senses.ground.fill(light_at(now));
    return senses;
  }
  void actuate(TimeNs, const emulator::BodyCommand& command) override { command_ = command; }
  const emulator::BodyCommand& command() const noexcept { return command_; }

 private:
  emulator::BodyCommand command_;
};

class TestedThymio final : public TestedRobot {
 public:
  explicit TestedThymio(std::size_t number)
      : robot_({}, body_,
               [this, number](TimeNs at, std::string_view event, const bridges::EventFields& fields) {
                 log("th" + std::to_string(number), at, bridges::to_json(at, event, fields));
               }),
        driver_(settings(number), hub_),
        ground_(driver_.robot().sensor<hal::Ground>()),
        wheels_(driver_.robot().actuator<hal::WheelSpeeds>()) {
    robot_.power_on(0);
  }

  void begin_faults(const std::vector<std::string>& texts, std::uint64_t seed, TimeNs now) override {
    line_.begin_faults(texts, seed, now);
  }
  void live(TimeNs now) override { line_.live(now); }
  Speed speed() const override {
    const double left = std::abs(body_.command().left_m_s), right = std::abs(body_.command().right_m_s);
    return {std::min(left, right), std::max(left, right)};
  }
  std::string state() const override {
    return std::string(bridge::state_name(driver_.state())) + ", " + driver_.trouble() + "; wheels " +
           std::to_string(body_.command().left_m_s) + " " + std::to_string(body_.command().right_m_s);
  }

  void open_link(TimeNs) override { hub_.open(); }
  void close_link(TimeNs) override { hub_.close(); }
  void latch(hal::Tick tick, TimeNs now) override {
    driver_.latch(tick, now);
    static_cast<hal::Reading&>(light_) = ground_;
    light_.count = 1;
    // White says 820 of 1023, black 10.
    light_.level[0] = (ground_.reflectance[0] * 820.0F - 10.0F) / 810.0F;
  }
  void command(double speed_m_s) override { wheels_.set(speed_m_s, speed_m_s); }
  void commit(TimeNs now) override { driver_.commit(now); }
  void pump(TimeNs now) override { driver_.pump(now); }
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
    return driver_.statistics().link_stops + driver_.statistics().restarts;
  }
  const hal::Light& light() const override { return light_; }

  void begin_guarding(TimeNs, bool) override {
    const auto open = [this]() -> hal::Result<std::unique_ptr<bridges::aseba::MessageLink>> {
      if (line_.hung_up()) return hal::Error{"there is no line"};
      return std::unique_ptr<bridges::aseba::MessageLink>(std::make_unique<bridge::ThymioLine::End>(line_));
    };
    stopper_.emplace(open, driver_.wiring().rest_messages());
  }
  bool guard(TimeNs now) override { return stopper_->poll(now) == bridges::guardian::StopState::Confirmed; }
  void end_guarding(TimeNs) override { stopper_.reset(); }

 private:
  static bridge::DriverSettings settings(std::size_t number) {
    bridge::DriverSettings s;
    s.robot.id = "th" + std::to_string(number);
    return s;
  }

  TimedBody body_;
  emulator::Thymio robot_;
  bridge::ThymioLine line_{robot_};
  bridge::ThymioLine::HubEnd hub_{line_};
  bridge::ThymioDriver driver_;
  const hal::Ground& ground_;
  hal::Light light_;
  hal::WheelSpeeds& wheels_;
  std::optional<bridges::aseba::NodeStopper> stopper_;
};

TEST(Faults, LeaveNoThymioMoving) {
  Kind kind;
  kind.name = "thymio";
  kind.choices = kChoices;
  kind.make = [](std::size_t number, std::uint64_t) { return std::make_unique<TestedThymio>(number); };
  kind.fresh_ns = 300 * kMs;  // its own measurements are up to 0.1 s old
  EXPECT_EQ(play_all(kind, 100), "");
}

}  // namespace
}  // namespace tandem::faults
