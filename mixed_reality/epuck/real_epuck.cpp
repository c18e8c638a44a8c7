#include "mixed_reality/epuck/real_epuck.hpp"

#include <cstring>

#include "bridges/link/link_text.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/spec/epuck.hpp"
#include "mixed_reality/settings/patience.hpp"

namespace tandem::mixed_reality {
namespace {

using bridges::epuck::SessionState;

bool left_to_the_twin(const hal::PortType& type) noexcept {
  return type.name == hal::RangeAndBearing::kName || type.name == hal::Clock::kName;
}

}  // namespace

RealEpuck::RealEpuck(bridges::epuck::BridgeSettings settings, bridges::LinkOpener opener, const hal::Log& log,
                     std::string firmware)
    : bridge_(std::make_unique<bridges::epuck::EpuckBridge>(std::move(settings), std::move(opener), log)),
      firmware_(std::move(firmware)) {}

void RealEpuck::latch(const Moment& now) noexcept {
  if (!started_) {
    started_ = true;
    bridge_->start();
  }
  bridge_->robot().set_origin(now.monotonic_ns - now.run_ns);
  bridge_->latch(0, now.monotonic_ns);
  const bridges::epuck::BridgeStatus status = bridge_->status();
  const bool begun_anew =
      was_active_ && status.session.handshakes != handshakes_;  // and every handshake stops the robot
  handshakes_ = status.session.handshakes;
  switch (status.state) {
    case SessionState::Active:
      wrong_firmware_ = !bridges::epuck::firmware_fits(firmware_, status.identity.firmware);
      if (wrong_firmware_) {
        health_ = LinkHealth::Connecting;
        break;
      }
      health_ = begun_anew ? LinkHealth::Suspect : LinkHealth::Active;
      was_active_ = true;
      break;
    case SessionState::Lost:
      health_ = was_active_ ? LinkHealth::Lost : LinkHealth::Connecting;
      break;
    case SessionState::Absent:
    case SessionState::Handshake:
    case SessionState::Ready:
    case SessionState::Suspect:
      health_ = was_active_ ? LinkHealth::Suspect : LinkHealth::Connecting;
      break;
  }
}

std::string RealEpuck::trouble() const {
  if (wrong_firmware_) return "it does not run the firmware '" + firmware_ + "' that the file names";
  return bridge_->status().trouble;
}

void* RealEpuck::port(const hal::PortType& type) const noexcept {
  if (left_to_the_twin(type)) return nullptr;
  try {
    return bridge_->robot().require(type);
  } catch (const hal::DeviceError&) {
    return nullptr;
  }
}

const void* RealEpuck::reading(const hal::PortType& type) const noexcept {
  return type.role == hal::Role::Sensor ? port(type) : nullptr;
}

bool RealEpuck::command(const hal::PortType& type, const void* command) noexcept {
  void* own = type.role == hal::Role::Actuator ? port(type) : nullptr;
  if (own == nullptr) return false;
  std::memcpy(own, command, type.size);
  return true;
}

void RealEpuck::commit(const Moment& now) noexcept {
  if (stop_asked_) {
    stop_asked_ = false;
    bridge_->resume();
  }
  bridge_->commit(now.monotonic_ns);
}

void RealEpuck::stop(const Moment& now) noexcept {
  const bridges::epuck::BridgeStatus status = bridge_->status();
  stop_asked_ = true;
  resynchronised_at_stop_ = status.session.resynchronised;
  confirmed_at_stop_ = status.session.stops_confirmed;
  bridge_->stop(now.monotonic_ns);
}

bool RealEpuck::stopped() const noexcept {
  if (!stop_asked_) return false;
  const bridges::epuck::BridgeStatus status = bridge_->status();
  // A handshake begins with a stop of its own.
  return status.session.stops_confirmed > confirmed_at_stop_ || status.session.resynchronised > resynchronised_at_stop_;
}

LinkReport RealEpuck::report() const {
  const bridges::epuck::BridgeStatus status = bridge_->status();
  const bridges::epuck::SessionStatistics& s = status.session;
  LinkReport report;
  report.packets = s.packets;
  report.answers = s.answers;
  report.time_outs = s.silent + s.cut_short;
  report.bad_answers = s.implausible;
  report.resynchronised = s.resynchronised;
  report.links_lost = s.links_lost;
  report.mean_round_trip_ns = s.answers > 0 ? s.sum_round_trip_ns / static_cast<hal::TimeNs>(s.answers) : 0;
  report.max_round_trip_ns = s.max_round_trip_ns;
  return report;
}

hal::Result<std::unique_ptr<RealRobot>> make_real_robot(const RealRobotRequest& request, const hal::Log& log) {
  const core::RobotItem& item = request.item;
  if (item.kind != hal::epuck::kDataSheet.kind)
    return hal::Error{"there is no bridge to robots of the kind '" + item.kind +
                      "'; there is: e-puck, foot-bot, eye-bot"};
  const auto address = bridges::parse_link(item.bridge->link);
  if (!address.ok()) return address.error();
  auto opener = bridges::epuck::epuck_link_opener(address.value());
  if (!opener.ok()) return opener.error();
  bridges::epuck::BridgeSettings settings;
  settings.driver.robot.id = item.id;
  settings.driver.robot.tick_ns = hal::time_of_tick(1, request.ticks_per_second);
  settings.driver.timing = bridges::epuck::timing_for(item.bridge->link);
  settings.driver.command_timeout_ns = lost_after_ns(item, request.ticks_per_second);
  return std::unique_ptr<RealRobot>(
      std::make_unique<RealEpuck>(std::move(settings), std::move(opener).value(), log, item.bridge->firmware));
}

}  // namespace tandem::mixed_reality
