#include "core/config/reading.hpp"

namespace tandem::core {

std::vector<std::string> words(std::string_view list) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t space = std::min(list.find(' ', at), list.size());
    out.emplace_back(list.substr(at, space - at));
    at = space + 1;
  }
  return out;
}

std::optional<Point2> point_of(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return std::nullopt;
  const auto x = hal::parse_quantity(std::string_view(text).substr(0, comma), hal::unit::m);
  const auto y = hal::parse_quantity(std::string_view(text).substr(comma + 1), hal::unit::m);
  if (!x.ok() || !y.ok()) return std::nullopt;
  return Point2{x.value(), y.value()};
}

KnownNames::KnownNames(const hal::Catalog& all)
    : robots(all.names(hal::RobotKind::kCategory)),
      engines(all.names(KnownEngine::kCategory)),
      media(all.names(MediumType::kCategory)),
      observers(all.names(ObserverType::kCategory)),
      run_parts(all.names(RunPartType::kCategory)),
      trackers(all.names("tracker")),  // whose type is above core
      catalog(all) {
  for (std::string& name : all.elsewhere(KnownEngine::kCategory)) engines.push_back(std::move(name));
  for (const FieldType* field : all.all<FieldType>()) {
    if (field->describe != nullptr) fields.emplace_back(field->name);
  }
  for (const hal::PortType* port : all.all<hal::PortType>())
    (port->role == hal::Role::Sensor ? sensors : actuators).emplace_back(port->name);
}

std::vector<std::string> KnownNames::children_of(std::vector<std::string> names) const {
  for (const auto& [stand_in, kinds] :
       {std::pair(schema::kRobotKind, &robots), std::pair(schema::kMediumKind, &media),
        std::pair(schema::kFieldKind, &fields), std::pair(schema::kObserverKind, &observers),
        std::pair(schema::kRunPartKind, &run_parts), std::pair(schema::kTrackerKind, &trackers)}) {
    const auto at = std::find(names.begin(), names.end(), stand_in);
    if (at != names.end()) names.insert(names.erase(at), kinds->begin(), kinds->end());
  }
  return names;
}

std::vector<std::string> Reading::check(const Element& element, const schema::ElementInfo& info) {
  std::vector<std::string> missing;
  for (const std::string& name : words(info.required)) {
    const std::string* value = element.attribute(name);
    if (value == nullptr) {
      error(element, "<" + element.name + "> needs the attribute '" + name + "'");
      missing.push_back(name);
    } else if (value->empty() && !(numbered_ && name == "id")) {
      error(element, name, "must not be empty");
    }
  }
  if (info.children == schema::kAnything) return missing;
  // A program without a world knows neither media nor fields nor observers, and no trackers.
  const auto may_hold = [&](std::string_view kind) { return info.children.find(kind) != std::string_view::npos; };
  if (((may_hold(schema::kMediumKind) || may_hold(schema::kObserverKind) || may_hold(schema::kRunPartKind)) &&
       known_.media.empty()) ||
      (may_hold(schema::kFieldKind) && known_.fields.empty()) ||
      (may_hold(schema::kTrackerKind) && known_.trackers.empty()))
    return missing;
  const std::vector<std::string> allowed = known_.children_of(words(info.children));
  const bool things = may_hold(schema::kRobotKind);  // none of which may be missing
  for (const Element& child : element.children) {
    if (std::find(allowed.begin(), allowed.end(), child.name) != allowed.end()) continue;
    if (things)
      error(child, cannot_hold(element, child, allowed));
    else
      unread(child, cannot_hold(element, child, allowed));
  }
  return missing;
}

Element* Reading::only(Element& parent, std::string_view name) {
  Element* first = nullptr;
  for (Element& child : parent.children) {
    if (child.name != name) continue;
    if (first != nullptr)
      unread(child, "a second <" + child.name + ">; the first is on line " + std::to_string(first->line));
    else
      first = &child;
  }
  return first;
}

Element& Reading::add_child(Element& parent, std::string_view name) {
  Element& child = parent.children.emplace_back();
  child.name = name;
  child.file = parent.file;
  child.line = parent.line;
  child.argos = parent.argos;
  return child;
}

}  // namespace tandem::core
