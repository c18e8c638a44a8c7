#include "core/config/fitted.hpp"

#include <algorithm>

#include "core/config/reader.hpp"
#include "core/config/reading.hpp"
#include "core/config/upgrade.hpp"
#include "hal/device/fitted.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::core {
namespace {

constexpr std::string_view kFitted = schema::Fitted::kElement.name;

bool fitted_part(std::string_view name) {
  return name == hal::FittedWheels::kName || name == hal::FittedProximity::kName;
}

void set_reality(hal::AnyPart& part, std::int64_t reality) {
  const auto set = [&](auto* of) {
    if (of != nullptr) of->reality = reality;
  };
  using hal::FittedProximity;
  using hal::FittedWheels;
  set(static_cast<FittedWheels*>(part.as(FittedWheels::kName, hal::part_layout<FittedWheels>())));
  set(static_cast<FittedProximity*>(part.as(FittedProximity::kName, hal::part_layout<FittedProximity>())));
}

/// The parts of one <model>; the element then shows every value.
std::vector<hal::AnyPart> read_parts_of(Reading& reading, Element& model, Problems& problems, std::int64_t reality) {
  std::vector<hal::AnyPart> parts;
  for (Element& e : model.children) {
    const auto* const type = fitted_part(e.name) ? reading.catalog().find<hal::PartType>(e.name) : nullptr;
    if (type == nullptr) {
      reading.error(
          e, cannot_hold(model, e, {std::string(hal::FittedWheels::kName), std::string(hal::FittedProximity::kName)}));
      continue;
    }
    hal::AnyPart part = type->make();
    ElementReader reader(e, problems);
    part.describe(reader);
    reader.finish();
    ElementWriter writer(e);
    part.describe(writer);
    set_reality(part, reality);
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

void include_fitted(Element& root, Problems& problems) {
  const auto found =
      std::find_if(root.children.begin(), root.children.end(), [](const Element& e) { return e.name == kFitted; });
  if (found == root.children.end()) return;
  const std::string* const file = found->attribute("file");
  if (file == nullptr || file->empty()) return;
  // A file that the command line names takes the place of what the experiment says.
  const bool replaces = std::any_of(found->attributes.begin(), found->attributes.end(),
                                    [](const Element::Attribute& a) { return a.name == "file" && !a.origin.empty(); });
  if (replaces) found->children.clear();
  if (!found->children.empty()) {
    problems.push_back(problem_at(*found, "file", "the element names a file, and holds models, too; leave one out"));
    return;
  }
  Problems inside;
  auto named = hal::read_xml_file(hal::path_beside(*file, root.file), inside);
  for (Problem& problem : inside) {
    if (problem.line == 0) problem = problem_at(*found, "file", "'" + *file + "': " + problem.message);
  }
  problems.insert(problems.end(), inside.begin(), inside.end());
  if (!named) return;
  if (named->name != kFitted) {
    problems.push_back(problem_at(
        *named, "the root element is <" + named->name + ">; a file of fitted parameters starts with <fitted>"));
    return;
  }
  schema::Fitted attributes;
  ElementReader reader(*named, problems);
  attributes.describe(reader);
  reader.finish_attributes();
  if (!attributes.file.empty())
    problems.push_back(problem_at(*named, "file", "a file of fitted parameters names no other"));
  if (const std::string why = version_problem(attributes.version); !why.empty())
    problems.push_back(problem_at(*named, "version", why));
  found->children = std::move(named->children);
  std::erase_if(found->attributes, [](const Element::Attribute& a) { return a.name == "file"; });
}

void read_fitted(Reading& reading, Element& fitted) {
  const auto attributes = reading.read<schema::Fitted>(fitted);
  Problems problems;
  for (Element& e : fitted.children) {
    if (e.name != schema::FittedModel::kElement.name) continue;
    const std::string kind = reading.read_open<schema::FittedModel>(e).kind;
    const auto* const known = reading.catalog().find<hal::RobotKind>(kind);
    if (known == nullptr && !kind.empty()) {
      reading.error(e, "kind",
                    "there is no robot '" + kind + "'; there are: " + listed(reading.known().robots) +
                        did_you_mean(kind, reading.known().robots));
    }
    if (reading.fitted(kind) != nullptr) reading.error(e, "kind", "a second model of '" + kind + "'; leave one out");
    std::vector<hal::AnyPart> parts = read_parts_of(reading, e, problems, attributes.reality);
    if (known != nullptr) reading.add_fitted(kind, std::move(parts));
  }
  reading.add_problems(std::move(problems));
}

std::string fitted_file(std::vector<FittedKind> kinds) {
  Element root;
  root.name = kFitted;
  root.attributes = {{"version", std::to_string(kFileVersion), 0}};
  for (FittedKind& kind : kinds) {
    Element& model = root.children.emplace_back();
    model.name = schema::FittedModel::kElement.name;
    model.attributes = {{"kind", kind.kind, 0}};
    for (hal::AnyPart& part : kind.parts) {
      Element& e = model.children.emplace_back();
      e.name = part.name();
      ElementWriter writer(e);
      part.describe(writer);
    }
  }
  return hal::to_xml(root);
}

}  // namespace tandem::core
