#include "core/config/overrides.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace tandem::core {
namespace {

/// Elements that stand once in their parent and may be left out: an override may add them.
constexpr std::array<std::string_view, 15> kMayBeAdded = {
    "fitted",  "desk",   "system",     "time", "floor", "params",          "battery",      "bridge",
    "tracker", "record", "trajectory", "run",  "media", "physics_engines", "visualization"};

struct Part {
  std::string name;
  std::string selector;  // inside [ ]; empty: none
};

/// Splits at the dots outside of brackets. Empty when the brackets do not fit.
std::vector<Part> split(std::string_view path) {
  std::vector<Part> parts(1);
  bool inside = false;
  bool closed = false;
  for (const char c : path) {
    if (c == '[' && !inside && !closed) {
      inside = true;
    } else if (c == ']' && inside && !parts.back().selector.empty()) {
      inside = false;
      closed = true;
    } else if (c == '.' && !inside) {
      parts.emplace_back();
      closed = false;
    } else if ((closed && !inside) || (c == ']' && inside)) {
      return {};
    } else {
      (inside ? parts.back().selector : parts.back().name) += c;
    }
  }
  return inside ? std::vector<Part>{} : parts;
}

/// What an element is chosen by: its id, or the name of a kind of robots.
const std::string* label_of(const Element& e) {
  return e.attribute(e.name == "kind" ? "name" : "id");
}

/// What stands in `parent`, for messages: "box [wall]", "distribute [0]", "floor".
std::vector<std::string> contents(const Element& parent) {
  std::vector<std::string> names;
  for (const Element& child : parent.children) {
    const auto same = [&](const Element& e) { return e.name == child.name; };
    const auto total = std::count_if(parent.children.begin(), parent.children.end(), same);
    const auto index = std::count_if(parent.children.data(), &child, same);
    const std::string* id = label_of(child);
    names.push_back(child.name + (id != nullptr ? "[" + *id + "]"
                                  : total > 1   ? "[" + std::to_string(index) + "]"
                                                : ""));
    if (names.size() > 20) break;
  }
  return names;
}

Element& add(Element& parent, const std::string& name, const std::string& origin) {
  Element& added = parent.children.emplace_back();
  added.name = name;
  added.file = origin;
  added.argos = parent.argos;
  return added;
}

Element* select(Element& parent, const Part& part, const std::string& origin, std::string& why) {
  std::vector<Element*> same;
  for (Element& child : parent.children) {
    if (child.name == part.name) same.push_back(&child);
  }
  if (part.selector.empty() && same.size() == 1) return same.front();
  if (part.selector.empty() && same.size() > 1) {
    why = "<" + parent.name + "> has " + std::to_string(same.size()) + " <" + part.name + ">; choose one with " +
          part.name + "[n], from 0, or " + part.name + "[id]: " + listed(contents(parent));
    return nullptr;
  }
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::string* id = label_of(*same[i]);
    if ((id != nullptr && *id == part.selector) || std::to_string(i) == part.selector) return same[i];
  }
  const bool of_a_plugin =
      parent.name == "params" || parent.name == "loop_functions" || parent.name == "run";  // judges its children itself
  if (part.selector.empty() && same.empty() && of_a_plugin) return &add(parent, part.name, origin);
  if (part.selector.empty() && std::find(kMayBeAdded.begin(), kMayBeAdded.end(), part.name) != kMayBeAdded.end()) {
    return &add(parent, part.name, origin);
  }
  std::vector<std::string> names;
  for (const Element& child : parent.children) names.push_back(child.name);
  why = "<" + parent.name + "> has no " + part.name + (part.selector.empty() ? "" : "[" + part.selector + "]") +
        "; it has: " + listed(contents(parent)) + (same.empty() ? did_you_mean(part.name, names) : "");
  return nullptr;
}

void set(Element& element, const Element::Attribute& attribute) {
  for (Element::Attribute& a : element.attributes) {
    if (a.name == attribute.name) {
      a = attribute;
      return;
    }
  }
  element.attributes.push_back(attribute);
}

/// Sets it in every element that the path names. @returns what is wrong with the path, or nothing
std::string set_in(Element& from, std::span<const Part> path, const Element::Attribute& attribute) {
  if (path.empty()) {
    set(from, attribute);
    return {};
  }
  std::string why;
  if (path.front().selector != "*") {
    Element* const next = select(from, path.front(), attribute.origin, why);
    return next == nullptr ? why : set_in(*next, path.subspan(1), attribute);
  }
  bool any = false;
  for (Element& child : from.children) {
    if (child.name != path.front().name) continue;
    any = true;
    if (why = set_in(child, path.subspan(1), attribute); !why.empty()) return why;
  }
  return any ? "" : "<" + from.name + "> has no " + path.front().name;
}

}  // namespace

void apply_override(Element& root, const std::string& assignment, Problems& problems) {
  const std::string origin = "--set " + assignment;
  const auto refuse = [&](const std::string& why) { problems.push_back({origin, 0, why, false}); };
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) return refuse("write path=value, e.g. framework.experiment.length=5");
  std::vector<Part> parts = split(std::string_view(assignment).substr(0, equals));
  if (!parts.empty() && parts.front().name == root.name) parts.erase(parts.begin());
  const bool broken = std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.name.empty(); });
  if (parts.size() < 2 || broken || !parts.back().selector.empty()) {
    return refuse("the path must name elements and at last an attribute, e.g. arena.distribute[0].entity.quantity");
  }
  const Element::Attribute set{parts.back().name, assignment.substr(equals + 1), 0, origin};
  parts.pop_back();
  if (const std::string why = set_in(root, parts, set); !why.empty()) refuse(why);
}

}  // namespace tandem::core
