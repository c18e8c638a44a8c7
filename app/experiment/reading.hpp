// Reads an experiment file for the commands, before they begin.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Steps to do; 0: until interrupted or a hook ends the run.
std::int64_t steps_of(std::optional<std::int64_t> steps, std::optional<double> seconds, const core::Scenario& scenario);

bool has_real_robots(const core::Scenario& scenario);
/// Makes robots that are real in the file ordinary ones. Error: there is no such real robot.
hal::Status leave_out(core::Scenario& scenario, const std::vector<std::string>& ids);

void print_problems(const core::Problems& problems);

/// `check` for files of kinds of robots, and of the catalog's other types; nothing when it is none.
std::optional<int> check_other_file(const std::string& path, const hal::Catalog& catalog);

}  // namespace tandem::app
