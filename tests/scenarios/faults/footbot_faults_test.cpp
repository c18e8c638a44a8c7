// Foot-bots among faults: driver, CAN bus and modules, and the stop of the guardian, in virtual time.
#include <cmath>
#include <gtest/gtest.h>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/aseba/node_stopper.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "bridges/footbot_emulator/faults.hpp"
#include "bridges/footbot_emulator/footbot.hpp"
#include "hal/device/wheels.hpp"
#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/can/memory_bus.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/faults/run_story.hpp"

namespace tandem::faults {
namespace {

namespace emulator = bridges::footbot_emulator;
namespace bridge = bridges::footbot;
using bridges::LinkHealth;

constexpr std::array<FaultChoice, 14> kChoices = {{
    {.text = "silent"},
    {.text = "deaf"},
    {.text = "silent=left-motor"},
    {.text = "deaf=right-motor"},
    {.text = "missing=left-motor"},
    {.text = "missing=gripper"},
    {.text = "drop=%P", .most = 0.3},
    {.text = "lose=%P", .most = 0.3},
    {.text = "double=%P", .most = 0.2},
    {.text = "swap=%P", .most = 0.2},
    {.text = "delay=%T", .most = 0.06},
    {.text = "hangup"},
    {.text = "restart", .lasts = false, .recovery_s = 0.2},
    {.text = "restart=right-motor", .lasts = false, .recovery_s = 0.2},
}};

const bridge::FootbotMap& default_map() {
  static const bridge::FootbotMap map = [] {
    hal::Problems problems;
    auto read =
        bridges::footbot::read_footbot_map(std::string(test::kSourceDir) + "/configs/footbot_map.xml", problems);
    for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
    return read.value_or(bridge::FootbotMap{});
  }();
  return map;
}

/// Open ground; the light tells the time.
class TimedBody final : public emulator::EmulatedBody {
 public:
  emulator::BodySenses sense(TimeNs now) override {
    emulator::BodySenses senses;
    senses.light.fill(light_at(now));
    return senses;
  }
  void actuate(TimeNs, const emulator::BodyCommand& command) override { command_ = command; }
  std::vector<emulator::Heard> take_heard() override { return {}; }
  const emulator::BodyCommand& command() const noexcept { return command_; }

 private:
  emulator::BodyCommand command_;
};

using bridges::aseba::CanMessages;
const bridges::aseba::CanMessagesSettings kOpen;

/// The hub's link, which the hub may close.
class HubMessages final : public bridges::aseba::MessageLink {
 public:
  HubMessages(std::unique_ptr<bridges::CanLink> link, bridges::Clock clock) : link_(std::move(link), kOpen, clock) {}
  bool send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept override {
    return open && link_.send(type, payload);
  }
  bool receive(bridges::aseba::MessageView& message) noexcept override {
    const bool any = link_.receive(message);
    return open && any;
  }
  bool wait(TimeNs timeout_ns) noexcept override { return link_.wait(timeout_ns); }
  void clear() noexcept override { link_.clear(); }
  bridges::aseba::Carrier state() const noexcept override {
    return open ? link_.state() : bridges::aseba::Carrier::Down;
  }
  bridges::aseba::MessageLinkStatistics statistics() const noexcept override { return link_.statistics(); }
  std::string name() const override { return link_.name(); }

  bool open = false;

 private:
  CanMessages link_;
};

class TestedFootbot final : public TestedRobot {
 public:
  TestedFootbot(std::size_t number, std::uint64_t seed)
      : robot_({.protocol = seed % 2 == 0 ? emulator::Protocol::V4 : emulator::Protocol::V5}, body_,
               [this, number](TimeNs at, std::string_view event, const bridges::EventFields& fields) {
                 log("fb" + std::to_string(number), at, bridges::to_json(at, event, fields));
               }),
        driver_(settings(number), messages_),
        light_(driver_.robot().sensor<hal::Light>()),
        wheels_(driver_.robot().actuator<hal::WheelSpeeds>()) {
    robot_.power_on(0);
  }

  void begin_faults(const std::vector<std::string>& texts, std::uint64_t seed, TimeNs now) override {
    std::vector<emulator::Fault> faults;
    for (const std::string& text : texts) faults.push_back(emulator::kFaults.parse(text).value());
    plan_ = emulator::FaultPlan(std::move(faults), seed);
    plan_.begin(now);
  }

  void live(TimeNs now) override {
    now_ = now;
    while (const auto change = plan_.next_change(now)) {
      emulator::apply(*change, robot_);
      if (change->fault->kind != emulator::FaultKind::Hangup) continue;
      to_robot_.clear();
      to_host_.clear();
      bus_.set_state(change->begins ? bridges::BusState::Down : bridges::BusState::Active);
    }
    for (bridges::CanFrame in; robots_end_->receive(in);) {
      const emulator::Frame frame{static_cast<std::uint16_t>(in.id), in.size, in.data};
      free_at_ = std::max(free_at_, now) + emulator::duration_ns(frame);
      if (plan_.reaches_robot(free_at_)) to_robot_.push_back({frame, free_at_});
    }
    for (; !to_robot_.empty() && to_robot_.front().at <= now; to_robot_.pop_front()) {
      robot_.receive(to_robot_.front().frame, to_robot_.front().at);
    }
    robot_.run_until(now);
    sent_.clear();
    robot_.take_sent(sent_);
    arriving_.clear();
    for (const emulator::TimedFrame& frame : sent_) plan_.to_host(frame, arriving_);
    to_host_.insert(to_host_.end(), arriving_.begin(), arriving_.end());
    for (; !to_host_.empty() && to_host_.front().at <= now; to_host_.pop_front()) {
      const emulator::Frame& frame = to_host_.front().frame;
      (void)robots_end_->send(bridges::make_frame(frame.id, std::span(frame.data).first(frame.size)));
    }
  }

  Speed speed() const override {
    const double left = std::abs(robot_.command().left_m_s), right = std::abs(robot_.command().right_m_s);
    return {std::min(left, right), std::max(left, right)};
  }
  std::string state() const override {
    return std::string(bridge::state_name(driver_.state())) + ", " + driver_.trouble() + "; wheels " +
           std::to_string(robot_.command().left_m_s) + " " + std::to_string(robot_.command().right_m_s);
  }

  void open_link(TimeNs) override { messages_.open = true; }
  void close_link(TimeNs) override {
    messages_.clear();
    messages_.open = false;
  }
  void latch(hal::Tick tick, TimeNs now) override { driver_.latch(tick, now); }
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
      std::unique_ptr<bridges::aseba::MessageLink> link = std::make_unique<CanMessages>(bus_.attach(), kOpen, clock());
      return link;
    };
    stopper_.emplace(open, driver_.wiring().rest_messages());
  }
  bool guard(TimeNs now) override { return stopper_->poll(now) == bridges::guardian::StopState::Confirmed; }
  void end_guarding(TimeNs) override { stopper_.reset(); }

 private:
  bridges::Clock clock() {
    return [this] { return now_; };
  }
  static bridge::DriverSettings settings(std::size_t number) {
    bridge::DriverSettings s;
    s.map = default_map();
    s.robot.id = "fb" + std::to_string(number);
    return s;
  }

  TimeNs now_ = 0, free_at_ = 0;
  TimedBody body_;
  emulator::Footbot robot_;
  emulator::FaultPlan plan_{{}, 1};
  bridges::MemoryBus bus_{[this] { return now_; }};
  std::unique_ptr<bridges::CanLink> robots_end_ = bus_.attach();
  std::deque<emulator::TimedFrame> to_robot_, to_host_;
  std::vector<emulator::TimedFrame> sent_, arriving_;
  HubMessages messages_{bus_.attach(), clock()};
  bridge::FootbotDriver driver_;
  const hal::Light& light_;
  hal::WheelSpeeds& wheels_;
  std::optional<bridges::aseba::NodeStopper> stopper_;
};

TEST(Faults, LeaveNoFootbotMoving) {
  ASSERT_FALSE(default_map().nodes.empty());
  Kind kind;
  kind.name = "footbot";
  kind.choices = kChoices;
  kind.make = [](std::size_t number, std::uint64_t seed) { return std::make_unique<TestedFootbot>(number, seed); };
  EXPECT_EQ(play_all(kind, 100), "");
}

}  // namespace
}  // namespace tandem::faults
