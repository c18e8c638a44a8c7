#include "bridges/peer/peer_robot.hpp"

#include <algorithm>

namespace tandem::bridges::peer {

PeerRobot::PeerRobot(const RobotMessage& robot, const hal::RobotKind& kind, std::span<const hal::PortType* const> types)
    : robot_(robot), kind_(kind), bank_(types) {}

void* PeerRobot::take(const hal::PortType& type) {
  PortName name{type.role, std::string(type.name), {}};
  for (const Taken& t : taken_) {
    if (t.name.role == name.role && t.name.name == name.name) return t.data;
  }
  const auto there = std::ranges::find_if(
      robot_.ports, [&](const PortName& port) { return port.role == name.role && port.name == name.name; });
  const std::string who = "robot '" + robot_.robot + "'";
  if (there == robot_.ports.end())
    throw hal::DeviceError(who + " of the hub has no " + name_of(name) +
                           ": the controller that its experiment file names there does not take it");
  RowForm form(type);
  name.digest = form.digest();
  void* const data = bank_.find(type);
  if (there->digest != name.digest || data == nullptr)
    throw hal::DeviceError(who + ": " + name_of(name) +
                           " has another form here than in the hub; build both of the same version");
  taken_.push_back({std::move(name), std::move(form), data});
  return data;
}

void PeerRobot::show(hal::PublishedField field, const void* member) {
  const std::size_t bytes = hal::size_of(field);
  shown_.push_back({form_of(field), member, bytes});
}

Ready PeerRobot::ready() const {
  Ready ready{robot_.session, {}, {}, {}};
  for (const Taken& t : taken_) ready.takes.push_back(t.name);
  for (const Shown& s : shown_) ready.publishes.push_back(s.form);
  return ready;
}

bool PeerRobot::take_readings(std::span<const std::uint8_t> payload, std::uint8_t flags) {
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    if (role == hal::Role::Actuator && (flags & kActuatorsFollow) == 0) break;
    for (const Taken& t : taken_) {
      if (t.name.role == role && !t.form.unpack(payload, t.data)) return false;
    }
  }
  return payload.empty();
}

void PeerRobot::give_commands(std::vector<std::uint8_t>& out) const {
  for (const Taken& t : taken_) {
    if (t.name.role == hal::Role::Actuator) t.form.pack(t.data, out);
  }
  for (const Shown& s : shown_) {
    const auto* const first = static_cast<const std::uint8_t*>(s.member);
    out.insert(out.end(), first, first + s.bytes);
  }
}

}  // namespace tandem::bridges::peer
