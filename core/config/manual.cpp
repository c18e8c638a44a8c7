// The manual of experiment files, from their schema.
#include "core/config/manual.hpp"

#include "hal/element_options.hpp"

namespace tandem::core {
namespace {

std::string joined(const std::vector<std::string>& names, std::string_view between) {
  std::string text;
  for (const std::string& n : names) text += (text.empty() ? "" : std::string(between)) + n;
  return text;
}

template <class... T>
std::vector<ElementManual> manuals_of() {
  return {manual_of<T>()...};
}

std::vector<ElementManual> all_manuals() {
  using namespace schema;
  return manuals_of<Root, Plugins, Kinds, Kind, Fitted, FittedModel, Framework, System, Experiment, Profiling, Time,
                    Peers, Controllers, Configuration, Sensors, Actuators, Arena, FieldElement, Box, Cylinder, Leds,
                    Led, Light, Sound, Robot, Body, RobotController, Battery, Bridge, Tracker, Peer, Trackers,
                    TrackerElement, Desk, Spare, Safety, FenceElement, KeepOut, Zone, DistributeElement, PositionDraw,
                    OrientationDraw, Entity, Engines, Engine, Boundaries, Top, Bottom, Sides, Vertex, Media,
                    schema::Medium, Hook, Record, Trajectory, ObserverElement, schema::RunParts, schema::RunPartElement,
                    Visualization>();
}

/// What a kind says of its own element.
template <class Type>
void add_own(const Type& type, ElementManual& manual) {
  ManualWriter writer;
  type.describe(writer);
  manual.doc = type.summary;
  manual.attributes += writer.text();
  manual.children.clear();
}

/// What the parts of a kind of robot let its element say.
void add_attributes(hal::RobotKind kind, ElementManual& manual) {
  ManualWriter writer;
  kind.attributes(writer);
  manual.doc = kind.summary;
  manual.attributes += writer.text();
}

/// The attributes that a part of this name reads of its element.
std::string options_of(const std::string& name, const hal::Catalog& catalog) {
  ManualWriter writer;
  if (const auto* const options = catalog.find<hal::ElementOptions>(name)) (void)options->read(writer);
  return writer.text();
}

/// An element whose name stands for several kinds becomes one a kind.
std::vector<ElementManual> expanded(const ElementManual& m, const KnownNames& known) {
  std::vector<std::string> names{m.name};
  if (m.name == schema::Robot::kElement.name) names = known.robots;
  if (m.name == schema::Engine::kElement.name) names = known.engines;
  if (m.name == schema::Medium::kElement.name) names = known.media;
  if (m.name == schema::FieldElement::kElement.name) names = known.fields;
  if (m.name == schema::ObserverElement::kElement.name) names = known.observers;
  if (m.name == schema::RunPartElement::kElement.name) names = known.run_parts;
  if (m.name == schema::TrackerElement::kElement.name) names = known.trackers;
  std::vector<ElementManual> out;
  for (const std::string& name : names) {
    out.push_back(m);
    out.back().name = name;
    out.back().children = known.children_of(m.children);
    if (m.name == schema::Robot::kElement.name) add_attributes(*known.catalog.find<hal::RobotKind>(name), out.back());
    if (m.name == schema::Medium::kElement.name) add_own(*known.catalog.find<MediumType>(name), out.back());
    if (m.name == schema::FieldElement::kElement.name) add_own(*known.catalog.find<FieldType>(name), out.back());
    if (m.name == schema::ObserverElement::kElement.name) add_own(*known.catalog.find<ObserverType>(name), out.back());
    if (m.name == schema::RunPartElement::kElement.name) add_own(*known.catalog.find<RunPartType>(name), out.back());
    if (m.name == schema::TrackerElement::kElement.name)
      out.back().attributes += options_of("tracker of " + name, known.catalog);
  }
  return out;
}

/// In which elements one may stand.
std::string parents_of(const ElementManual& m, const std::vector<ElementManual>& all, const KnownNames& known) {
  std::vector<std::string> parents;
  for (const ElementManual& other : all) {
    if (std::find(other.children.begin(), other.children.end(), m.name) != other.children.end())
      parents.push_back(other.name);
  }
  // Those of which the parent says "anything".
  if (m.name == schema::Configuration::kElement.name) parents = {"controllers"};
  if (m.name == schema::Boundaries::kElement.name) parents = known.engines;
  if (known.engine(m.name) != nullptr) parents = {"physics_engines"};
  return joined(parents, " or ");
}

/// What parts add to an element: of what they are, and their attributes.
std::string options_of_parts(const std::string& element, const hal::Catalog& catalog) {
  std::string text;
  const std::string begin = element + " of ";
  for (const hal::ElementOptions* options : catalog.all<hal::ElementOptions>()) {
    if (!options->name.starts_with(begin)) continue;
    ManualWriter writer;
    (void)options->read(writer);
    if (!writer.text().empty()) text += "  of " + options->name.substr(begin.size()) + ":\n" + writer.text();
  }
  return text;
}

}  // namespace

std::set<std::string> element_names(const KnownNames& known) {
  static const std::set<std::string> always = [] {
    std::set<std::string> names;
    for (const ElementManual& m : all_manuals()) names.insert(m.name);
    return names;
  }();
  std::set<std::string> all = always;
  for (const std::vector<std::string>* names : {&known.robots, &known.engines, &known.media, &known.fields})
    all.insert(names->begin(), names->end());
  return all;
}

std::vector<ElementManual> element_manuals(const hal::Catalog& catalog) {
  const KnownNames known(catalog);
  std::vector<ElementManual> manuals;
  for (const ElementManual& m : all_manuals()) {
    for (ElementManual& one : expanded(m, known)) manuals.push_back(std::move(one));
  }
  for (ElementManual& m : manuals) {
    m.parent = parents_of(m, manuals, known);
    if (m.name != schema::Tracker::kElement.name)  // whose kinds' options belong to the elements of <trackers>
      m.attributes += options_of_parts(m.name, catalog);
  }
  return manuals;
}

}  // namespace tandem::core
