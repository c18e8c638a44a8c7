// Worlds of the validation's own experiments, and what stands in them as solids for the ray caster.
#pragma once
#include <memory>
#include <string>

#include "core/space/space.hpp"
#include "hal/result.hpp"
#include "library/open_world.hpp"
#include "validate/ray_caster.hpp"

namespace tandem::validate {

/// The world of validate/experiments/NAME, started; `{wheels}` and the like in it are replaced. @throws
/// std::runtime_error with all problems when it cannot be made
std::unique_ptr<library::OpenWorld> open_experiment(
    const std::string& name, std::uint64_t seed, const std::vector<std::pair<std::string, std::string>>& replace = {},
    const std::vector<std::string>& parameters = {});

/// All objects, and robots' bodies: that of the i-th robot has the owner i + 1. `grown_m` is added on every
/// side.
Solids solids_of(const core::Space& space, double grown_m = 0.0);

}  // namespace tandem::validate
