#include "bridges/thymio/register.hpp"

#include "bridges/aseba/node_bridge.hpp"
#include "bridges/aseba/node_stopper.hpp"
#include "bridges/link/link_text.hpp"
#include "bridges/thymio/driver.hpp"
#include "hal/element_options.hpp"

namespace tandem::bridges::thymio {
namespace {

struct Options {
  std::int64_t node = 0;
  double full_speed_m_s = 0.2;
  double white = Calibration{}.white;
  void describe(hal::ParamVisitor& v) {
    v.integer("node", node, {0, 255}, "Its number where several Thymios are on one link; 0: the only one.");
    v.number("full_speed", full_speed_m_s, hal::unit::cm_s, {0.01, 1.0},
             "How fast this robot drives with the motors' target 500: measure it.");
    v.number("ground_white", white, hal::unit::none, {1.0, 1023.0}, "What its ground sensors say of white ground.");
  }
};

hal::Status add(const BridgeRequest& request, DriverSettings& driver) {
  const auto options = options_of<Options>(request);
  driver.calibration = {
      .node = static_cast<std::uint8_t>(options.node), .full_m_s = options.full_speed_m_s, .white = options.white};
  return {};
}

using Maker = aseba::NodeBridgeMaker<ThymioParts>;

/// Several may share a switch, under numbers of their own.
std::string reached_by(const BridgeRequest& request) {
  return absolute_link(request.link) + " node " + std::to_string(options_of<Options>(request).node);
}

const BridgeType kType{.name = hal::thymio::kName,
                       .summary = "tcp:HOST:PORT (asebaswitch), serial:DEVICE@115200",
                       .make = &Maker::make<add>,
                       .check = &check_by<Maker::prepare<add>>,
                       .reached_by = &reached_by};

constexpr guardian::StopperType kStopper{hal::thymio::kName, &aseba::make_node_stopper};

}  // namespace

void register_bridge(hal::Registrar& registrar) {
  registrar.add(kType);
  registrar.add(hal::element_options<Options>("bridge of " + std::string(kType.name)));
  registrar.add(kStopper);
}

}  // namespace tandem::bridges::thymio
