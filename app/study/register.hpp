// Entries of the module `study`.
#pragma once
#include "app/command/check.hpp"
#include "hal/catalog.hpp"

namespace tandem::app {

extern const CheckedFile study_file;

void register_study(hal::Registrar& registrar);

}  // namespace tandem::app
