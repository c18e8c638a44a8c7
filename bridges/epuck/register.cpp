#include "bridges/epuck/register.hpp"

#include "bridges/bridge_type.hpp"
#include "bridges/epuck/bridge.hpp"
#include "bridges/epuck/stopper.hpp"
#include "hal/element_options.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/epuck2.hpp"

namespace tandem::bridges::epuck {
namespace {

struct Options {
  std::string firmware = "auto";
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 5> kFirmware = {"auto", "btcom", "gctronic", "webots", "epuck2"};
    v.choice("firmware", firmware, kFirmware, "Which firmware it runs; auto asks it.");
  }
};

struct Epuck2Options : Options {};  // an element's options have a type of their own

hal::Result<EpuckLink> link_for(const BridgeRequest& request) {
  return epuck_link(request.link, {request.permit});
}

MadeBridge make(const BridgeRequest& request, const hal::Log& log) {
  auto link = link_for(request);
  if (!link.ok()) return link.error();
  BridgeSettings settings;
  apply(request, settings);
  settings.link = request.link;
  settings.firmware = options_of<Options>(request).firmware;
  settings.driver.timing = timing_for(request.link);
  settings.driver.wire = link.value().wire;
  return std::unique_ptr<RobotBridge>(
      std::make_unique<EpuckBridge>(std::move(settings), std::move(link).value().open, log));
}

const BridgeType kType{.name = hal::epuck::kName, .summary = kLinks, .make = &make, .check = &check_by<link_for>};
const BridgeType kType2{.name = hal::epuck2::kName, .summary = kLinks, .make = &make, .check = &check_by<link_for>};

}  // namespace

void register_bridge(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<Options>("bridge of " + std::string(kType.name)));
  registrar.add(kType2);
  registrar.add(hal::element_options<Epuck2Options>("bridge of " + std::string(kType2.name)));
  registrar.add(stopper_type());
  registrar.add(inspector_type());
}

}  // namespace tandem::bridges::epuck
