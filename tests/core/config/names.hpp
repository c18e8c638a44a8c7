// A catalog of names, for tests of the reader: it knows no engine, only what they are called.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "bridges/epuck/register.hpp"
#include "bridges/eyebot/register.hpp"
#include "bridges/footbot/register.hpp"
#include "bridges/thymio/register.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/scenario/field_type.hpp"
#include "core/scenario/medium_type.hpp"
#include "hal/catalog.hpp"
#include "hal/check.hpp"
#include "hal/device/ports.hpp"
#include "hal/port.hpp"
#include "hal/robot/robots.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// Every port and every robot of the control interface, the bridges to those, and these engines.
inline hal::Catalog catalog_with(const std::vector<std::string_view>& engines) {
  static constexpr KnownEngine kAll[] = {{"kinematics2d", "", {}},
                                         {"dynamics2d", "", {.forces = true}},
                                         {"dynamics3d", "", {.plane = false, .forces = true}},
                                         {"particle3d", "pointmass3d", {.plane = false, .air = true}}};
  static constexpr auto kNothing = [](hal::ParamVisitor&) {};
  static constexpr MediumType kMedia[] = {{"range_and_bearing", "Messages.", kNothing}, {"led", "Light.", kNothing}};
  static constexpr auto kFloor = [](hal::ParamVisitor& v) {
    std::string id, source = "none", path;
    double pixels = 100.0;
    v.text("id", id, "Name.");
    v.text("source", source, "Where it comes from.");
    v.text("path", path, "A picture.");
    v.number("pixels_per_meter", pixels, hal::unit::none, hal::kNotNegative, "Resolution.");
  };
  static constexpr FieldType kFields[] = {{"floor", "Its shade.", kFloor}, {"light", "Has no element.", nullptr}};
  hal::Catalog catalog;
  const hal::Status good = catalog.add_from("tests", [&](hal::Registrar& r) {
    hal::register_ports(r);
    hal::register_robots(r);
    for (const MediumType& medium : kMedia) r.add(medium);
    for (const FieldType& field : kFields) r.add(field);
    bridges::epuck::register_bridge(r);
    bridges::footbot::register_bridge(r);
    bridges::eyebot::register_bridge(r);
    bridges::thymio::register_bridge(r);
    for (const KnownEngine& engine : kAll) {
      for (const std::string_view wanted : engines) {
        if (wanted == engine.kind) r.add(engine);
      }
    }
  });
  TANDEM_CHECK(good.ok(), good.error().message.c_str());
  return catalog;
}

inline const hal::Catalog& known_names() {
  static const hal::Catalog names = catalog_with({"kinematics2d", "dynamics2d", "dynamics3d", "particle3d"});
  return names;
}

}  // namespace tandem::core
