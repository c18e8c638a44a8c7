// Files as the commands read them: every problem is printed.
#include <algorithm>
#include <fmt/format.h>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/terminal.hpp"
#include "core/config/reader.hpp"
#include "core/config/xml.hpp"
#include "mixed_reality/settings/bridge_check.hpp"
#include "mixed_reality/settings/map_file.hpp"

namespace tandem::app {

void print_problems(const core::Problems& problems) {
  for (const core::Problem& problem : problems) say(core::to_text(problem));
}

std::optional<core::Scenario> read_or_complain(const std::string& path, const std::vector<std::string>& overrides) {
  core::Problems problems;
  auto scenario = core::read_experiment(path, overrides, catalog(), problems);
  if (scenario) mixed_reality::check_bridges(*scenario, problems);
  print_problems(problems);
  if (core::has_errors(problems)) return std::nullopt;
  return scenario;
}

std::int64_t steps_of(std::optional<std::int64_t> steps, std::optional<double> seconds,
                      const core::Scenario& scenario) {
  if (steps) return *steps;
  const double length_s = seconds.value_or(scenario.length_s);
  const auto wanted = static_cast<std::int64_t>(length_s * static_cast<double>(scenario.ticks_per_second) + 0.5);
  return length_s > 0.0 ? std::max<std::int64_t>(1, wanted) : 0;  // a duration below a tick is one tick, not endless
}

bool is_map(const std::string& path) {
  core::Problems ignored;
  const auto root = core::read_xml_file(path, ignored);
  return root && root->name == "footbot_map";
}

int check_map(const std::string& path) {
  core::Problems problems;
  const auto map = mixed_reality::read_footbot_map(path, problems);
  print_problems(problems);
  if (!map) return kBadInput;
  std::size_t variables = 0;
  for (const auto& node : map->nodes) variables += node.variables.size();
  fmt::print("{}: good: {} nodes, {} variables\n", path, map->nodes.size(), variables);
  return kDone;
}

}  // namespace tandem::app
