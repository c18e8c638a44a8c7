#include "bridges/bridged_robot.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "hal/device/body_sensors.hpp"

namespace tandem::bridges {
namespace {

constexpr hal::TimeNs kLeastFresh = 150 * hal::kNsPerMs;

}  // namespace

BridgedRobot::BridgedRobot(std::string_view noun, const hal::RobotKind& kind, RobotSettings settings,
                           std::span<const hal::PortType* const> types)
    : noun_(noun),
      kind_(settings.kind != nullptr ? *settings.kind : kind),
      settings_(std::move(settings)),
      bank_(types),
      state_(types.size()) {
  settings_.tick_ns = std::max<hal::TimeNs>(settings_.tick_ns, 1);
  if (settings_.fresh_ns <= 0) settings_.fresh_ns = std::max(2 * settings_.tick_ns, kLeastFresh);
  std::size_t bytes = 0;
  for (const hal::PortType* type : types) bytes += type->role == hal::Role::Actuator ? type->size : 0;
  kept_.resize(bytes);
}

void BridgedRobot::keep_commands() noexcept {
  std::byte* to = kept_.data();
  for (const PortBank::Row& row : bank_.rows()) {
    if (row.type->role != hal::Role::Actuator) continue;
    std::memcpy(to, row.data(), row.type->size);
    to += row.type->size;
  }
}

void BridgedRobot::restore_commands() noexcept {
  const std::byte* from = kept_.data();
  for (const PortBank::Row& row : bank_.rows()) {
    if (row.type->role != hal::Role::Actuator) continue;
    std::memcpy(row.data(), from, row.type->size);
    from += row.type->size;
  }
}

void BridgedRobot::leave_out(const hal::PortType& type, std::string_view why) {
  State& state = state_[bank_.row_of(type)];
  state.present = false;
  state.why = why;
}

bool BridgedRobot::listed(const hal::PortType& type) const {
  const auto& list = type.role == hal::Role::Sensor ? settings_.sensors : settings_.actuators;
  return !list || std::ranges::find(*list, type.name) != list->end();
}

void* BridgedRobot::take(const hal::PortType& type) {
  const std::string who = noun_ + " '" + settings_.id + "'";
  const std::string what =
      std::string(type.role == hal::Role::Sensor ? "sensor '" : "actuator '") + std::string(type.name) + "'";
  const std::size_t row = bank_.find(type.name, type.role);
  if (row == state_.size()) throw hal::DeviceError(who + " has no " + what + std::string(never_had));
  if (!state_[row].present && !state_[row].why.empty())
    throw hal::DeviceError(who + " has no " + what + std::string(state_[row].why));
  if (bank_.rows()[row].type->layout != type.layout)
    throw hal::DeviceError(who + ": the controller was built for another form of " + what + "; rebuild it");
  if (!listed(type)) throw hal::DeviceError(who + ": the configuration does not list " + what + "; add it there");
  return take(row);
}

void* BridgedRobot::take(std::size_t row) {
  if (!std::exchange(state_[row].taken, true)) order_.push_back(row);
  return bank_.rows()[row].data();
}

void* BridgedRobot::find(const hal::PortType& type) noexcept {
  const std::size_t row = bank_.find(type.name, type.role);
  const bool there = row < state_.size() && state_[row].present && bank_.rows()[row].type->layout == type.layout;
  return there ? take(row) : nullptr;
}

std::vector<PortView> BridgedRobot::taken() const {
  std::vector<PortView> all;
  for (const std::size_t row : order_) all.push_back({bank_.rows()[row].type, bank_.rows()[row].data()});
  return all;
}

std::vector<const hal::PortType*> BridgedRobot::present() const {
  std::vector<const hal::PortType*> all;
  for (std::size_t row = 0; row < state_.size(); ++row) {
    if (state_[row].present) all.push_back(bank_.rows()[row].type);
  }
  return all;
}

void BridgedRobot::stamp(hal::Reading& reading, hal::TimeNs taken, hal::TimeNs period_ns,
                         hal::TimeNs now) const noexcept {
  if (taken == 0) return;
  reading.taken_ns = taken - settings_.origin_ns;
  reading.validity = now - taken <= settings_.fresh_ns + period_ns ? hal::Validity::Fresh : hal::Validity::Stale;
}

void BridgedRobot::tell_time(hal::Tick tick) noexcept {
  auto& clock = port<hal::Clock>();
  clock.tick = tick;
  clock.now_ns = tick * settings_.tick_ns;
  clock.tick_s = hal::to_seconds(settings_.tick_ns);
  clock.taken_ns = clock.now_ns;
  clock.validity = hal::Validity::Fresh;
}

}  // namespace tandem::bridges
