// `--set path=value`: changes an experiment before it is read.
#pragma once
#include <string>

#include "core/scenario/element.hpp"

namespace tandem::core {

/// Sets one attribute, e.g. "arena.distribute[0].entity.quantity=1000" or
/// "controllers.diffusion[d].params.velocity=3". The root's name is left out; of several elements of one name,
/// "[n]" (from 0) or "[id]" chooses, and "[*]" means each; the last part is the attribute, there already or not: the
/// schema judges it afterwards, under the name of this override. An element that may be left out and stands once
/// (system, time, params, …) is added. Other paths that lead nowhere are problems that name the part and what there is.
void apply_override(Element& root, const std::string& assignment, Problems& problems);

}  // namespace tandem::core
