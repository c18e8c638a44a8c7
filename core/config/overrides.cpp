#include "core/config/overrides.hpp"

#include <algorithm>

namespace tandem::core {
namespace {

struct Part {
  std::string name;
  std::string selector;  // inside [ ]; empty: none
};

/// Splits at the dots outside of brackets.
std::vector<Part> split(const std::string& path) {
  std::vector<Part> parts(1);
  bool inside = false;
  for (const char c : path) {
    if (c == '[') inside = true;
    else if (c == ']') inside = false;
    else if (c == '.' && !inside) parts.emplace_back();
    else (inside ? parts.back().selector : parts.back().name) += c;
  }
  return parts;
}

Element* select(Element& parent, const Part& part, std::string& why) {
  std::vector<Element*> same;
  std::string ids;
  for (Element& child : parent.children) {
    if (child.name != part.name) continue;
    same.push_back(&child);
    const std::string* id = child.attribute("id");
    ids += (ids.empty() ? "" : ", ") + (id != nullptr ? *id : "[" + std::to_string(same.size() - 1) + "]");
  }
  if (part.selector.empty()) {
    if (same.size() == 1) return same.front();
    if (same.size() > 1) {
      why = "there are " + std::to_string(same.size()) + " <" + part.name + "> in <" + parent.name + ">; choose one with " + part.name +
            "[n] or " + part.name + "[id]: " + ids;
      return nullptr;
    }
    Element& added = parent.children.emplace_back();
    added.name = part.name;
    added.file = parent.file;
    return &added;
  }
  for (std::size_t i = 0; i < same.size(); ++i) {
    const std::string* id = same[i]->attribute("id");
    if ((id != nullptr && *id == part.selector) || std::to_string(i) == part.selector) return same[i];
  }
  why = "<" + parent.name + "> has no <" + part.name + "> '" + part.selector + "'; it has: " + (ids.empty() ? "none" : ids);
  return nullptr;
}

}  // namespace

void apply_override(Element& root, const std::string& assignment, Problems& problems) {
  const std::size_t equals = assignment.find('=');
  const auto refuse = [&](const std::string& why) { problems.push_back({"--set " + assignment, 0, why, false}); };
  if (equals == std::string::npos || equals == 0) return refuse("write path=value, e.g. framework.experiment.length=5");
  std::vector<Part> parts = split(assignment.substr(0, equals));
  if (!parts.empty() && parts.front().name == root.name) parts.erase(parts.begin());
  const bool broken = std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.name.empty(); });
  if (parts.size() < 2 || broken || !parts.back().selector.empty()) {
    return refuse("the path must name elements and at last an attribute, e.g. framework.experiment.length");
  }
  Element* at = &root;
  for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
    std::string why;
    Element* next = select(*at, parts[i], why);
    if (next == nullptr) return refuse(why);
    at = next;
  }
  const std::string value = assignment.substr(equals + 1);
  for (Element::Attribute& a : at->attributes) {
    if (a.name == parts.back().name) {
      a.value = value;
      return;
    }
  }
  at->attributes.push_back({parts.back().name, value, 0});
}

}  // namespace tandem::core
