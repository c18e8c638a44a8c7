// A foot-bot for `tandem robot`.
#include <fmt/format.h>

#include "app/driven_robot.hpp"
#include "bridges/footbot/bridge.hpp"
#include "bridges/footbot/guardian.hpp"
#include "mixed_reality/settings/footbot_parts.hpp"

namespace tandem::app {
namespace {

namespace footbot = bridges::footbot;

class DrivenFootbot final : public DrivenRobot {
 public:
  DrivenFootbot(const core::RobotItem& item, footbot::Guardian guardian, mixed_reality::FootbotParts parts,
                const hal::Log& log)
      : item_(item), guardian_(std::move(guardian)), bridge_(std::move(parts.settings), std::move(parts.opener), log) {}

  hal::Robot& robot() noexcept override { return bridge_.robot(); }
  void set_origin(hal::TimeNs origin_ns) noexcept override { bridge_.robot().set_origin(origin_ns); }
  void start() override { bridge_.start(); }
  hal::Status wait_active(hal::TimeNs timeout_ns) override { return bridge_.wait_active(timeout_ns); }
  bool unreachable() const override {
    const footbot::BridgeStatus s = bridge_.status();
    return s.links_opened == 0 && !s.link_trouble.empty();
  }
  hal::Status check_identity() const override { return {}; }  // it would not be active with other variables

  void latch(hal::Tick tick, hal::TimeNs now) noexcept override { bridge_.latch(tick, now); }
  void commit(hal::TimeNs now) noexcept override {
    // Before the first command leaves, the guardian knows how to stop the robot as it is wired now.
    auto words = bridge_.last_words();
    if (words != last_words_) {
      last_words_ = std::move(words);
      guardian_.watch(item_.bridge->link, last_words_);
    }
    bridge_.commit(now);
  }
  void fault(hal::TimeNs now, std::string_view why) override { bridge_.fault(now, why); }

  void forget() override { guardian_.release(item_.bridge->link); }
  void shut_down() override {
    status_ = bridge_.status();
    ended_ = true;
    bridge_.shut_down();
    if (bridge_.status().at_rest) forget();  // else it may yet be stopped
  }

  std::string loss() const override {
    const footbot::BridgeStatus s = status();
    return s.state == footbot::RobotState::Lost ? s.trouble : "";
  }
  std::string link() const override { return status().link; }

  void add_to_report(Json& json) const override {
    const footbot::BridgeStatus s = status();
    json.field("state", footbot::state_name(s.state)).field("messages_in", s.messages.received);
    json.field("messages_out", s.messages.sent).field("messages_dropped", s.messages.dropped);
    json.field("interruptions", s.driver.link_stops).field("recovered", s.driver.recovered);
    json.field("losses", s.driver.lost).field("stops_for_want_of_commands", s.driver.watchdog_stops);
    json.field("other_hosts", s.network.other_hosts).field("not_understood", s.network.not_understood);
    json.field("counter_jumps", s.wiring.counter_jumps).field("not_obeyed", s.wiring.not_obeyed);
    json.field("commands_clamped", s.driver.clamped).field("commands_not_finite", s.driver.not_finite);
    json.key("nodes").begin_array();
    for (const footbot::NodeStatus& n : s.nodes) {
      json.begin_object();
      json.field("name", n.name).field("id", static_cast<std::int64_t>(n.id)).field("needed", n.needed);
      json.field("state", bridges::aseba::node_state_name(n.state)).field("trouble", n.trouble);
      json.field("reads", n.statistics.reads).field("answers", n.statistics.answers);
      json.field("unanswered", n.statistics.unanswered).field("writes", n.statistics.writes);
      json.field("times_lost", n.statistics.times_lost).field("times_ready", n.statistics.times_ready);
      json.end_object();
    }
    json.end_array();
  }

  std::vector<std::pair<std::string, std::string>> table() const override {
    const footbot::BridgeStatus s = status();
    std::uint64_t reads = 0, answers = 0, lost = 0;
    hal::TimeNs sum_ns = 0;
    std::string modules;
    for (const footbot::NodeStatus& n : s.nodes) {
      reads += n.statistics.reads;
      answers += n.statistics.answers;
      lost += n.statistics.times_lost;
      sum_ns += n.statistics.sum_round_trip_ns;
      if (n.state == bridges::aseba::NodeState::Ready) modules += (modules.empty() ? "" : ", ") + n.name;
    }
    const double mean_ms = answers > 0 ? static_cast<double>(sum_ns) * 1e-6 / static_cast<double>(answers) : 0.0;
    std::vector<std::pair<std::string, std::string>> rows = {
        {"modules", modules},
        {"answers", fmt::format("{} to {} questions, {:.1f} ms round trip on average", answers, reads, mean_ms)},
        {"trouble", fmt::format("{} interruptions, {} recoveries, {} modules lost, {} commands not obeyed at once",
                                s.driver.link_stops, s.driver.recovered, lost, s.wiring.not_obeyed)},
        {"at the end", footbot::state_name(s.state)}};
    if (!s.trouble.empty()) rows.emplace_back("missing", s.trouble);
    return rows;
  }

 private:
  footbot::BridgeStatus status() const { return ended_ ? status_ : bridge_.status(); }

  const core::RobotItem& item_;
  footbot::Guardian guardian_;
  footbot::FootbotBridge bridge_;
  std::vector<footbot::LastWords> last_words_;
  bool ended_ = false;
  footbot::BridgeStatus status_;
};

}  // namespace

hal::Result<std::unique_ptr<DrivenRobot>> make_driven_footbot(const DrivenRobotRequest& request, const hal::Log& log) {
  auto parts = mixed_reality::footbot_parts(request.item, request.ticks_per_second);
  if (!parts.ok()) return parts.error();
  auto guardian = footbot::Guardian::start();
  if (!guardian.ok()) return guardian.error();
  parts->settings.driver.robot.seed = request.seed;
  parts->settings.driver.robot.sensors = device_names(request.controller.sensors);
  parts->settings.driver.robot.actuators = device_names(request.controller.actuators);
  return std::unique_ptr<DrivenRobot>(
      std::make_unique<DrivenFootbot>(request.item, std::move(guardian).value(), std::move(parts).value(), log));
}

}  // namespace tandem::app
