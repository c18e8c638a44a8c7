// The catalog of the program for a robot's board: bridges and controllers, nothing simulated.
#include "app/catalog.hpp"
#include "bridges/epuck/register.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/thymio/register.hpp"
#include "hal/check.hpp"
#include "hal/command.hpp"
#include "hal/device/ports.hpp"
#include "hal/robot/robots.hpp"

namespace tandem::app {

const hal::Catalog& catalog() {
  static const hal::Catalog all = [] {
    hal::Catalog made;
    made.know<hal::CommandType>();
    const hal::Status good = made.add_from(std::string(hal::Catalog::kInside), [](hal::Registrar& r) {
      hal::register_ports(r);
      hal::register_robots(r);
      bridges::epuck::register_bridge(r);
      bridges::footbot::register_bridge(r);
      bridges::eyebot::register_bridge(r);
      bridges::thymio::register_bridge(r);
    });
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

}  // namespace tandem::app
