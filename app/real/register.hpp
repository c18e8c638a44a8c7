// Entries of the module `real`.
#pragma once
#include <string>
#include <vector>

#include "app/experiment/real_side_type.hpp"

namespace tandem::app {

void register_real(hal::Registrar& registrar);

// Of the functions above.
void register_real_side(hal::Registrar& registrar);
void check_real(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems);
std::vector<std::string> outlooks_of_trackers(const core::Scenario& scenario, const hal::Catalog& catalog);
std::vector<RealSideType::Input> inputs_of_bridges(const core::Scenario& scenario, const hal::Catalog& catalog);

}  // namespace tandem::app
