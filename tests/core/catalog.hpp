// The catalog of everything simulated, for tests that make worlds without the program.
#pragma once
#include <string>
#include <vector>

#include "core/device/device.hpp"
#include "core/field/floor/floor.hpp"
#include "core/field/light/light.hpp"
#include "core/field/sound/sound.hpp"
#include "core/hook/hook.hpp"
#include "core/medium/led/led.hpp"
#include "core/medium/medium.hpp"
#include "core/medium/range_and_bearing/range_and_bearing.hpp"
#include "core/physics/dynamics2d/dynamics2d.hpp"
#include "core/physics/dynamics3d/dynamics3d.hpp"
#include "core/physics/kinematics2d/kinematics2d.hpp"
#include "core/physics/particle3d/particle3d.hpp"
#include "hal/catalog.hpp"
#include "hal/check.hpp"
#include "hal/device/ports.hpp"
#include "hal/robot/robots.hpp"

namespace tandem::test {

inline const hal::Catalog& catalog() {
  static const hal::Catalog all = [] {
    hal::Catalog made;
    made.know<core::HookType>();
    const hal::Status good = made.add_from("tests", [](hal::Registrar& r) {
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
      core::register_dynamics2d(r);
      core::register_dynamics3d(r);
      core::register_particle3d(r);
    });
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
    return made;
  }();
  return all;
}

inline std::vector<std::string> engine_kinds() {
  return catalog().names(core::EngineType::kCategory);
}
inline const core::EngineType& engine_type(const std::string& kind) {
  const auto* type = catalog().find<core::EngineType>(kind);
  TANDEM_CHECK(type != nullptr, "a test names an engine that there is");
  return *type;
}

inline const core::EngineTraits& engine_traits(const std::string& kind) {
  return engine_type(kind).traits;
}

}  // namespace tandem::test
