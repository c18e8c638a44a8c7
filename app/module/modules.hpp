// Modules: parts of the program that lie in libraries of their own, and are built and loaded when a command or a file
// first needs them (app/module/README.md).
//
// A module is a library that registers entries as a plug-in does. Its entries are the program's own, and it may call
// all of the program and the modules that it needs. Programs for boards, tests, Python and the library have modules
// linked in (app/module/linked_modules.hpp); nothing is loaded there.
#pragma once
#include <filesystem>
#include <string_view>

#include "app/module/module_table.hpp"
#include "hal/catalog.hpp"
#include "hal/command.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// Entry of a catalog that has all that the module brings.
struct LoadedModule {
  static constexpr std::string_view kCategory = "module";
  using Crosses = hal::Layouts<std::string_view>;
  std::string_view name, summary;
};

/// Null: there is none of that name.
const Module* find_module(std::string_view name) noexcept;
/// The module whose commands begin with this word; null: none.
const Module* module_of_command(std::string_view word) noexcept;
/// Whether it is linked in or was loaded.
bool is_loaded(const Module& module) noexcept;
/// Its file, whether there is one or not.
std::filesystem::path file_of(const Module& module);

/// Loads the module and those it needs; one that is not built is built first, where the launcher at the top of a
/// checkout has started this program. Starts no thread. Errors: no such library, and no way to build it; it
/// could not be built; it does not fit this program.
hal::Status load_module(std::string_view name);
/// The same, and the loader's catalog has its entries.
hal::Status need_module(hal::PluginLoader& loader, std::string_view name);
/// The modules whose categories a plug-in adds to.
hal::Status need_modules_of(hal::PluginLoader& loader, const hal::PluginNote& note);
/// What loaders of this program do when a plug-in needs a module, or a library of the checkout's own is not built yet.
hal::PluginLoader::OnDemand on_demand() noexcept;
/// All that are built. What does not load is reported, and left out.
void load_built_modules();

/// Registers all that a loaded module brings, and a `LoadedModule`.
void register_module(const Module& module, hal::Registrar& registrar);
/// Adds the loaded modules that the catalog does not have yet.
void add_loaded_modules(hal::Catalog& catalog);
/// Registers the commands of modules that are not loaded, by name and summary alone.
void register_missing_commands(hal::Registrar& registrar);

}  // namespace tandem::app
