// Adds the tracker `apriltag` to the catalog.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::bridges::tag_tracker {

void register_tracker(hal::Registrar& registrar);

}  // namespace tandem::bridges::tag_tracker
