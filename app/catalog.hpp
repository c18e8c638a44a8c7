// What this program contains. There are two such pages, catalog.cpp for the whole program and board_catalog.cpp for the
// one on a robot's board; a build has one of them.
#pragma once
#include "app/plugin_folders.hpp"
#include "core/config/reader.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

/// Names that experiment files may use.
const core::KnownNames& known_names();

}  // namespace tandem::app
