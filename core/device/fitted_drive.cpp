#include "core/device/fitted_drive.hpp"

#include <cmath>

#include "core/device/fitted_values.hpp"

namespace tandem::core {

FittedDrive::FittedDrive(const hal::FittedWheels& part, const BlockColumns& columns)
    : part_(part), states_(columns.find<DriveState>()), hidden_(columns.find<HiddenRoll>()) {}

std::string FittedDrive::flaw(const hal::FittedWheels& part, double tick_s) {
  const double most_s = static_cast<double>(DriveState::kLine - 2) * tick_s;
  const auto too_long = [&](double delay_s) { return delay_s > most_s; };
  bool longer = too_long(part.mean.of.delay_s);
  for (const auto& robot : part.robots) longer = longer || too_long(robot.value.of.delay_s);
  if (!longer) return {};
  return "the fitted delay of the wheels is longer than " + std::to_string(DriveState::kLine - 2) +
         " ticks; use fewer ticks_per_second";
}

void FittedDrive::tell(const DeviceContext& context, std::size_t i, double left_m_s, double right_m_s) noexcept {
  DriveState& s = states_[i];
  if (!s.known) {
    const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
    const hal::WheelModel v = fitted_values(part_, hal::FittedWheels::kName, context.stores, entity);
    s.known = true;
    s.left = v.left;
    s.right = v.right;
    s.base = v.base;
    s.counted_left = v.counted_left;
    s.counted_right = v.counted_right;
    s.noise_sqrt_m = v.noise_sqrt_m;
    s.delay_ticks = v.delay_s / context.tick_s;
  }
  s.newest = static_cast<std::uint32_t>((s.newest + 1) % DriveState::kLine);
  s.told_left_m_s[s.newest] = left_m_s;
  s.told_right_m_s[s.newest] = right_m_s;
}

void FittedDrive::drive(const DeviceContext& context, std::size_t i, double& left_m_s, double& right_m_s) noexcept {
  const DriveState& s = states_[i];
  const auto of = [&](const std::array<double, DriveState::kLine>& ring) {
    return delayed(s.delay_ticks, DriveState::kLine,
                   [&](std::size_t n) { return ring[(s.newest + DriveState::kLine - n) % DriveState::kLine]; });
  };
  const double told_left = of(s.told_left_m_s);
  const double told_right = of(s.told_right_m_s);
  double left = s.left * told_left;
  double right = s.right * told_right;
  if (s.noise_sqrt_m > 0.0) {
    const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
    const auto bits = draw(context.seed, entity, Stream::WheelNoise, context.tick, 1);
    const auto noise = to_normal(bits[0], bits[1]);
    left += s.noise_sqrt_m * std::sqrt(std::fabs(left) / context.tick_s) * noise[0];
    right += s.noise_sqrt_m * std::sqrt(std::fabs(right) / context.tick_s) * noise[1];
  }
  // The engine turns by the kind's wheel base.
  const double forward = 0.5 * (left + right);
  const double half_turn = 0.5 * (right - left) / s.base;
  left_m_s = forward - half_turn;
  right_m_s = forward + half_turn;
  HiddenRoll& hidden = hidden_[i];
  hidden.left_m_s = left_m_s - s.counted_left * told_left;
  hidden.right_m_s = right_m_s - s.counted_right * told_right;
  hidden.left_m += hidden.left_m_s * context.tick_s;
  hidden.right_m += hidden.right_m_s * context.tick_s;
}

void FittedDrive::stand(std::size_t i) noexcept {
  hidden_[i].left_m_s = 0.0;
  hidden_[i].right_m_s = 0.0;
}

}  // namespace tandem::core
