// Which kinds of physics engine there are, and how those of a scenario and their regions are made.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/physics/engine.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// All kinds; the first is that of files without engines.
const std::vector<KnownEngine>& known_engines();
std::vector<std::string> engine_kinds();  ///< their names
EngineTraits engine_traits(std::string_view kind);
std::string_view engine_summary(std::string_view kind);

/// Names of those kinds that fit, for messages.
std::string engines_that(const std::function<bool(const EngineTraits&)>& fit);
/// Why bodies in the region cannot be held together by these kinds of joints, and what to do; empty: they can.
std::string lacks_joints(const Region& region, JointKinds needed);

/// Shows the parameters of a kind to `visitor`, for the manual.
void describe_engine(std::string_view kind, hal::ParamVisitor& visitor);

/// Why engines of a kind cannot move an object of this size and mass; empty: they can.
std::string unfit_for(std::string_view kind, const Object& object);

/// One engine a kind. Fills `stores.regions`; the arena and `robots`, their number, must be known. Problems
/// (overlapping regions, parameters) are appended with their lines.
std::vector<std::unique_ptr<Engine>> make_engines(const Scenario& scenario, std::size_t robots, SpaceStores& stores,
                                                  Problems& problems);

}  // namespace tandem::core
