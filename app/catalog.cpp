#include "app/catalog.hpp"

#include "app/module/modules.hpp"
#include "core/device/device.hpp"
#include "core/field/floor/floor.hpp"
#include "core/field/light/light.hpp"
#include "core/field/sound/sound.hpp"
#include "core/hook/hook.hpp"
#include "core/medium/led/led.hpp"
#include "core/medium/medium.hpp"
#include "core/medium/range_and_bearing/range_and_bearing.hpp"
#include "core/physics/kinematics2d/kinematics2d.hpp"
#include "core/run/run.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/scenario/observer_type.hpp"
#include "core/scenario/run_part_type.hpp"
#include "core/space/stores.hpp"
#include "hal/check.hpp"
#include "hal/command.hpp"
#include "hal/device/ports.hpp"
#include "hal/robot/robots.hpp"

namespace tandem::app {

namespace {

hal::Catalog own_entries() {
  hal::Catalog made;
  made.know<hal::CommandType>();
  made.know<core::HookType>();
  made.know<core::ObserverType>();
  made.know<core::RunPartType>();
  made.know<core::RunSurface>();
  made.know<core::StoresSurface>();
  const hal::Status good = made.add_from(std::string(hal::Catalog::kInside), [](hal::Registrar& r) {
    hal::register_ports(r);
    hal::register_robots(r);
    core::register_floor(r);
    core::register_light(r);
    core::register_sound(r);
    core::register_led_medium(r);
    core::register_range_and_bearing_medium(r);
    core::register_unused_media(r);
    core::register_devices(r);
    core::register_kinematics2d(r);
  });
  TANDEM_CHECK(good.ok(), good.error().message.c_str());
  for (const std::string_view engine : module_table::kDynamicsEngines)
    made.know_elsewhere(core::KnownEngine::kCategory, engine);
  return made;
}

}  // namespace

const hal::Catalog& catalog() {
  static hal::Catalog all = own_entries();
  add_loaded_modules(all);
  return all;
}

}  // namespace tandem::app
