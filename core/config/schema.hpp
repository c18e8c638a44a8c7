// Every element of an experiment file, described once: what it is, what it must have, what may stand in it, and each of
// its attributes. Reading, checking, defaults and the manual all come from these descriptions.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/config/schema_element.hpp"
#include "core/config/schema_real.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core::schema {

struct Root {
  static constexpr ElementInfo kElement{
      "tandem",
      "An experiment. Under the name <argos-configuration> it is one of ARGoS 3: what nothing reads is a warning, and "
      "some "
      "defaults are ARGoS' (docs/from-argos.md).",
      "",
      "plugins kinds fitted framework controllers arena trackers safety desk physics_engines "
      "media visualization loop_functions record run"};
  std::int64_t version = 0;
  void describe(ParamVisitor& v) {
    v.integer("version", version, {0, 999'999'999},
              "Of the vocabulary that the file is written in; `tandem upgrade` brings it to this program's. Left out "
              "or 0: of before there were versions, or one of ARGoS'.");
  }
};

struct Plugins {
  static constexpr ElementInfo kElement{
      "plugins", "A library with parts for this experiment: devices, robots, engines, bridges, …", "library"};
  std::string library;
  void describe(ParamVisitor& v) {
    v.text("library", library, "Shared object; folder, prefix and extension may be left out.");
  }
};

struct Kinds {
  static constexpr ElementInfo kElement{
      "kinds", "Kinds of robots that the file gives. Also the root of a file that holds nothing else.", "",
      "kind kinds"};
  std::string file;
  std::int64_t version = 0;
  void describe(ParamVisitor& v) {
    v.text("file", file, "Takes all kinds of that file instead; looked for in the folder of this one.");
    v.integer("version", version, {0, 999'999'999}, "Of the vocabulary, as that of an experiment.");
  }
};

struct Kind {
  static constexpr ElementInfo kElement{
      "kind",
      "A kind of robot: <body>, a drive, and parts, which `tandem list parts` names. Then <NAME> is such a robot.",
      "name", kAnything};
  std::string name, like, without, summary, bridge;
  void describe(ParamVisitor& v) {
    v.text("name", name, "Of the element of such robots.");
    v.text("like", like, "The kind whose facts hold where this one says nothing.");
    v.text("without", without, "Parts of that kind that it does not have, separated by spaces.");
    v.text("summary", summary, "What it is, for people.");
    v.text(
        "bridge", bridge,
        "The kind whose bridge drives real ones; left out: that of the kind that it is like, or one of its own name.");
  }
};

struct Fitted {
  static constexpr ElementInfo kElement{
      "fitted",
      "Parameters that were fitted to real robots, for simulated ones of their kinds. Also the root of a file that "
      "`tandem fit` writes.",
      "", "model"};
  std::string file;
  std::int64_t reality = 0;
  std::int64_t version = 0;
  void describe(ParamVisitor& v) {
    v.text("file", file, "Takes what that file holds; looked for in the folder of this one.");
    v.integer("reality", reality, {0, 999'999'999},
              "Number of a pseudo-reality: robots are then drawn from what was measured. 0: as measured.");
    v.integer("version", version, {0, 999'999'999}, "Of the vocabulary, as that of an experiment.");
  }
};

struct FittedModel {
  static constexpr ElementInfo kElement{
      "model", "What was fitted to robots of one kind: <fitted_wheels>, <fitted_proximity>.", "kind", kAnything};
  std::string kind;
  void describe(ParamVisitor& v) { v.text("kind", kind, "Of the robots that it holds for."); }
};

struct Framework : Bare {
  static constexpr ElementInfo kElement{"framework", "How the run goes.", "", "system experiment profiling time"};
};

struct System {
  static constexpr ElementInfo kElement{"system", "Threads."};
  std::int64_t threads = 0;
  std::string method = "balance_quantity";
  bool pin_threads_to_cores = false;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 4> kMethods = {"balance_quantity", "balance_length", "static",
                                                                 "dynamic"};
    v.integer("threads", threads, {0, 1024},
              "Threads that step the world; 0 and 1: the caller alone. Results do not depend on it.");
    v.choice("method", method, kMethods,
             "balance_quantity or static: work is split in advance. balance_length or dynamic: handed out.");
    v.flag("pin_threads_to_cores", pin_threads_to_cores, "Accepted for ARGoS files; the system places threads.");
  }
};

struct Experiment {
  static constexpr ElementInfo kElement{"experiment", "Length, tick and seed."};
  double length_s = 0.0;
  std::int64_t ticks_per_second = 10;
  std::int64_t random_seed = 0;
  bool real_time = false;
  std::string visualization;
  void describe(ParamVisitor& v) {
    v.number("length", length_s, unit::s, {0.0, 1e9}, "Virtual duration; 0: until interrupted or a hook ends it.");
    v.integer("ticks_per_second", ticks_per_second, {1, 100000}, "Control steps a virtual second.");
    v.integer("random_seed", random_seed, {0, 9.2e18},
              "Seed of all chance; 0: from the clock, and named in the report.");
    v.flag("real_time", real_time, "The same as <time mode=\"realtime\"/>.");
    v.text("visualization", visualization, "Accepted for ARGoS files.");
  }
};

struct Profiling {
  static constexpr ElementInfo kElement{"profiling", "Accepted for ARGoS files; left out."};
  std::string file, format = "human_readable";
  bool truncate_file = true;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kFormats = {"human_readable", "table"};
    v.text("file", file, "Accepted for ARGoS files; figures are in --report.");
    v.choice("format", format, kFormats, "Accepted for ARGoS files.");
    v.flag("truncate_file", truncate_file, "Accepted for ARGoS files.");
  }
};

struct Time {
  static constexpr ElementInfo kElement{"time", "How the run is paced.", "", "peers"};
  std::string mode = "fast";
  std::int64_t priority = 0;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kModes = {"fast", "realtime", "lockstep"};
    v.choice("mode", mode, kModes,
             "fast: as fast as possible; realtime: paced by absolute time; lockstep: as fast as the robots with a "
             "<peer> answer.");
    v.integer("priority", priority, {0, 99},
              "Real-time priority (SCHED_FIFO, 1 to 99) of the thread that steps a run with real robots; 0: none.");
  }
};

struct Peers {
  static constexpr ElementInfo kElement{"peers", "How a run in lock-step waits for the robots that have a <peer>."};
  std::string listen = "127.0.0.1:7654", missing = "fail", controllers = "same";
  double timeout_s = 30.0;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kMissing = {"fail", "simulate"};
    static constexpr std::array<std::string_view, 2> kControllers = {"same", "any"};
    v.text("listen", listen,
           "Where peers connect: PORT, of this computer alone, or ADDRESS:PORT (0.0.0.0: of all its networks).");
    v.number("timeout", timeout_s, unit::s, {0.1, 86400.0}, "How long a peer's answer is waited for.");
    v.choice("missing", missing, kMissing,
             "When it does not come: end the run, or step the robot's controller here from then on.");
    v.choice("controllers", controllers, kControllers,
             "same: a peer whose controller is known to be another than this computer's copy is refused; any: it is "
             "taken, and the difference told.");
  }
};

struct Controllers : Bare {
  static constexpr ElementInfo kElement{"controllers", "Configurations of controllers.", "", kAnything};
};

struct Configuration {
  static constexpr ElementInfo kElement{"configuration",
                                        "One configuration, written with the registered name of its controller.", "id",
                                        "actuators sensors params"};
  std::string id, library;
  void describe(ParamVisitor& v) {
    v.text("id", id, "How robots refer to this configuration.");
    v.text("library", library,
           "Shared object with the controller; folder, prefix and extension may be left out. Left out itself: "
           "the one that is called as the controller.");
  }
};

struct Sensors : Bare {
  static constexpr ElementInfo kElement{
      "sensors", "The sensors that the controller may take, each with its implementation= and options.", "", kAnything};
};

struct Actuators : Bare {
  static constexpr ElementInfo kElement{
      "actuators", "The actuators that the controller may take, each with its implementation= and options.", "",
      kAnything};
};

struct Hook {
  static constexpr ElementInfo kElement{
      "loop_functions",
      "A hook: what the experiment does around the robots. Further attributes and children are its own.", "library",
      kAnything};
  std::string library, label;
  void describe(ParamVisitor& v) {
    v.text("library", library, "Shared object with the hook.");
    v.text("label", label, "Its registered name; may be left out when the library has only one.");
  }
};

struct Arena {
  static constexpr ElementInfo kElement{"arena", "The space and what is in it.", "size",
                                        "FIELD box cylinder light sound distribute ROBOT"};
  Vec3 size{1.0, 1.0, 1.0}, center{};
  Vec3 positional_grid_size{};
  std::string escape = "error";
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kPolicies = {"error", "stop", "remove"};
    v.vector("size", size, unit::m, "Extent in x, y, z.");
    v.vector("center", center, unit::m, "Its middle.");
    v.vector("positional_grid_size", positional_grid_size, unit::none,
             "Accepted for ARGoS files; the grid chooses its size itself.");
    v.choice("escape", escape, kPolicies,
             "What happens to a body that leaves: error ends the run, stop keeps it at the edge, remove.");
  }
};

/// What fields of every kind have: nothing; the attributes are the kind's own.
struct FieldElement : Bare {
  static constexpr ElementInfo kElement{"field", "A field over the arena, written with its name, e.g. <floor>.", "",
                                        kAnything};
};

struct Box {
  static constexpr ElementInfo kElement{"box", "A box.", "id size", "body leds"};
  std::string id;
  Vec3 size{1.0, 1.0, 1.0};
  bool movable = false;
  double mass_kg = 1.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name.");
    v.vector("size", size, unit::m, "Extent in x, y, z.");
    v.flag("movable", movable, "Whether it can be pushed.");
    v.number("mass", mass_kg, unit::kg, {1e-9, 1e9}, "Mass of a movable box.");
  }
};

struct Cylinder {
  static constexpr ElementInfo kElement{"cylinder", "A cylinder.", "id radius height", "body leds"};
  std::string id;
  double radius_m = 1.0, height_m = 1.0;
  bool movable = false;
  double mass_kg = 1.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name.");
    v.number("radius", radius_m, unit::m, {kSmallest_m, kLargestArena_m}, "Radius.");
    v.number("height", height_m, unit::m, {kSmallest_m, kLargestArena_m}, "Height.");
    v.flag("movable", movable, "Whether it can be pushed.");
    v.number("mass", mass_kg, unit::kg, {1e-9, 1e9}, "Mass of a movable cylinder.");
  }
};

struct Light {
  static constexpr ElementInfo kElement{"light", "A lamp.", "id"};
  std::string id, color = "yellow", medium;
  Vec3 position{}, orientation{};
  double intensity = 1.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name.");
    v.vector("position", position, unit::m, "Where it hangs.");
    v.vector("orientation", orientation, unit::deg, "Accepted for ARGoS files; lamps shine everywhere.");
    v.text("color", color, "A name (red, white, …) or \"r,g,b\", 0 to 255.");
    v.number("intensity", intensity, unit::none, {0.0, 1e6}, "Distance in metres up to which a facing sensor reads 1.");
    v.text("medium", medium, "Id of the LED medium in which cameras see it; empty: all cameras do.");
  }
};

struct Sound {
  static constexpr ElementInfo kElement{"sound", "A steady sound, for microphones.", "id position"};
  std::string id;
  Vec3 position{};
  double level = 1.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name.");
    v.vector("position", position, unit::m, "Where it sounds.");
    v.number("level", level, unit::none, {0.0, 1.0}, "Level at the source.");
  }
};

struct Body {
  static constexpr ElementInfo kElement{"body", "Where a thing starts. Inside <distribute> that decides instead."};
  Vec3 position{}, orientation{};
  void describe(ParamVisitor& v) {
    v.vector("position", position, unit::m, "Where its base stands: x, y, z.");
    v.vector("orientation", orientation, unit::deg, "Rotations about z, then y, then x.");
  }
};

struct Robot {
  static constexpr ElementInfo kElement{"robot", "A robot, written with the name of its kind.", "id",
                                        "body controller battery bridge tracker peer"};
  std::string id;
  void describe(ParamVisitor& v) { v.text("id", id, "Name; inside <distribute> the beginning of the names."); }
};

/// With what its parts let the element say. `kind` becomes that robot's own.
struct RobotOfKind : Robot {
  hal::RobotKind& kind;
  void describe(ParamVisitor& v) {
    Robot::describe(v);
    kind.attributes(v);
  }
};

struct RobotController {
  static constexpr ElementInfo kElement{
      "controller", "Which configuration drives the robot; a <params> inside overrides its parameters one by one.",
      "config", "params"};
  std::string config;
  void describe(ParamVisitor& v) { v.text("config", config, "Id of a configuration under <controllers>."); }
};

struct Battery {
  static constexpr ElementInfo kElement{"battery", "How the battery discharges."};
  BatteryConfig c;
  double time_factor = 0.0, pos_factor = 0.0, orient_factor = 0.0;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kModels = {"time", "motion", "time_motion"};
    v.choice("model", c.model, kModels, "What discharges it.");
    v.number("full_charge", c.full_charge, unit::none, {1e-9, 1e9}, "Charge when full.");
    v.number("start_charge", c.start_charge, unit::none, {0.0, 1e9}, "Charge at the start.");
    v.number("delta", c.delta, unit::none, kNotNegative, "Charge lost a tick (time).");
    v.number("time_factor", time_factor, unit::none, kNotNegative, "Charge lost a tick (time_motion).");
    v.number("pos_delta", c.pos_delta, unit::none, kNotNegative, "Charge lost a metre (motion).");
    v.number("orient_delta", c.orient_delta, unit::none, kNotNegative, "Charge lost a radian (motion).");
    v.number("pos_factor", pos_factor, unit::none, kNotNegative, "Charge lost a metre (time_motion).");
    v.number("orient_factor", orient_factor, unit::none, kNotNegative, "Charge lost a radian (time_motion).");
  }
};

struct DistributeElement : Bare {
  static constexpr ElementInfo kElement{"distribute", "Places many of one thing, without overlap.", "",
                                        "position orientation entity"};
};

/// Which attribute belongs to which method of drawing.
struct DrawAttribute {
  std::string_view name, method;
};
inline constexpr std::array<DrawAttribute, 8> kDrawAttributes = {{{"min", "uniform"},
                                                                  {"max", "uniform"},
                                                                  {"mean", "gaussian"},
                                                                  {"std_dev", "gaussian"},
                                                                  {"values", "constant"},
                                                                  {"center", "grid"},
                                                                  {"distances", "grid"},
                                                                  {"layout", "grid"}}};

/// Draws triples; a bare number is in `bare`.
struct Draw {
  std::string method;
  Vec3 min{}, max{}, mean{}, std_dev{}, values{}, center{}, distances{}, layout{1, 1, 1};
  hal::Unit bare = unit::m;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 4> kMethods = {"uniform", "gaussian", "constant", "grid"};
    v.choice("method", method, kMethods, "How each triple is drawn.");
    v.vector("min", min, bare, "Least values (uniform).");
    v.vector("max", max, bare, "Greatest values (uniform).");
    v.vector("mean", mean, bare, "Means (gaussian).");
    v.vector("std_dev", std_dev, bare, "Standard deviations (gaussian).");
    v.vector("values", values, bare, "The values (constant).");
    v.vector("center", center, bare, "Middle of the grid.");
    v.vector("distances", distances, bare, "Spacing of the grid.");
    v.vector("layout", layout, unit::none,
             "Places of the grid in x, y, z; filled west to east, then south to north, then upwards.");
  }
};

struct PositionDraw : Draw {
  static constexpr ElementInfo kElement{
      "position", "How positions are drawn. Each method needs its own attributes, and takes no others.", "method"};
};

struct OrientationDraw : Draw {
  static constexpr ElementInfo kElement{"orientation", "How orientations are drawn: rotations about z, then y, then x.",
                                        "method"};
  OrientationDraw() { bare = unit::deg; }
};

struct Entity {
  static constexpr ElementInfo kElement{"entity", "How many of the one thing inside.", "quantity",
                                        "box cylinder light ROBOT"};
  std::int64_t quantity = 1, max_trials = 100, base_num = 0;
  void describe(ParamVisitor& v) {
    v.integer("quantity", quantity, {0, kLargestQuantity}, "How many.");
    v.integer("max_trials", max_trials, {1, 1e7}, "Draws for a free place before giving up.");
    v.integer("base_num", base_num, {0, 1e15}, "Number of the first.");
  }
};

struct Engines : Bare {
  static constexpr ElementInfo kElement{
      "physics_engines", "What moves the bodies. None: one of the first kind for the whole arena.", "", kAnything};
};

/// What engines of every kind have; the rest of the attributes are the engine's own.
struct Engine {
  static constexpr ElementInfo kElement{"engine", "A physics engine, written with the name of its kind.", "id",
                                        kAnything};
  std::string id, regions;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for gates.");
    v.text("regions", regions,
           "How the arena is split, \"4x4\" (columns x lines) or \"auto\": from the number of robots. Left out: auto. "
           "Engines that work on all as one need no split: any is the same to them.");
  }
};

struct Boundaries : Bare {
  static constexpr ElementInfo kElement{
      "boundaries", "The region of an engine: a right prism. Left out: the whole arena.", "", "top bottom sides"};
};

struct Top {
  static constexpr ElementInfo kElement{"top", "Upper end of a region.", "height"};
  double height_m = 0.0;
  void describe(ParamVisitor& v) { v.number("height", height_m, unit::m, kAny, "Height above the floor."); }
};

struct Bottom {
  static constexpr ElementInfo kElement{"bottom", "Lower end of a region.", "height"};
  double height_m = 0.0;
  void describe(ParamVisitor& v) { v.number("height", height_m, unit::m, kAny, "Height above the floor."); }
};

struct Sides : Bare {
  static constexpr ElementInfo kElement{"sides", "Outline of a region: its corners in order, at least three.", "",
                                        "vertex"};
};

struct Vertex {
  static constexpr ElementInfo kElement{
      "vertex", "A corner of a region, and the side from here to the next: a wall, or a gate.", "point"};
  std::string point, gate;
  void describe(ParamVisitor& v) {
    v.text("point", point, "\"x,y\"; bare numbers are in m.");
    v.text("gate", gate,
           "Id of the engine behind this side; left out: a wall. In a file that names no gate at all, "
           "sides are open where another engine's region lies behind.");
  }
};

struct Media : Bare {
  static constexpr ElementInfo kElement{"media", "What carries signals.", "", kMediumKind};
};

/// What media of every kind have; the rest of the attributes are the kind's own.
struct Medium {
  static constexpr ElementInfo kElement{
      "medium", "A medium, written with the name of its kind, e.g. <range_and_bearing>.", "id", kAnything};
  std::string id;
  std::string index;
  std::string grid_size;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name that devices refer to.");
    v.text("index", index, "Accepted for ARGoS files.");
    v.text("grid_size", grid_size, "Accepted for ARGoS files; the grid chooses its size itself.");
  }
};

struct Leds {
  static constexpr ElementInfo kElement{"leds", "LEDs on a box or cylinder, for cameras.", "", "led"};
  std::string medium;
  void describe(ParamVisitor& v) {
    v.text("medium", medium, "Id of the LED medium: cameras of others do not see them. Empty: all cameras do.");
  }
};

struct Led {
  // In <leds>. A <led> in <media> is a Medium.
  static constexpr ElementInfo kElement{"led", "An LED.", "offset color"};
  Vec3 offset{};
  std::string anchor = "origin";
  std::string color = "black";
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 1> kAnchors = {"origin"};
    v.vector("offset", offset, unit::m, "From the anchor, turning with the object: x, y, z.");
    v.choice("anchor", anchor, kAnchors, "origin: the middle of the object's base.");
    v.text("color", color, "A name (red, white, …) or \"r,g,b\", 0 to 255; black is off.");
  }
};

struct Record {
  static constexpr ElementInfo kElement{
      "record", "What is written down: a record for `tandem export`, a table of poses, files of observers.", "",
      "trajectory OBSERVER"};
  std::string path, entities = "*", ports;
  std::int64_t every = 1, fingerprint_every = 1000;
  bool state = true, look = true, inputs = true;
  void describe(ParamVisitor& v) {
    v.text("path", path, "Record to write; none: no record.");
    v.text("entities", entities, "Ids of its robots, separated by commas; '*' stands for any text.");
    v.text("ports", ports, "Names of ports whose fields it holds, separated by commas; '*': all.");
    v.integer("every", every, {1, 1e12}, "Ticks between rows.");
    v.flag("state", state, "Whether it holds what controllers publish.");
    v.flag("look", look,
           "Whether it holds LEDs, turrets, grippers, who is halted, floor and drawings, when they change.");
    v.flag("inputs", inputs, "Whether it holds all that reaches controllers of real robots, in every tick.");
    v.integer("fingerprint_every", fingerprint_every, {0, 1e12}, "Ticks between fingerprints of the state; 0: none.");
  }
};

/// What observers of every kind have: nothing; the attributes are the kind's own.
struct ObserverElement : Bare {
  static constexpr ElementInfo kElement{"observer", "What looks at the world after every tick, written with its name.",
                                        "", kAnything};
};

struct RunParts : Bare {
  static constexpr ElementInfo kElement{"run", "What joins the run: parts of plug-ins.", "", "RUN_PART"};
};

/// What such parts of every kind have: nothing; the attributes are the kind's own.
struct RunPartElement : Bare {
  static constexpr ElementInfo kElement{"run_part", "What joins a run, written with its name.", "", kAnything};
};

struct Visualization : Bare {
  static constexpr ElementInfo kElement{
      "visualization", "Views of ARGoS; left out with a warning, but for their camera placements.", "", kAnything};
};

struct Trajectory {
  static constexpr ElementInfo kElement{"trajectory", "Poses of chosen robots, as CSV.", "path"};
  std::string path, entities = "*";
  std::int64_t every = 1;
  void describe(ParamVisitor& v) {
    v.text("path", path, "CSV file to write.");
    v.text("entities", entities, "Ids separated by commas; '*' stands for any text.");
    v.integer("every", every, {1, 1e12}, "Ticks between rows.");
  }
};

}  // namespace tandem::core::schema
