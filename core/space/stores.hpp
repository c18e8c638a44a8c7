// The arrays that hold the simulated state. For the kernels that run over them; others go through Space.
//
// Robots of one kind and one controller configuration form a group; a group's robots lie in blocks of up to kBlockRows.
// Within a block, row i of every array, port array and controller array is the same robot. Blocks never move once made,
// so ports and controllers keep their addresses. At the start rows are in spatial order, so that neighbours share cache
// lines.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/space/body_index.hpp"
#include "core/space/body_key.hpp"
#include "core/space/columns.hpp"
#include "core/space/field.hpp"
#include "core/space/halt.hpp"
#include "core/space/ids.hpp"
#include "core/space/joint.hpp"
#include "core/space/large_memory.hpp"
#include "core/space/mechanisms.hpp"
#include "core/space/object_index.hpp"
#include "core/space/real_sense.hpp"
#include "core/space/region.hpp"
#include "core/space/space.hpp"
#include "hal/controller.hpp"
#include "hal/port.hpp"
#include "hal/robot_kind.hpp"
#include "hal/surface.hpp"

namespace tandem::core {

struct RobotItem;       // core/scenario/scenario.hpp
struct GroupFactories;  // core/device/device.hpp
class Medium;           // core/medium/medium.hpp

inline constexpr std::size_t kBlockRows = 256;

/// Height, attitude and velocities of a body, for engines with forces or a third dimension. In W.
struct Motion {
  static constexpr std::string_view kName = "motion";
  static constexpr std::string_view kDoc = "Height, attitude and velocities.";
  double z_m = 0.0;  ///< of the base above the ground
  std::array<double, 4> q_WB = {1.0, 0.0, 0.0,
                                0.0};  ///< w, x, y, z; its yaw is the heading. Engines of the plane: unused
  std::array<double, 3> v_m_s{};
  std::array<double, 3> w_rad_s{};

  void describe(hal::FieldList& f) const {
    f.add("z", z_m, hal::unit::m, "of the base above the ground");
    f.add("q_WB", q_WB, hal::unit::none, "w, x, y, z");
    f.add("v", v_m_s, hal::unit::m_s, "in W");
    f.add("w", w_rad_s, hal::unit::rad_s, "in W");
  }
};

/// Setpoint of a flying robot.
struct FlightCommand {
  static constexpr std::string_view kName = "flight_command";
  static constexpr std::string_view kDoc = "What pilots tell flying robots to do.";

  enum class Mode : std::uint8_t {
    None,  ///< motors off: it falls or stands
    Velocity,
    Position,
    Attitude,
    Held  ///< motors off, held where it is by something that does not give way
  };
  Mode mode = Mode::None;
  /// Velocity in m/s, or position in m, in W; Attitude: roll and pitch in rad, thrust in parts of the weight.
  std::array<double, 3> target{};
  double yaw = 0.0;  ///< Velocity, Attitude: turn rate in rad/s; Position: heading in rad

  void describe(hal::FieldList& f) const {
    f.add("mode", mode, hal::unit::none, "");
    f.add("target", target, hal::unit::none, "in W; an attitude: roll, pitch, thrust");
    f.add("yaw", yaw, hal::unit::none, "in rad/s, of a position in rad");
  }
};

/// Bodies, one array a quantity. Positions and headings in W.
struct Bodies {
  LargeVector<double> x_m, y_m;
  LargeVector<double> cos_h, sin_h;
  LargeVector<double> left_m_s, right_m_s;  ///< rim speeds that the engine drives with in this tick
  LargeVector<double> left_m, right_m;      ///< rolled since the start
  LargeVector<float> radius_m;
  LargeVector<std::uint8_t> flags;    ///< BodyFlag
  LargeVector<std::uint32_t> entity;  ///< index of the robot's id
  LargeVector<std::uint16_t> region;  ///< index into SpaceStores::regions
  bool has_motion = false;            ///< an engine takes part that keeps bodies of its own
  std::vector<Motion> motion;         ///< empty without

  std::size_t size() const noexcept { return x_m.size(); }
  void resize(std::size_t rows);
  void reserve(std::size_t rows);
  std::size_t bytes() const noexcept {
    const std::size_t a_row =
        8 * sizeof(double) + sizeof radius_m[0] + sizeof flags[0] + sizeof entity[0] + sizeof region[0];
    return size() * a_row + motion.size() * sizeof(Motion);
  }
  void remember(auto& archive) {
    archive(x_m, y_m, cos_h, sin_h, left_m_s, right_m_s, left_m, right_m, radius_m, flags, entity, region, has_motion,
            motion);
  }
};

enum BodyFlag : std::uint8_t {
  kAlive = 1,
  kExternal = 2,   ///< pose set from outside: engines leave it, others bump into it
  kEscaped = 4,    ///< left the arena in this tick
  kNotFinite = 8,  ///< its controller commanded something that is no finite number, in this tick
  kMoved = 16      ///< put somewhere else between steps: its region is to be found again
};

/// A robot's place in a block.
struct Slot {
  std::uint32_t block = 0;
  std::uint32_t slot = 0;
};

/// Use of a medium by the devices of a group.
struct MediumUse {
  const Medium* medium = nullptr;
  bool publishes = false, listens = false;
  double reach_m = 0.0;  ///< how far along the ground they look for signals; 0: as far as those reach
};

/// A group of robots: what they have in common.
struct RobotGroup {
  std::shared_ptr<const RobotItem> item;  ///< one of theirs: what it says of battery and radio holds for all
  const hal::RobotKind* kind = nullptr;
  const hal::ControllerType* controller = nullptr;
  std::size_t config = 0;                           ///< index into Scenario::controllers
  std::shared_ptr<const void> params;               ///< of those that have none of their own in RobotBlock::params
  std::shared_ptr<const GroupFactories> factories;  ///< of the devices that its configuration lists
  std::vector<const hal::PortType*> ports;          ///< those that its controllers took, in the order of taking
  std::vector<KeptColumn> columns;                  ///< that their devices need
  std::vector<hal::PublishedField> published;       ///< what its controllers show, with offsets into each of them
  double rab_range_m = 0.0;
  double rab_height_m = 0.0;  ///< of their range-and-bearing boards, where they have any
  unsigned rab_payload = 0;
  std::vector<MediumUse> media;  ///< that the devices work in
  std::vector<std::size_t> blocks;
  std::vector<Slot> free_slots;  ///< of robots that were removed; the last is used next

  /// Whether its controllers took such a port.
  template <class Port>
  bool takes() const noexcept {
    const hal::PortType& type = hal::port_type<Port>();
    for (const hal::PortType* port : ports) {
      if (port->layout == type.layout && port->role == type.role) return true;
    }
    return false;
  }
  const MediumUse* use_of(const Medium& medium) const noexcept {
    for (const MediumUse& use : media) {
      if (use.medium == &medium) return &use;
    }
    return nullptr;
  }
};

/// Up to kBlockRows robots of one group. Slots below `used` hold or held robots; those of robots that were removed are
/// halted, and their rows not alive.
struct RobotBlock {
  std::size_t group = 0;
  std::size_t first_row = 0;
  std::size_t capacity = 0;
  std::size_t used = 0;
  std::vector<std::byte*> ports;  ///< parallel to RobotGroup::ports
  std::byte* controllers = nullptr;
  std::size_t controller_stride = 0;
  /// By slot, of robots that came while the run goes on with parameters of their own; as long as the last such needs.
  std::vector<std::shared_ptr<const void>> params;
  /// Arrays that are not the slab's: those made while the run goes on. Shared with the snapshots that put them back.
  std::vector<std::shared_ptr<std::byte>> own_arrays;
  std::array<std::uint8_t, kBlockRows> halted{};       ///< bits of HaltOwner; 0: its controller steps
  std::array<std::uint8_t, kBlockRows> constructed{};  ///< 1: a controller lives in the slot

  std::byte* controller(std::size_t slot) const noexcept { return controllers + slot * controller_stride; }
  template <class T>
  T* port_array(std::size_t i) const noexcept {
    return std::launder(reinterpret_cast<T*>(ports[i]));
  }
};

/// One robot by id.
struct RobotEntity {
  std::uint32_t generation = 0;
  std::uint32_t block = 0;
  std::uint32_t slot = 0;
  std::uint32_t item = 0;    ///< of SpaceStores::names
  std::int64_t number = -1;  ///< appended to the item's id; -1: nothing
  bool alive = false;
  std::uint8_t real_senses = 0;  ///< bits of RealSense, of one whose pose is set from outside
};

/// Ids of robots are not stored one by one: "ep" + number, numbers rising from `base` for entities from `first_entity`.
struct NameRange {
  std::string prefix;
  std::int64_t base = -1;  ///< -1: a single robot, the prefix is its id
  std::uint32_t first_entity = 0;
  std::uint32_t count = 1;

  void remember(auto& archive) { archive(prefix, base, first_entity, count); }
};

struct SpaceStores {
  double min_x_m = -1.0, min_y_m = -1.0, max_x_m = 1.0, max_y_m = 1.0;  ///< the arena
  double max_z_m = std::numeric_limits<double>::infinity();             ///< its ceiling: what flies stays below

  Bodies bodies;
  Columns columns;
  Column<FlightCommand> flight = columns.of<FlightCommand>();  ///< of robots that fly; so with the next
  Column<RotorState> rotors = columns.of<RotorState>();
  Slab slab;  ///< holds ports and controllers of the blocks that were made at the start
  std::vector<RobotGroup> groups;
  std::vector<RobotBlock> blocks;
  std::vector<RobotEntity> robots;    ///< by entity index
  std::vector<std::uint32_t> living;  ///< entity indices, rising
  bool twins = false;                 ///< the pose of some robot is set from outside, or was
  std::vector<NameRange> names;       ///< those of the file, then those of the added robots, one each
  std::unordered_map<std::string, std::uint32_t> added_robots;  ///< entity index by id, also of robots that are gone

  std::vector<Object> objects;  ///< by number; parallel to the next two
  std::vector<Motion> object_motion;
  std::vector<std::uint16_t> object_region;  ///< of movable ones
  std::uint64_t immovables_version = 1;      ///< rises whenever an immovable object appears, changes or goes
  bool bodies_changed = true;                ///< robots or movable objects appeared, went or were put elsewhere
  std::unordered_map<std::string, std::uint32_t> object_numbers;  ///< by id, also of objects that are gone
  ObjectIndex static_index;                                       ///< of the immovable ones
  ObjectIndex movable_index;
  std::uint64_t object_leds_version = 1;  ///< rises whenever an LED of an object changes
  std::vector<Joint> joints;              ///< by number

  std::vector<Region> regions;  ///< at least one
  double border_reach_m = 0.0;  ///< how far outside its outline a region's mirrored bodies may lie
  BodyIndex body_index;

  std::vector<LightSource> lights;
  std::vector<SoundSource> sounds;
  Fields fields;
  Sketch sketch;

  std::uint32_t generations = 0;  ///< rises with every id that is given out after the start, and with every restore
  std::uint32_t joint_generations = 0;  ///< the same for joints
  bool altered = false;                 ///< something came, or anything immovable changed or went, since the start
  std::uint64_t poses_version = 1;      ///< rises whenever engines moved bodies
  std::vector<BodyKey> touched;         ///< bodies that came or were put elsewhere since then

  /// Calls `visit(const Object&)` for every living object that may be within the indices' reach of (x, y).
  template <class Visit>
  [[gnu::always_inline]] inline void for_each_object_near(double x_m, double y_m, Visit&& visit) const noexcept {
    for (const std::uint32_t k : static_index.near(x_m, y_m)) visit(objects[k]);
    if (movable_index.empty()) return;
    for (const std::uint32_t k : movable_index.near(x_m, y_m)) visit(objects[k]);
  }

  const RobotGroup& group_of_row(std::size_t row) const noexcept {
    return groups[blocks[robots[bodies.entity[row]].block].group];
  }
  const hal::RobotKind& kind_of_row(std::size_t row) const noexcept { return *group_of_row(row).kind; }
  /// How high the base of a body stands above the ground, in m.
  double base_m(std::size_t row) const noexcept { return bodies.motion.empty() ? 0.0 : bodies.motion[row].z_m; }
  /// What a column holds for the robot in this row; null: nothing.
  template <class T>
  T* state_of(const Column<T>& column, std::size_t row) const noexcept {
    if (column.empty()) return nullptr;
    const RobotEntity& e = robots[bodies.entity[row]];
    return column.at(e.block, e.slot);
  }
  /// What the robot in this row is told to fly like; one that does not fly: nothing.
  const FlightCommand& command_of(std::size_t row) const noexcept {
    static constexpr FlightCommand kNone;
    const FlightCommand* command = state_of(flight, row);
    return command == nullptr ? kNone : *command;
  }
  /// Whether engines leave the body where it is: its pose is set from outside, or it hangs at the ceiling.
  bool led_or_held(std::size_t row) const noexcept {
    return (bodies.flags[row] & kExternal) != 0 ||
           (!flight.empty() && command_of(row).mode == FlightCommand::Mode::Held);
  }
  /// Whether some height belongs to both bodies. Call only while `bodies.motion` is there: else all stand on the
  /// ground.
  bool side_by_side(std::size_t row, std::size_t other) const noexcept {
    const double low = bodies.motion[row].z_m;
    const double other_low = bodies.motion[other].z_m;
    return low < other_low + kind_of_row(other).body.height_m && other_low < low + kind_of_row(row).body.height_m;
  }

  /// Whether the body in `row` is a real robot that senses `other`, another real one, by itself.
  bool senses_really(std::size_t row, std::size_t other, RealSense sense) const noexcept {
    if (!twins || (bodies.flags[row] & bodies.flags[other] & kExternal) == 0) return false;
    const auto has = [&](std::size_t which) { return (robots[bodies.entity[which]].real_senses & bit(sense)) != 0; };
    return has(row) && (sense != RealSense::Messages || has(other));
  }
  std::size_t row_of(RobotId id) const noexcept {
    const RobotEntity& e = robots[id.index];
    return blocks[e.block].first_row + e.slot;
  }
  std::byte* controller_of(RobotId id) const noexcept {
    const RobotEntity& e = robots[id.index];
    return blocks[e.block].controller(e.slot);
  }
  bool contains(RobotId id) const noexcept {
    return id.index < robots.size() && robots[id.index].alive && robots[id.index].generation == id.generation;
  }
  bool contains(ObjectId id) const noexcept {
    return id.index < objects.size() && objects[id.index].alive && objects[id.index].generation == id.generation;
  }
  /// The entity that has or had this id.
  std::optional<std::uint32_t> find_entity(std::string_view id) const noexcept;
  /// A body was put where it is now, or came: engines, regions and indices are to take notice.
  void touch(BodyKey body) {
    touched.push_back(body);
    bodies_changed = true;
  }
};

/// What the state of a space is made of besides its groups, blocks, columns and fields: for copies of it, in memory and
/// on disk.
template <class Stores>
auto parts_of(Stores& s) noexcept {
  return std::tie(s.bodies, s.robots, s.living, s.names, s.added_robots, s.objects, s.object_numbers, s.object_motion,
                  s.object_region, s.joints, s.lights, s.sounds, s.body_index, s.static_index, s.movable_index,
                  s.altered, s.sketch);
}
/// The same as values.
template <class... T>
std::tuple<std::remove_const_t<T>...> values_of(const std::tuple<T&...>& /*parts*/);
using SpaceParts = decltype(values_of(parts_of(std::declval<SpaceStores&>())));

/// Layouts that plug-ins which work on the stores must have been built against.
using StoreLayouts =
    hal::Layouts<SpaceStores, Bodies, Motion, FlightCommand, Columns, ColumnArrays, KeptColumn, RobotGroup, RobotBlock,
                 RobotEntity, Object, Joint, Region, LightSource, SoundSource, Field, FieldGrid, Fields, FieldPlaces,
                 FieldSpot, hal::RowType, hal::RobotKind, hal::RobotKind::Crosses>;

/// The stores as a surface of their own, for parts whose tables say nothing of them: fields, media, observers. Their
/// base classes write it into the note of a plug-in that has such.
struct StoresSurface {
  static constexpr std::string_view kCategory = "stores";
  using Crosses = StoreLayouts;
};

inline Field::Field() noexcept {
  hal::detail::note_surface<StoresSurface>();
}

}  // namespace tandem::core
