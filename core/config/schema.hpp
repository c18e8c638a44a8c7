// The attributes of every element of an experiment file, each described once. Reading, checking, defaults and the manual
// all come from these descriptions.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/params.hpp"

namespace tandem::core::schema {

using hal::kAny;
using hal::kNotNegative;
using hal::ParamVisitor;
namespace unit = hal::unit;

inline constexpr double kLargestArena_m = 1e6;
inline constexpr double kLargestQuantity = 1e8;
inline constexpr double kSmallest_m = 1e-6;

struct None {
  void describe(ParamVisitor&) {}
};

struct System {
  std::int64_t threads = 0;
  std::string method = "balance_quantity";
  bool pin_threads_to_cores = false;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 4> kMethods = {"balance_quantity", "balance_length", "static", "dynamic"};
    v.integer("threads", threads, {0, 1024}, "Threads that step the world; 0 and 1: the caller alone. Results do not depend on it.");
    v.choice("method", method, kMethods, "balance_quantity or static: work is split in advance. balance_length or dynamic: handed out.");
    v.flag("pin_threads_to_cores", pin_threads_to_cores, "Accepted for ARGoS files; the system places threads.");
  }
};

struct ExperimentAttributes {
  double length_s = 0.0;
  std::int64_t ticks_per_second = 10;
  std::int64_t random_seed = 0;
  bool real_time = false;
  std::string visualization;
  void describe(ParamVisitor& v) {
    v.number("length", length_s, unit::s, {0.0, 1e9}, "Virtual duration; 0: until interrupted or a hook ends it.");
    v.integer("ticks_per_second", ticks_per_second, {1, 100000}, "Control steps a virtual second.");
    v.integer("random_seed", random_seed, {0, 9.2e18}, "Seed of all chance; 0: from the clock, and named in the report.");
    v.flag("real_time", real_time, "The same as <time mode=\"realtime\"/>.");
    v.text("visualization", visualization, "Accepted for ARGoS files.");
  }
};

struct Profiling {
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
  std::string mode = "fast";
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kModes = {"fast", "realtime", "lockstep"};
    v.choice("mode", mode, kModes, "fast: as fast as possible; realtime: paced by absolute time; lockstep: waits for every peer.");
  }
};

struct Controller {
  std::string id, library;
  void describe(ParamVisitor& v) {
    v.text("id", id, "How robots refer to this configuration.");
    v.text("library", library, "Shared object with the controller; folder and extension may be left out.");
  }
};

struct Device {
  std::string implementation = "default";
  void describe(ParamVisitor& v) { v.text("implementation", implementation, "Which model of the device; see `tandem list devices`."); }
};

struct Hook {
  std::string library, label;
  void describe(ParamVisitor& v) {
    v.text("library", library, "Shared object with the hook.");
    v.text("label", label, "Its registered name.");
  }
};

struct Arena {
  Vec3 size{}, center{};
  Vec3 positional_grid_size{};
  std::string escape = "error";
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kPolicies = {"error", "stop", "remove"};
    v.vector("size", size, unit::m, "Extent in x, y, z.");
    v.vector("center", center, unit::m, "Its middle.");
    v.vector("positional_grid_size", positional_grid_size, unit::none, "Accepted for ARGoS files; the grid chooses its size itself.");
    v.choice("escape", escape, kPolicies, "What happens to a body that leaves: error ends the run, stop keeps it at the edge, remove.");
  }
};

struct Floor {
  std::string id, source = "none", path;
  double pixels_per_meter = 100.0;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kSources = {"none", "image", "loop_functions"};
    v.text("id", id, "Name.");
    v.choice("source", source, kSources, "Where the floor's shade comes from: even grey, a PNG image, or a hook's floor().");
    v.text("path", path, "The PNG image, laid over the whole arena, its top to the north (+y).");
    v.number("pixels_per_meter", pixels_per_meter, unit::none, {0.01, 10000.0}, "Resolution of a floor painted by a hook.");
  }
};

struct Box {
  std::string id;
  Vec3 size{};
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
  std::string id;
  double radius_m = 0.0, height_m = 0.0;
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
  std::string id, color = "yellow", medium;
  Vec3 position{}, orientation{};
  double intensity = 1.0;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name.");
    v.vector("position", position, unit::m, "Where it hangs.");
    v.vector("orientation", orientation, unit::deg, "Accepted for ARGoS files; lamps shine everywhere.");
    v.text("color", color, "A name (red, white, …) or \"r,g,b\", 0 to 255.");
    v.number("intensity", intensity, unit::none, {0.0, 1e6}, "Distance in metres up to which a facing sensor reads 1.");
    v.text("medium", medium, "Accepted for ARGoS files.");
  }
};

struct Sound {
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
  Vec3 position{}, orientation{};
  void describe(ParamVisitor& v) {
    v.vector("position", position, unit::m, "Where its base stands: x, y, z.");
    v.vector("orientation", orientation, unit::deg, "Rotations about z, then y, then x.");
  }
};

struct Robot {
  std::string id;
  double rab_range_m = -1.0;
  std::int64_t rab_data_size = -1;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name; inside <distribute> the beginning of the names.");
    v.number("rab_range", rab_range_m, unit::m, {-1.0, 1e4}, "Reach of range-and-bearing; negative: the data sheet's.");
    v.integer("rab_data_size", rab_data_size, {-1, 10}, "Bytes of a range-and-bearing message; negative: the data sheet's.");
  }
};

struct RobotController {
  std::string config;
  void describe(ParamVisitor& v) { v.text("config", config, "Id of a configuration under <controllers>."); }
};

struct Battery {
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
  std::string link, firmware = "auto";
  double timeout_s = 0.5;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 5> kFirmware = {"auto", "btcom", "gctronic", "webots", "epuck2"};
    v.text("link", link, "Where the real robot is, e.g. serial:/dev/ttyUSB0@115200.");
    v.choice("firmware", firmware, kFirmware, "Which firmware it runs; auto asks it.");
    v.number("timeout", timeout_s, unit::s, {0.05, 60.0}, "Age of the last answer from which the robot counts as lost and is stopped.");
  }
};

struct Tracker {
  std::string source = "odometry";
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 1> kSources = {"odometry"};
    v.choice("source", source, kSources, "Where the real robot's pose comes from.");
  }
};

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
    v.vector("layout", layout, unit::none, "Places of the grid in x, y, z.");
  }
};

struct EntityAttributes {
  std::int64_t quantity = 1, max_trials = 100, base_num = 0;
  void describe(ParamVisitor& v) {
    v.integer("quantity", quantity, {0, kLargestQuantity}, "How many.");
    v.integer("max_trials", max_trials, {1, 1e7}, "Draws for a free place before giving up.");
    v.integer("base_num", base_num, {0, 1e15}, "Number of the first.");
  }
};

struct Engine {
  std::string id, regions;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name.");
    v.text("regions", regions, "How the arena is split; kinematics2d needs no split, any is the same to it.");
  }
};

struct Medium {
  std::string id;
  std::int64_t index = 0;
  std::string grid_size;
  bool check_occlusions = true;
  void describe(ParamVisitor& v) {
    v.text("id", id, "Name that devices refer to.");
    v.integer("index", index, kNotNegative, "Accepted for ARGoS files.");
    v.text("grid_size", grid_size, "Accepted for ARGoS files; the grid chooses its size itself.");
    v.flag("check_occlusions", check_occlusions, "Whether boxes and cylinders block.");
  }
};

struct Trajectory {
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
