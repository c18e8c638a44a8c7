// A robot as its controller sees it while being constructed: who it is, and the devices it has.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "hal/port.hpp"
#include "hal/published.hpp"
#include "hal/random.hpp"
#include "hal/robot_kind.hpp"
#include "hal/robot_log.hpp"

namespace tandem::hal {

/// A device that the robot does not have, or that its configuration does not list. Thrown from a controller's
/// constructor.
class DeviceError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Handed to a controller's constructor and valid only during it; the ports it gives live as long as the robot.
class Robot {
 public:
  virtual ~Robot() = default;

  virtual std::string_view id() const noexcept = 0;
  /// What kind of robot it is: its body, how it moves, its parts. Lives as long as the robot.
  virtual const RobotKind& kind() const noexcept = 0;
  /// A part of it, or its locomotion: `robot.part<DifferentialDrive>().wheel_base_m`.
  /// @throws DeviceError when robots of its kind are built without.
  template <class P>
  const P& part() const {
    const P* const found = kind().template part<P>();
    if (found == nullptr)
      throw DeviceError("needs the part '" + std::string(P::kName) + "', which the robot '" + kind().name +
                        "' is built without, or has in another form than the controller was compiled for");
    return *found;
  }
  /// The seed of the whole run.
  virtual std::uint64_t run_seed() const noexcept = 0;
  /// Random numbers of this robot's own, from the run's seed and the robot's id: the same in every world.
  Random random(std::uint32_t stream = 0) const noexcept { return Random(seed_of(run_seed(), id()), stream); }
  /// Where the controller may tell people something, while it steps too.
  RobotLog log() const noexcept { return log_; }

  /// The reading of device class `T`; filled before every step.
  /// @throws DeviceError when the robot has no such device or its configuration does not list it.
  template <SensorPort T>
  const T& sensor() {
    return *static_cast<const T*>(take(port_type<T>()));
  }

  /// The command of device class `T`; taken over after every step. Keeps its value until written again.
  /// @throws DeviceError as above.
  template <ActuatorPort T>
  T& actuator() {
    return *static_cast<T*>(take(port_type<T>()));
  }

  /// Shows a member of the controller (a scalar, or an array of them) to records and views, which read it between
  /// steps; publishing costs no time in a step. `member` must lie in the controller itself. One name, one member.
  /// @throws std::logic_error otherwise
  template <class M>
  void publish(std::string_view name, const M& member, const Unit& unit = unit::none, std::string_view doc = {}) {
    show(described(name, member, unit, doc), &member);
  }
  /// The same for an enumeration: `texts` name its values from 0 on.
  template <class E>
  requires std::is_enum_v<E>
  void publish(std::string_view name, const E& member, std::initializer_list<std::string_view> texts,
               std::string_view doc = {}) {
    PublishedField field = described(name, member, unit::none, doc);
    field.texts.assign(texts.begin(), texts.end());
    show(std::move(field), &member);
  }

  /// For the world that the robot is in.
  void set_log(const RobotLog& log) noexcept { log_ = log; }

 protected:
  /// Memory of a port with `type`'s layout. Never null; throws DeviceError.
  virtual void* take(const PortType& type) = 0;
  /// Keeps the description of a member of the controller that is being constructed; its offset is the world's to find.
  /// A world without records and views keeps none.
  virtual void show(PublishedField /*field*/, const void* /*member*/) {}

 private:
  template <class M>
  static PublishedField described(std::string_view name, const M& member, const Unit& unit, std::string_view doc) {
    std::vector<Field> fields;
    FieldList list(&member, fields);
    const Field& f = list.add(name, member, unit, Frame::None, Fusion::Real, doc);
    return {std::string(name), 0, f.scalar, f.count, unit, std::string(doc), {}};
  }

  RobotLog log_;
};

}  // namespace tandem::hal
