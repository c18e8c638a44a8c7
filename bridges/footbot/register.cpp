#include "bridges/footbot/register.hpp"

#include "bridges/aseba/message_link_text.hpp"
#include "bridges/aseba/node_stopper.hpp"
#include "bridges/bridge_type.hpp"
#include "bridges/footbot/bridge.hpp"
#include "bridges/footbot/inspect.hpp"
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

struct Parts {
  BridgeSettings settings;
  aseba::MessageLinkOpener opener;
};

hal::Result<Parts> parts_for(const BridgeRequest& request) {
  auto opener = aseba::message_link_opener(request.link, {request.permit});
  if (!opener.ok()) return opener.error();
  const std::string path = map_of(request);
  if (path.empty()) {
    return hal::Error{"the <bridge> of the foot-bot '" + request.robot +
                      "' names no map of its variables; write map=\"footbot_map.xml\""};
  }
  hal::Problems problems;
  auto map = read_footbot_map(path, problems);
  if (!map) {
    std::string message = "the map of the foot-bot '" + request.robot + "' cannot be used";
    for (const hal::Problem& p : problems) message += "\n" + to_text(p);
    return hal::Error{message};
  }
  Parts parts;
  parts.opener = std::move(opener).value();
  parts.settings.link = request.link;
  parts.settings.driver.map = std::move(*map);
  apply(request, parts.settings);
  return parts;
}

hal::Status check(const BridgeRequest& request) {
  const auto parts = parts_for(request);
  return parts.ok() ? hal::Status{} : hal::Status{parts.error()};
}

MadeBridge make(const BridgeRequest& request, const hal::Log& log) {
  auto parts = parts_for(request);
  if (!parts.ok()) return parts.error();
  return std::unique_ptr<RobotBridge>(
      std::make_unique<FootbotBridge>(std::move(parts->settings), std::move(parts->opener), log));
}

std::vector<InputFile> inputs(const BridgeRequest& request) {
  return {{"robot's map", map_of(request)}};
}

const BridgeType kType{.name = hal::footbot::kName,
                       .summary = "can:INTERFACE, slcan:DEVICE@RATE, serial:DEVICE@921600, tcp:HOST:PORT",
                       .make = &make,
                       .check = &check,
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
