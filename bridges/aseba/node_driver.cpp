#include "bridges/aseba/node_driver.hpp"

#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"

namespace tandem::bridges::aseba {

const char* state_name(RobotState state) noexcept {
  constexpr std::array kNames = {"absent", "searching", "ready", "active", "suspect", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

NodeRobot::NodeRobot(std::string_view noun, const hal::RobotKind& kind, RobotSettings settings,
                     std::span<const hal::PortType* const> types)
    : BridgedRobot(noun, kind, std::move(settings), types),
      reckoning_(this->kind().drive() != nullptr ? this->kind().drive()->wheel_base_m : 0.0) {
  if (const auto* const part = this->kind().part<hal::ProximityPart>(); part != nullptr)
    port<hal::Proximity>().range_m = static_cast<float>(part->range_m);
}

bool NodeRobot::uses(const hal::PortType& type) const noexcept {
  const bool reckons =
      &type == &hal::port_type<hal::WheelEncoders>() && BridgedRobot::uses(hal::port_type<hal::Odometry>());
  return reckons || BridgedRobot::uses(type);
}

void NodeRobot::complete(hal::Tick tick) noexcept {
  tell_time(tick);
  reckoning_.follow(port<hal::WheelEncoders>(), port<hal::Odometry>());
}

bool NodeWiring::others_are_there() noexcept {
  std::uint64_t print = 1;
  for (const std::uint8_t id : network_.known()) {
    const Node& node = network_.node(id);
    print = print * 1099511628211ULL + (node.generation * 2 + (node.ready() ? 1 : 0)) * 256 + id;
  }
  if (print == seen_) return false;
  seen_ = print;
  ++rest_version_;
  return true;
}

NodeStatus NodeWiring::status_of(const Node* node, std::string name, bool needed, std::string trouble,
                                 std::uint64_t times_wired) {
  NodeStatus status{
      .name = std::move(name), .needed = needed, .trouble = std::move(trouble), .times_wired = times_wired};
  if (node == nullptr) return status;
  status.name = node->description.name;
  status.id = node->id;
  status.state = node->state;
  status.statistics = node->statistics;
  return status;
}

std::optional<RestMessage> NodeWiring::rest_message(const Node& node, std::size_t address,
                                                    std::span<const std::int16_t> words, bool confirm) {
  Payload payload;
  payload.append(node.id);
  payload.append(static_cast<std::uint16_t>(address));
  if (!payload.append(words)) return std::nullopt;
  return RestMessage{
      static_cast<std::uint16_t>(Type::SetVariables), {payload.bytes().begin(), payload.bytes().end()}, confirm};
}

hal::Log detail::named(const hal::Log& log, const std::string& who) {
  return hal::Log([log, who](hal::Severity severity, std::string_view text) {
    const std::string line = who + std::string(text);
    if (severity == hal::Severity::Info) return log.info(line);
    if (severity == hal::Severity::Warning) return log.warning(line);
    log.error(line);
  });
}

}  // namespace tandem::bridges::aseba
