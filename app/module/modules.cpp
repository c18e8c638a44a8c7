#include "app/module/modules.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <dlfcn.h>
#include <set>
#include <sys/wait.h>
#include <unistd.h>

#include "app/catalog.hpp"
#include "app/module/linked_modules.hpp"
#include "app/module/own_plugins.hpp"
#include "app/process/terminal.hpp"
#include "hal/check.hpp"
#include "hal/library_folder.hpp"
#include "hal/plugin.hpp"

namespace tandem::app {
namespace {

using RegisterAll = void (*)(hal::Registrar&);

/// The modules that are there, by what registers each. Of the whole process, as libraries are.
struct Loaded {
  const Module* module;
  RegisterAll register_all;
};
std::deque<Loaded>& loaded() {
  static std::deque<Loaded> all = [] {
    std::deque<Loaded> linked;
    for (const LinkedModule& one : linked_modules()) linked.push_back({find_module(one.name), one.register_all});
    return linked;
  }();
  return all;
}

const Loaded* find_loaded(std::string_view name) noexcept {
  const auto found = std::ranges::find_if(loaded(), [&](const Loaded& one) { return one.module->name == name; });
  return found == loaded().end() ? nullptr : &*found;
}

/// Has the launcher that started this program build something, and tells people what and why. @returns whether it did.
bool have_built(const std::string& what, const std::string& name, const std::string& why) {
  const char* const launcher = std::getenv("TANDEM_LAUNCHER");
  if (launcher == nullptr || access(launcher, X_OK) != 0) return false;
  const char* const preset = std::getenv("TANDEM_PRESET");
  say(why);
  const std::vector<std::string> words = {launcher, "--preset", preset != nullptr ? preset : "release",
                                          "build",  what,       name};
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = vfork();  // of a program without threads, or whose threads go on: nothing is touched in between
  if (child == 0) {
    if (dup2(STDERR_FILENO, STDOUT_FILENO) >= 0) execv(launcher, arguments.data());
    _exit(127);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Of the checkout's own controllers and hooks.
bool make_plugin(const std::string& library) {
  std::string name = std::filesystem::path(library).stem().string();
  if (name.starts_with("lib")) name.erase(0, 3);
  if (std::ranges::find(own_plugins(), name) == own_plugins().end()) return false;
  static std::set<std::string> tried;  // what could not be built is asked for several times
  if (!tried.insert(name).second) return false;
  return have_built("plugin", name, "building '" + name + "', once");
}

/// The table of the loaded library. Error: it does not fit this program.
hal::Result<const hal::PluginInfo*> open_module(const Module& module, const std::filesystem::path& file) {
  const std::string name = "module '" + std::string(module.name) + "' (" + file.string() + ")";
  const std::string rebuild = "\n  Build it again: ./tandem build module " + std::string(module.name);
  const auto note = hal::read_plugin_note(file);
  if (!note.ok()) return hal::Error{name + " " + note.error().message + rebuild};
  hal::Catalog here = catalog();
  here.know<hal::Border>();
  here.know<hal::ControllerType>();
  std::vector<hal::Surface> known = here.surfaces();
  for (const hal::Surface& surface : note.value().surfaces) {  // what it brings itself is known when it is there
    const auto same = [&](const hal::Surface& s) { return s.name == surface.name; };
    if (std::ranges::none_of(known, same)) known.push_back(surface);
  }
  std::string why = hal::misfit(note.value(), known);
  if (why.empty() && note.value().release != hal::kRelease)
    why =
        "is of the release " + hal::to_text(note.value().release) + "; this program is " + hal::to_text(hal::kRelease);
  if (!why.empty()) return hal::Error{name + " " + why + rebuild};
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);  // never closed: its entries are the program's
  if (library == nullptr) return hal::Error{name + " does not load: " + dlerror() + rebuild};
  const auto* const info = static_cast<const hal::PluginInfo*>(dlsym(library, "tandem_plugin"));
  if (info == nullptr || info->register_all == nullptr) return hal::Error{name + " registers nothing" + rebuild};
  return info;
}

bool begins_with(std::string_view command, std::string_view word) {
  return command.substr(0, command.find(' ')) == word;
}

}  // namespace

const Module* find_module(std::string_view name) noexcept {
  const auto found = std::ranges::find(kModules, name, &Module::name);
  return found == kModules.end() ? nullptr : &*found;
}

const Module* module_of_command(std::string_view word) noexcept {
  const auto brings = [&](const Module& module) {
    return std::ranges::any_of(module.commands, [&](const ModuleCommand& c) { return begins_with(c.name, word); });
  };
  const auto found = std::ranges::find_if(kModules, brings);
  return found == kModules.end() ? nullptr : &*found;
}

bool is_loaded(const Module& module) noexcept {
  return find_loaded(module.name) != nullptr;
}

std::filesystem::path file_of(const Module& module) {
  return hal::library_folder() / "modules" / ("libtandem_" + std::string(module.name) + ".so");
}

hal::Status load_module(std::string_view name) {
  const Module* const module = find_module(name);
  if (module == nullptr) return hal::Error{"there is no module '" + std::string(name) + "'"};
  if (is_loaded(*module)) return {};
  const std::filesystem::path file = file_of(*module);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    const std::string what = "the module '" + std::string(name) + "' (" + std::string(module->summary) + ")";
    const bool built = have_built("module", std::string(name),
                                  "building " + what + ", once; about " + std::to_string(module->minutes) +
                                      (module->minutes == 1 ? " minute" : " minutes"));
    if (!built || !std::filesystem::exists(file, ignored))
      return hal::Error{what + (built || std::getenv("TANDEM_LAUNCHER") != nullptr
                                    ? " could not be built; all that does not need it goes on without it"
                                    : " is not here; looked for " + file.string() +
                                          "\n  In a checkout: ./tandem build module " + std::string(name))};
  }
  for (const std::string_view other : module->needs) {
    if (hal::Status needed = load_module(other); !needed.ok()) return needed;
  }
  const auto opened = open_module(*module, file);
  if (!opened.ok()) return opened.error();
  loaded().push_back({module, opened.value()->register_all});
  return {};
}

hal::Status need_module(hal::PluginLoader& loader, std::string_view name) {
  if (hal::Status there = load_module(name); !there.ok()) return there;
  for (const Loaded& one : loaded()) {
    if (loader.catalog().find<LoadedModule>(one.module->name) != nullptr) continue;
    if (hal::Status added = loader.add_inside([&](hal::Registrar& r) { register_module(*one.module, r); }); !added.ok())
      return added;
  }
  return {};
}

hal::Status need_modules_of(hal::PluginLoader& loader, const hal::PluginNote& note) {
  for (const Module& module : kModules) {
    const bool used = std::ranges::any_of(module.categories, [&](std::string_view c) { return note.uses(c); });
    if (!used) continue;
    if (hal::Status needed = need_module(loader, module.name); !needed.ok()) return needed;
  }
  return {};
}

hal::PluginLoader::OnDemand on_demand() noexcept {
  return {&need_modules_of, &make_plugin};
}

void load_built_modules() {
  for (const Module& module : kModules) {
    std::error_code ignored;
    if (is_loaded(module) || !std::filesystem::exists(file_of(module), ignored)) continue;
    if (const hal::Status good = load_module(module.name); !good.ok()) say("warning: " + good.error().message);
  }
}

void register_module(const Module& module, hal::Registrar& registrar) {
  static const std::vector<LoadedModule> entries = [] {
    std::vector<LoadedModule> all;
    for (const Module& one : kModules) all.push_back({one.name, one.summary});
    return all;
  }();
  find_loaded(module.name)->register_all(registrar);
  registrar.add(*std::ranges::find(entries, module.name, &LoadedModule::name));
}

void add_loaded_modules(hal::Catalog& catalog) {
  for (const Loaded& one : loaded()) {
    if (catalog.find<LoadedModule>(one.module->name) != nullptr) continue;
    const auto fill = [&](hal::Registrar& registrar) { register_module(*one.module, registrar); };
    const hal::Status good = catalog.add_from(std::string(hal::Catalog::kInside), fill);
    TANDEM_CHECK(good.ok(), good.error().message.c_str());
  }
}

void register_missing_commands(hal::Registrar& registrar) {
  static const std::vector<hal::CommandType> all = [] {
    std::vector<hal::CommandType> made;
    for (const Module& module : kModules) {
      for (const ModuleCommand& command : module.commands) made.push_back(command_of(command));
    }
    return made;
  }();
  for (const hal::CommandType& type : all) {
    const Module* const module = module_of_command(type.name.substr(0, type.name.find(' ')));
    if (!is_loaded(*module)) registrar.add(type);
  }
}

}  // namespace tandem::app
