#include "core/live/field_ref.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "hal/element.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::core {
namespace {

using Role = FieldRef::Role;

const std::vector<std::string> kRoles{"sensor", "actuator", "published", "pose"};
const std::vector<std::string> kAxes{"x", "y", "z", "heading"};

hal::Error unknown(const std::string& what, const std::string& name, const std::vector<std::string>& there) {
  return {what + " '" + name + "'; there are: " + (there.empty() ? "none" : hal::listed(there)) +
          hal::did_you_mean(name, there)};
}

hal::Error too_far(const FieldRef& ref, std::size_t count) {
  return {ref.text() + ": it has " + std::to_string(count) + (count == 1 ? " value" : " values") + ", from index 0 on"};
}

}  // namespace

std::string FieldRef::text() const {
  std::string all = kRoles[static_cast<std::size_t>(role)] + " ";
  if (!port.empty()) all += port + ".";
  return all + field + (index == 0 ? "" : "[" + std::to_string(index) + "]");
}

hal::Result<FieldRef> read_field_ref(const hal::Json& json) {
  FieldRef ref;
  const std::string role = hal::text_of(json, "role");
  const auto found = std::find(kRoles.begin(), kRoles.end(), role);
  if (found == kRoles.end()) return unknown("\"role\": there is no role", role, kRoles);
  ref.role = static_cast<Role>(found - kRoles.begin());
  ref.port = hal::text_of(json, "port");
  ref.field = hal::text_of(json, "field");
  if (ref.field.empty()) return hal::Error{"\"field\" is missing: the name of the value"};
  const bool of_port = ref.role == Role::Sensor || ref.role == Role::Actuator;
  if (of_port && ref.port.empty()) return hal::Error{"\"port\" is missing: the name of the " + role};
  if (!of_port) ref.port.clear();
  const auto index = json.find("index");
  if (index != json.end()) {
    if (!index->is_number_integer() || index->get<std::int64_t>() < 0)
      return hal::Error{"\"index\" is a whole number from 0 on"};
    ref.index = index->get<std::size_t>();
  }
  return ref;
}

hal::Result<FieldPlace> FieldPlace::find(const FieldRef& ref, const RobotGroup& group) {
  FieldPlace place;
  place.role_ = ref.role;
  place.index_ = ref.index;
  std::vector<std::string> names;
  if (ref.role == Role::Pose) {
    if (std::find(kAxes.begin(), kAxes.end(), ref.field) == kAxes.end())
      return unknown("a pose has no field", ref.field, kAxes);
    if (ref.index > 0) return too_far(ref, 1);
    place.axis_ = ref.field[0];
    return place;
  }
  if (ref.role == Role::Published) {
    for (const hal::PublishedField& field : group.published) {
      names.push_back(field.name);
      if (field.name != ref.field) continue;
      if (ref.index >= field.count) return too_far(ref, field.count);
      place.published_ = &field;
      return place;
    }
    return unknown("the controller '" + std::string(group.controller->name) + "' publishes no", ref.field, names);
  }
  const hal::Role role = ref.role == Role::Sensor ? hal::Role::Sensor : hal::Role::Actuator;
  for (std::size_t p = 0; p < group.ports.size(); ++p) {
    const hal::PortType& type = *group.ports[p];
    if (type.role != role) continue;
    names.emplace_back(type.name);
    if (type.name != ref.port) continue;
    place.port_ = p;
    place.type_ = &type;
    place.field_ = type.field(ref.field);
    if (place.field_ == nullptr) {
      names.clear();
      for (const hal::Field& field : type.fields) names.emplace_back(field.name);
      return unknown("the port '" + ref.port + "' has no field", ref.field, names);
    }
    if (ref.index >= place.field_->count) return too_far(ref, place.field_->count);
    place.used_ = hal::used_by(type, *place.field_);
    return place;
  }
  return unknown("the controller '" + std::string(group.controller->name) + "' takes no " +
                     (role == hal::Role::Sensor ? "sensor" : "actuator"),
                 ref.port, names);
}

std::optional<double> FieldPlace::value(const SpaceStores& s, const RobotBlock& block,
                                        std::size_t slot) const noexcept {
  if (role_ == Role::Pose) {
    const std::size_t row = block.first_row + slot;
    const Bodies& b = s.bodies;
    switch (axis_) {
      case 'x':
        return b.x_m[row];
      case 'y':
        return b.y_m[row];
      case 'z':
        return s.base_m(row);
      default:
        return std::atan2(b.sin_h[row], b.cos_h[row]);
    }
  }
  if (role_ == Role::Published) {
    if (block.constructed[slot] == 0) return {};
    return hal::value_of(*published_, block.controller(slot), index_);
  }
  const std::byte* const row = block.ports[port_] + slot * type_->size;
  if (index_ >= hal::used_count(used_, row, *field_)) return {};
  return hal::get_value(row, *field_, index_);
}

const std::vector<std::string>& FieldPlace::texts() const noexcept {
  static const std::vector<std::string> none;
  return published_ != nullptr ? published_->texts : none;
}

hal::Result<std::optional<double>> value_of(const FieldRef& ref, const Space& space, RobotId robot) {
  const SpaceStores& s = space.stores();
  if (!space.contains(robot)) return hal::Error{"there is no such robot, or no more"};
  const RobotEntity& entity = s.robots[robot.index];
  const RobotBlock& block = s.blocks[entity.block];
  const auto place = FieldPlace::find(ref, s.groups[block.group]);
  if (!place.ok()) return place.error();
  return place.value().value(s, block, entity.slot);
}

}  // namespace tandem::core
