// The catalog of the program for a robot's board: nothing simulated.
#include "app/catalog.hpp"
#include "app/module/modules.hpp"
#include "hal/check.hpp"
#include "hal/command.hpp"
#include "hal/device/ports.hpp"
#include "hal/robot/robots.hpp"

namespace tandem::app {

namespace {

hal::Catalog own_entries() {
  hal::Catalog made;
  made.know<hal::CommandType>();
  const hal::Status good = made.add_from(std::string(hal::Catalog::kInside), [](hal::Registrar& r) {
    hal::register_ports(r);
    hal::register_robots(r);
  });
  TANDEM_CHECK(good.ok(), good.error().message.c_str());
  return made;
}

}  // namespace

const hal::Catalog& catalog() {
  static hal::Catalog all = own_entries();
  add_loaded_modules(all);
  return all;
}

}  // namespace tandem::app
