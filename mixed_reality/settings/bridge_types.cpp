#include "mixed_reality/settings/bridge_types.hpp"

#include <array>

#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"
#include "mixed_reality/settings/epuck_parts.hpp"
#include "mixed_reality/settings/eyebot_parts.hpp"
#include "mixed_reality/settings/footbot_parts.hpp"

namespace tandem::mixed_reality {
namespace {

std::vector<std::string> device_names(const std::vector<core::DeviceChoice>& choices) {
  std::vector<std::string> names;
  for (const core::DeviceChoice& c : choices) names.push_back(c.device);
  return names;
}

/// From the parts of one kind, which `Parts` names, to its bridge.
template <class Bridge, auto Parts>
MadeBridge make(const BridgeRequest& request, const hal::Log& log) {
  auto parts = Parts(request.item, request.ticks_per_second, request.permit);
  if (!parts.ok()) return parts.error();
  auto& robot = parts->settings.driver.robot;
  robot.seed = request.seed;
  robot.sensors = device_names(request.controller.sensors);
  robot.actuators = device_names(request.controller.actuators);
  if constexpr (requires { parts->settings.driver.unix_clock; }) {
    if (request.unix_clock != nullptr) parts->settings.driver.unix_clock = request.unix_clock;
  }
  return std::unique_ptr<bridges::RobotBridge>(
      std::make_unique<Bridge>(std::move(parts->settings), std::move(parts->opener), log));
}

template <auto Parts>
hal::Status check(const core::RobotItem& item, std::int64_t ticks_per_second) {
  const auto parts = Parts(item, ticks_per_second, {});
  return parts.ok() ? hal::Status{} : hal::Status{parts.error()};
}

hal::Result<const BridgeType*> type_for(std::string_view kind) {
  std::string kinds;
  for (const BridgeType& type : bridge_types()) {
    if (type.kind == kind) return &type;
    kinds += (kinds.empty() ? "" : ", ") + std::string(type.kind);
  }
  return hal::Error{"there is no bridge to robots of the kind '" + std::string(kind) + "'; there is: " + kinds};
}

}  // namespace

std::span<const BridgeType> bridge_types() noexcept {
  static const std::array<BridgeType, 3> types = {{
      {hal::epuck::kDataSheet.kind,
       &make<bridges::epuck::EpuckBridge, &epuck_parts>,
       &check<&epuck_parts>,
       {.charge = 0.0, .supply_V = hal::epuck::kBatteryLow_V}},
      {hal::footbot::kDataSheet.kind,
       &make<bridges::footbot::FootbotBridge, &footbot_parts>,
       &check<&footbot_parts>,
       {.charge = 0.0, .supply_V = hal::footbot::kBatteryLow_V}},
      {hal::eyebot::kDataSheet.kind,
       &make<bridges::eyebot::EyebotBridge, &eyebot_parts>,
       &check<&eyebot_parts>,
       {.charge = hal::eyebot::kBatteryLow}},
  }};
  return types;
}

BatteryLimit battery_limit(std::string_view kind) noexcept {
  for (const BridgeType& type : bridge_types()) {
    if (type.kind == kind) return type.battery;
  }
  return {};
}

hal::Status check_bridge(const core::RobotItem& item, std::int64_t ticks_per_second) {
  const auto type = type_for(item.kind);
  return type.ok() ? type.value()->check(item, ticks_per_second) : hal::Status{type.error()};
}

MadeBridge make_bridge(const BridgeRequest& request, const hal::Log& log) {
  const auto type = type_for(request.item.kind);
  if (!type.ok()) return type.error();
  return type.value()->make(request, log);
}

}  // namespace tandem::mixed_reality
