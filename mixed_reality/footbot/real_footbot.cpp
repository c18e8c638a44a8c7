#include "mixed_reality/footbot/real_footbot.hpp"

#include <cstring>

#include "hal/device/body_sensors.hpp"
#include "mixed_reality/settings/footbot_parts.hpp"

namespace tandem::mixed_reality {

using bridges::footbot::BridgeStatus;
using bridges::footbot::RobotState;

RealFootbot::RealFootbot(bridges::footbot::BridgeSettings settings, bridges::aseba::MessageLinkOpener opener,
                         const hal::Log& log)
    : bridge_(std::make_unique<bridges::footbot::FootbotBridge>(std::move(settings), std::move(opener), log)) {}

void RealFootbot::latch(const Moment& now) noexcept {
  if (!started_) {
    started_ = true;
    bridge_->start();
  }
  bridge_->robot().set_origin(now.monotonic_ns - now.run_ns);
  bridge_->latch(0, now.monotonic_ns);
  const auto statistics = bridge_->statistics();
  // Every interruption stops the robot, also one that is over already.
  const std::uint64_t interruptions = statistics.link_stops + statistics.watchdog_stops;
  const bool begun_anew = was_active_ && interruptions != interruptions_;
  interruptions_ = interruptions;
  switch (bridge_->state()) {
    case RobotState::Active:
      health_ = begun_anew ? LinkHealth::Suspect : LinkHealth::Active;
      was_active_ = true;
      break;
    case RobotState::Lost:
      health_ = was_active_ ? LinkHealth::Lost : LinkHealth::Connecting;
      break;
    case RobotState::Absent:
    case RobotState::Searching:
    case RobotState::Ready:
    case RobotState::Suspect:
      health_ = was_active_ ? LinkHealth::Suspect : LinkHealth::Connecting;
      break;
  }
}

void* RealFootbot::port(const hal::PortType& type) const noexcept {
  if (type.name == hal::Clock::kName) return nullptr;
  try {
    return bridge_->robot().require(type);
  } catch (const hal::DeviceError&) {
    return nullptr;
  }
}

const void* RealFootbot::reading(const hal::PortType& type) const noexcept {
  return type.role == hal::Role::Sensor ? port(type) : nullptr;
}

bool RealFootbot::command(const hal::PortType& type, const void* command) noexcept {
  void* own = type.role == hal::Role::Actuator ? port(type) : nullptr;
  if (own == nullptr) return false;
  std::memcpy(own, command, type.size);
  return true;
}

void RealFootbot::commit(const Moment& now) noexcept {
  if (stop_asked_) {
    stop_asked_ = false;
    bridge_->resume();
  }
  bridge_->commit(now.monotonic_ns);
}

void RealFootbot::stop(const Moment& now) noexcept {
  stop_asked_ = true;
  bridge_->stop(now.monotonic_ns);
}

bool RealFootbot::stopped() const noexcept {
  return stop_asked_ && bridge_->at_rest();
}

LinkReport RealFootbot::report() const {
  const BridgeStatus status = bridge_->status();
  LinkReport report;
  hal::TimeNs sum_round_trip_ns = 0;
  report.packets = status.messages.sent;
  for (const auto& node : status.nodes) {
    report.answers += node.statistics.answers;
    report.time_outs += node.statistics.asked_again + node.statistics.unanswered;
    report.bad_answers += node.statistics.wrong_length + node.statistics.not_understood;
    sum_round_trip_ns += node.statistics.sum_round_trip_ns;
    report.max_round_trip_ns = std::max(report.max_round_trip_ns, node.statistics.max_round_trip_ns);
  }
  if (report.answers > 0) report.mean_round_trip_ns = sum_round_trip_ns / static_cast<hal::TimeNs>(report.answers);
  report.resynchronised = status.driver.recovered;
  report.links_lost = status.driver.lost;
  return report;
}

hal::Result<std::unique_ptr<RealFootbot>> make_real_footbot(const RealRobotRequest& request, const hal::Log& log) {
  auto parts = footbot_parts(request.item, request.ticks_per_second);
  if (!parts.ok()) return parts.error();
  return std::make_unique<RealFootbot>(std::move(parts->settings), std::move(parts->opener), log);
}

}  // namespace tandem::mixed_reality
