#include "app/command/manuals.hpp"

#include <algorithm>
#include <sstream>

#include "app/command/known_commands.hpp"
#include "app/command/launcher_commands.hpp"

namespace tandem::app {
namespace {

CommandManual manual_of(const hal::CommandType& type, bool of_launcher) {
  CommandManual manual{
      std::string(type.name), std::string(type.summary), std::string(type.group), of_launcher, nullptr, {}};
  if (type.make == nullptr) return manual;
  manual.command = type.make();
  manual.command->describe(manual.line);
  return manual;
}

/// Shells and this program agree about these words without quoting them.
bool is_plain(const std::string& word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.' || c == '+';
  });
}

}  // namespace

std::string CommandManual::group() const {
  const std::size_t space = name.find(' ');
  return space == std::string::npos ? "" : name.substr(0, space);
}

std::string CommandManual::last_word() const {
  return name.substr(name.find(' ') + 1);  // npos + 1 is 0
}

std::vector<CommandManual> command_manuals(const hal::Catalog& catalog) {
  std::vector<CommandManual> all;
  for (const hal::CommandType* type : by_group(catalog.all<hal::CommandType>())) all.push_back(manual_of(*type, false));
  for (const hal::CommandType& type : launcher_commands()) all.push_back(manual_of(type, true));
  return all;
}

std::vector<std::string> names_of(const hal::Argument& argument) {
  std::vector<std::string> names;
  std::istringstream in(argument.names);
  for (std::string name; std::getline(in, name, ',');) names.push_back(name);
  return names;
}

bool takes_several(const hal::Argument& argument) {
  return std::holds_alternative<std::vector<std::string>*>(argument.value) ||
         std::holds_alternative<std::vector<std::int64_t>*>(argument.value) ||
         std::holds_alternative<std::vector<double>*>(argument.value);
}

std::vector<std::string> values_of(const hal::Argument& argument, const hal::Catalog& catalog) {
  std::vector<std::string> values = argument.choices;
  values.insert(values.end(), argument.suggestions.begin(), argument.suggestions.end());
  for (const hal::Catalog::Entry& entry : catalog.entries()) {
    if (!argument.category.empty() && (argument.category == "*" || argument.category == entry.category))
      values.push_back(entry.name);
  }
  std::erase_if(values, [](const std::string& value) { return !is_plain(value); });
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

}  // namespace tandem::app
