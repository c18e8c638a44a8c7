#include "bridges/epuck/register.hpp"

#include "bridges/bridge_type.hpp"
#include "bridges/epuck/bridge.hpp"
#include "bridges/epuck/inspect.hpp"
#include "bridges/epuck/stopper.hpp"
#include "hal/element_options.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

struct Options {
  std::string firmware = "auto";
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 5> kFirmware = {"auto", "btcom", "gctronic", "webots", "epuck2"};
    v.choice("firmware", firmware, kFirmware, "Which firmware it runs; auto asks it.");
  }
};

hal::Result<LinkOpener> opener_for(const BridgeRequest& request) {
  const auto address = parse_link(request.link);
  if (!address.ok()) return address.error();
  return epuck_link_opener(address.value(), {request.permit});
}

hal::Status check(const BridgeRequest& request) {
  const auto opener = opener_for(request);
  return opener.ok() ? hal::Status{} : hal::Status{opener.error()};
}

MadeBridge make(const BridgeRequest& request, const hal::Log& log) {
  auto opener = opener_for(request);
  if (!opener.ok()) return opener.error();
  BridgeSettings settings;
  apply(request, settings);
  settings.link = request.link;
  settings.firmware = options_of<Options>(request).firmware;
  settings.driver.timing = timing_for(request.link);
  return std::unique_ptr<RobotBridge>(
      std::make_unique<EpuckBridge>(std::move(settings), std::move(opener).value(), log));
}

const BridgeType kType{.name = hal::epuck::kName, .summary = "serial:DEVICE@115200", .make = &make, .check = &check};

}  // namespace

void register_bridge(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<Options>("bridge of " + std::string(kType.name)));
  registrar.add(stopper_type());
  registrar.add(inspector_type());
}

}  // namespace tandem::bridges::epuck
