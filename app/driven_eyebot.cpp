// An eye-bot for `tandem robot`.
#include <fmt/format.h>

#include "app/driven_robot.hpp"
#include "bridges/eyebot/bridge.hpp"
#include "bridges/eyebot/guardian.hpp"
#include "mixed_reality/settings/eyebot_parts.hpp"

namespace tandem::app {
namespace {

namespace eyebot = bridges::eyebot;

class DrivenEyebot final : public DrivenRobot {
 public:
  DrivenEyebot(eyebot::Guardian guardian, mixed_reality::EyebotParts parts, const hal::Log& log)
      : guardian_(std::move(guardian)),
        bridge_(std::move(parts.settings), std::move(parts.opener), log),
        last_words_(bridge_.last_words(parts.url)) {}

  hal::Robot& robot() noexcept override { return bridge_.robot(); }
  void set_origin(hal::TimeNs origin_ns) noexcept override { bridge_.robot().set_origin(origin_ns); }
  void start() override {
    guardian_.watch(last_words_);
    bridge_.start();
  }
  hal::Status wait_active(hal::TimeNs timeout_ns) override { return bridge_.wait_active(timeout_ns); }
  bool unreachable() const override {
    const eyebot::BridgeStatus s = bridge_.status();
    return s.links_opened == 0 && !s.link_trouble.empty();
  }
  hal::Status check_identity() const override { return {}; }  // its name is its channel

  void latch(hal::Tick tick, hal::TimeNs now) noexcept override { bridge_.latch(tick, now); }
  void commit(hal::TimeNs now) noexcept override { bridge_.commit(now); }
  void fault(hal::TimeNs now, std::string_view why) override { bridge_.fault(now, why); }

  void forget() override { guardian_.release(last_words_); }
  void shut_down() override {
    status_ = bridge_.status();
    ended_ = true;
    bridge_.shut_down();
    const eyebot::BridgeStatus after = bridge_.status();
    status_.flight = after.flight;
    status_.orders = after.orders;
    status_.driver = after.driver;
    if (after.at_rest) forget();  // else it may yet be brought down
  }

  std::string loss() const override {
    const eyebot::BridgeStatus s = status();
    return s.state == eyebot::RobotState::Lost ? s.trouble : "";
  }
  std::string link() const override { return status().link; }

  void add_to_report(Json& json) const override {
    const eyebot::BridgeStatus s = status();
    json.field("state", eyebot::state_name(s.state)).field("mode", eyebot::mode_name(s.flight.mode));
    json.field("messages_in", s.messages.received).field("messages_out", s.driver.said);
    json.field("messages_lost", s.messages.lost).field("messages_old", s.messages.old);
    json.field("messages_replaced", s.messages.replaced);
    json.field("messages_refused", s.messages.refused + s.driver.not_understood);
    json.field("messages_unsent", s.driver.unsent).field("from_other_senders", s.other_senders);
    json.field("interruptions", s.driver.link_stops).field("recovered", s.driver.recovered);
    json.field("losses", s.driver.lost).field("stops_for_want_of_commands", s.driver.watchdog_stops);
    json.field("restarts", s.restarts).field("clock_jumps", s.clock_jumps).field("links_opened", s.links_opened);
    json.field("orders", s.orders.orders).field("orders_said_again", s.orders.said_again);
    json.field("orders_refused", s.orders.refused).field("orders_unanswered", s.orders.unanswered);
    json.field("refused_for_another_hub", s.driver.refused_control);
    json.field("commands_clamped", s.driver.clamped).field("commands_not_finite", s.driver.not_finite);
  }

  std::vector<std::pair<std::string, std::string>> table() const override {
    const eyebot::BridgeStatus s = status();
    const std::uint64_t answered = s.orders.accepted + s.orders.refused;
    const double mean_ms =
        answered > 0 ? static_cast<double>(s.orders.sum_round_trip_ns) * 1e-6 / static_cast<double>(answered) : 0.0;
    std::vector<std::pair<std::string, std::string>> rows = {
        {"messages",
         fmt::format("{} in, {} of them lost on the way; {} out", s.messages.received, s.messages.lost, s.driver.said)},
        {"orders", fmt::format("{} accepted, {} refused, {} not answered; {:.1f} ms round trip on average",
                               s.orders.accepted, s.orders.refused, s.orders.unanswered, mean_ms)},
        {"trouble",
         fmt::format("{} interruptions, {} recoveries, {} restarts, {} damaged messages", s.driver.link_stops,
                     s.driver.recovered, s.restarts, s.messages.refused + s.driver.not_understood)},
        {"at the end", fmt::format("{}, {}", eyebot::state_name(s.state), eyebot::mode_name(s.flight.mode))}};
    if (!s.trouble.empty()) rows.emplace_back("missing", s.trouble);
    return rows;
  }

 private:
  eyebot::BridgeStatus status() const { return ended_ ? status_ : bridge_.status(); }

  eyebot::Guardian guardian_;
  eyebot::EyebotBridge bridge_;
  eyebot::LastWords last_words_;
  bool ended_ = false;
  eyebot::BridgeStatus status_;
};

}  // namespace

hal::Result<std::unique_ptr<DrivenRobot>> make_driven_eyebot(const DrivenRobotRequest& request, const hal::Log& log) {
  auto parts = mixed_reality::eyebot_parts(request.item, request.ticks_per_second);
  if (!parts.ok()) return parts.error();
  auto guardian = eyebot::Guardian::start();
  if (!guardian.ok()) return guardian.error();
  parts->settings.driver.robot.seed = request.seed;
  parts->settings.driver.robot.sensors = device_names(request.controller.sensors);
  parts->settings.driver.robot.actuators = device_names(request.controller.actuators);
  return std::unique_ptr<DrivenRobot>(
      std::make_unique<DrivenEyebot>(std::move(guardian).value(), std::move(parts).value(), log));
}

}  // namespace tandem::app
