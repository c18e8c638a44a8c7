#include "app/command/known_commands.hpp"

#include <algorithm>
#include <map>

#include "app/catalog.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/module/modules.hpp"
#include "app/process/terminal.hpp"
#include "hal/check.hpp"

namespace tandem::app {
namespace {

hal::Catalog with_commands(hal::Catalog catalog, void (*register_commands)(hal::Registrar&)) {
  const hal::Status good = catalog.add_from(std::string(hal::Catalog::kInside), [&](hal::Registrar& registrar) {
    register_commands(registrar);
    register_missing_commands(registrar);
  });
  TANDEM_CHECK(good.ok(), good.error().message.c_str());
  return catalog;
}

bool begins_with(const hal::CommandType& type, std::string_view word) {
  return type.name.substr(0, type.name.find(' ')) == word;
}

}  // namespace

std::vector<const hal::CommandType*> by_group(std::vector<const hal::CommandType*> types) {
  namespace group = hal::command_group;
  std::map<std::string_view, std::string_view> group_of;
  std::vector<std::string_view> order(group::kAll.begin(), group::kAll.end());
  for (const hal::CommandType* type : types) {
    group_of[type->name] = type->group;
    if (std::ranges::find(order, type->group) == order.end()) order.push_back(type->group);
  }
  const auto place = [&](const hal::CommandType* type) {
    const auto parent = group_of.find(type->name.substr(0, type->name.find(' ')));
    return std::ranges::find(order, parent == group_of.end() ? type->group : parent->second) - order.begin();
  };
  std::ranges::stable_sort(types, {}, place);
  return types;
}

KnownCommands::KnownCommands(void (*register_commands)(hal::Registrar&))
    : register_commands_(register_commands), inside_(with_commands({}, register_commands)) {}

hal::PluginLoader& KnownCommands::loader() const {
  if (!loader_)
    loader_ = std::make_unique<hal::PluginLoader>(plugin_folders(), with_commands(app::catalog(), register_commands_),
                                                  on_demand());
  return *loader_;
}

std::vector<const hal::CommandType*> KnownCommands::all() const {
  return current().all<hal::CommandType>();
}

std::vector<const hal::CommandType*> KnownCommands::of(std::string_view word) const {
  std::vector<const hal::CommandType*> found = all();
  std::erase_if(found, [word](const hal::CommandType* type) { return !begins_with(*type, word); });
  return found;
}

hal::Status KnownCommands::open(const std::vector<std::string>& libraries) {
  for (const std::string& library : libraries) {
    if (hal::Status opened = loader().open(library); !opened.ok())
      return hal::Error{"--plugin: " + opened.error().message};
  }
  return {};
}

hal::Status KnownCommands::load_module_of(std::string_view word) {
  const Module* const module = module_of_command(word);
  if (module == nullptr) return {};
  if (hal::Status there = load_module(module->name); !there.ok()) return there;
  inside_ = with_commands(app::catalog(), register_commands_);
  return {};
}

hal::Status KnownCommands::judge(const std::vector<std::string>& libraries) {
  std::vector<std::string> with_commands;
  for (const std::string& library : libraries) {
    const auto note = loader().inspect(library);
    if (note.ok() && note.value().uses(hal::CommandType::kCategory)) with_commands.push_back(library);
  }
  return open(with_commands);
}

hal::Status KnownCommands::look_in_folders(std::string_view word) {
  for (const auto& file : plugin_files()) {
    const std::string library = file.string();
    const auto note = loader().inspect(library);
    if (!note.ok() || !note.value().uses(hal::CommandType::kCategory)) continue;
    const hal::Status opened = loader().open(library);
    if (opened.ok()) continue;
    if (!word.empty() && brings(library, word)) return opened;
    say("warning: " + opened.error().message);
  }
  return {};
}

bool KnownCommands::brings(const std::string& library, std::string_view word) const {
  hal::PluginLoader apart(plugin_folders(), app::catalog(), on_demand());
  if (!apart.open(library).ok()) return false;
  const auto types = apart.catalog().all<hal::CommandType>();
  return std::any_of(types.begin(), types.end(), [word](const auto* type) { return begins_with(*type, word); });
}

}  // namespace tandem::app
