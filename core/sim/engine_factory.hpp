// Makes the physics engines of a scenario and their regions.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/physics/engine.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// Why bodies in the region cannot be held together by these kinds of joints, and what to do; empty: they can.
std::string lacks_joints(const hal::Catalog& catalog, const Region& region, JointKinds needed);

/// Why engines of a kind cannot move an object of this size and mass; empty: they can.
std::string unfit_for(const hal::Catalog& catalog, std::string_view kind, const Object& object);

/// One engine a kind of `catalog`. Fills `stores.regions`; the arena and `robots`, their number, must be known.
/// Problems (overlapping regions, parameters) are appended with their lines.
std::vector<std::unique_ptr<Engine>> make_engines(const Scenario& scenario, const hal::Catalog& catalog,
                                                  std::size_t robots, SpaceStores& stores, Problems& problems);

}  // namespace tandem::core
