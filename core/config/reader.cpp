#include "core/config/reader.hpp"

#include <filesystem>
#include <map>
#include <tuple>

#include "core/config/fitted.hpp"
#include "core/config/kinds.hpp"
#include "core/config/overrides.hpp"
#include "core/config/reading.hpp"
#include "core/config/upgrade.hpp"
#include "hal/xml/xml.hpp"

namespace tandem::core {
namespace {

/// What follows the kind of robot that ARGoS' name of a device begins with; empty where it begins with none.
std::string_view without_robot(std::string_view argos_name, const hal::Catalog& catalog) {
  for (std::string kind : catalog.names(hal::RobotKind::kCategory)) {
    std::erase(kind, '-');
    if (argos_name.starts_with(kind + "_")) return argos_name.substr(kind.size() + 1);
  }
  return {};
}

/// ARGoS drops no message and no blob: the device with more room is there, too.
void add_grown(const hal::Catalog& catalog, const std::string& device, hal::Role role,
               std::vector<DeviceChoice>& choices) {
  for (const hal::PortType* port : catalog.all<hal::PortType>()) {
    if (port->role != role || port->grows != device) continue;
    DeviceChoice grown = choices.back();
    grown.device = port->name;
    grown.grown = true;
    choices.push_back(std::move(grown));
  }
}

void read_devices(Reading& reading, Element& list, bool sensors, std::vector<DeviceChoice>& choices) {
  const std::vector<std::string>& known = sensors ? reading.known().sensors : reading.known().actuators;
  std::map<std::string, int> lines;
  for (Element& e : list.children) {
    DeviceChoice choice;
    choice.device = device_name(e.name, sensors ? hal::Role::Sensor : hal::Role::Actuator, reading.catalog());
    if (e.attribute("implementation") == nullptr) e.attributes.push_back({"implementation", "default", 0});
    choice.implementation = *e.attribute("implementation");
    choice.options = e;
    if (std::find(known.begin(), known.end(), choice.device) == known.end()) {
      const std::string what = sensors ? "sensor" : "actuator";
      // A robot's name would hide what was meant where the rest is misspelt.
      const std::string_view bare = without_robot(e.name, reading.catalog());
      reading.error(e, "unknown " + what + " <" + e.name + ">; known: " + listed(known) +
                           did_you_mean(bare.empty() ? choice.device : std::string(bare), known));
      continue;
    }
    const auto [first, fresh] = lines.emplace(choice.device, e.line);
    if (!fresh) {
      reading.unread(e, "<" + e.name + ">: the device '" + choice.device + "' is already on line " +
                            std::to_string(first->second));
      std::erase_if(choices, [&](const DeviceChoice& other) {
        const auto* const port = reading.catalog().find<hal::PortType>(
            hal::port_entry(other.device, sensors ? hal::Role::Sensor : hal::Role::Actuator));
        return other.device == choice.device || (other.grown && port->grows == choice.device);
      });
    }
    const std::string device = choice.device;
    choices.push_back(std::move(choice));
    if (e.argos) add_grown(reading.catalog(), device, sensors ? hal::Role::Sensor : hal::Role::Actuator, choices);
  }
}

void read_configuration(Reading& reading, Element& e) {
  const auto attributes = reading.read<schema::Configuration>(e);
  ControllerConfig config;
  config.id = attributes.id;
  config.library = attributes.library.empty() ? e.name : attributes.library;
  config.label = e.name;
  config.line = e.line;
  config.params.name = "params";
  config.params.file = e.file;
  config.params.line = e.line;
  config.params.argos = e.argos;
  reading.once(e, "sensors", [&](Element& c) {
    reading.read<schema::Sensors>(c);
    read_devices(reading, c, true, config.sensors);
  });
  reading.once(e, "actuators", [&](Element& c) {
    reading.read<schema::Actuators>(c);
    read_devices(reading, c, false, config.actuators);
  });
  reading.once(e, "params", [&](const Element& c) { config.params = c; });
  reading.out().controllers.push_back(std::move(config));
}

/// The children that are of a type of the catalog, read as it describes them.
template <class Schema, class Type>
void read_named(Reading& reading, Element& parent, std::vector<Element>& out) {
  for (Element& e : parent.children) {
    const auto* const type = reading.catalog().find<Type>(e.name);
    if (type == nullptr) continue;  // told already, or of no type
    if (type->describe == nullptr)
      reading.read<Schema>(e);
    else
      reading.read_with<Schema>(e, type->describe);
    out.push_back(e);
  }
}

/// Nobody waits for a simulated robot.
void check_priority(Reading& reading, Element& root) {
  const std::vector<RobotItem>& robots = reading.out().robots;
  if (reading.out().priority == 0 || std::any_of(robots.begin(), robots.end(), [](const auto& r) { return r.bridge; }))
    return;
  reading.warn(*root.child("framework")->child("time"), "'priority' has no effect: no robot has a <bridge>");
}

/// A run waits for peers in lock-step alone, and for nothing else there.
void check_peers(Reading& reading, Element& root) {
  Scenario& out = reading.out();
  const Element* const framework = root.child("framework");
  const Element* const time = framework == nullptr ? nullptr : framework->child("time");
  if (time == nullptr) return;  // told already
  const auto at = [&](int line) {
    Element e = *time;
    e.line = line;
    return e;
  };
  const bool lockstep = out.time_mode == TimeMode::Lockstep;
  bool any = false;
  for (RobotItem& item : out.robots) {
    any = any || item.peer.has_value();
    if (item.peer && !lockstep) {
      reading.warn(
          at(item.peer->line),
          "<peer> has no effect: only <time mode=\"lockstep\"/> waits for peers; robot '" + item.id + "' is simulated");
      item.peer.reset();
    } else if (lockstep && item.bridge) {
      reading.error(at(item.bridge->line),
                    "robot '" + item.id +
                        "': a real robot's time goes on while others are waited for; in lock-step there are no "
                        "<bridge>s: take <peer link=\"emulated:…\"/>, or <time mode=\"realtime\"/>");
    }
  }
  if (lockstep && !any)
    reading.error(*time, "mode", "'lockstep' has nobody to wait for: give a robot a <peer/>, or use fast");
}

Scenario read_parts(Reading& reading, Element& root) {
  reading.out().file = root.file;
  reading.out().name = std::filesystem::path(root.file).stem().string();
  if (root.name == schema::Kinds::kElement.name) {
    reading.error(root, "this is a file of kinds of robots; an experiment takes it with <kinds file=\"" +
                            std::filesystem::path(root.file).filename().string() + "\"/>");
    return std::move(reading.out());
  }
  if (root.name != "tandem" && root.name != hal::kArgosRoot) {
    reading.error(
        root, "the root element is <" + root.name + ">; an experiment starts with <tandem> or <argos-configuration>");
    return std::move(reading.out());
  }
  if (const std::string why = version_problem(reading.read<schema::Root>(root).version); !why.empty()) {
    reading.error(root, "version", why);
    return std::move(reading.out());
  }
  if (root.child("framework") == nullptr) {
    reading.error(
        root,
        "there is no <framework>; add <framework><experiment length=\"60\" ticks_per_second=\"10\"/></framework>");
  }
  if (root.child("arena") == nullptr) reading.error(root, "there is no <arena>; add <arena size=\"4,4,1\">…</arena>");
  reading.once(root, "framework", [&](Element& e) { read_framework(reading, e); });
  reading.once(root, "controllers", [&](Element& e) { read_controllers(reading, e); });
  reading.once_or_default(root, "physics_engines", [&](Element& e) { read_engines(reading, e); });
  reading.once(root, "media", [&](Element& e) { read_media(reading, e); });
  reading.once(root, "fitted", [&](Element& e) { read_fitted(reading, e); });
  reading.once(root, "arena", [&](Element& e) { read_arena(reading, e); });
  reading.once(root, "trackers", [&](Element& e) { read_trackers(reading, e); });
  reading.once(root, "safety", [&](Element& e) { read_safety(reading, e); });
  reading.once(root, "desk", [&](Element& e) { read_desk(reading, e); });
  for (Element& e : root.children) {
    if (e.name == "loop_functions") read_hook(reading, e);
    if (e.name == "plugins") reading.out().plugins.push_back({reading.read<schema::Plugins>(e).library, e.line});
  }
  reading.once(root, "record", [&](Element& e) { read_record(reading, e); });
  reading.once(root, "run", [&](Element& e) {
    reading.read<schema::RunParts>(e);
    read_named<schema::RunPartElement, RunPartType>(reading, e, reading.out().run_parts);
  });
  reading.once(root, "visualization", [&](Element& e) { read_visualization(reading, e); });
  connect_media(reading);
  check_ids(reading);
  check_priority(reading, root);
  check_peers(reading, root);
  return std::move(reading.out());
}

ExperimentFile opened(Element root, const std::vector<std::string>& overrides, Problems found) {
  ExperimentFile file{std::move(root), std::move(found)};
  include_kinds(file.root, file.problems);
  for (const std::string& assignment : overrides) apply_override(file.root, assignment, file.problems);
  include_fitted(file.root, file.problems);
  return file;
}

/// Hands what was found on, in the order of the file; first what is in files that it includes.
void report(Problems found, const std::string& file, Problems& problems) {
  const auto place = [&](const Problem& p) { return std::tuple(p.line > 0, p.file == file, p.line); };
  std::stable_sort(found.begin(), found.end(), [&](const Problem& a, const Problem& b) { return place(a) < place(b); });
  count_ignored(found);
  problems.insert(problems.end(), found.begin(), found.end());
}

}  // namespace

void read_framework(Reading& reading, Element& e) {
  Scenario& out = reading.out();
  reading.read<schema::Framework>(e);
  reading.once_or_default(e, "system", [&](Element& c) {
    const auto s = reading.read<schema::System>(c);
    out.threads = s.threads;
    out.assignment = s.method == "balance_length" || s.method == "dynamic" ? Assignment::Dynamic : Assignment::Static;
  });
  if (e.child("experiment") == nullptr) {
    reading.error(e, "<framework> needs an <experiment>, e.g. <experiment length=\"60\" ticks_per_second=\"10\"/>");
  }
  bool real_time = false;
  reading.once(e, "experiment", [&](Element& c) {
    const auto x = reading.read<schema::Experiment>(c);
    out.length_s = x.length_s;
    out.ticks_per_second = x.ticks_per_second;
    if (x.random_seed != 0) out.seed = static_cast<std::uint64_t>(x.random_seed);
    real_time = x.real_time;
  });
  reading.once_or_default(e, "time", [&](Element& c) {
    const bool said = c.attribute("mode") != nullptr;
    schema::Time start;
    if (real_time) start.mode = "realtime";
    const schema::Time time = reading.read(c, start);
    const std::string& mode = time.mode;
    out.time_mode = mode == "realtime" ? TimeMode::Realtime : mode == "lockstep" ? TimeMode::Lockstep : TimeMode::Fast;
    const auto peers = [&](Element& p) {
      const auto read = reading.read<schema::Peers>(p);
      out.lockstep = {read.listen, read.timeout_s, read.missing == "simulate", read.controllers == "any", p.line};
    };
    if (out.time_mode == TimeMode::Lockstep)
      reading.once_or_default(c, "peers", peers);
    else
      reading.once(c, "peers", peers);
    out.priority = static_cast<int>(time.priority);
    if (said && real_time && mode != "realtime")
      reading.error(c, "mode", "'" + mode + "' contradicts <experiment real_time=\"true\">; drop one of them");
  });
  reading.once(e, "profiling", [&](Element& c) {
    reading.read<schema::Profiling>(c);
    reading.warn(c, "<profiling> is left out; times are in --report");
  });
}

void read_controllers(Reading& reading, Element& controllers) {
  reading.read<schema::Controllers>(controllers);
  std::map<std::string, int> lines;
  for (Element& e : controllers.children) {
    read_configuration(reading, e);
    const std::string* id = e.attribute("id");
    if (id == nullptr) continue;
    const auto [first, fresh] = lines.emplace(*id, e.line);
    if (!fresh)
      reading.error(e, "id",
                    "a second controller '" + *id + "'; the first is on line " + std::to_string(first->second));
  }
}

void read_hook(Reading& reading, Element& e) {
  const auto attributes = reading.read_open<schema::Hook>(e);
  reading.out().hooks.push_back({attributes.library, attributes.label, e, e.line});
}

/// The words of a list with commas. Empty, and told: one of them is empty.
std::vector<std::string> read_list(Reading& reading, Element& e, const char* attribute, const std::string& text,
                                   const char* what) {
  std::vector<std::string> words;
  std::string word;
  for (const char c : text + ",") {
    if (c != ',') {
      if (c != ' ') word += c;
    } else if (word.empty()) {
      reading.error(e, attribute, "'" + text + "' must be " + what + " separated by commas");
      return {};
    } else {
      words.push_back(std::exchange(word, {}));
    }
  }
  return words;
}

void read_record(Reading& reading, Element& record) {
  const auto r = reading.read<schema::Record>(record);
  RecordConfig& config = reading.out().record;
  config.path = r.path;
  config.every = r.every;
  config.entities = read_list(reading, record, "entities", r.entities, "ids");
  config.state = r.state;
  config.look = r.look;
  config.inputs = r.inputs;
  config.fingerprint_every = r.fingerprint_every;
  if (!r.ports.empty()) config.ports = read_list(reading, record, "ports", r.ports, "names of ports");
  reading.once(record, "trajectory", [&](Element& e) {
    const auto t = reading.read<schema::Trajectory>(e);
    reading.out().trajectory = TrajectoryConfig{t.path, read_list(reading, e, "entities", t.entities, "ids"), t.every};
  });
  read_named<schema::ObserverElement, ObserverType>(reading, record, reading.out().observers);
}

void read_visualization(Reading& reading, Element& visualization) {
  for (const Element& e : visualization.children) {
    const Element* camera = e.child("camera");
    if (camera != nullptr) reading.out().camera = *camera;
    const Element* drawing = e.child("user_functions");
    const std::string *library = nullptr, *label = nullptr;
    if (drawing != nullptr && e.name == "qt-opengl") {
      library = drawing->attribute("library");
      label = drawing->attribute("label");
    }
    if (label != nullptr)
      reading.out().hooks.push_back(
          {library == nullptr ? std::string() : *library, "qt-opengl " + *label, *drawing, drawing->line, true});
    reading.warn(e, "<" + e.name + "> is left out: there is no such view here" +
                        (camera != nullptr ? "; its camera placements are kept" : "") +
                        (label != nullptr ? "; its user functions draw into the window and into pictures" : ""));
  }
}

std::optional<ExperimentFile> open_experiment(const std::string& path, const std::vector<std::string>& overrides,
                                              Problems& problems) {
  Problems found;
  auto root = hal::read_xml_file(path, found);
  if (root) return opened(std::move(*root), overrides, std::move(found));
  report(std::move(found), path, problems);
  return std::nullopt;
}

std::optional<ExperimentFile> open_experiment_text(const std::string& text, const std::string& name,
                                                   const std::vector<std::string>& overrides, Problems& problems) {
  Problems found;
  auto root = hal::read_xml_text(text, name, found);
  if (root) return opened(std::move(*root), overrides, std::move(found));
  report(std::move(found), name, problems);
  return std::nullopt;
}

std::vector<PluginConfig> plugins_of(const Element& root) {
  std::vector<PluginConfig> plugins;
  for (const Element& e : root.children) {
    const std::string* const library = e.attribute("library");
    if (e.name == schema::Plugins::kElement.name && library != nullptr) plugins.push_back({*library, e.line});
  }
  return plugins;
}

bool names_real_robots(const Element& root, const std::vector<std::string>& without) {
  const std::string* const id = root.attribute("id");
  const bool left_out = id != nullptr && std::find(without.begin(), without.end(), *id) != without.end();
  return std::any_of(root.children.begin(), root.children.end(), [&](const Element& e) {
    return e.name == schema::Bridge::kElement.name ? !left_out : names_real_robots(e, without);
  });
}

std::optional<Scenario> read_experiment(ExperimentFile file, const hal::Catalog& catalog, Problems& problems) {
  Problems found = std::move(file.problems);
  std::vector<KindConfig> kinds = read_kinds(file.root, catalog, found);
  const hal::Catalog with = kinds.empty() ? hal::Catalog() : with_kinds(catalog, kinds);
  Reading reading(kinds.empty() ? catalog : with, found);
  reading.out().kinds = std::move(kinds);
  std::optional<Scenario> scenario = read_parts(reading, file.root);
  const std::string path = file.root.file;
  scenario->effective = std::move(file.root);
  if (has_errors(found)) scenario.reset();
  report(std::move(found), path, problems);
  return scenario;
}

std::optional<Scenario> read_experiment(const std::string& path, const std::vector<std::string>& overrides,
                                        const hal::Catalog& catalog, Problems& problems) {
  auto file = open_experiment(path, overrides, problems);
  return file ? read_experiment(std::move(*file), catalog, problems) : std::nullopt;
}

std::optional<Scenario> read_experiment_text(const std::string& text, const std::string& name,
                                             const std::vector<std::string>& overrides, const hal::Catalog& catalog,
                                             Problems& problems) {
  auto file = open_experiment_text(text, name, overrides, problems);
  return file ? read_experiment(std::move(*file), catalog, problems) : std::nullopt;
}

std::string effective_settings(const Scenario& scenario) {
  return hal::to_xml(scenario.effective);
}

std::string device_name(std::string_view argos_name, hal::Role role, const hal::Catalog& catalog) {
  const bool sensor = role == hal::Role::Sensor;
  if (catalog.find<hal::PortType>(hal::port_entry(argos_name, role)) != nullptr) return std::string(argos_name);
  if (argos_name == "differential_steering" && sensor) return "wheel_encoders";
  if (argos_name == "colored_blob_omnidirectional_camera") return "omnidirectional_camera";
  if (argos_name == "colored_blob_perspective_camera") return "perspective_camera";
  const std::string_view bare = without_robot(argos_name, catalog);
  if (bare.empty()) return std::string(argos_name);
  if (bare == "encoder" && sensor) return "wheel_encoders";
  // As a plug-in of ARGoS names them.
  if (bare == "wheels") return sensor ? "wheel_encoders" : "differential_steering";
  if (!sensor && (bare == "rgb_leds" || bare == "base_leds")) return "leds";
  return std::string(catalog.find<hal::PortType>(hal::port_entry(bare, role)) != nullptr ? bare : argos_name);
}

}  // namespace tandem::core
