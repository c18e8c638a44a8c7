// `--set path=value`: changes an experiment before it is read.
#pragma once
#include <string>
#include <vector>

#include "core/scenario/element.hpp"

namespace tandem::core {

/// Sets one attribute, e.g. "arena.distribute[0].entity.quantity=1000" or "controllers.epuck_diffusion[ed].params.velocity=3".
/// The root's name is left out; a name that occurs several times takes "[n]" (from 0) or "[id]"; the last part is the
/// attribute. A missing element is added, so that the schema then judges it. Problems name the part that is not there.
void apply_override(Element& root, const std::string& assignment, Problems& problems);

}  // namespace tandem::core
