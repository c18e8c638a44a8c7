// The values that a simulated robot works by where parameters were fitted to real ones: its own, the mean, or drawn.
#pragma once
#include <algorithm>
#include <charconv>
#include <string_view>

#include "core/random/random.hpp"
#include "core/space/stores.hpp"
#include "hal/device/fitted.hpp"

namespace tandem::core {

/// Whether the robot has this id. Allocates nothing.
inline bool has_id(const SpaceStores& stores, std::uint32_t entity, std::string_view id) noexcept {
  const RobotEntity& e = stores.robots[entity];
  const std::string& prefix = stores.names[e.item].prefix;
  if (!id.starts_with(prefix)) return false;
  if (e.number < 0) return id.size() == prefix.size();
  std::array<char, 24> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), e.number).ptr;
  return id.substr(prefix.size()) == std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
}

/// Draws depend on the part's reality and the robot alone, not on the run's seed: runs of a study share a reality.
template <class Model>
Model fitted_values(const hal::FittedPart<Model>& part, std::string_view name, const SpaceStores& stores,
                    std::uint32_t entity) noexcept {
  const hal::FittedRobot<Model>* own = nullptr;
  for (const hal::FittedRobot<Model>& robot : part.robots) {
    if (has_id(stores, entity, robot.id)) own = &robot;
  }
  Model values = own != nullptr ? own->value.of : part.mean.of;
  if (part.reality == 0) return values;
  const Model& deviations = own != nullptr ? own->error.of : part.spread.of;
  std::uint32_t k = 0;
  for (const hal::ModelField<Model>& f : Model::fields()) {
    const auto bits = draw(own_seed(static_cast<std::uint64_t>(part.reality), name), entity, Stream::Plugin, 0, k++);
    const double drawn = values.*f.member + deviations.*f.member * to_normal(bits[0], bits[1])[0];
    values.*f.member = std::clamp(drawn, f.range.min, f.range.max);
  }
  return values;
}

/// A value of a line of past values, `ticks` ago, linear between them. `at(n)` is the one of n ticks ago; n < `length`.
template <class At>
auto delayed(double ticks, std::size_t length, At&& at) noexcept {
  const double most = static_cast<double>(length - 2);
  const double whole = std::floor(std::clamp(ticks, 0.0, most));
  const double rest = std::clamp(ticks, 0.0, most) - whole;
  const auto n = static_cast<std::size_t>(whole);
  return (1.0 - rest) * at(n) + rest * at(n + 1);
}

}  // namespace tandem::core
