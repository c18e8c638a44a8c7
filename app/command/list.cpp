// `tandem list` and `tandem describe`: what there is, and its manual, from the schemas.
#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <map>

#include "app/catalog.hpp"
#include "app/command/command.hpp"
#include "app/port_types.hpp"
#include "app/terminal.hpp"
#include "core/device/device.hpp"
#include "core/loop/hook.hpp"
#include "core/sim/engine_factory.hpp"
#include "core/sim/robot_factory.hpp"

namespace tandem::app {
namespace {

/// All plug-ins of the plug-in folders, opened; those that do not load are named on standard error.
std::unique_ptr<hal::PluginLoader> open_all() {
  auto loader = std::make_unique<hal::PluginLoader>(plugin_folders());
  for (const auto& file : plugin_files()) {
    const hal::Status opened = loader->open(file.string());
    if (!opened.ok()) say("warning: " + opened.error().message);
  }
  return loader;
}

std::string_view summary_of(const hal::PluginLoader::Entry& entry) {
  if (entry.category == "controller") return static_cast<const hal::ControllerType*>(entry.type)->summary;
  return static_cast<const core::HookType*>(entry.type)->summary;
}

void list_plugins(std::string_view category, std::string_view title) {
  const auto loader = open_all();
  fmt::print("{}:\n", title);
  bool none = true;
  for (const auto& entry : loader->entries()) {
    if (entry.category != category) continue;
    fmt::print("  {:<22} {}\n", printable(entry.name), printable(summary_of(entry)));
    none = false;
  }
  if (none) fmt::print("  none in the plug-in folders; TANDEM_PLUGIN_PATH names further ones\n");
}

void list_devices() {
  fmt::print("devices (implementations):\n");
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    std::string last;
    for (const core::DeviceType& type : core::device_types()) {
      if (type.role != role || type.device == last) continue;
      last = type.device;
      std::string names;
      for (const core::DeviceType& t : core::device_types()) {
        if (t.device == type.device && t.role == role)
          names += (names.empty() ? "" : ", ") + std::string(t.implementation);
      }
      fmt::print("  {:<22} {:<9} {}\n", type.device, role == hal::Role::Sensor ? "sensor" : "actuator", names);
    }
  }
}

void list_names(std::string_view title, const std::vector<std::string>& names) {
  fmt::print("{}:\n", title);
  for (const std::string& name : names) fmt::print("  {}\n", name);
}

void list_elements() {
  fmt::print("elements of experiment files:\n");
  for (const core::ElementManual& m : core::element_manuals(known_names())) fmt::print("  {:<22} {}\n", m.name, m.doc);
}

const std::map<std::string, std::function<void()>>& kinds() {
  static const std::map<std::string, std::function<void()>> all = {
      {"controllers", [] { list_plugins("controller", "controllers"); }},
      {"hooks", [] { list_plugins("hook", "hooks"); }},
      {"devices", &list_devices},
      {"engines", [] { list_names("physics engines", known_names().engine_names()); }},
      {"robots", [] { list_names("robots", known_names().robots); }},
      {"elements", &list_elements}};
  return all;
}

/// The port class behind a device name, for its fields.
void describe_fields(std::string_view name, hal::Role role) {
  for (const hal::PortType* port : all_port_types()) {
    if (port->name != name || port->role != role) continue;
    fmt::print("  what a controller {}: {}\n", role == hal::Role::Sensor ? "reads" : "writes", port->doc);
    for (const hal::Field& f : port->fields) {
      fmt::print("    {:<14} {}{}{}\n", f.name, f.doc, f.count > 1 ? fmt::format(", up to {}", f.count) : "",
                 f.unit.symbol.empty() ? "" : fmt::format(" [{}]", f.unit.symbol));
    }
  }
}

bool describe_device(const std::string& name) {
  bool found = false;
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    bool first = true;
    for (const core::DeviceType& type : core::device_types()) {
      if (type.device != name || type.role != role) continue;
      if (first) {
        fmt::print("{} <{}>\n", role == hal::Role::Sensor ? "sensor" : "actuator", name);
        describe_fields(name, role);
      }
      first = false;
      found = true;
      fmt::print("  implementation=\"{}\": {}\n", type.implementation, type.summary);
      core::ManualWriter manual;
      type.describe(manual);
      fmt::print("{}", manual.text());
    }
  }
  return found;
}

bool describe_plugin(const std::string& name) {
  const auto loader = open_all();
  bool found = false;
  for (const auto& entry : loader->entries()) {
    if (entry.name != name) continue;
    found = true;
    fmt::print("{} {}: {}\n  library: {}\n", entry.category, printable(name), printable(summary_of(entry)),
               entry.library);
    core::ManualWriter manual;
    if (entry.category == "controller")
      (void)static_cast<const hal::ControllerType*>(entry.type)->read_params(manual);
    else
      static_cast<const core::HookType*>(entry.type)->describe(manual);
    fmt::print("parameters:\n{}", manual.text().empty() ? "  none\n" : manual.text());
  }
  return found;
}

bool describe_physics_engine(const std::string& name) {
  const auto kinds = core::engine_kinds();
  if (std::find(kinds.begin(), kinds.end(), name) == kinds.end()) return false;
  const core::EngineTraits traits = core::engine_traits(name);
  fmt::print("<{}> in <physics_engines>: {}{}{}\n", name, core::engine_summary(name),
             traits.forces ? " Objects may be movable." : " Objects do not move.",
             traits.plane ? "" : " Robots may fly.");
  fmt::print("joints: {}\n", traits.joints == 0 ? "none" : core::words_of(traits.joints));
  core::ManualWriter manual;
  core::describe_engine(name, manual);
  fmt::print("{}", manual.text());
  return true;
}

/// Devices of this role that robots with this data sheet have: "a, b, c".
std::string devices_of(const hal::DataSheet& sheet, hal::Role role) {
  std::string all;
  std::string_view last;
  for (const core::DeviceType& type : core::device_types()) {
    if (type.role != role || type.device == last || !type.fits(sheet)) continue;
    last = type.device;
    all += (all.empty() ? "" : ", ") + std::string(type.device);
  }
  return all;
}

/// What a kind of robot is and has.
bool describe_robot(const std::string& name) {
  const hal::DataSheet* const sheet = core::data_sheet_of(name);
  if (sheet == nullptr) return false;
  const double cm = 100.0;
  fmt::print("robot <{}>: a disc of {:.3g} cm radius, {:.3g} cm high, {:.3g} kg\n", name, cm * sheet->body_radius_m,
             cm * sheet->body_height_m, sheet->mass_kg);
  if (sheet->wheel_base_m > 0.0) {
    fmt::print("  drives on two wheels {:.3g} cm apart, each up to {:.3g} cm/s\n", cm * sheet->wheel_base_m,
               cm * sheet->max_wheel_speed_m_s);
  }
  if (sheet->flies) {
    fmt::print("  flies up to {:.3g} m/s and turns up to {:.3g} rad/s; needs an engine in space: {}\n",
               sheet->max_flight_speed_m_s, sheet->max_flight_turn_rad_s,
               core::engines_that([](const core::EngineTraits& traits) { return !traits.plane; }));
  }
  fmt::print("  sensors: {}\n  actuators: {}\n", devices_of(*sheet, hal::Role::Sensor),
             devices_of(*sheet, hal::Role::Actuator));
  fmt::print("  in experiment files: <{} id=\"…\"><body position=\"x,y,z\"/><controller config=\"…\"/></{}>\n", name,
             name);
  return true;
}

bool describe_element(const std::string& name) {
  bool found = false;
  for (const core::ElementManual& m : core::element_manuals(known_names())) {
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

}  // namespace

int list(const std::string& kind) {
  if (kind.empty()) {
    for (const auto& [name, print] : kinds()) print();
    return kDone;
  }
  const auto found = kinds().find(kind);
  if (found == kinds().end()) {
    std::string all;
    for (const auto& [name, print] : kinds()) all += (all.empty() ? "" : ", ") + name;
    fmt::print(stderr, "tandem list: there is no kind '{}'; there are: {}\n", kind, all);
    return kWrongUsage;
  }
  found->second();
  return kDone;
}

int describe(const std::string& name) {
  const bool robot = describe_robot(name);
  const bool engine = describe_physics_engine(name);
  const bool element = describe_element(name);
  const bool device = describe_device(name);
  const bool plugin = describe_plugin(name);
  if (robot || engine || element || device || plugin) return kDone;
  std::vector<std::string> all;
  for (const core::ElementManual& m : core::element_manuals(known_names())) all.emplace_back(m.name);
  for (const core::DeviceType& t : core::device_types()) all.emplace_back(t.device);
  for (const std::string& kind : core::engine_kinds()) all.push_back(kind);
  for (const std::string& kind : core::robot_kinds()) all.push_back(kind);
  const auto loader = open_all();
  for (const auto& e : loader->entries()) all.push_back(e.name);
  const std::string near = core::closest(name, all);
  fmt::print(stderr, "tandem describe: there is nothing called '{}'{}. `tandem list` shows what there is.\n", name,
             near.empty() ? "" : "; did you mean '" + near + "'?");
  return kBadInput;
}

}  // namespace tandem::app
