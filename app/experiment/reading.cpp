// Files as the commands read them: every problem is printed.
#include "app/experiment/reading.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/exit_code.hpp"
#include "app/process/terminal.hpp"
#include "core/config/kinds.hpp"
#include "hal/file_type.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::app {

void print_problems(const core::Problems& problems) {
  for (const core::Problem& problem : problems) say(core::to_text(problem));
}

std::int64_t steps_of(std::optional<std::int64_t> steps, std::optional<double> seconds,
                      const core::Scenario& scenario) {
  if (steps) return *steps;
  const double length_s = seconds.value_or(scenario.length_s);
  const auto wanted = static_cast<std::int64_t>(length_s * static_cast<double>(scenario.ticks_per_second) + 0.5);
  return length_s > 0.0 ? std::max<std::int64_t>(1, wanted) : 0;  // a duration below a tick is one tick, not endless
}

namespace {

int check_kinds(const std::string& path, const hal::Catalog& catalog) {
  core::Problems problems;
  const auto kinds = core::read_kinds_file(path, catalog, problems);
  print_problems(problems);
  if (!kinds) return kBadInput;
  std::string names;
  for (const core::KindConfig& config : *kinds) names += (names.empty() ? ": " : ", ") + config.kind->name;
  fmt::print("{}: good: {} {} of robots{}\n", path, kinds->size(), kinds->size() == 1 ? "kind" : "kinds", names);
  return kDone;
}

}  // namespace

std::optional<int> check_other_file(const std::string& path, const hal::Catalog& catalog) {
  core::Problems problems;
  const auto root = hal::read_xml_file(path, problems);
  if (root && root->name == "kinds") return check_kinds(path, catalog);
  const auto* const type = root ? catalog.find<hal::FileType>(root->name) : nullptr;
  if (type == nullptr) return std::nullopt;
  problems.clear();
  const std::string content = type->check(path, problems);
  print_problems(problems);
  if (content.empty()) return kBadInput;
  fmt::print("{}: good: {}\n", path, content);
  return kDone;
}

bool has_real_robots(const core::Scenario& scenario) {
  for (const core::RobotItem& item : scenario.robots) {
    if (item.bridge) return true;
  }
  return false;
}

hal::Status leave_out(core::Scenario& scenario, const std::vector<std::string>& ids) {
  for (const std::string& id : ids) {
    std::string real;
    bool found = false;
    for (core::RobotItem& item : scenario.robots) {
      if (!item.bridge && !item.peer) continue;
      real += (real.empty() ? "" : ", ") + item.id;
      if (item.id != id) continue;
      item.bridge.reset();
      item.peer.reset();
      found = true;
    }
    if (!found)
      return hal::Error{"--without " + id +
                        ": there is no real robot of this name; there are: " + (real.empty() ? "none" : real)};
  }
  return {};
}

}  // namespace tandem::app
