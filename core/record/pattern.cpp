#include "core/record/pattern.hpp"

#include <algorithm>

#include "core/scenario/element.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {
namespace {

std::string text_of(const std::vector<std::string>& names) {
  constexpr std::size_t kNamesShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kNamesShown); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kNamesShown) text += ", … (" + std::to_string(names.size()) + " in all)";
  return text;
}

std::string hint(const std::string& word, const std::vector<std::string>& known) {
  const std::string near = closest(word, known);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

}  // namespace

bool fits_pattern(std::string_view text, std::string_view pattern) noexcept {
  std::size_t t = 0, p = 0;
  std::size_t star = std::string_view::npos, from = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = t;
    } else if (p < pattern.size() && pattern[p] == text[t]) {
      ++t;
      ++p;
    } else if (star != std::string_view::npos) {
      p = star + 1;  // let the last star take one more
      t = ++from;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

hal::Status check_chosen(const RecordConfig& config, const Space& space, std::string_view what) {
  std::vector<std::string> names, ports;
  for (std::size_t i = 0; i < space.robot_count(); ++i) names.push_back(space.robot_name(space.robot(i)));
  for (const RobotGroup& group : space.stores().groups) {
    for (const hal::PortType* port : group.ports) {
      if (std::find(ports.begin(), ports.end(), port->name) == ports.end()) ports.emplace_back(port->name);
    }
  }
  for (const std::string& pattern : config.entities) {
    const auto fits = [&pattern](const std::string& name) { return fits_pattern(name, pattern); };
    if (names.empty() || std::any_of(names.begin(), names.end(), fits)) continue;  // none: a hook may bring them
    return hal::Error{std::string(what) + ": no robot fits '" + pattern + "'" + hint(pattern, names) +
                      "; there are: " + text_of(names)};
  }
  for (const std::string& port : config.ports) {
    if (port == "*" || std::find(ports.begin(), ports.end(), port) != ports.end()) continue;
    return hal::Error{std::string(what) + ": no robot's controller uses a port '" + port + "'" + hint(port, ports) +
                      (ports.empty() ? "; they use none" : "; they use: " + text_of(ports))};
  }
  return {};
}

}  // namespace tandem::core
