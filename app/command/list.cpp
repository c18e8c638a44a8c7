// `tandem list` and `tandem describe`: what there is, and its manual, from the schemas.
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/command/launcher_commands.hpp"
#include "app/command/listing.hpp"
#include "app/command/shared_options.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/modules.hpp"
#include "app/module/own_plugins.hpp"
#include "app/process/terminal.hpp"
#include "controllers/lua_controller/api/manual.hpp"
#include "core/config/kinds.hpp"
#include "core/config/reader.hpp"
#include "core/device/coupling.hpp"
#include "core/device/device.hpp"
#include "core/hook/hook.hpp"
#include "core/physics/solver.hpp"
#include "core/scenario/field_type.hpp"
#include "core/scenario/medium_type.hpp"
#include "core/scenario/observer_type.hpp"
#include "core/scenario/run_part_type.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

std::string from(const hal::Catalog& catalog, const void* entry) {
  const std::string origin = catalog.origin_of(entry);
  return origin == hal::Catalog::kInside ? "" : " (" + std::filesystem::path(origin).filename().string() + ")";
}

bool describe_elements(const std::vector<core::ElementManual>& manuals, const std::string& name) {
  bool found = false;
  for (const core::ElementManual& m : manuals) {
    if (m.name != name) continue;
    found = true;
    fmt::print("<{}>{}: {}\n{}", m.name, m.parent.empty() ? "" : fmt::format(" in <{}>", m.parent), m.doc,
               m.attributes);
    std::string children;
    for (const std::string& c : m.children)
      children += (children.empty() ? "" : ", ") + (c == "*" ? std::string("anything") : c);
    if (!children.empty()) fmt::print("  may hold: {}\n", children);
  }
  return found;
}

namespace {

/// What is listed and described: of the program, of plug-ins, and of a file.
struct Known {
  std::unique_ptr<hal::PluginLoader> loader;
  std::unique_ptr<KindsOfFile> file;
  const hal::Catalog& catalog() const { return file != nullptr ? file->catalog : loader->catalog(); }
};

/// All plug-ins: of `--plugin`, of the file, and of the plug-in folders, of which those that do not load are named on
/// standard error. Nothing, when one of the others cannot be opened, or the file's kinds cannot be read.
std::optional<Known> all_known(const hal::Catalog& inside, const Libraries& plugins, const std::string& file) {
  Known known{std::make_unique<hal::PluginLoader>(plugin_folders(), inside), nullptr};
  if (!open_plugins(*known.loader, plugins)) return std::nullopt;
  if (!file.empty() && (known.file = kinds_of_file(*known.loader, file)) == nullptr) return std::nullopt;
  open_plugin_folders(*known.loader);
  if (known.file == nullptr) return known;
  // A plug-in of the folders may have a robot that the file knows nothing of.
  std::erase_if(known.file->kinds, [&](const core::KindConfig& config) {
    const auto* const other = known.loader->catalog().find<hal::RobotKind>(config.kind->name);
    if (other == nullptr) return false;
    say(fmt::format("warning: {}:{}: the kind '{}' is left out: {} has a robot of that name", config.file, config.line,
                    config.kind->name, known.loader->catalog().origin_of(other)));
    return true;
  });
  known.file->catalog = core::with_kinds(known.loader->catalog(), known.file->kinds);
  return known;
}

void list_devices(const hal::Catalog& catalog) {
  fmt::print("devices (implementations):\n");
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    std::string_view last;
    for (const core::DeviceType* type : catalog.all<core::DeviceType>()) {
      if (type->role != role || type->device == last) continue;
      last = type->device;
      std::string names;
      for (const core::DeviceType* t : catalog.all<core::DeviceType>()) {
        if (t->device == type->device && t->role == role)
          names += (names.empty() ? "" : ", ") + std::string(t->implementation) + from(catalog, t);
      }
      fmt::print("  {:<22} {:<9} {}\n", type->device, role == hal::Role::Sensor ? "sensor" : "actuator", names);
    }
  }
}

void list_names(const hal::Catalog& catalog, std::string_view category, std::string_view title) {
  fmt::print("{}:\n", title);
  for (const hal::Catalog::Entry& e : catalog.entries()) {
    if (e.category == category) fmt::print("  {}{}\n", e.name, from(catalog, e.entry));
  }
}

void list_engines(const hal::Catalog& catalog) {
  list_names(catalog, core::EngineType::kCategory, "physics engines");
  for (const std::string& name : catalog.elsewhere(core::KnownEngine::kCategory))
    fmt::print("  {}; NOT BUILT: tandem describe {} has it built, as the first file does\n", name, name);
}

/// The module that has the engine of this name, if it is not loaded. False: it could not be loaded, which was told.
bool need_module_of_engine(const hal::Catalog& catalog, const std::string& name) {
  const std::vector<std::string> elsewhere = catalog.elsewhere(core::KnownEngine::kCategory);
  if (std::ranges::find(elsewhere, name) == elsewhere.end()) return true;
  for (const Module& module : kModules) {
    if (std::ranges::find(module.elements, name) == module.elements.end()) continue;
    if (const hal::Status there = load_module(module.name); !there.ok())
      return complain(kBadInput, there.error().message) == kDone;
  }
  return true;
}

void list_elements(const hal::Catalog& catalog) {
  fmt::print("elements of experiment files:\n");
  for (const core::ElementManual& m : core::element_manuals(catalog)) fmt::print("  {:<22} {}\n", m.name, m.doc);
}

/// The plug-ins, each with what it brings: "libx.so  2 controllers, 1 device".
void list_libraries(const hal::Catalog& catalog) {
  std::map<std::string, std::map<std::string, int>> brought;
  for (const hal::Catalog::Entry& e : catalog.entries()) {
    if (e.origin != hal::Catalog::kInside) ++brought[e.origin][e.category];
  }
  fmt::print("plug-ins:\n");
  for (const auto& [library, counts] : brought) {
    std::string all;
    for (const auto& [category, count] : counts)
      all += fmt::format("{}{} {}{}", all.empty() ? "" : ", ", count, category,
                         count == 1 || category.ends_with('s') ? "" : "s");
    fmt::print("  {}: {}\n", printable(library), printable(all));
  }
}

void list_commands(const hal::Catalog& catalog) {
  list_entries<hal::CommandType>(catalog, "commands");
  fmt::print("commands of the launcher at the top of a checkout:\n");
  for (const hal::CommandType& type : launcher_commands()) fmt::print("  {:<22} {}\n", type.name, type.summary);
}

/// Modules that are not built, and what they are for.
void list_modules(const hal::Catalog& /*catalog*/) {
  fmt::print("modules:\n");
  for (const Module& module : kModules) {
    std::string commands;
    for (const ModuleCommand& c : module.commands)
      commands += (commands.empty() ? "; commands " : ", ") + std::string(c.name);
    fmt::print("  {:<22} {}{}{}\n", module.name, module.summary, commands,
               is_loaded(module) ? ""
                                 : "; NOT BUILT: the first command or file that needs it has it built, or "
                                   "./tandem build module " +
                                       std::string(module.name));
  }
}

/// The port class behind a device name, for its fields.
void describe_fields(const hal::Catalog& catalog, std::string_view name, hal::Role role) {
  const auto* const port = catalog.find<hal::PortType>(hal::port_entry(name, role));
  if (port == nullptr) return;
  fmt::print("  what a controller {}: {}{}\n", role == hal::Role::Sensor ? "reads" : "writes", port->doc,
             from(catalog, port));
  for (const hal::Field& f : port->fields) {
    fmt::print("    {:<14} {}{}{}\n", f.name, f.doc, f.count > 1 ? fmt::format(", up to {}", f.count) : "",
               f.unit.symbol.empty() ? "" : fmt::format(" [{}]", f.unit.symbol));
  }
}

bool describe_device(const hal::Catalog& catalog, const std::string& name) {
  bool found = false;
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    bool first = true;
    for (const core::DeviceType* type : catalog.all<core::DeviceType>()) {
      if (type->device != name || type->role != role) continue;
      if (first) {
        fmt::print("{} <{}>\n", role == hal::Role::Sensor ? "sensor" : "actuator", name);
        describe_fields(catalog, name, role);
      }
      first = false;
      found = true;
      fmt::print("  implementation=\"{}\": {}{}\n", type->implementation, type->summary, from(catalog, type));
      core::ManualWriter manual;
      type->describe(manual);
      fmt::print("{}", manual.text());
    }
  }
  return found;
}

void describe_params(const hal::ControllerType& type, hal::ParamVisitor& manual) {
  (void)type.read_params(manual);
}
void describe_params(const core::HookType& type, hal::ParamVisitor& manual) {
  if (type.describe != nullptr) type.describe(manual);
}

template <class T>
bool describe_plugin(const hal::Catalog& catalog, const std::string& name) {
  bool found = false;
  for (const T* type : catalog.all<T>()) {
    if (type->name != name) continue;
    found = true;
    fmt::print("{} {}: {}\n  library: {}\n", T::kCategory, printable(name), printable(type->summary),
               catalog.origin_of(type));
    core::ManualWriter manual;
    describe_params(*type, manual);
    fmt::print("parameters:\n{}", manual.text().empty() ? "  none\n" : manual.text());
  }
  return found;
}

bool describe_physics_engine(const hal::Catalog& catalog, const std::string& name) {
  const auto* const type = catalog.find<core::EngineType>(name);
  if (type == nullptr) return false;
  const core::EngineTraits& traits = type->traits;
  fmt::print("<{}> in <physics_engines>: {}{}{}{}\n", name, type->summary,
             traits.forces ? " Objects may be movable." : " Objects do not move.",
             traits.plane ? "" : " Robots may fly.", from(catalog, type));
  fmt::print("joints: {}\n", traits.joints == 0 ? "none" : core::words_of(traits.joints));
  core::ManualWriter manual;
  type->describe(manual);
  fmt::print("{}", manual.text());
  return true;
}

/// Devices of this role that robots of this kind have: "a, b, c".
std::string devices_of(const hal::Catalog& catalog, const hal::RobotKind& kind, hal::Role role) {
  std::string all;
  std::string_view last;
  for (const core::DeviceType* type : catalog.all<core::DeviceType>()) {
    if (type->role != role || type->device == last || !type->fits(kind)) continue;
    last = type->device;
    all += (all.empty() ? "" : ", ") + std::string(type->device);
  }
  return all;
}

/// A kind of robot as a file that gives it.
int print_xml(const hal::Catalog& catalog, const Known& known, const std::string& name) {
  const auto* const kind = catalog.find<hal::RobotKind>(name);
  if (kind == nullptr) {
    const std::vector<std::string> kinds = catalog.names(hal::RobotKind::kCategory);
    return complain(kBadInput, "tandem describe: --xml: there is no robot '" + name +
                                   "'; there are: " + hal::listed(kinds) + hal::did_you_mean(name, kinds));
  }
  std::string bridge;
  for (const core::KindConfig& config : known.file != nullptr ? known.file->kinds : std::vector<core::KindConfig>{}) {
    if (config.kind->name == name) bridge = config.bridge;
  }
  fmt::print("{}", core::kinds_file({core::element_of(*kind, bridge)}));
  return kDone;
}

/// A part, drive or body, as files give it to a kind of robot.
bool describe_part(const hal::Catalog& catalog, const std::string& name) {
  hal::ManualWriter manual;
  const auto print = [&](std::string_view doc, const std::string& origin) {
    fmt::print("<{}> in <kind>: {}{}\n{}", name, printable(doc), origin, manual.text());
    return true;
  };
  const auto is = [&](auto part) {
    if (name != part.kName) return false;
    part.describe(manual);
    return print(part.kDoc, "");
  };
  if (is(hal::Body{}) || is(hal::DifferentialDrive{}) || is(hal::Quadrotor{})) return true;
  const auto* const type = catalog.find<hal::PartType>(name);
  if (type == nullptr) return false;
  hal::AnyPart part = type->make();
  part.describe(manual);
  return print(type->summary, from(catalog, type));
}

/// What a kind of robot is and has.
bool describe_robot(const hal::Catalog& catalog, const std::string& name) {
  const auto* const kind = catalog.find<hal::RobotKind>(name);
  if (kind == nullptr) return false;
  fmt::print("robot <{}>: {}{}\n", name, printable(kind->summary), from(catalog, kind));
  fmt::print("  sensors: {}\n  actuators: {}\n", devices_of(catalog, *kind, hal::Role::Sensor),
             devices_of(catalog, *kind, hal::Role::Actuator));
  if (kind->flies())
    fmt::print("  needs an engine in space: {}\n",
               core::engines_that(catalog, [](const core::EngineTraits& traits) { return !traits.plane; }));
  fmt::print("  in experiment files: <{} id=\"…\"><body position=\"x,y,z\"/><controller config=\"…\"/></{}>\n", name,
             name);
  hal::RobotKind shown = *kind;
  hal::FactWriter facts;
  shown.describe(facts);
  std::istringstream lines(facts.text());
  for (std::string line; std::getline(lines, line);) fmt::print("{}\n", printable(line));
  return true;
}

bool describe_coupling(const hal::Catalog& catalog, const std::string& name) {
  const auto* const type = catalog.find<core::CouplingType>(name);
  if (type != nullptr) fmt::print("coupling {}: {}{}\n", name, printable(type->summary), from(catalog, type));
  return type != nullptr;
}

/// What scripts have.
bool describe_scripts(const hal::Catalog& catalog, const std::string& name) {
  if (name == "lua") fmt::print("{}", controllers::lua::manual(catalog));
  return name == "lua";
}

bool describe_element(const hal::Catalog& catalog, const std::string& name) {
  return describe_elements(core::element_manuals(catalog), name);
}

constexpr Listing kListings[] = {
    {"robots", [](const hal::Catalog& c) { list_entries<hal::RobotKind>(c, "robots"); }, &describe_robot},
    {"engines", &list_engines, &describe_physics_engine},
    {"couplings", [](const hal::Catalog& c) { list_entries<core::CouplingType>(c, "couplings"); }, &describe_coupling},
    {"elements", &list_elements, &describe_element},
    {"parts", [](const hal::Catalog& c) { list_entries<hal::PartType>(c, "parts of robots"); }, &describe_part},
    {"devices", &list_devices, &describe_device},
    {"controllers", [](const hal::Catalog& c) { list_entries<hal::ControllerType>(c, "controllers"); },
     &describe_plugin<hal::ControllerType>},
    {"hooks", [](const hal::Catalog& c) { list_entries<core::HookType>(c, "hooks"); },
     &describe_plugin<core::HookType>},
    {"commands", &list_commands},
    {"plugins", &list_libraries},
    {"modules", &list_modules},
    {"fields", [](const hal::Catalog& c) { list_entries<core::FieldType>(c, "fields"); }},
    {"observers", [](const hal::Catalog& c) { list_entries<core::ObserverType>(c, "observers"); }},
    {"run_parts", [](const hal::Catalog& c) { list_entries<core::RunPartType>(c, "parts that join a run"); }},
    {"media", [](const hal::Catalog& c) { list_entries<core::MediumType>(c, "media"); }},
    {"scripts", nullptr, &describe_scripts}};

/// By name; the program's own before those of modules.
std::vector<const Listing*> listings(const hal::Catalog& catalog) {
  std::vector<const Listing*> all;
  for (const Listing& listing : kListings) all.push_back(&listing);
  for (const Listing* listing : catalog.all<Listing>()) all.push_back(listing);
  return all;
}

std::vector<std::string> listed_kinds(const hal::Catalog& catalog) {
  std::vector<std::string> names;
  for (const Listing* listing : listings(catalog)) {
    if (listing->list != nullptr) names.emplace_back(listing->name);
  }
  for (const Module& module : kModules) names.insert(names.end(), module.lists.begin(), module.lists.end());
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// What modules that are not built would add to this list, and libraries of the checkout.
void list_elsewhere(const hal::PluginLoader& loader, std::string_view kind) {
  for (const Module& module : kModules) {
    if (is_loaded(module) || std::ranges::find(module.lists, kind) == module.lists.end()) continue;
    fmt::print("{} of the module '{}' ({}): NOT BUILT; ./tandem build module {}\n", kind, module.name, module.summary,
               module.name);
  }
  if (kind != "controllers" && kind != "hooks") return;
  std::string missing;
  for (const std::string_view name : own_plugins()) {
    if (!loader.find(std::string(name)).ok()) missing += (missing.empty() ? "" : ", ") + std::string(name);
  }
  if (!missing.empty())
    fmt::print("libraries of the checkout with controllers or hooks that are NOT BUILT, until a file names them: {}\n",
               missing);
}

struct ListOptions {
  Libraries plugins;
  std::string file;  ///< whose plug-ins and kinds of robots are shown, too
  std::string kind;  ///< bridges, controllers, couplings, commands, … robots; empty: all

  void describe(hal::CommandLine& line) {
    line.word("kind", kind, "Only this kind").suggest(listed_kinds(app::catalog()));
    line.option("--in", file, "Also what this file adds: its plug-ins, its kinds of robots").file();
    describe_plugins(line, plugins);
  }
};

int list(const ListOptions& options, const hal::CommandContext& context) {
  load_built_modules();
  const auto known = all_known(context.catalog(), options.plugins, options.file);
  if (!known) return kBadInput;
  const std::vector<std::string> kinds = listed_kinds(known->catalog());
  if (!options.kind.empty() && std::ranges::find(kinds, options.kind) == kinds.end()) {
    fmt::print(stderr, "tandem list: there is no kind '{}'; there are: {}\n", options.kind, hal::listed(kinds));
    return kWrongUsage;
  }
  for (const std::string& kind : kinds) {
    for (const Listing* listing : listings(known->catalog())) {
      if (listing->list != nullptr && kind == listing->name && (options.kind.empty() || options.kind == kind))
        listing->list(known->catalog());
    }
    if (options.kind.empty() || options.kind == kind) list_elsewhere(*known->loader, kind);
  }
  return kDone;
}

struct DescribeOptions {
  Libraries plugins;
  std::string file;  ///< as above
  std::string name;
  bool xml = false;  ///< a kind of robot as an element of a file

  void describe(hal::CommandLine& line) {
    line.word("name", name, "Its name").required().named_in("*");
    line.option("--in", file, "A file with plug-ins and kinds of robots that may be meant, too").file();
    line.flag("--xml", xml, "A kind of robot as a file that gives it");
    describe_plugins(line, plugins);
  }
};

int describe(const DescribeOptions& options, const hal::CommandContext& context) {
  load_built_modules();
  const std::string& name = options.name;
  if (!need_module_of_engine(context.catalog(), name)) return kBadInput;
  const auto known = all_known(context.catalog(), options.plugins, options.file);
  if (!known) return kBadInput;
  const hal::Catalog& catalog = known->catalog();
  if (options.xml) return print_xml(catalog, *known, name);
  bool found = false;
  for (const Listing* listing : listings(catalog))
    found = (listing->describe != nullptr && listing->describe(catalog, name)) || found;
  if (found) return kDone;
  std::vector<std::string> all;
  for (const core::ElementManual& m : core::element_manuals(catalog)) all.emplace_back(m.name);
  for (const core::DeviceType* t : catalog.all<core::DeviceType>()) all.emplace_back(t->device);
  for (const hal::Catalog::Entry& e : catalog.entries()) all.push_back(e.name);
  const std::string near = core::closest(name, all);
  fmt::print(stderr, "tandem describe: there is nothing called '{}'{}. `tandem list` shows what there is.\n", name,
             near.empty() ? "" : "; did you mean '" + near + "'?");
  return kBadInput;
}

}  // namespace

constinit const hal::CommandType list_command = hal::command_type<ListOptions, list>(
    "list", "List what there is: controllers, hooks, devices, engines, robots, elements.", hal::command_group::kExtend);
constinit const hal::CommandType describe_command = hal::command_type<DescribeOptions, describe>(
    "describe", "Print the manual of a controller, device, robot, hook or element.", hal::command_group::kExtend);

}  // namespace tandem::app
