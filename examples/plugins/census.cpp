// A command: counts the robots of an experiment file by kind, those that are distributed too.
#include <charconv>
#include <cstdio>
#include <map>
#include <string>

#include "hal/catalog.hpp"
#include "hal/command.hpp"
#include "hal/plugin.hpp"
#include "hal/robot_kind.hpp"
#include "hal/xml/xml.hpp"

namespace {

using namespace tandem;

struct Census {
  std::string experiment;
  std::string only;
  bool sum = false;

  void describe(hal::CommandLine& line) {
    line.word("experiment", experiment, "The experiment file (.xml)").required().file();
    line.option("--only", only, "Only robots of this kind").named_in("robot");
    line.flag("--sum", sum, "Only how many there are in all");
  }
};

using Counts = std::map<std::string, long>;

/// A robot has a controller; its element is its kind. What is here is there that many times.
void count(const hal::Element& element, long times, Counts& counts) {
  if (const std::string* quantity = element.attribute("quantity"); element.name == "entity" && quantity != nullptr) {
    long several = 0;
    std::from_chars(quantity->data(), quantity->data() + quantity->size(), several);
    times *= several;
  }
  if (element.child("controller") != nullptr) counts[element.name] += times;
  for (const hal::Element& child : element.children) count(child, times, counts);
}

hal::Result<int> run(const Census& census, const hal::CommandContext& context) {
  if (!census.only.empty() && context.catalog().find<hal::RobotKind>(census.only) == nullptr)
    std::fprintf(stderr, "warning: there is no kind '%s' but, perhaps, in the file\n", census.only.c_str());
  hal::Problems problems;
  const auto root = hal::read_xml_file(census.experiment, problems);
  for (const hal::Problem& problem : problems) std::fprintf(stderr, "%s\n", hal::to_text(problem).c_str());
  if (!root) return 1;
  const hal::Element* const arena = root->child("arena");
  if (arena == nullptr) return hal::Error{census.experiment + " has no <arena>"};
  Counts counts;
  count(*arena, 1, counts);
  long all = 0;
  for (const auto& [kind, robots] : counts) {
    if (!census.only.empty() && kind != census.only) continue;
    if (!census.sum) std::printf("%s: %ld\n", kind.c_str(), robots);
    all += robots;
  }
  std::printf("%ld in all\n", all);
  return 0;
}

void register_all(hal::Registrar& registrar) {
  static const hal::CommandType type =
      hal::command_type<Census, run>("census", "Count the robots of an experiment file by kind.");
  registrar.add(type);
}

}  // namespace

TANDEM_PLUGIN(register_all)
