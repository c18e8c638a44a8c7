// Ports: one device of one robot as plain data that describes its own fields.
// Rows of what the simulation keeps for a robot describe themselves in the same way.
//
// A reading (sensor) carries when it was taken and whether it can be trusted; a command (actuator),
// default-constructed, is the safe one. `port_type<T>()` gives the description at run time, so that recording,
// printing, comparing and fusing need no code per device.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "hal/limits.hpp"
#include "hal/robot_kind.hpp"
#include "hal/surface.hpp"
#include "hal/time.hpp"
#include "hal/unit.hpp"

namespace tandem::hal {

/// Absent: never measured, or the device is not there. Stale: measured, but too long ago to act on. Fresh: of this
/// tick.
enum class Validity : std::uint8_t { Absent, Stale, Fresh };

/// First base of every sensor port.
struct Reading {
  TimeNs taken_ns = 0;  ///< when the values were measured, on the run's clock
  Validity validity = Validity::Absent;
};

/// First base of every actuator port. A default-constructed command is the safe one (wheels 0, LEDs off). How others
/// are made safe is said by its `limit` (hal/limits.hpp).
struct Command {};

enum class Role : std::uint8_t { Sensor, Actuator };
enum class Scalar : std::uint8_t { F32, F64, U8, U16, U32, I32, I64, Bool };

/// In which frame a field is expressed. Body: x forward, y left, z up.
enum class Frame : std::uint8_t { None, Body, World, Sensor };

/// Rule by which a real reading and a virtual one of the same device become one.
enum class Fusion : std::uint8_t {
  Real,     ///< the real device's value
  Virtual,  ///< the simulated device's value
  Nearer,   ///< the smaller (distances)
  Larger,   ///< the larger (activations)
  Union,    ///< entries of both, each once (messages, blobs); done by the port's own `merge`
  ByAngle   ///< the nearer of those that look the same way (distances of a scanner); done by the port's own `merge`
};

/// In bytes.
constexpr std::size_t size_of(Scalar scalar) noexcept {
  switch (scalar) {
    case Scalar::U8:
    case Scalar::Bool:
      return 1;
    case Scalar::U16:
      return 2;
    case Scalar::F32:
    case Scalar::U32:
    case Scalar::I32:
      return 4;
    case Scalar::F64:
    case Scalar::I64:
      return 8;
  }
  return 1;
}

/// One field of a row: `count` scalars at `offset`.
struct Field {
  std::string_view name;
  std::size_t offset = 0;
  Scalar scalar = Scalar::F32;
  std::size_t count = 1;  ///< capacity; how many are in use is the field `used_by` where that is set
  Unit unit = unit::none;
  Frame frame = Frame::None;
  Fusion fusion = Fusion::Real;
  std::string_view doc;
  std::string_view used_by = {};  ///< name of the field that holds how many of `count` are in use; empty: all
};

/// The run-time description of plain data. One per class and program; compare by name and `layout`.
struct RowType {
  std::string_view name;  ///< of a port: as written in experiment files, e.g. "proximity"
  std::string_view doc;
  std::size_t size = 0;
  std::size_t align = 0;
  std::uint64_t layout = 0;  ///< fingerprint of names, offsets and types: equal on both sides of a plug-in border
  std::vector<Field> fields;
  void (*reset)(void*) = nullptr;  ///< writes the default
  const void* initial = nullptr;   ///< a row as `reset` leaves it

  const Field* field(std::string_view field_name) const noexcept;
};

/// "sensor proximity": the name of a port and its role, as the catalog has it.
std::string port_entry(std::string_view name, Role role);

/// The run-time description of a port class. Its default is an absent reading, or the safe command.
struct PortType : RowType {
  static constexpr std::string_view kCategory = "port";
  static constexpr std::uint32_t kNumber = 2;
  using Crosses = Layouts<RowType, Field, Unit, Reading, Command, Limited, Fence, Pose, RobotKind, RobotKind::Crosses>;
  Role role = Role::Sensor;
  void (*merge)(void* real, const void* virtual_) = nullptr;  ///< for Fusion::Union and ByAngle; null where none

  /// Makes commands safe, in place, from number `first` on: stops after the first of them that had to be changed, tells
  /// in `what` how, and returns its number; `end` when none had. Null where any value is safe, and for sensors.
  std::size_t (*limit)(void* commands, std::size_t first, std::size_t end, const RobotKind& kind,
                       Limited& what) = nullptr;
  /// The three that follow are set for commands that move the robot, and are asked for real robots alone.
  /// Slows the command so that the robot moves with `most_m_s` at most; the way and the direction stay. `at`: where it
  /// is; null: unknown.
  void (*slow_down)(void* command, double most_m_s, const Pose* at) = nullptr;
  /// Takes away, or replaces, what leads out of the fence within `look_ahead_s`. @returns whether there was such.
  bool (*keep_inside)(void* command, const Fence& fence, const Pose& at, double look_ahead_s) = nullptr;
  /// Takes away what leads deeper into something; (out_x, out_y) is the way out in W, of length 1. Turning and coming
  /// out stay possible. @returns whether there was such.
  bool (*keep_out)(void* command, const Pose& at, double out_x, double out_y) = nullptr;
  /// The port that this one is with more room than any real robot has; empty: none.
  std::string_view grows = {};

  std::string catalog_name() const { return port_entry(name, role); }
  /// That of the port without more room.
  std::string_view plain_name() const noexcept { return grows.empty() ? name : grows; }
};

/// Part that limits the commands of robots of a kind. A kind without such a part: one that allows nothing.
template <class Part>
const Part& limiting(const RobotKind& kind) noexcept {
  if constexpr (std::is_same_v<Part, RobotKind>) {
    return kind;
  } else {
    static const Part none{};
    const Part* const part = kind.part<Part>();
    return part != nullptr ? *part : none;
  }
}

namespace detail {
template <class T>
constexpr Scalar scalar_of() {
  if constexpr (std::is_same_v<T, float>)
    return Scalar::F32;
  else if constexpr (std::is_same_v<T, double>)
    return Scalar::F64;
  else if constexpr (std::is_same_v<T, bool>)
    return Scalar::Bool;
  else if constexpr (std::is_enum_v<T>)
    return scalar_of<std::underlying_type_t<T>>();
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return Scalar::U8;
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return Scalar::U16;
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return Scalar::U32;
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return Scalar::I32;
  else {
    static_assert(std::is_same_v<T, std::int64_t> || std::is_same_v<T, long long>, "not a scalar that a port may hold");
    return Scalar::I64;
  }
}
std::uint64_t layout_fingerprint(const RowType& type) noexcept;

template <class T>
std::size_t limit_commands(void* commands, std::size_t first, std::size_t end, const RobotKind& kind,
                           Limited& what) noexcept {
  T* const all = static_cast<T*>(commands);
  const auto& by = limiting<typename T::LimitedBy>(kind);
  for (std::size_t i = first; i < end; ++i) {
    const Limited limited = all[i].limit(by);
    if (limited.result == LimitResult::Passed) continue;
    what = limited;
    return i;
  }
  return end;
}

template <class T>
concept MovesRobot = requires(T t, const Fence& fence, const Pose& at) {
  t.slow_down(0.0, &at);
  { t.keep_inside(fence, at, 0.0) } -> std::same_as<bool>;
  { t.keep_out(at, 0.0, 0.0) } -> std::same_as<bool>;
};

template <class T>
concept LimitsItself = requires {
  typename T::LimitedBy;
}
&&requires(T c, const typename T::LimitedBy& by) {
  c.limit(by);
};

/// Fills in the limits of commands of class `T`.
template <class T>
void fill_limits(PortType& t) {
  constexpr bool limited = LimitsItself<T>;
  constexpr bool any_is_safe = requires {
    T::kAnyValueIsSafe;
  };
  static_assert(limited != any_is_safe,
                "an actuator says how its commands are made safe: by `using LimitedBy = TurretPart;` (a part, a "
                "locomotion, or RobotKind) and `Limited limit(const LimitedBy&) noexcept`, or by "
                "`static constexpr bool kAnyValueIsSafe = true;`");
  if constexpr (limited) t.limit = &limit_commands<T>;
  constexpr bool part = requires(T c, const Fence& fence, const Pose& at) {
    c.keep_inside(fence, at, 0.0);
  }
  || requires(T c, const Pose& at) {
    c.slow_down(0.0, &at);
  }
  || requires(T c, const Pose& at) {
    c.keep_out(at, 0.0, 0.0);
  };
  static_assert(!part || MovesRobot<T>, "a command that moves the robot has slow_down, keep_inside and keep_out");
  if constexpr (MovesRobot<T>) {
    t.slow_down = [](void* c, double most_m_s, const Pose* at) { static_cast<T*>(c)->slow_down(most_m_s, at); };
    t.keep_inside = [](void* c, const Fence& fence, const Pose& at, double look_ahead_s) {
      return static_cast<T*>(c)->keep_inside(fence, at, look_ahead_s);
    };
    t.keep_out = [](void* c, const Pose& at, double out_x, double out_y) {
      return static_cast<T*>(c)->keep_out(at, out_x, out_y);
    };
  }
}
}  // namespace detail

/// Collects the fields of one class of rows; handed to `T::describe`.
class FieldList {
 public:
  FieldList(const void* base, std::vector<Field>& fields)
      : base_(static_cast<const std::byte*>(base)), fields_(fields) {}

  /// `member` is a scalar or an array of scalars of the row at hand.
  template <class M>
  Field& add(std::string_view name, const M& member, const Unit& unit, Frame frame, Fusion fusion,
             std::string_view doc) {
    Field f;
    f.name = name;
    f.offset = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&member) - base_);
    if constexpr (requires {
                    typename M::value_type;
                    std::tuple_size<M>::value;
                  }) {
      f.scalar = detail::scalar_of<typename M::value_type>();
      f.count = std::tuple_size<M>::value;
    } else {
      f.scalar = detail::scalar_of<M>();
    }
    f.unit = unit;
    f.frame = frame;
    f.fusion = fusion;
    f.doc = doc;
    fields_.push_back(f);
    return fields_.back();
  }

  /// A field of a row that no real robot has.
  template <class M>
  Field& add(std::string_view name, const M& member, const Unit& unit, std::string_view doc) {
    return add(name, member, unit, Frame::None, Fusion::Virtual, doc);
  }

 private:
  const std::byte* base_;
  std::vector<Field>& fields_;
};

template <class T>
concept SensorPort = std::is_base_of_v<Reading, T>;
template <class T>
concept ActuatorPort = std::is_base_of_v<Command, T>;

namespace detail {
/// Fills in all but `layout`; `list_more` adds the fields that stand before T's own.
template <class T, class ListMore>
void describe_row(RowType& type, ListMore&& list_more) {
  static_assert(std::is_trivially_copyable_v<T>, "a row is plain data");
  static const T prototype{};
  type.name = T::kName;
  type.doc = T::kDoc;
  type.size = sizeof(T);
  type.align = alignof(T);
  type.initial = &prototype;
  type.reset = [](void* row) { *static_cast<T*>(row) = T{}; };
  FieldList list(&prototype, type.fields);
  list_more(list, prototype);
  prototype.describe(list);
  type.layout = layout_fingerprint(type);
}
}  // namespace detail

/// The description of class `T`, which has `kName`, `kDoc` and `void describe(FieldList&) const`.
template <class T>
const RowType& row_type() {
  static const RowType type = [] {
    RowType t;
    detail::describe_row<T>(t, [](FieldList&, const T&) {});
    return t;
  }();
  return type;
}

/// The description of port class `T`.
template <class T>
const PortType& port_type() {
  static_assert(SensorPort<T> || ActuatorPort<T>);
  static const PortType type = [] {
    PortType t;
    t.role = SensorPort<T> ? Role::Sensor : Role::Actuator;
    detail::describe_row<T>(t, [](FieldList& list, const T& port) {
      if constexpr (SensorPort<T>) {
        list.add("taken_ns", port.taken_ns, unit::none, Frame::None, Fusion::Real, "when the values were measured");
        list.add("validity", port.validity, unit::none, Frame::None, Fusion::Real, "0 absent, 1 stale, 2 fresh");
      }
    });
    if constexpr (requires(T & a, const T& b) { a.merge(b); }) {
      t.merge = [](void* real, const void* virt) { static_cast<T*>(real)->merge(*static_cast<const T*>(virt)); };
    }
    if constexpr (ActuatorPort<T>) detail::fill_limits<T>(t);
    if constexpr (requires { T::kGrows; }) t.grows = T::kGrows;
    return t;
  }();
  return type;
}

/// Element `index` of `field` in `row`, as a double (exact for all but large 64-bit integers).
double get_value(const void* row, const Field& field, std::size_t index) noexcept;
void set_value(void* row, const Field& field, std::size_t index, double value) noexcept;

/// Field that counts the entries in use of another, and the number of scalars of each. No field: all are in use.
struct UsedBy {
  const Field* field = nullptr;
  std::size_t per_entry = 1;
};
UsedBy used_by(const RowType& type, const Field& field) noexcept;

/// Number of elements of `field` that are in use in this row.
std::size_t used_count(const RowType& type, const void* row, const Field& field) noexcept;
std::size_t used_count(const UsedBy& used, const void* row, const Field& field) noexcept;

/// "proximity: distance=[0.1 0.1 …] m validity=2 …": every field in use, for people.
std::string to_text(const PortType& type, const void* port);

/// Largest absolute difference over all fields in use but the stamps; infinity when the numbers of elements differ.
double max_difference(const PortType& type, const void* a, const void* b) noexcept;

/// True when every floating-point value in the port is finite.
bool all_finite(const PortType& type, const void* port) noexcept;

/// Makes `real` the fused reading of both, field by field as each says: of a field with `used_by`, as many entries as
/// both sides use. An absent side is left out; the virtual side alone stands in for an absent device where all that it
/// says may come from there (fields of Fusion::Virtual or Union). A stale real reading stays stale.
void fuse(const PortType& type, void* real, const void* virtual_) noexcept;

}  // namespace tandem::hal
