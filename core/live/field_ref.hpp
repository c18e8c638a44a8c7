// One value of a robot by the names that people use: a field of a port, of published state, or of its pose.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "core/space/space.hpp"
#include "core/space/stores.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::core {

struct FieldRef {
  enum class Role : std::uint8_t { Sensor, Actuator, Published, Pose };
  Role role = Role::Pose;
  std::string port;   ///< of a sensor or an actuator
  std::string field;  ///< of a pose: x, y, z, heading
  std::size_t index = 0;

  /// "sensor proximity.value[3]".
  std::string text() const;
};

/// Reads {"role", "port", "field", "index"}. Errors: missing or unknown members.
hal::Result<FieldRef> read_field_ref(const hal::Json& json);

/// Where that value lies in the robots of a group. Valid until the group changes: to be found again for every tick.
class FieldPlace {
 public:
  /// Errors: its controllers take no such port, or it has no such field or element; says what there is.
  static hal::Result<FieldPlace> find(const FieldRef& ref, const RobotGroup& group);
  /// Of the robot in that slot, which is alive; none: a list's entry that is not in use.
  std::optional<double> value(const SpaceStores& stores, const RobotBlock& block, std::size_t slot) const noexcept;
  /// In which `value` is: an enumeration's names, or empty.
  const std::vector<std::string>& texts() const noexcept;

 private:
  FieldRef::Role role_ = FieldRef::Role::Pose;
  std::size_t index_ = 0;
  std::size_t port_ = 0;  // of the group's ports
  const hal::PortType* type_ = nullptr;
  const hal::Field* field_ = nullptr;
  hal::UsedBy used_;
  const hal::PublishedField* published_ = nullptr;
  char axis_ = 'x';
};

/// Of one robot, as it is now. Errors: gone; as `FieldPlace::find`.
hal::Result<std::optional<double>> value_of(const FieldRef& ref, const Space& space, RobotId robot);

}  // namespace tandem::core
