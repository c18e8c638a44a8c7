#include "core/scenario/scenario.hpp"

#include <algorithm>

#include "hal/check.hpp"

namespace tandem::core {
namespace {

const KindConfig* config_of(const Scenario& scenario, std::string_view kind) noexcept {
  const auto found = std::find_if(scenario.kinds.begin(), scenario.kinds.end(),
                                  [&](const KindConfig& config) { return config.kind->name == kind; });
  return found == scenario.kinds.end() ? nullptr : &*found;
}

}  // namespace

const hal::RobotKind* find_kind(const Scenario& scenario, const hal::Catalog& catalog, std::string_view name) noexcept {
  const KindConfig* const config = config_of(scenario, name);
  return config != nullptr ? config->kind.get() : catalog.find<hal::RobotKind>(name);
}

std::vector<std::string> kind_names(const Scenario& scenario, const hal::Catalog& catalog) {
  std::vector<std::string> names = catalog.names(hal::RobotKind::kCategory);
  for (const KindConfig& config : scenario.kinds) names.push_back(config.kind->name);
  return names;
}

hal::Catalog with_kinds(const hal::Catalog& catalog, const std::vector<KindConfig>& kinds) {
  hal::Catalog with = catalog;
  for (const KindConfig& config : kinds) {
    const hal::Status added = with.add_from(config.file + ":" + std::to_string(config.line),
                                            [&](hal::Registrar& registrar) { registrar.add(*config.kind); });
    TANDEM_CHECK(added.ok(), added.error().message.c_str());  // the reader of files has judged it
  }
  return with;
}

std::string bridged_as(const Scenario& scenario, const std::string& kind) {
  const KindConfig* const config = config_of(scenario, kind);
  return config == nullptr || config->bridge.empty() ? kind : config->bridge;
}

hal::Result<std::uint8_t> medium_number(const std::vector<MediumConfig>& media, std::string_view kind,
                                        const std::string& id) {
  if (id.empty()) return std::uint8_t{0};
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < media.size(); ++i) {
    if (media[i].kind != kind) continue;
    if (media[i].id == id) return static_cast<std::uint8_t>(i + 1);
    ids.push_back(media[i].id);
  }
  return hal::Error{"<media> has no <" + std::string(kind) + "> with id '" + id + "'; it has: " + listed(ids) +
                    did_you_mean(id, ids)};
}

std::vector<hal::ListedDevice> listed_devices(const ControllerConfig& config, const hal::Catalog& catalog, bool real) {
  std::vector<hal::ListedDevice> all;
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    for (const DeviceChoice& choice : role == hal::Role::Sensor ? config.sensors : config.actuators) {
      const auto* const port = catalog.find<hal::PortType>(hal::port_entry(choice.device, role));
      if (port == nullptr || (real && choice.grown)) continue;
      const bool instead = choice.grown && !all.empty() && all.back().port->name == port->grows;
      if (instead)
        all.back().port = port;
      else
        all.push_back({port, choice.options.name});
    }
  }
  return all;
}

}  // namespace tandem::core
