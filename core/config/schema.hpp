// Every element of an experiment file, described once: what it is, what it must have, what may stand in it, and each of
// its attributes. Reading, checking, defaults and the manual all come from these descriptions.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/params.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core::schema {

using hal::kAny;
using hal::kNotNegative;
using hal::ParamVisitor;
namespace unit = hal::unit;

inline constexpr double kLargestArena_m = 1e6;
inline constexpr double kLargestQuantity = 1e8;
inline constexpr double kSmallest_m = 1e-6;

inline constexpr std::string_view kAnything = "*";         ///< as children: any element
inline constexpr std::string_view kRobotKind = "ROBOT";    ///< in children: every kind of robot that the program knows
inline constexpr std::string_view kFieldKind = "FIELD";    ///< … every field of which files say something
inline constexpr std::string_view kMediumKind = "MEDIUM";  ///< … and every kind of medium
inline constexpr std::string_view kObserverKind = "OBSERVER";  ///< … and of observer
inline constexpr std::string_view kRunPartKind = "RUN_PART";   ///< … and of part that joins a run
inline constexpr std::string_view kTrackerKind = "TRACKER";    ///< … and of tracker

/// What an element is and holds. Lists are names separated by spaces.
struct ElementInfo {
  std::string_view name;  ///< as written; "configuration" and "robot" stand for names of controllers and of kinds
  std::string_view doc;
  std::string_view required = {};
  std::string_view children = {};
};

struct Root {
  static constexpr ElementInfo kElement{
      "tandem", "An experiment. The name <argos-configuration> means the same.", "",
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

struct Framework {
  static constexpr ElementInfo kElement{"framework", "How the run goes.", "", "system experiment profiling time"};
  void describe(ParamVisitor&) {}
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

struct Controllers {
  static constexpr ElementInfo kElement{"controllers", "Configurations of controllers.", "", kAnything};
  void describe(ParamVisitor&) {}
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

struct Sensors {
  static constexpr ElementInfo kElement{
      "sensors", "The sensors that the controller may take, each with its implementation= and options.", "", kAnything};
  void describe(ParamVisitor&) {}
};

struct Actuators {
  static constexpr ElementInfo kElement{
      "actuators", "The actuators that the controller may take, each with its implementation= and options.", "",
      kAnything};
  void describe(ParamVisitor&) {}
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
struct FieldElement {
  static constexpr ElementInfo kElement{"field", "A field over the arena, written with its name, e.g. <floor>.", "",
                                        kAnything};
  void describe(ParamVisitor&) {}
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

struct Bridge {
  static constexpr ElementInfo kElement{
      "bridge", "Makes the robot stand for a real one on this link. Further attributes are those of its kind.", "link",
      kAnything};
  std::string link, rearm = "proved", missing = "refuse";
  double timeout_s = 0.5, settle_s = 0.3, ramp_m_s2 = 0.25, connect_s = 15.0, stop_s = 1.0;
  void describe(ParamVisitor& v) {
    v.text("link", link, "Where the real robot is, e.g. serial:/dev/ttyUSB0@115200.");
    v.number("timeout", timeout_s, unit::s, {0.05, 60.0},
             "Age of the last answer from which the robot counts as lost and is stopped.");
    v.text("rearm", rearm,
           "What lets the robot drive again after a stop: proved (a short outage ends by itself, all else waits for a "
           "person), operator (every stop waits for a person), after a time in which all was well, never. Whatever it "
           "says: a robot that is not proved to be the one that was armed waits for a person, who names it.");
    v.number("settle_after", settle_s, unit::s, {0.0, 60.0},
             "Before it drives, all must have been well for this long.");
    v.number("rearm_ramp", ramp_m_s2, unit::m_s2, {0.001, 100.0}, "Its largest speed then grows from 0 by this.");
    static constexpr std::array<std::string_view, 3> kMissing = {"refuse", "simulate", "wait"};
    v.choice("missing", missing, kMissing,
             "When it is not there at the start: refuse to run, run with a simulated robot instead, or wait for it.");
    v.number("connect_timeout", connect_s, unit::s, {0.1, 3600.0}, "How long it is waited for before it is missing.");
    v.number("stop_timeout", stop_s, unit::s, {0.1, 60.0}, "How long it has to confirm its stop at the end.");
  }
};

struct Peer {
  static constexpr ElementInfo kElement{
      "peer", "The robot's controller steps elsewhere, in lock-step: on a board, in another program, behind a wire."};
  std::string link;
  void describe(ParamVisitor& v) {
    v.text("link", link,
           "Left out: the peer connects to the port of <peers listen>. Else where it is, serial:/dev/ttyUSB0@115200 or "
           "tcp:HOST:PORT; or emulated:FIRMWARE, a bridge and the emulated firmware in this program.");
  }
};

struct Tracker {
  static constexpr ElementInfo kElement{"tracker", "Where a real robot's pose comes from."};
  std::string source = "auto", id;
  double turn_rad = 0.0, lost_m = 0.1, height_m = -1.0;
  Vec3 offset{};
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 4> kSources = {"auto", "odometry", "positioning", "fused"};
    v.choice("source", source, kSources,
             "odometry: its wheels alone; positioning: what it says itself; fused: wheels, gyroscope and <trackers>; "
             "auto: fused where the file has trackers and the robot wheels, else one of the others.");
    v.text("id", id, "Names or tags by which trackers know it, separated by spaces; left out: its id.");
    v.number("turn", turn_rad, unit::deg, kAny, "By which the tag on it is turned against its forward axis.");
    v.vector("offset", offset, unit::m, "Where the tag's centre is on it: forward, to the left; the third is 0.");
    v.number("height", height_m, unit::m, {-1.0, 10.0},
             "Of the tag above the floor, for cameras; negative: that of the robot's body.");
    v.number("lost_above", lost_m, unit::m, {0.001, 100.0},
             "It stands while its fused pose is known no better: standard deviation.");
  }
};

struct Trackers {
  static constexpr ElementInfo kElement{"trackers", "What sees real robots from outside.", "", kTrackerKind};
  void describe(ParamVisitor&) {}
};

/// What trackers of every kind have; the rest of the attributes are the kind's own.
struct TrackerElement {
  static constexpr ElementInfo kElement{
      "tracker_kind", "A tracker, written with the name of its kind, e.g. <udp>; further attributes are the kind's.",
      "", kAnything};
  std::string id, clock = "own";
  double latency_s = 0.0, sd_m = 0.003, sd_rad = 0.02, turn_rad = 0.0;
  Vec3 origin{};
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kClocks = {"own", "unix", "monotonic"};
    v.text("id", id, "Name; left out: that of its kind.");
    v.choice("clock", clock, kClocks,
             "Of its stamps: own, whose offset is found out; unix, the date; monotonic, CLOCK_MONOTONIC of this "
             "computer.");
    v.number("latency", latency_s, unit::s, {0.0, 2.0},
             "From exposure to arrival, at least: for a clock of its own, or where there are no stamps.");
    v.number("sd", sd_m, unit::m, {1e-6, 10.0}, "Standard deviation of x and y, where sightings do not say.");
    v.number("sd_heading", sd_rad, unit::rad, {1e-6, 3.0}, "Standard deviation of headings, likewise.");
    v.vector("origin", origin, unit::m, "Where the origin of its frame lies in the arena.");
    v.number("turn", turn_rad, unit::deg, kAny, "By which its frame is turned, counter-clockwise.");
  }
};

struct Safety {
  static constexpr ElementInfo kElement{
      "safety", "Where real robots may go, how fast, and whom they keep from. Simulated robots are not held.", "",
      "fence keep_out zone"};
  std::string avoid = "real";
  double apart_m = 0.01, latency_s = 0.05;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kAvoid = {"none", "real", "all"};
    v.choice("avoid", avoid, kAvoid,
             "Whom commands may not run a real robot into: nobody; other real robots; these and all that is virtual.");
    v.number("apart", apart_m, unit::m, {0.0, 10.0}, "Left between bodies, and between a body and an area's edge.");
    v.number("latency", latency_s, unit::s, {0.0, 10.0},
             "Until a command moves the robot, at least; a link's measured round trip counts where it is longer.");
  }
};

inline constexpr double kHighest_m = 1000.0;  ///< of an area that has no upper end

struct FenceElement {
  static constexpr ElementInfo kElement{"fence", "Real robots stay in it with their whole bodies.", "points"};
  std::string id, points;
  double height_m = kHighest_m;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for people.");
    v.text("points", points, "Its corners in order, \"x,y x,y …\"; bare numbers are in m. It may be concave.");
    v.number("height", height_m, unit::m, {kSmallest_m, kHighest_m}, "Nothing that flies rises above it.");
  }
};

struct KeepOut {
  static constexpr ElementInfo kElement{"keep_out", "Real robots stay out of it with their whole bodies.", "points"};
  std::string id, points;
  double from_m = 0.0, to_m = kHighest_m;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for people.");
    v.text("points", points, "Its corners in order, \"x,y x,y …\"; bare numbers are in m. It may be concave.");
    v.number("from", from_m, unit::m, {0.0, kHighest_m}, "Its lower end: what is below passes under it.");
    v.number("to", to_m, unit::m, {0.0, kHighest_m}, "Its upper end: what flies higher passes over it.");
  }
};

struct Zone {
  static constexpr ElementInfo kElement{"zone", "Real robots are no faster in it.", "points max_speed"};
  std::string id, points;
  double from_m = 0.0, to_m = kHighest_m, max_speed_m_s = 0.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name, for people.");
    v.text("points", points, "Its corners in order, \"x,y x,y …\"; bare numbers are in m. It may be concave.");
    v.number("max_speed", max_speed_m_s, unit::m_s, {1e-3, 1000.0}, "Of a body any part of which is in it.");
    v.number("from", from_m, unit::m, {0.0, kHighest_m}, "Its lower end.");
    v.number("to", to_m, unit::m, {0.0, kHighest_m}, "Its upper end.");
  }
};

struct Desk {
  static constexpr ElementInfo kElement{
      "desk", "Who commands real robots besides the terminal and the window, and robots that stand by.", "", "spare"};
  std::string lcm, channel = "tandem/desk";
  bool hold = false;
  void describe(ParamVisitor& v) {
    v.text("lcm", lcm, "Where commands come over LCM: udpm://GROUP:PORT?ttl=N; left out: nowhere.");
    v.text("channel", channel, "Their channel; answers go to CHANNEL/reply.");
    v.flag("hold", hold, "The robots are connected, stand, and wait for somebody to start the run.");
  }
};

struct Spare {
  static constexpr ElementInfo kElement{"spare", "A real robot that may take another one's place in a run.", "id link"};
  std::string id, link, seen_as;
  void describe(ParamVisitor& v) {
    v.text("id", id, "How it is called.");
    v.text("link", link, "Where it is, as in <bridge>.");
    v.text("seen_as", seen_as, "Names or tags by which trackers know it, separated by spaces; left out: its id.");
  }
};

struct DistributeElement {
  static constexpr ElementInfo kElement{"distribute", "Places many of one thing, without overlap.", "",
                                        "position orientation entity"};
  void describe(ParamVisitor&) {}
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

struct Engines {
  static constexpr ElementInfo kElement{
      "physics_engines", "What moves the bodies. None: one of the first kind for the whole arena.", "", kAnything};
  void describe(ParamVisitor&) {}
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

struct Boundaries {
  static constexpr ElementInfo kElement{
      "boundaries", "The region of an engine: a right prism. Left out: the whole arena.", "", "top bottom sides"};
  void describe(ParamVisitor&) {}
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

struct Sides {
  static constexpr ElementInfo kElement{"sides", "Outline of a region: its corners in order, at least three.", "",
                                        "vertex"};
  void describe(ParamVisitor&) {}
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

struct Media {
  static constexpr ElementInfo kElement{"media", "What carries signals.", "", kMediumKind};
  void describe(ParamVisitor&) {}
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
struct ObserverElement {
  static constexpr ElementInfo kElement{"observer", "What looks at the world after every tick, written with its name.",
                                        "", kAnything};
  void describe(ParamVisitor&) {}
};

struct RunParts {
  static constexpr ElementInfo kElement{"run", "What joins the run: parts of plug-ins.", "", "RUN_PART"};
  void describe(ParamVisitor&) {}
};

/// What such parts of every kind have: nothing; the attributes are the kind's own.
struct RunPartElement {
  static constexpr ElementInfo kElement{"run_part", "What joins a run, written with its name.", "", kAnything};
  void describe(ParamVisitor&) {}
};

struct Visualization {
  static constexpr ElementInfo kElement{
      "visualization", "Views of ARGoS; left out with a warning, but for their camera placements.", "", kAnything};
  void describe(ParamVisitor&) {}
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

/// Red, green and blue of a colour name or "r,g,b"; false when it is neither.
bool parse_color(const std::string& text, std::array<std::uint8_t, 3>& rgb);

}  // namespace tandem::core::schema
