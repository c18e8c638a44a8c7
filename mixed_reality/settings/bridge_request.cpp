#include "mixed_reality/settings/bridge_request.hpp"

#include "mixed_reality/settings/kind_check.hpp"
#include "mixed_reality/settings/timeouts.hpp"

namespace tandem::mixed_reality {
namespace {

using bridges::BridgeType;

std::vector<std::string> device_names(const std::vector<core::DeviceChoice>& choices) {
  std::vector<std::string> names;
  for (const core::DeviceChoice& c : choices) {
    if (!c.grown) names.push_back(c.device);
  }
  return names;
}

hal::Result<const BridgeType*> type_for(const hal::Catalog& catalog, const std::string& kind) {
  if (const auto* const type = catalog.find<BridgeType>(kind)) return type;
  return hal::Error{"there is no bridge to robots of the kind '" + kind +
                    "'; there is: " + hal::listed(catalog.names(BridgeType::kCategory))};
}

hal::Status check_built(const hal::Catalog& catalog, const bridges::BridgeRequest& request) {
  const auto* const real = catalog.find<hal::RobotKind>(request.kind);
  return real == nullptr ? hal::Status{} : check_built_as(request.robot_kind, *real);
}

}  // namespace

bridges::BridgeRequest bridge_request(const core::Scenario& scenario, const core::RobotItem& item, std::uint64_t seed) {
  bridges::BridgeRequest request;
  request.kind = core::bridged_as(scenario, item.kind);
  request.robot_kind = item.own_kind.get();
  for (const core::KindConfig& config : scenario.kinds) {
    if (request.robot_kind == nullptr && config.kind->name == item.kind) request.robot_kind = config.kind.get();
  }
  request.robot = item.id;
  request.link = item.bridge->link;
  request.file = scenario.file;
  request.options = item.bridge->own;
  request.tick_ns = hal::time_of_tick(1, scenario.ticks_per_second);
  request.lost_after_ns = lost_after_ns(item, scenario.ticks_per_second);
  request.seed = seed;
  if (item.controller < scenario.controllers.size()) {
    request.sensors = device_names(scenario.controllers[item.controller].sensors);
    request.actuators = device_names(scenario.controllers[item.controller].actuators);
  }
  return request;
}

bridges::MadeBridge make_bridge(const hal::Catalog& catalog, const bridges::BridgeRequest& request,
                                const hal::Log& log) {
  const auto type = type_for(catalog, request.kind);
  if (!type.ok()) return type.error();
  if (const hal::Status built = check_built(catalog, request); !built.ok()) return built.error();
  return type.value()->make(request, log);
}

std::vector<bridges::InputFile> bridge_inputs(const hal::Catalog& catalog, const bridges::BridgeRequest& request) {
  const auto* const type = catalog.find<BridgeType>(request.kind);
  if (type == nullptr || type->inputs == nullptr) return {};
  std::vector<bridges::InputFile> files = type->inputs(request);
  std::erase_if(files, [](const bridges::InputFile& file) { return file.second.empty(); });
  return files;
}

hal::Status check_bridge(const hal::Catalog& catalog, const bridges::BridgeRequest& request) {
  const auto type = type_for(catalog, request.kind);
  if (!type.ok()) return type.error();
  const hal::Status built = check_built(catalog, request);
  return built.ok() ? type.value()->check(request) : built;
}

}  // namespace tandem::mixed_reality
