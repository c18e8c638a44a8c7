// An e-puck for `tandem robot`.
#include <algorithm>
#include <fmt/format.h>

#include "app/driven_robot.hpp"
#include "bridges/epuck/bridge.hpp"
#include "bridges/epuck/guardian.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::app {
namespace {

namespace epuck = bridges::epuck;

class DrivenEpuck final : public DrivenRobot {
 public:
  DrivenEpuck(const core::RobotItem& item, bridges::LinkAddress address, epuck::Guardian guardian,
              const epuck::BridgeSettings& settings, bridges::LinkOpener opener, const hal::Log& log)
      : item_(item),
        address_(std::move(address)),
        guardian_(std::move(guardian)),
        bridge_(settings, std::move(opener), log) {}

  hal::Robot& robot() noexcept override { return bridge_.robot(); }
  void set_origin(hal::TimeNs origin_ns) noexcept override { bridge_.robot().set_origin(origin_ns); }
  void start() override {
    guardian_.watch(address_.target, address_.rate);
    bridge_.start();
  }
  hal::Status wait_active(hal::TimeNs timeout_ns) override { return bridge_.wait_active(timeout_ns); }
  bool unreachable() const override {
    const epuck::BridgeStatus s = bridge_.status();
    return s.links_opened == 0 && !s.trouble.empty();
  }
  hal::Status check_identity() const override {
    const epuck::Identity who = bridge_.status().identity;
    if (epuck::firmware_fits(item_.bridge->firmware, who.firmware)) return {};
    return hal::Error{"robot '" + item_.id + "' runs the firmware '" + std::string(who.version_text()) + "', not '" +
                      item_.bridge->firmware + "' as the file says; correct firmware=\"…\" or say auto"};
  }

  void latch(hal::Tick tick, hal::TimeNs now) noexcept override { bridge_.latch(tick, now); }
  void commit(hal::TimeNs now) noexcept override { bridge_.commit(now); }
  void fault(hal::TimeNs now, std::string_view why) override { bridge_.fault(now, why); }

  void forget() override { guardian_.release(address_.target); }
  void shut_down() override {
    status_ = bridge_.status();
    ended_ = true;
    bridge_.shut_down();
    if (status_.state != epuck::SessionState::Lost) forget();  // else it may yet be stopped
  }

  std::string loss() const override {
    const epuck::BridgeStatus s = status();
    return s.state == epuck::SessionState::Lost ? s.trouble : "";
  }
  std::string link() const override { return status().link; }

  void add_to_report(Json& json) const override {
    const epuck::BridgeStatus s = status();
    json.field("firmware", s.identity.version_text()).field("state", epuck::state_name(s.state));
    json.field("packets", s.session.packets).field("answers", s.session.answers).field("silent", s.session.silent);
    json.field("cut_short", s.session.cut_short)
        .field("implausible", s.session.implausible)
        .field("resynchronised", s.session.resynchronised);
    json.field("restarts", s.session.restarts).field("links_lost", s.session.links_lost);
    json.field("commands_clamped", s.driver.clamped).field("commands_not_finite", s.driver.not_finite);
    json.field("bytes_in", s.bytes.bytes_in).field("bytes_out", s.bytes.bytes_out);
  }

  std::vector<std::pair<std::string, std::string>> table() const override {
    const epuck::BridgeStatus status_now = status();
    const epuck::SessionStatistics& s = status_now.session;
    const double mean_ms =
        s.answers > 0 ? static_cast<double>(s.sum_round_trip_ns) * 1e-6 / static_cast<double>(s.answers) : 0.0;
    return {
        {"firmware", std::string(status_now.identity.version_text())},
        {"answers", fmt::format("{} of {} packets, {:.1f} ms round trip on average", s.answers, s.packets, mean_ms)},
        {"trouble", fmt::format("{} silences, {} answers cut short, {} implausible, {} restarts, {} links lost",
                                s.silent, s.cut_short, s.implausible, s.restarts, s.links_lost)},
        {"rolled",
         fmt::format("{:.3f} m left, {:.3f} m right", status_now.odometry.left_m, status_now.odometry.right_m)},
        {"at the end", epuck::state_name(status_now.state)}};
  }

 private:
  epuck::BridgeStatus status() const { return ended_ ? status_ : bridge_.status(); }

  const core::RobotItem& item_;
  bridges::LinkAddress address_;
  epuck::Guardian guardian_;
  epuck::EpuckBridge bridge_;
  bool ended_ = false;
  epuck::BridgeStatus status_;
};

}  // namespace

hal::Result<std::unique_ptr<DrivenRobot>> make_driven_epuck(const DrivenRobotRequest& request, const hal::Log& log) {
  const core::RobotItem& item = request.item;
  const auto address = bridges::parse_link(item.bridge->link);
  if (!address.ok()) return address.error();
  auto opener = epuck::epuck_link_opener(address.value());
  if (!opener.ok()) return opener.error();
  auto guardian = epuck::Guardian::start();
  if (!guardian.ok()) return guardian.error();
  epuck::BridgeSettings settings;
  settings.driver.robot.id = item.id;
  settings.driver.robot.seed = request.seed;
  settings.driver.robot.tick_ns = hal::time_of_tick(1, request.ticks_per_second);
  settings.driver.robot.sensors = device_names(request.controller.sensors);
  settings.driver.robot.actuators = device_names(request.controller.actuators);
  settings.driver.timing = epuck::timing_for(item.bridge->link);
  settings.driver.command_timeout_ns =
      std::max<hal::TimeNs>(static_cast<hal::TimeNs>(item.bridge->timeout_s * 1e9), 2 * settings.driver.robot.tick_ns);
  return std::unique_ptr<DrivenRobot>(std::make_unique<DrivenEpuck>(item, address.value(), std::move(guardian).value(),
                                                                    settings, std::move(opener).value(), log));
}

}  // namespace tandem::app
