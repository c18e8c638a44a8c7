#include "mixed_reality/eyebot/real_eyebot.hpp"

#include <algorithm>
#include <cstring>

#include "hal/device/body_sensors.hpp"

namespace tandem::mixed_reality {

using bridges::eyebot::BridgeStatus;
using bridges::eyebot::RobotState;

RealEyebot::RealEyebot(bridges::eyebot::BridgeSettings settings, bridges::eyebot::LcmOpener opener, std::string url,
                       const hal::Log& log)
    : url_(std::move(url)),
      land_(settings.farewell.land),
      bridge_(std::make_unique<bridges::eyebot::EyebotBridge>(std::move(settings), std::move(opener), log)) {}

void RealEyebot::latch(const Moment& now) noexcept {
  if (!started_) {
    started_ = true;
    bridge_->start();
  }
  bridge_->robot().set_origin(now.monotonic_ns - now.run_ns);
  bridge_->latch(0, now.monotonic_ns);
  if (stop_asked_ && !stop_confirmed_ && bridge_->at_rest()) {
    stop_confirmed_ = true;
    if (land_) bridge_->land(now.monotonic_ns);
  }
  const auto statistics = bridge_->statistics();
  // Every interruption has it hover, also one that is over already.
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
    case RobotState::Ready:
    case RobotState::Suspect:
      health_ = was_active_ ? LinkHealth::Suspect : LinkHealth::Connecting;
      break;
  }
}

void* RealEyebot::port(const hal::PortType& type) const noexcept {
  if (type.name == hal::Clock::kName) return nullptr;
  try {
    return bridge_->robot().require(type);
  } catch (const hal::DeviceError&) {
    return nullptr;
  }
}

const void* RealEyebot::reading(const hal::PortType& type) const noexcept {
  return type.role == hal::Role::Sensor ? port(type) : nullptr;
}

bool RealEyebot::command(const hal::PortType& type, const void* command) noexcept {
  void* own = type.role == hal::Role::Actuator ? port(type) : nullptr;
  if (own == nullptr) return false;
  std::memcpy(own, command, type.size);
  return true;
}

void RealEyebot::commit(const Moment& now) noexcept {
  if (stop_asked_) {
    stop_asked_ = stop_confirmed_ = false;
    bridge_->resume();
  }
  bridge_->commit(now.monotonic_ns);
}

void RealEyebot::stop(const Moment& now) noexcept {
  stop_asked_ = true;
  bridge_->stop(now.monotonic_ns);
}

bool RealEyebot::stopped() const noexcept {
  return stop_asked_ && stop_confirmed_;
}

LinkReport RealEyebot::report() const {
  const BridgeStatus status = bridge_->status();
  LinkReport report;
  report.packets = status.driver.said;
  report.answers = status.messages.received - status.messages.refused - status.messages.old;
  report.time_outs = status.messages.lost + status.orders.unanswered;
  report.bad_answers = status.messages.refused + status.driver.not_understood;
  report.resynchronised = status.driver.recovered;
  report.links_lost = status.driver.lost;
  const std::uint64_t answered = status.orders.accepted + status.orders.refused;
  if (answered > 0) report.mean_round_trip_ns = status.orders.sum_round_trip_ns / static_cast<hal::TimeNs>(answered);
  report.max_round_trip_ns = status.orders.max_round_trip_ns;
  return report;
}

hal::Result<std::unique_ptr<RealEyebot>> make_real_eyebot(const RealRobotRequest& request, const hal::Log& log) {
  auto parts = eyebot_parts(request.item, request.ticks_per_second);
  if (!parts.ok()) return parts.error();
  return std::make_unique<RealEyebot>(std::move(parts->settings), std::move(parts->opener), std::move(parts->url), log);
}

}  // namespace tandem::mixed_reality
