#include "core/config/reader.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <set>

#include "core/config/overrides.hpp"
#include "core/config/schema.hpp"
#include "core/config/xml.hpp"

namespace tandem::core {
namespace schema {

bool parse_color(const std::string& text, std::array<std::uint8_t, 3>& rgb) {
  static const std::map<std::string, std::array<std::uint8_t, 3>> kNames = {
      {"black", {0, 0, 0}},      {"white", {255, 255, 255}}, {"red", {255, 0, 0}},       {"green", {0, 255, 0}},
      {"blue", {0, 0, 255}},     {"yellow", {255, 255, 0}},  {"magenta", {255, 0, 255}}, {"cyan", {0, 255, 255}},
      {"orange", {255, 140, 0}}, {"brown", {165, 42, 42}},   {"purple", {160, 32, 240}}, {"gray10", {26, 26, 26}},
      {"gray50", {128, 128, 128}}, {"gray90", {230, 230, 230}}};
  if (const auto named = kNames.find(text); named != kNames.end()) {
    rgb = named->second;
    return true;
  }
  const char* at = text.data();
  const char* end = text.data() + text.size();
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned value = 0;
    const auto [next, status] = std::from_chars(at, end, value);
    if (status != std::errc{} || value > 255 || (i < 2 ? next == end || *next != ',' : next != end)) return false;
    rgb[i] = static_cast<std::uint8_t>(value);
    at = next + 1;
  }
  return true;
}

}  // namespace schema

namespace {

namespace fs = std::filesystem;

/// Elements and what may stand in them. An empty list of children: none; "*": anything.
struct ElementSchema {
  std::string_view name, parent, doc;
  void (*describe)(hal::ParamVisitor&);
  std::vector<std::string> children;
};

template <class T>
void describe_of(hal::ParamVisitor& v) {
  T t;
  t.describe(v);
}

const std::vector<ElementSchema>& schemas() {
  using namespace schema;
  static const std::vector<std::string> kInArena = {"floor", "box", "cylinder", "light", "sound", "distribute", "e-puck"};
  static const std::vector<ElementSchema> all = {
      {"tandem", "", "An experiment. ARGoS' <argos-configuration> is the same.", &describe_of<None>,
       {"framework", "controllers", "arena", "physics_engines", "media", "visualization", "loop_functions", "record"}},
      {"framework", "tandem", "How the run goes.", &describe_of<None>, {"system", "experiment", "profiling", "time"}},
      {"system", "framework", "Threads.", &describe_of<System>, {}},
      {"experiment", "framework", "Length, tick and seed.", &describe_of<ExperimentAttributes>, {}},
      {"profiling", "framework", "Accepted for ARGoS files.", &describe_of<Profiling>, {}},
      {"time", "framework", "How the run is paced.", &describe_of<Time>, {}},
      {"controllers", "tandem", "Configurations of controllers; an element's name is the controller's registered name.", &describe_of<None>, {"*"}},
      {"controller", "controllers", "One configuration (written with the controller's own name).", &describe_of<Controller>,
       {"actuators", "sensors", "params"}},
      {"sensors", "controller", "The sensors that the controller may take.", &describe_of<None>, {"*"}},
      {"actuators", "controller", "The actuators that the controller may take.", &describe_of<None>, {"*"}},
      {"arena", "tandem", "The space and what is in it.", &describe_of<Arena>, kInArena},
      {"floor", "arena", "The floor's shade.", &describe_of<Floor>, {}},
      {"box", "arena", "A box.", &describe_of<Box>, {"body", "leds"}},
      {"cylinder", "arena", "A cylinder.", &describe_of<Cylinder>, {"body", "leds"}},
      {"light", "arena", "A lamp.", &describe_of<Light>, {}},
      {"sound", "arena", "A steady sound, for microphones.", &describe_of<Sound>, {}},
      {"e-puck", "arena", "An e-puck.", &describe_of<Robot>, {"body", "controller", "battery", "bridge", "tracker"}},
      {"body", "e-puck", "Where a thing starts.", &describe_of<Body>, {}},
      {"robot_controller", "e-puck", "Written <controller>: which configuration drives the robot.", &describe_of<RobotController>, {"params"}},
      {"battery", "e-puck", "How the battery discharges.", &describe_of<Battery>, {}},
      {"bridge", "e-puck", "Makes the robot stand for a real one on this link.", &describe_of<Bridge>, {}},
      {"tracker", "e-puck", "Where a real robot's pose comes from.", &describe_of<Tracker>, {}},
      {"distribute", "arena", "Places many of one entity, without overlap.", &describe_of<None>, {"position", "orientation", "entity"}},
      {"position", "distribute", "How positions are drawn.", &describe_of<Draw>, {}},
      {"orientation", "distribute", "How orientations are drawn.", &describe_of<Draw>, {}},
      {"entity", "distribute", "How many of the one entity inside.", &describe_of<EntityAttributes>, {"e-puck", "box", "cylinder", "light"}},
      {"physics_engines", "tandem", "What moves the bodies.", &describe_of<None>, {"*"}},
      {"kinematics2d", "physics_engines", "Wheels roll without slip; overlapping discs are pushed apart.", &describe_of<Engine>, {"boundaries"}},
      {"boundaries", "kinematics2d", "The region of the engine.", &describe_of<None>, {"top", "bottom", "sides"}},
      {"media", "tandem", "What carries signals.", &describe_of<None>, {"led", "range_and_bearing", "directional_led", "tag", "simple_radio"}},
      {"range_and_bearing", "media", "Carries situated messages.", &describe_of<Medium>, {}},
      {"led", "media", "Carries light of LEDs.", &describe_of<Medium>, {}},
      {"loop_functions", "tandem", "A hook: what the experiment does around the robots.", &describe_of<Hook>, {"*"}},
      {"record", "tandem", "What is written down.", &describe_of<None>, {"trajectory"}},
      {"trajectory", "record", "Poses of chosen robots, as CSV.", &describe_of<Trajectory>, {}},
      {"visualization", "tandem", "Views; those of ARGoS are left out with a warning.", &describe_of<None>, {"*"}}};
  return all;
}

const ElementSchema* schema_of(std::string_view name) {
  for (const ElementSchema& s : schemas()) {
    if (s.name == name) return &s;
  }
  return nullptr;
}

class Reader {
 public:
  Reader(Element root, const KnownNames& known, Problems& problems) : root_(std::move(root)), known_(known), problems_(problems) {}

  Scenario run() {
    out_.file = root_.file;
    out_.name = fs::path(root_.file).stem().string();
    if (root_.name != "tandem" && root_.name != "argos-configuration") {
      error(root_.line, "the root element is <" + root_.name + ">; an experiment starts with <tandem> or <argos-configuration>");
      return std::move(out_);
    }
    check_children(root_, "tandem");
    read<schema::None>(root_);
    once(root_, "framework", [&](Element& e) { framework(e); });
    if (root_.child("framework") == nullptr) warn_missing("framework", "ticks_per_second=10, endless");
    once(root_, "controllers", [&](Element& e) { controllers(e); });
    once(root_, "physics_engines", [&](Element& e) { engines(e); });
    if (root_.child("arena") == nullptr) error(root_.line, "there is no <arena>");
    once(root_, "arena", [&](Element& e) { arena(e); });
    once(root_, "media", [&](Element& e) { media(e); });
    for (Element& child : root_.children) {
      if (child.name == "loop_functions") hook(child);
    }
    once(root_, "visualization", [&](Element& e) { visualization(e); });
    once(root_, "record", [&](Element& e) { record(e); });
    check_ids();
    out_.effective = std::move(root_);
    return std::move(out_);
  }

 private:
  void error(int line, std::string message) { problems_.push_back({root_.file, line, std::move(message), false}); }
  void warn(int line, std::string message) { problems_.push_back({root_.file, line, std::move(message), true}); }
  void warn_missing(std::string_view what, std::string_view defaults) {
    warn(root_.line, "there is no <" + std::string(what) + ">: " + std::string(defaults));
  }

  /// Reads an element's attributes and fills in those left out.
  template <class T>
  T read(Element& element, T value = {}) {
    ElementReader reader(element, problems_);
    value.describe(reader);
    reader.finish();
    ElementWriter writer(element);
    value.describe(writer);
    return value;
  }

  void require(const Element& element, std::string_view attribute) {
    if (element.attribute(attribute) == nullptr) error(element.line, "<" + element.name + "> needs the attribute '" + std::string(attribute) + "'");
  }

  void check_children(const Element& element, std::string_view schema_name) {
    const ElementSchema* schema = schema_of(schema_name);
    if (schema == nullptr) return;
    std::vector<std::string> allowed = schema->children;
    if (!allowed.empty() && allowed.front() == "*") return;
    if (schema_name == "arena" || schema_name == "entity") allowed.insert(allowed.end(), known_.robots.begin(), known_.robots.end());
    for (const Element& child : element.children) {
      if (std::find(allowed.begin(), allowed.end(), child.name) != allowed.end()) continue;
      const std::string near = closest(child.name, allowed);
      std::string list;
      for (const std::string& a : allowed) {
        if (list.find(a) == std::string::npos) list += (list.empty() ? "" : ", ") + a;
      }
      error(child.line, "<" + element.name + "> cannot hold <" + child.name + ">" +
                            (!near.empty() ? ". Did you mean <" + near + ">?" : list.empty() ? "" : "; it may hold: " + list));
    }
  }

  /// Calls `use` for the only child of that name; a second one is an error.
  template <class Use>
  void once(Element& element, std::string_view name, Use&& use) {
    Element* first = nullptr;
    for (Element& child : element.children) {
      if (child.name != name) continue;
      if (first != nullptr) error(child.line, "a second <" + child.name + ">; the first is on line " + std::to_string(first->line));
      else first = &child;
    }
    if (first != nullptr) use(*first);
  }

  void framework(Element& e) {
    read<schema::None>(e);
    check_children(e, "framework");
    once(e, "system", [&](Element& c) {
      const auto s = read<schema::System>(c);
      out_.threads = s.threads;
      out_.assignment = s.method == "balance_length" || s.method == "dynamic" ? Assignment::Dynamic : Assignment::Static;
    });
    if (e.child("experiment") == nullptr) error(e.line, "<framework> needs an <experiment>, e.g. <experiment length=\"60\" ticks_per_second=\"10\"/>");
    once(e, "experiment", [&](Element& c) {
      const auto x = read<schema::ExperimentAttributes>(c);
      out_.length_s = x.length_s;
      out_.ticks_per_second = x.ticks_per_second;
      if (x.random_seed != 0) out_.seed = static_cast<std::uint64_t>(x.random_seed);
      if (x.real_time) out_.time_mode = TimeMode::Realtime;
    });
    once(e, "profiling", [&](Element& c) {
      read<schema::Profiling>(c);
      warn(c.line, "<profiling> is left out; times are in --report");
    });
    once(e, "time", [&](Element& c) {
      const std::string mode = read<schema::Time>(c).mode;
      out_.time_mode = mode == "realtime" ? TimeMode::Realtime : mode == "lockstep" ? TimeMode::Lockstep : TimeMode::Fast;
    });
  }

  void controllers(Element& e) {
    read<schema::None>(e);
    for (Element& c : e.children) {
      const auto attributes = read<schema::Controller>(c);
      check_children(c, "controller");
      require(c, "id");
      if (attributes.library.empty()) error(c.line, "<" + c.name + "> needs library=\"…\", the shared object that holds the controller");
      ControllerConfig config;
      config.id = attributes.id;
      config.library = attributes.library;
      config.label = c.name;
      config.line = c.line;
      once(c, "sensors", [&](Element& s) { devices(s, true, config.sensors); });
      once(c, "actuators", [&](Element& a) { devices(a, false, config.actuators); });
      config.params = params_of(c);
      if (find_controller(config.id)) error(c.line, "a second controller with id '" + config.id + "'");
      out_.controllers.push_back(std::move(config));
    }
  }

  static Element params_of(const Element& e) {
    if (const Element* given = e.child("params"); given != nullptr) return *given;
    Element none;
    none.name = "params";
    none.file = e.file;
    none.line = e.line;
    return none;
  }

  void devices(Element& list, bool sensors, std::vector<DeviceChoice>& choices) {
    read<schema::None>(list);
    const std::vector<std::string>& known = sensors ? known_.sensors : known_.actuators;
    for (Element& c : list.children) {
      DeviceChoice choice;
      choice.device = device_name(c.name, sensors);
      if (const std::string* implementation = c.attribute("implementation"); implementation != nullptr) choice.implementation = *implementation;
      else choice.implementation = "default";
      choice.options = c;
      if (std::find(known.begin(), known.end(), choice.device) == known.end()) {
        const std::string near = closest(choice.device, known);
        std::string all;
        for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
        error(c.line, std::string("unknown ") + (sensors ? "sensor" : "actuator") + " <" + c.name + ">" +
                          (near.empty() ? "; known: " + all : ". Did you mean <" + near + ">?"));
        continue;
      }
      for (const DeviceChoice& other : choices) {
        if (other.device == choice.device) error(c.line, "<" + c.name + "> is listed twice");
      }
      choices.push_back(std::move(choice));
    }
  }

  std::optional<std::size_t> find_controller(const std::string& id) const {
    for (std::size_t i = 0; i < out_.controllers.size(); ++i) {
      if (out_.controllers[i].id == id) return i;
    }
    return std::nullopt;
  }

  void engines(Element& e) {
    read<schema::None>(e);
    for (Element& c : e.children) {
      EngineConfig config;
      config.kind = c.name == "pointmass3d" ? "particle3d" : c.name;
      config.line = c.line;
      if (const std::string* id = c.attribute("id"); id != nullptr) config.id = *id;
      if (const std::string* regions = c.attribute("regions"); regions != nullptr) config.regions = *regions;
      config.options = c;
      if (std::find(known_.engines.begin(), known_.engines.end(), config.kind) == known_.engines.end()) {
        std::string all;
        for (const std::string& k : known_.engines) all += (all.empty() ? "" : ", ") + k;
        const std::string near = closest(config.kind, known_.engines);
        error(c.line, "unknown physics engine <" + c.name + ">; known: " + all + (near.empty() ? "" : ". Did you mean <" + near + ">?"));
        continue;
      }
      boundaries(c, config);
      out_.engines.push_back(std::move(config));
    }
  }

  struct Height {
    double height_m = 0.0;
    void describe(hal::ParamVisitor& v) { v.number("height", height_m, hal::unit::m, hal::kAny, "Height."); }
  };
  struct Vertex {
    std::string point, gate;
    void describe(hal::ParamVisitor& v) {
      v.text("point", point, "\"x,y\" in metres.");
      v.text("gate", gate, "Id of the engine behind the side that starts here.");
    }
  };

  void boundaries(Element& engine, EngineConfig& config) {
    once(engine, "boundaries", [&](Element& b) {
      read<schema::None>(b);
      check_children(b, "boundaries");
      once(b, "top", [&](Element& t) { config.top_m = read<Height>(t).height_m; });
      once(b, "bottom", [&](Element& t) { config.bottom_m = read<Height>(t).height_m; });
      once(b, "sides", [&](Element& sides) {
        for (Element& side : sides.children) {
          const auto vertex = read<Vertex>(side);
          BoundarySide out;
          out.line = side.line;
          out.gate = vertex.gate;
          const std::size_t comma = vertex.point.find(',');
          const auto x = hal::parse_quantity(vertex.point.substr(0, comma), hal::unit::m);
          const auto y = comma == std::string::npos ? hal::Result<double>(hal::Error{"no comma"})
                                                    : hal::parse_quantity(vertex.point.substr(comma + 1), hal::unit::m);
          if (!x.ok() || !y.ok()) {
            error(side.line, "<" + side.name + " point>: '" + vertex.point + "' must be two numbers, \"x,y\"");
            continue;
          }
          out.x_m = x.value();
          out.y_m = y.value();
          config.sides.push_back(out);
        }
        if (config.sides.size() < 3) error(sides.line, "<sides> needs at least three vertices");
      });
    });
  }

  void arena(Element& e) {
    require(e, "size");
    const auto a = read<schema::Arena>(e);
    check_children(e, "arena");
    out_.arena_size = a.size;
    out_.arena_center = a.center;
    out_.escape = a.escape == "stop" ? EscapePolicy::Stop : a.escape == "remove" ? EscapePolicy::Remove : EscapePolicy::Error;
    for (std::size_t i = 0; i < 2; ++i) {
      if (!(a.size[i] > 0.0) || a.size[i] > schema::kLargestArena_m) {
        error(e.line, "<arena size>: every length must be above 0 and at most 1000 km");
        break;
      }
    }
    for (Element& c : e.children) entity(c, nullptr);
    once(e, "floor", [&](Element& c) {
      const auto f = read<schema::Floor>(c);
      out_.floor.source = f.source;
      out_.floor.pixels_per_meter = f.pixels_per_meter;
      out_.floor.path = resolve(f.path);
      out_.floor.line = c.line;
      if (f.source == "image" && f.path.empty()) error(c.line, "<floor source=\"image\"> needs the attribute 'path'");
    });
  }

  std::string resolve(const std::string& path) const {
    if (path.empty() || fs::path(path).is_absolute() || fs::exists(path)) return path;
    return (fs::path(root_.file).parent_path() / path).string();
  }

  void entity(Element& e, const Distribute* distribute) {
    const auto set = [&](auto& item) {
      if (distribute != nullptr) item.distribute = *distribute;
    };
    if (e.name == "distribute") {
      if (distribute == nullptr) distribution(e);
    } else if (e.name == "box") {
      auto item = box(e);
      set(item);
      object(e, std::move(item));
    } else if (e.name == "cylinder") {
      auto item = cylinder(e);
      set(item);
      object(e, std::move(item));
    } else if (e.name == "light") {
      auto item = light(e);
      set(item);
      out_.lights.push_back(std::move(item));
    } else if (e.name == "sound") {
      require(e, "id");
      const auto s = read<schema::Sound>(e);
      out_.sounds.push_back({s.id, s.position, s.level, e.line});
    } else if (std::find(known_.robots.begin(), known_.robots.end(), e.name) != known_.robots.end()) {
      if (auto item = robot(e); item) {
        set(*item);
        out_.robots.push_back(std::move(*item));
      }
    }
  }

  Placement body(Element& e, bool distributed) {
    Placement placement;
    Element* given = nullptr;
    once(e, "body", [&](Element& b) { given = &b; });
    if (given == nullptr) {
      if (!distributed) error(e.line, "<" + e.name + "> needs a <body position=\"x,y,z\" orientation=\"z,y,x\"/>");
      return placement;
    }
    const auto b = read<schema::Body>(*given);
    placement.p_W = b.position;
    placement.yaw_rad = b.orientation[0];
    placement.pitch_rad = b.orientation[1];
    placement.roll_rad = b.orientation[2];
    return placement;
  }

  bool inside_distribute_ = false;

  ObjectItem box(Element& e) {
    require(e, "id");
    require(e, "size");
    const auto b = read<schema::Box>(e);
    check_children(e, "box");
    for (const double length : b.size) {
      if (length > 0.0 && length <= schema::kLargestArena_m) continue;
      error(e.line, "<box size>: every length must be above 0");
      break;
    }
    return {ShapeKind::Box, b.id, b.size, b.movable, b.mass_kg, body(e, inside_distribute_), {}, e.line};
  }

  ObjectItem cylinder(Element& e) {
    require(e, "id");
    require(e, "radius");
    require(e, "height");
    const auto c = read<schema::Cylinder>(e);
    check_children(e, "cylinder");
    return {ShapeKind::Cylinder, c.id, {c.radius_m, c.radius_m, c.height_m}, c.movable, c.mass_kg, body(e, inside_distribute_), {}, e.line};
  }

  void object(Element& e, ObjectItem item) {
    if (e.child("leds") != nullptr) warn(e.line, "the LEDs of <" + e.name + "> are left out: nothing here senses them");
    if (item.movable) {
      const bool moving = std::find(known_.engines.begin(), known_.engines.end(), "dynamics2d") != known_.engines.end();
      bool pushed = false;
      for (const EngineConfig& engine : out_.engines) pushed = pushed || engine.kind.starts_with("dynamics");
      if (!pushed) {
        error(e.line, "<" + e.name + " movable=\"true\">: kinematics2d moves no objects" +
                          std::string(moving ? "; use <dynamics2d>" : "; say movable=\"false\""));
      }
    }
    out_.objects.push_back(std::move(item));
  }

  LightItem light(Element& e) {
    require(e, "id");
    const auto l = read<schema::Light>(e);
    LightItem item;
    item.id = l.id;
    item.p_W = l.position;
    item.intensity = l.intensity;
    item.line = e.line;
    if (!schema::parse_color(l.color, item.rgb)) error(e.line, "<light color>: '" + l.color + "' is neither a colour's name nor \"r,g,b\"");
    return item;
  }

  std::optional<RobotItem> robot(Element& e) {
    require(e, "id");
    const auto r = read<schema::Robot>(e);
    check_children(e, "e-puck");
    RobotItem item;
    item.kind = e.name;
    item.id = r.id;
    item.rab_range_m = r.rab_range_m;
    item.rab_payload = r.rab_data_size;
    item.line = e.line;
    item.placement = body(e, inside_distribute_);
    bool good = false;
    if (e.child("controller") == nullptr) error(e.line, "<" + e.name + "> needs a <controller config=\"…\"/>");
    once(e, "controller", [&](Element& c) {
      const auto attributes = read<schema::RobotController>(c);
      check_children(c, "robot_controller");
      if (c.child("params") != nullptr) item.params = *c.child("params");
      const auto found = find_controller(attributes.config);
      if (!found) {
        std::vector<std::string> ids;
        std::string all;
        for (const ControllerConfig& config : out_.controllers) {
          ids.push_back(config.id);
          all += (all.empty() ? "" : ", ") + config.id;
        }
        const std::string near = closest(attributes.config, ids);
        error(c.line, "there is no controller with id '" + attributes.config + "'; there are: " + (all.empty() ? "none" : all) +
                          (near.empty() ? "" : ". Did you mean '" + near + "'?"));
        return;
      }
      item.controller = *found;
      good = true;
    });
    once(e, "battery", [&](Element& b) {
      const auto battery = read<schema::Battery>(b);
      item.battery = battery.c;
      if (battery.time_factor > 0.0) item.battery.delta = battery.time_factor;
      if (battery.pos_factor > 0.0) item.battery.pos_delta = battery.pos_factor;
      if (battery.orient_factor > 0.0) item.battery.orient_delta = battery.orient_factor;
      if (item.battery.start_charge > item.battery.full_charge) error(b.line, "<battery>: start_charge is above full_charge");
    });
    once(e, "bridge", [&](Element& b) {
      require(b, "link");
      const auto bridge = read<schema::Bridge>(b);
      item.bridge = BridgeConfig{bridge.link, bridge.firmware, bridge.timeout_s, b, b.line};
      if (inside_distribute_) error(b.line, "a <bridge> stands for one real robot; it cannot be distributed");
    });
    once(e, "tracker", [&](Element& t) { item.tracker = TrackerConfig{read<schema::Tracker>(t).source, t, t.line}; });
    if (!good) return std::nullopt;
    return item;
  }

  Distribution draw_of(Element& e, const hal::Unit& bare) {
    schema::Draw start;
    start.bare = bare;
    const std::string* method = e.attribute("method");
    if (method == nullptr) error(e.line, "<" + e.name + "> needs the attribute 'method': uniform, gaussian, constant or grid");
    ElementReader reader(e, problems_);
    start.describe(reader);
    reader.finish();
    Distribution d;
    d.line = e.line;
    const auto needs = [&](std::initializer_list<std::string_view> names) {
      for (const std::string_view name : names) require(e, name);
    };
    if (start.method == "uniform") {
      d.method = Distribution::Method::Uniform;
      needs({"min", "max"});
      for (std::size_t i = 0; i < 3; ++i) {
        if (start.min[i] > start.max[i]) {
          error(e.line, "<" + e.name + ">: min is above max in its " + std::array<std::string, 3>{"first", "second", "third"}[i] + " number");
        }
      }
    } else if (start.method == "gaussian") {
      d.method = Distribution::Method::Gaussian;
      needs({"mean", "std_dev"});
      for (const double s : start.std_dev) {
        if (s < 0.0) error(e.line, "<" + e.name + ">: std_dev is negative");
      }
    } else if (start.method == "grid") {
      d.method = Distribution::Method::Grid;
      needs({"center", "distances", "layout"});
    } else {
      needs({"values"});
    }
    d.min = start.min;
    d.max = start.max;
    d.mean = start.mean;
    d.std_dev = start.std_dev;
    d.values = start.values;
    d.center = start.center;
    d.distances = start.distances;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(start.layout[i] >= 1.0) || start.layout[i] > 1e6 || start.layout[i] != static_cast<double>(static_cast<int>(start.layout[i]))) {
        error(e.line, "<" + e.name + " layout>: each must be a whole number from 1");
        return d;
      }
      d.layout[i] = static_cast<int>(start.layout[i]);
    }
    return d;
  }

  void distribution(Element& e) {
    read<schema::None>(e);
    check_children(e, "distribute");
    Distribute d;
    d.line = e.line;
    for (const std::string_view needed : {"position", "orientation", "entity"}) {
      if (e.child(needed) == nullptr) error(e.line, "<distribute> needs a <" + std::string(needed) + ">");
    }
    once(e, "position", [&](Element& c) { d.position = draw_of(c, hal::unit::m); });
    once(e, "orientation", [&](Element& c) { d.orientation = draw_of(c, hal::unit::deg); });
    once(e, "entity", [&](Element& c) {
      const auto attributes = read<schema::EntityAttributes>(c);
      check_children(c, "entity");
      d.quantity = attributes.quantity;
      d.max_trials = attributes.max_trials;
      d.base_num = attributes.base_num;
      if (c.children.size() != 1) {
        error(c.line, "<entity> needs exactly one robot, box, cylinder or light inside");
        return;
      }
      if (d.position.method == Distribution::Method::Grid) {
        const std::int64_t places = std::int64_t{1} * d.position.layout[0] * d.position.layout[1] * d.position.layout[2];
        if (d.quantity > places) {
          error(c.line, "<entity quantity=\"" + std::to_string(d.quantity) + "\">: the grid has only " + std::to_string(places) + " places");
        }
      }
      inside_distribute_ = true;
      entity(c.children.front(), &d);
      inside_distribute_ = false;
    });
  }

  void media(Element& e) {
    read<schema::None>(e);
    check_children(e, "media");
    for (Element& c : e.children) {
      const auto medium = read<schema::Medium>(c);
      out_.media.push_back({c.name, medium.id, c, c.line});
    }
  }

  void hook(Element& e) {
    HookConfig config;
    if (const std::string* library = e.attribute("library"); library != nullptr) config.library = *library;
    if (const std::string* label = e.attribute("label"); label != nullptr) config.label = *label;
    if (config.library.empty()) error(e.line, "<loop_functions> needs the attribute 'library'");
    config.options = e;
    config.line = e.line;
    out_.hooks.push_back(std::move(config));
  }

  void visualization(Element& e) {
    for (const Element& c : e.children) {
      warn(c.line, "<" + c.name + "> is left out: that view does not exist here; use --picture");
      if (const Element* camera = c.child("camera"); camera != nullptr) out_.camera = *camera;
    }
  }

  void record(Element& e) {
    read<schema::None>(e);
    check_children(e, "record");
    once(e, "trajectory", [&](Element& t) {
      require(t, "path");
      const auto trajectory = read<schema::Trajectory>(t);
      TrajectoryConfig config;
      config.path = trajectory.path;
      config.every = trajectory.every;
      for (std::size_t at = 0; at <= trajectory.entities.size();) {
        const std::size_t comma = std::min(trajectory.entities.find(',', at), trajectory.entities.size());
        config.entities.push_back(trajectory.entities.substr(at, comma - at));
        at = comma + 1;
      }
      out_.trajectory = std::move(config);
    });
  }

  /// No two things may have one id; a distributed item's ids are its prefix and a number.
  void check_ids() {
    std::map<std::string, int> seen;
    const auto claim = [&](const std::string& id, int line, const char* what) {
      if (id.empty()) return;
      const auto [at, fresh] = seen.emplace(id, line);
      if (!fresh) error(line, std::string("a second ") + what + " with id '" + id + "'; the first is on line " + std::to_string(at->second));
    };
    for (const RobotItem& r : out_.robots) claim(r.id, r.line, "robot");
    seen.clear();
    for (const ObjectItem& o : out_.objects) claim(o.id, o.line, "object");
    for (const RobotItem& r : out_.robots) {
      if (!r.distribute) continue;
      for (const RobotItem& other : out_.robots) {
        if (other.distribute || !other.id.starts_with(r.id) || other.id == r.id) continue;
        std::int64_t number = 0;
        const char* end = other.id.data() + other.id.size();
        const auto [at, status] = std::from_chars(other.id.data() + r.id.size(), end, number);
        if (status == std::errc{} && at == end && number >= r.distribute->base_num && number < r.distribute->base_num + r.distribute->quantity) {
          error(other.line, "the id '" + other.id + "' is also one of the distributed robots '" + r.id + "…' of line " + std::to_string(r.line));
        }
      }
    }
  }

  Element root_;
  const KnownNames& known_;
  Problems& problems_;
  Scenario out_;
};

std::optional<Scenario> read_root(std::optional<Element> root, const std::vector<std::string>& overrides, const KnownNames& known, Problems& problems) {
  if (!root) return std::nullopt;
  const std::size_t before = problems.size();
  for (const std::string& assignment : overrides) apply_override(*root, assignment, problems);
  Scenario scenario = Reader(std::move(*root), known, problems).run();
  if (has_errors(Problems(problems.begin() + static_cast<std::ptrdiff_t>(before), problems.end()))) return std::nullopt;
  return scenario;
}

}  // namespace

std::optional<Scenario> read_experiment(const std::string& path, const std::vector<std::string>& overrides, const KnownNames& known,
                                        Problems& problems) {
  return read_root(read_xml_file(path, problems), overrides, known, problems);
}

std::optional<Scenario> read_experiment_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                                             const KnownNames& known, Problems& problems) {
  return read_root(read_xml_text(text, name, problems), overrides, known, problems);
}

std::string device_name(std::string_view argos_name, bool sensor) {
  if (argos_name == "differential_steering") return sensor ? "wheel_encoders" : "differential_steering";
  if (argos_name == "epuck_leds") return "leds";
  for (const std::string_view prefix : {"epuck_", "footbot_", "eyebot_"}) {
    if (!argos_name.starts_with(prefix)) continue;
    const std::string_view rest = argos_name.substr(prefix.size());
    if (rest == "proximity" || rest == "light" || rest == "ground" || rest == "encoder") return rest == "encoder" ? "wheel_encoders" : std::string(rest);
    if (rest == "base_ground" || rest == "motor_ground") return "ground";
  }
  return std::string(argos_name);
}

std::vector<ElementManual> element_manuals() {
  std::vector<ElementManual> manuals;
  for (const ElementSchema& s : schemas()) {
    ManualWriter writer;
    s.describe(writer);
    manuals.push_back({s.name, s.parent, s.doc, writer.text(), s.children});
  }
  return manuals;
}

}  // namespace tandem::core
