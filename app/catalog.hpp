// Contents of this program: the catalog. There are two such pages, catalog.cpp for the whole program and
// board_catalog.cpp for the one on a robot's board; a build has one of them.
#pragma once
#include "hal/catalog.hpp"

namespace tandem::app {

/// Everything that comes with this program.
const hal::Catalog& catalog();

}  // namespace tandem::app
