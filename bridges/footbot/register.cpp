#include "bridges/footbot/register.hpp"

#include "bridges/aseba/node_bridge.hpp"
#include "bridges/aseba/node_stopper.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "hal/element.hpp"
#include "hal/element_options.hpp"
#include "hal/file_type.hpp"
#include "hal/robot/footbot.hpp"

namespace tandem::bridges::footbot {
namespace {

struct Options {
  std::string map;
  void describe(hal::ParamVisitor& v) {
    v.text("map", map, "File that says which variable of its modules is which reading or command.");
  }
};

std::string map_of(const BridgeRequest& request) {
  return hal::path_beside(options_of<Options>(request).map, request.file);
}

hal::Status add(const BridgeRequest& request, DriverSettings& driver) {
  const std::string path = map_of(request);
  if (path.empty()) {
    return hal::Error{"the <bridge> of the foot-bot '" + request.robot +
                      "' names no map of its variables; write map=\"footbot_map.xml\""};
  }
  auto map = footbot_map_for(request.robot, path);
  if (!map.ok()) return map.error();
  driver.map = std::move(map).value();
  return {};
}

using Maker = aseba::NodeBridgeMaker<FootbotParts>;

std::vector<InputFile> inputs(const BridgeRequest& request) {
  return {{"robot's map", map_of(request)}};
}

const BridgeType kType{.name = hal::footbot::kName,
                       .summary = "can:INTERFACE, slcan:DEVICE@RATE, serial:DEVICE@921600, tcp:HOST:PORT",
                       .make = &Maker::make<add>,
                       .check = &check_by<Maker::prepare<add>>,
                       .inputs = &inputs};

std::string check_map(const std::string& path, hal::Problems& problems) {
  const auto map = read_footbot_map(path, problems);
  if (!map) return {};
  std::size_t variables = 0;
  for (const NodeMap& node : map->nodes) variables += node.variables.size();
  return std::to_string(map->nodes.size()) + " nodes, " + std::to_string(variables) + " variables";
}

constexpr guardian::StopperType kStopper{hal::footbot::kName, &aseba::make_node_stopper};

constexpr hal::FileType kMapType{"footbot_map", &check_map};

}  // namespace

void register_bridge(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<Options>("bridge of " + std::string(kType.name)));
  registrar.add(kStopper);
  registrar.add(inspector_type());
  registrar.add(kMapType);
}

}  // namespace tandem::bridges::footbot
