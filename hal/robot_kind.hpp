// A kind of robot: its body, how it moves, and the parts that it is built with, each with its source.
//
//   RobotKind kind;
//   kind.name = "crab";
//   kind.body = {.radius_m = 0.1, .height_m = 0.1, .mass_kg = 1.0, .source = "[paper]"};
//   kind.locomotion = DifferentialDrive{…};
//   kind.add(ProximityPart{…});       parts are defined with their devices, in hal/device or in a library of their own
//   registrar.add(kind);              checks it
//   kind.part<ProximityPart>()        null: it is built without
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "hal/appearance.hpp"
#include "hal/catalog.hpp"
#include "hal/params.hpp"
#include "hal/surface.hpp"

namespace tandem::hal {

/// A sensor or lamp on the body. Body frame: x forward, y left, z up; bearing counter-clockwise from forward.
struct Mount {
  double bearing_rad = 0.0;  ///< where it looks
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  void describe(ParamVisitor& v);
  /// In files, one element of a list may stand for a ring of them, and give its place by its distance from the axis.
  static void add_to(std::vector<Mount>& mounts, ParamVisitor& v);
};

/// Flaw of a list of mounts for a port with `capacity` values; empty: none.
std::string mounts_flaw(const std::vector<Mount>& mounts, std::size_t capacity);

/// Mounts of a part that is nothing else: sensors, in the order of the readings of a port with so many.
template <std::size_t kMost>
struct MountedSensors {
  std::vector<Mount> mounts = {};
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.list("mount", mounts, "A sensor, in the order of the readings.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const { return mounts_flaw(mounts, kMost); }
};

/// A lamp that is nothing but its place.
struct MountedLamp {
  Mount mount = {};
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.group("mount", mount, "Its place.");
    v.text("source", source, "Where these figures come from.");
  }
};

/// An upright cylinder.
struct Body {
  static constexpr std::string_view kName = "body";
  static constexpr std::string_view kDoc = "An upright cylinder.";
  double radius_m = 0.0;
  double height_m = 0.0;
  double mass_kg = 0.0;
  std::string source = {};  ///< of these figures
  void describe(ParamVisitor& v);
};

/// Moves on two wheels, or tracks, beside each other.
struct DifferentialDrive {
  static constexpr std::string_view kName = "differential_drive";
  static constexpr std::string_view kDoc = "Drives on two wheels beside each other.";
  static constexpr double kNoLimit_m_s = 100.0;  ///< a `max_speed_m_s` that stands for none
  double wheel_radius_m = 0.0;
  double wheel_base_m = 0.0;   ///< distance between the two wheels' contact points
  double max_speed_m_s = 0.0;  ///< of a wheel, at its rim
  double force_N = 0.0;        ///< that the wheels together can push with
  double torque_Nm = 0.0;      ///< that they can turn the body with
  std::string source = {};
  void describe(ParamVisitor& v);
  /// What the element of a robot may say otherwise.
  void attributes(ParamVisitor& v);
  bool limited() const noexcept { return max_speed_m_s < kNoLimit_m_s; }
};

/// Flies on four rotors whose thrusts follow what is commanded with a lag [Mellinger and Kumar 2011, "Minimum snap
/// trajectory generation and control for quadrotors", ICRA].
struct Quadrotor {
  static constexpr std::string_view kName = "quadrotor";
  static constexpr std::string_view kDoc = "Flies on four rotors.";
  double max_speed_m_s = 0.0;          ///< in any direction
  double max_acceleration_m_s2 = 0.0;  ///< beyond what holds it up, in any direction
  double max_turn_rad_s = 0.0;
  double max_lean_rad = 0.0;    ///< that it obeys
  double max_thrust = 0.0;      ///< of all rotors together, in parts of its weight
  double climb_m_s = 0.0;       ///< when taking off or rising to the ceiling, by default
  double sink_m_s = 0.0;        ///< when landing, by default
  double take_off_m = 0.0;      ///< height to which it takes off
  double inertia_kg_m2 = 0.0;   ///< moment of inertia about each axis
  double rotor_arm_m = 0.0;     ///< from the axis to each of the rotors, at 45, 135, -135 and -45 degrees
  double rotor_lag_s = 0.0;     ///< in which a rotor's thrust covers 63 % of a change
  double rotor_torque_m = 0.0;  ///< drag torque about the rotor's axis for each newton of its thrust
  std::string source = {};
  void describe(ParamVisitor& v);
};

/// Locomotion of a kind; the first: none. The physics engines know these forms and no others.
using Locomotion = std::variant<std::monostate, DifferentialDrive, Quadrotor>;

/// Differs when a class of parts was compiled to another form: by size and alignment, those that it lists as `Crosses`
/// (hal/surface.hpp), and the number `kNumber` that it may raise.
template <class P>
constexpr std::uint64_t part_layout() noexcept {
  std::uint64_t layout = Layouts<P>::digest();
  if constexpr (requires { typename P::Crosses; }) layout = detail::mixed(layout, P::Crosses::digest());
  if constexpr (requires { P::kNumber; }) layout = detail::mixed(layout, P::kNumber);
  return layout;
}

/// Part of a kind: facts that a device needs of the robots that carry it. A part owns its data; it is found by name and
/// layout, never by the language's own type information, which two libraries need not share. It may have `std::string
/// flaw() const`: what makes it unusable, as in "has no mounts; give it at least one"; empty: nothing. `void
/// attributes(ParamVisitor&)`: what of it the element of a robot may say otherwise for that robot alone. And `void
/// appear(const RobotKind&, Appearance&) const`: what it looks like (hal/appearance.hpp).
template <class P>
concept RobotPart = Described<P> && requires(const P& part) {
  { P::kName } -> std::convertible_to<std::string_view>;
  { P::kDoc } -> std::convertible_to<std::string_view>;
  { part.source } -> std::convertible_to<std::string>;
} && std::is_copy_constructible_v<P>;

namespace detail {
/// Functions of the parts of one class; in the library that was compiled with it.
struct PartTable {
  std::string_view name, doc;
  std::uint64_t layout;
  void (*describe)(void* part, ParamVisitor& visitor);
  void (*attributes)(void* part, ParamVisitor& visitor);
  std::string (*flaw)(const void* part);
  void (*appear)(const void* part, const RobotKind& kind, Appearance& look);
  void* (*copy)(const void* part);
  void (*destroy)(void* part);
};
}  // namespace detail

/// A part of any class. Copies are deep.
class AnyPart {
 public:
  template <RobotPart P>
  explicit AnyPart(P part) : table_(&kTable<P>), data_(new P(std::move(part)), kTable<P>.destroy) {}
  AnyPart(const AnyPart& other) : table_(other.table_), data_(other.table_->copy(other.data_.get()), table_->destroy) {}
  AnyPart(AnyPart&&) noexcept = default;
  AnyPart& operator=(AnyPart other) noexcept {
    table_ = other.table_;
    data_ = std::move(other.data_);
    return *this;
  }
  ~AnyPart() = default;

  std::string_view name() const noexcept { return table_->name; }
  std::string_view doc() const noexcept { return table_->doc; }
  std::string flaw() const { return table_->flaw(data_.get()); }
  void appear(const RobotKind& kind, Appearance& look) const { table_->appear(data_.get(), kind, look); }
  void describe(ParamVisitor& v);
  void attributes(ParamVisitor& v);
  /// Null when the part has another name or form.
  void* as(std::string_view name, std::uint64_t layout) const noexcept {
    return table_->layout == layout && table_->name == name ? data_.get() : nullptr;
  }

 private:
  template <class P>
  static constexpr detail::PartTable kTable = {
      P::kName,
      P::kDoc,
      part_layout<P>(),
      [](void* part, ParamVisitor& v) { static_cast<P*>(part)->describe(v); },
      [](void* part, ParamVisitor& v) {
        if constexpr (requires(P & p) { p.attributes(v); }) static_cast<P*>(part)->attributes(v);
      },
      [](const void* part) {
        if constexpr (requires(const P& p) { p.flaw(); })
          return std::string(static_cast<const P*>(part)->flaw());
        else
          return std::string();
      },
      [](const void* part, const RobotKind& kind, Appearance& look) {
        if constexpr (requires(const P& p) { p.appear(kind, look); }) static_cast<const P*>(part)->appear(kind, look);
      },
      [](const void* part) -> void* { return new P(*static_cast<const P*>(part)); },
      [](void* part) { delete static_cast<P*>(part); }};

  const detail::PartTable* table_;
  std::unique_ptr<void, void (*)(void*)> data_;
};

/// A class of parts, so that files can name it: `registrar.add(hal::part_type<LiftPart>())`, where its port is
/// registered.
struct PartType {
  static constexpr std::string_view kCategory = "part";
  using Crosses = Layouts<AnyPart, detail::PartTable, ParamVisitor, ParamList, Mount, Appearance, Appearance::Joint,
                          Appearance::Link, Appearance::Lamp, Driver, std::string>;
  std::string_view name;        ///< of the element in that of a kind
  std::string_view summary;     ///< for people: a line
  AnyPart (*make)() = nullptr;  ///< with the defaults of the class
};

/// The table of a class of parts.
template <RobotPart P>
requires std::is_default_constructible_v<P>
const PartType& part_type() {
  static constexpr PartType type{P::kName, P::kDoc, [] { return AnyPart(P{}); }};
  return type;
}

/// A part that robots of a kind may be built with besides, or in place of their own. ARGoS files mean it by listing its
/// device, under the name of the port or one of ARGoS' own.
struct ExtraPart {
  static constexpr std::string_view kCategory = "extra_part";
  using Crosses = Layouts<AnyPart, detail::PartTable>;
  std::string_view robot, device;
  AnyPart (*make)() = nullptr;

  std::string catalog_name() const { return entry(robot, device); }
  static std::string entry(std::string_view robot, std::string_view device) {
    return std::string(robot) + " " + std::string(device);
  }
};

/// All that is known of a kind of robot. Constant while it is in a catalog: devices, bridges and controllers keep
/// pointers into it.
class RobotKind {
 public:
  static constexpr std::string_view kCategory = "robot";
  static constexpr std::uint32_t kNumber = 3;
  static constexpr bool kWhole = true;
  using Crosses = Layouts<Body, Locomotion, DifferentialDrive, Quadrotor, AnyPart, detail::PartTable, std::string>;

  std::string name;     ///< as the element in experiment files, e.g. "e-puck"
  std::string summary;  ///< for people: a line
  Body body;
  Locomotion locomotion;

  const DifferentialDrive* drive() const noexcept { return std::get_if<DifferentialDrive>(&locomotion); }
  const Quadrotor* flight() const noexcept { return std::get_if<Quadrotor>(&locomotion); }
  bool flies() const noexcept { return flight() != nullptr; }
  /// The most that it moves with by itself; 0: it stays.
  double top_speed_m_s() const noexcept {
    return drive() != nullptr ? drive()->max_speed_m_s : flies() ? flight()->max_speed_m_s : 0.0;
  }

  template <RobotPart P>
  RobotKind& add(P part) {
    parts_.emplace_back(std::move(part));
    return *this;
  }
  RobotKind& add(AnyPart part) {
    parts_.push_back(std::move(part));
    return *this;
  }
  /// Takes the part of that name away. False: it has none.
  bool remove(std::string_view part) {
    return std::erase_if(parts_, [&](const AnyPart& p) { return p.name() == part; }) > 0;
  }
  /// The part, or null. Body and locomotion are found in the same way. Not for loops: it looks the part up by name.
  template <class P>
  const P* part() const noexcept {
    if constexpr (std::is_same_v<P, Body>)
      return &body;
    else if constexpr (std::is_same_v<P, DifferentialDrive> || std::is_same_v<P, Quadrotor>)
      return std::get_if<P>(&locomotion);
    else
      return static_cast<const P*>(find(P::kName, part_layout<P>()));
  }
  template <class P>
  P* part() noexcept {
    return const_cast<P*>(std::as_const(*this).template part<P>());
  }
  const std::vector<AnyPart>& parts() const noexcept { return parts_; }
  std::span<AnyPart> parts() noexcept { return parts_; }

  /// Body, locomotion and parts, each as a group of its own.
  void describe(ParamVisitor& v);
  /// What the element of a robot may say otherwise for that robot alone, in the order of the parts.
  void attributes(ParamVisitor& v);
  /// Adds the looks of body and locomotion to those of the parts, unless these say that they are all.
  void appear(Appearance& look) const;
  /// What makes the kind unusable, as in "has no body; …"; empty: nothing. Asked when it is registered.
  std::string flaw() const;

 private:
  void* find(std::string_view part, std::uint64_t layout) const noexcept {
    for (const AnyPart& p : parts_) {
      if (void* const found = p.as(part, layout); found != nullptr) return found;
    }
    return nullptr;
  }

  std::vector<AnyPart> parts_;
};

}  // namespace tandem::hal
