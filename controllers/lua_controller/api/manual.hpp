// Names that scripts in Lua have, for people and for tests.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "hal/catalog.hpp"
#include "hal/port.hpp"

namespace tandem::controllers::lua {

/// A name that scripts use, and the port that it comes from; without one it is always there.
struct ApiName {
  std::string_view port;  ///< empty: always there
  hal::Role role = hal::Role::Sensor;
  std::string_view name;       ///< "robot.wheels.set_velocity"
  std::string_view arguments;  ///< "(left, right)"; empty: a value
  std::string_view doc;
};

std::span<const ApiName> api_names();

/// The manual: the names, then every port of the catalog by its fields.
std::string manual(const hal::Catalog& catalog);

}  // namespace tandem::controllers::lua
