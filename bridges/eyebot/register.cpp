#include "bridges/eyebot/register.hpp"

#include "bridges/eyebot/stopper.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/element_options.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {
namespace {

struct Options {
  std::string name, at_end = "land";
  std::array<double, 3> origin_m{};
  double turn_rad = 0.0;
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kEnds = {"land", "hover"};
    v.text("name", name, "What it is called in its LCM channels; empty: its id.");
    v.choice("at_end", at_end, kEnds, "What it does when its run ends.");
    v.vector("origin", origin_m, hal::unit::m, "Where the origin of its own world lies in the arena.");
    v.number("turn", turn_rad, hal::unit::deg, {},
             "How far its world is turned against the arena's, counter-clockwise.");
  }
};

std::string name_of(const BridgeRequest& request) {
  const std::string name = options_of<Options>(request).name;
  return name.empty() ? request.robot : name;
}

MadeBridge make(const BridgeRequest& request, const hal::Log& log) {
  auto settings = settings_for(request);
  if (!settings.ok()) return settings.error();
  const auto opener = [url = settings->url] { return lcm_bus::LcmLink::open(url); };
  return std::unique_ptr<RobotBridge>(std::make_unique<EyebotBridge>(std::move(settings).value(), opener, log));
}

/// Several share a link.
std::string reached_by(const BridgeRequest& request) {
  return absolute_link(request.link) + " as '" + name_of(request) + "'";
}

const BridgeType kType{.name = hal::eyebot::kName,
                       .summary = "lcm:URL",
                       .make = &make,
                       .check = &check_by<settings_for>,
                       .reached_by = &reached_by};

}  // namespace

hal::Result<BridgeSettings> settings_for(const BridgeRequest& request) {
  const auto address = parse_link(request.link);
  if (!address.ok()) return address.error();
  if (address.value().scheme != LinkScheme::Lcm)
    return hal::Error{"link '" + request.link +
                      "' does not carry an eye-bot's messages; write lcm:" + std::string(lcm_bus::kDefaultLcmUrl)};
  BridgeSettings settings;
  apply(request, settings);
  settings.url = address.value().target;
  settings.permit = request.permit;
  DriverSettings& driver = settings.driver;
  driver.session = 0;  // to be drawn
  driver.name = name_of(request);
  if (!is_robot_name(driver.name))
    return hal::Error{"'" + driver.name +
                      "' cannot be part of a channel; an eye-bot's name has 1 to 24 letters, digits, '_' and '-'"};
  if (request.unix_clock != nullptr) driver.unix_clock = request.unix_clock;
  const auto options = options_of<Options>(request);
  driver.world = {options.origin_m, options.turn_rad};
  settings.shutdown.land = options.at_end == "land";
  return settings;
}

void register_bridge(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<Options>("bridge of " + std::string(kType.name)));
  registrar.add(stopper_type());
  registrar.add(inspector_type());
}

}  // namespace tandem::bridges::eyebot
