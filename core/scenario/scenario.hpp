// The immutable input of runs: one experiment, read and checked. Any number of runs may share it.
//
// Lengths in metres, angles in radians, times in seconds, masses in kilograms. W is the world frame (x east, z up).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/element.hpp"
#include "core/scenario/polygon.hpp"
#include "hal/catalog.hpp"
#include "hal/device_list.hpp"
#include "hal/result.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

using Vec3 = std::array<double, 3>;

/// A pose in W: position, and orientation as yaw-pitch-roll (rotations about z, then y, then x).
struct Placement {
  Vec3 p_W{};
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
};

enum class TimeMode { Fast, Realtime, Lockstep };
enum class Assignment { Static, Dynamic };        ///< of work to threads
enum class EscapePolicy { Error, Stop, Remove };  ///< what happens to a body that leaves the arena

/// One listed device of a controller configuration: `<proximity implementation="noisy" noise_level="0.1"/>`.
struct DeviceChoice {
  std::string device;          ///< the port's name; ARGoS' names are already mapped to ours
  std::string implementation;  ///< as written, "default" when absent
  Element options;
  std::uint8_t medium = 0;  ///< number of the medium that the options name, as `medium_number` gives it
  bool grown = false;       ///< the device of the one before it with more room: for simulated robots
};

struct ControllerConfig {
  std::string id;
  std::string label;  ///< the element's name: the registered name of the controller
  std::string library;
  std::vector<DeviceChoice> sensors;
  std::vector<DeviceChoice> actuators;
  Element params;  ///< `<params …>`, empty element where absent
  int line = 0;
};

/// Distribution of one coordinate triple.
struct Distribution {
  enum class Method { Uniform, Gaussian, Constant, Grid };
  Method method = Method::Constant;
  Vec3 min{}, max{};           ///< Uniform
  Vec3 mean{}, std_dev{};      ///< Gaussian
  Vec3 values{};               ///< Constant
  Vec3 center{}, distances{};  ///< Grid
  std::array<int, 3> layout{1, 1, 1};
  int line = 0;
};

/// `<distribute>` around an entity. Orientation triples are (yaw, pitch, roll) in radians.
struct Distribute {
  Distribution position;
  Distribution orientation;
  std::int64_t quantity = 1;
  std::int64_t max_trials = 1;
  std::int64_t base_num = 0;
  int order = 0;  ///< which of the file's <distribute> elements this is: they are placed in this order
  int line = 0;
};

struct BatteryConfig {
  std::string model = "time";  ///< time, motion or time_motion
  double full_charge = 1.0;
  double start_charge = 1.0;
  double delta = 0.0;         ///< charge lost a tick (time)
  double pos_delta = 0.0;     ///< charge lost a metre (motion)
  double orient_delta = 0.0;  ///< charge lost a radian (motion)
};

/// Policy for a real robot that is not there at the start. Refuse: it does not begin. Simulate: it begins
/// with a simulated robot instead. Wait: it does not begin before the robot is there.
enum class IfMissing : std::uint8_t { Refuse, Simulate, Wait };

/// A robot that stands for a real one: where its bridge connects.
struct BridgeConfig {
  std::string link;        ///< "serial:/dev/ttyUSB0@115200"
  double timeout_s = 0.5;  ///< age from which the link counts as lost
  Element options;
  int line = 0;
  std::shared_ptr<const void> own = {};  ///< the attributes of its kind, as its bridge reads them; null: left out
  std::string rearm = "proved";          ///< release after a stop: proved, operator, after a time, never
  double settle_s = 0.3;                 ///< then all must have been well for so long
  double ramp_m_s2 = 0.25;               ///< then its largest speed grows from 0 by this
  IfMissing if_missing = IfMissing::Refuse;
  double connect_s = 15.0;  ///< from which it counts as missing, before the run
  double stop_s = 1.0;      ///< for it to confirm its stop, at the end
};

/// A simulated robot whose controller steps elsewhere, in lock-step with the run.
struct PeerConfig {
  std::string
      link;  ///< "serial:/dev/ttyS0@115200", "tcp:HOST:PORT", "emulated:…"; empty: it connects to the run's port
  int line = 0;
};

/// How a run in lock-step waits for its peers.
struct LockstepConfig {
  std::string listen = "127.0.0.1:7654";  ///< where peers connect: PORT or ADDRESS:PORT
  double timeout_s = 30.0;                ///< of wall time, for an answer
  bool simulate_missing = false;          ///< then its controller steps in the hub; else the run ends
  bool any_controller = false;            ///< a peer may run another controller than the hub's copy; else it is refused
  int line = 0;
};

/// Where the pose of a robot that stands for a real one comes from.
struct TrackerConfig {
  std::string source = "auto";  ///< odometry, positioning, fused, or auto: what suits the robot and the file
  Element options;
  int line = 0;
  std::vector<std::string> names = {};  ///< by which trackers know it; empty: by its id
  double turn_rad = 0.0;                ///< of what they see of it, against its forward axis
  double lost_m = 0.1;                  ///< standard deviation from which its pose counts as stale
  Vec3 p_BT{};                          ///< of that on the robot: x forward, y to the left
  std::optional<double> tag_m = {};     ///< its height above the floor; nothing: that of the robot's body
};

/// What sees real robots from outside: an element of <trackers>. Its frame T stands in W.
struct TrackerItem {
  std::string kind;  ///< name of a tracker of the catalog
  std::string id;
  std::string clock = "own";  ///< of its stamps: own, unix, monotonic
  double latency_s = 0.0;     ///< from exposure to arrival, at least; for clocks of its own, and without stamps
  double sd_m = 0.003;        ///< of its coordinates and headings, where it does not say itself
  double sd_rad = 0.02;
  Vec3 p_WT{};
  double turn_rad = 0.0;  ///< of T against W
  Element options;
  int line = 0;
  std::shared_ptr<const void> own = {};  ///< the attributes of its kind, as it reads them; null: left out
};

/// An area of <safety>: an upright prism.
struct SafetyArea {
  std::string id;
  std::vector<Point2> corners;      ///< in order, whichever way around
  double from_m = 0.0, to_m = 0.0;  ///< heights between which it applies; of a fence: from the ground up to its height
  double max_speed_m_s = 0.0;       ///< of a zone
  int line = 0;
};

/// Whom real robots are kept from running into.
enum class Avoid : std::uint8_t { Nobody, Real, All };

/// Where real robots may go, and what they keep from.
struct SafetyConfig {
  Avoid avoid = Avoid::Real;
  double apart_m = 0.01;    ///< left between bodies, and between a body and the edge of an area
  double latency_s = 0.05;  ///< until a command moves the robot, at least
  std::vector<SafetyArea> fences, keep_outs, zones;
};

/// A real robot that may take another one's place while a run goes on.
struct SpareItem {
  std::string id;
  std::string link;
  std::vector<std::string> names;  ///< by which trackers know it; empty: by its id
  int line = 0;
};

/// Desks: commanders of real robots besides the run's own terminal and window, and how the run begins.
struct DeskConfig {
  std::string lcm;                      ///< URL; empty: no commands over LCM
  std::string channel = "tandem/desk";  ///< of commands; answers go to this and "/reply"
  bool hold = false;                    ///< the run waits to be started
  std::vector<SpareItem> spares;
};

/// A robot, or with `distribute` as many as it says: ids are then `id` + number.
struct RobotItem {
  std::string kind;  ///< of the catalog's robots
  std::string id;
  std::size_t controller = 0;     ///< index into Scenario::controllers
  std::optional<Element> params;  ///< overrides of the controller's parameters, for these robots alone
  Placement placement;
  std::optional<Distribute> distribute;
  BatteryConfig battery;
  std::optional<BridgeConfig> bridge;
  std::optional<TrackerConfig> tracker;
  int line = 0;
  /// The kind with what the robot's element says of its parts; null: as the catalog has it. Shared by those that say
  /// the same.
  std::shared_ptr<const hal::RobotKind> own_kind = {};
  std::optional<PeerConfig> peer = {};
};

/// A kind of robot that the file gives, itself or by a file that it names.
struct KindConfig {
  std::shared_ptr<const hal::RobotKind> kind;
  std::string bridge;  ///< the kind whose bridge drives real robots of this one; empty: a bridge of its own name
  std::string file;    ///< in which it stands
  int line = 0;
};

enum class ShapeKind { Box, Cylinder };

/// An LED on a box or cylinder.
struct LedItem {
  Vec3 p_O{};  ///< from the centre of the object's base, in its frame
  std::array<std::uint8_t, 3> rgb{};
};

/// A box or a cylinder. `placement.p_W` is the centre of its base. `size` is (x, y, z) of a box, or (radius, radius,
/// height).
struct ObjectItem {
  ShapeKind shape = ShapeKind::Box;
  std::string id;
  Vec3 size{};
  bool movable = false;
  double mass_kg = 1.0;
  Placement placement;
  std::optional<Distribute> distribute;
  int line = 0;
  std::vector<LedItem> leds = {};
  std::string led_medium = {};  ///< id of their medium; empty: seen by all cameras
  int led_line = 0;
};

struct LightItem {
  std::string id;
  Vec3 p_W{};
  std::array<std::uint8_t, 3> rgb{255, 255, 0};
  double intensity = 1.0;  ///< distance in metres up to which a facing sensor reads 1
  std::optional<Distribute> distribute;
  int line = 0;
  std::string medium = {};  ///< id of the LED medium in which cameras see it; empty: all do
};

/// A steady sound, for microphones.
struct SoundItem {
  std::string id;
  Vec3 p_W{};
  double level = 1.0;  ///< 0 to 1, at the source
  int line = 0;
};

/// A vertex of a region's outline; the side that starts here is a wall, or a gate to `gate`.
struct BoundarySide {
  double x_m = 0.0;
  double y_m = 0.0;
  std::string gate;  ///< id of the engine behind this side; empty: a wall
  int line = 0;
};

struct EngineConfig {
  std::string kind;  ///< name of a KnownEngine; ARGoS' names are mapped
  std::string id;
  std::optional<double> top_m, bottom_m;
  std::vector<BoundarySide> sides;  ///< empty: the whole arena
  std::string regions;              ///< "", "4x4" or "auto"
  Element options;
  int line = 0;
};

struct MediumConfig {
  std::string kind;  ///< name of a MediumType
  std::string id;
  Element options;
  int line = 0;
};

/// The place of the medium of that kind and id among `media`, counted from 1; 0: none is named. Error: there is none.
hal::Result<std::uint8_t> medium_number(const std::vector<MediumConfig>& media, std::string_view kind,
                                        const std::string& id);

/// A library that adds to the catalog of the run.
struct PluginConfig {
  std::string library;
  int line = 0;
};

struct HookConfig {
  std::string library;
  std::string label;
  Element options;  ///< the whole element with its children
  int line = 0;
  bool optional = false;  ///< user functions of a view: without their library the run goes on, with a warning
};

struct TrajectoryConfig {
  std::string path;                   ///< CSV
  std::vector<std::string> entities;  ///< ids, or patterns with '*'
  std::int64_t every = 1;             ///< ticks between rows
};

/// Contents of a record of the run (core/record/record.hpp).
struct RecordConfig {
  std::string path;                           ///< empty: no record
  std::int64_t every = 1;                     ///< ticks between rows
  std::vector<std::string> entities = {"*"};  ///< ids of robots, or patterns with '*'
  std::vector<std::string> ports;             ///< names of ports; "*": all
  bool state = true;                          ///< what controllers publish
  std::int64_t fingerprint_every = 1000;      ///< ticks; 0: none
  bool look = true;                           ///< LEDs, turrets, grippers, halts, floor and hooks' drawings
  bool inputs = true;                         ///< of real robots, in every tick
  bool objects = true;                        ///< poses of movable ones
  bool attitudes = true;                      ///< of robots in space
};

struct Scenario {
  std::string file;
  std::string name;  ///< file name without folder and extension

  double length_s = 0.0;  ///< 0: endless
  std::int64_t ticks_per_second = 10;
  std::optional<std::uint64_t> seed;  ///< absent: from the clock (then named in the report)
  std::int64_t threads = 0;
  Assignment assignment = Assignment::Static;
  TimeMode time_mode = TimeMode::Fast;
  LockstepConfig lockstep;
  int priority = 0;  ///< SCHED_FIFO of the stepping thread of runs with real robots; 0: none is asked for

  Vec3 arena_size{};
  Vec3 arena_center{};
  EscapePolicy escape = EscapePolicy::Error;
  std::vector<Element> fields;  ///< what the file says of fields, each the element of a FieldType

  std::vector<EngineConfig> engines;
  std::vector<MediumConfig> media;
  std::vector<ControllerConfig> controllers;
  std::vector<KindConfig> kinds;
  std::vector<RobotItem> robots;
  std::vector<TrackerItem> trackers;
  SafetyConfig safety;
  DeskConfig desk;
  std::vector<ObjectItem> objects;
  std::vector<LightItem> lights;
  std::vector<SoundItem> sounds;
  std::vector<PluginConfig> plugins;
  std::vector<HookConfig> hooks;
  RecordConfig record;
  std::optional<TrajectoryConfig> trajectory;
  std::vector<Element> observers;  ///< each the element of an ObserverType
  std::vector<Element> run_parts;  ///< each the element of a RunPartType
  Element camera;                  ///< placements of ARGoS' view, kept for ours
  Element effective;               ///< the whole file with every default filled in
};

/// The kind of robot of that name: the file's, or the catalog's; null: there is none.
const hal::RobotKind* find_kind(const Scenario& scenario, const hal::Catalog& catalog, std::string_view name) noexcept;
/// The names of all kinds that robots of this scenario may have.
std::vector<std::string> kind_names(const Scenario& scenario, const hal::Catalog& catalog);
/// The catalog with these kinds, which must outlive it.
hal::Catalog with_kinds(const hal::Catalog& catalog, const std::vector<KindConfig>& kinds);
/// What a controller that takes whatever there is may take. Of a device and the same with more room one is listed: the
/// latter, for a real robot the former.
std::vector<hal::ListedDevice> listed_devices(const ControllerConfig& config, const hal::Catalog& catalog, bool real);
/// The kind whose bridge drives real robots of that one.
std::string bridged_as(const Scenario& scenario, const std::string& kind);

}  // namespace tandem::core
