// Which kinds of physics engine there are, and how those of a scenario and their regions are made.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/physics/engine.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// Their names in experiment files.
std::vector<std::string> engine_kinds();

/// What a kind can do, for tests and messages.
struct EngineTraits {
  std::string_view summary;
  bool plane = true;    ///< bodies stay on the ground
  bool forces = false;  ///< knows masses: movable objects, pushing, joints
};
EngineTraits engine_traits(std::string_view kind);

/// Shows the parameters of a kind to `visitor`, for the manual.
void describe_engine(std::string_view kind, hal::ParamVisitor& visitor);

/// Why engines of a kind cannot move an object of this size and mass; empty: they can.
std::string unfit_for(std::string_view kind, const Object& object);

/// One engine a kind. Fills `stores.regions`; the arena and `robots`, their number, must be known. Problems
/// (overlapping regions, parameters) are appended with their lines.
std::vector<std::unique_ptr<Engine>> make_engines(const Scenario& scenario, std::size_t robots, SpaceStores& stores,
                                                  Problems& problems);

}  // namespace tandem::core
