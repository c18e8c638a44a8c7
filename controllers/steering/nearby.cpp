#include "controllers/steering/nearby.hpp"

#include <cmath>

#include "hal/angle.hpp"

namespace tandem::controllers {
namespace {

constexpr double kStep_m = 0.05;     // readings of neighbouring sensors that differ by less belong to one thing
constexpr double kRobot_m = 0.40;    // a robot farther away is beyond the proximity sensors
constexpr double kRobot_rad = 0.45;  // half of the angle under which a robot that nearly touches is seen

bool sees(const hal::Proximity& proximity, std::size_t i) noexcept {
  return proximity.distance_m[i] < proximity.range_m;
}

}  // namespace

bool robot_near(const hal::RangeAndBearing& heard, double bearing_rad, double within_rad, double range_m) noexcept {
  for (std::size_t k = 0; k < heard.count; ++k) {
    if (static_cast<double>(heard.range_m[k]) <= range_m &&
        std::fabs(hal::wrapped(static_cast<double>(heard.bearing_rad[k]) - bearing_rad)) <= within_rad)
      return true;
  }
  return false;
}

Thing nearest_thing(const hal::Proximity& proximity, std::span<const hal::Mount> mounts,
                    const hal::RangeAndBearing& heard) noexcept {
  const std::size_t n = std::min<std::size_t>(proximity.count, mounts.size());
  std::size_t nearest = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (!sees(proximity, i) || (nearest < n && proximity.distance_m[i] >= proximity.distance_m[nearest])) continue;
    if (!robot_near(heard, mounts[i].bearing_rad, kRobot_rad, kRobot_m)) nearest = i;
  }
  if (nearest == n) return {};
  // From the nearest on to both sides, as long as the readings hang together.
  const auto end_of = [&](std::size_t step) {
    std::size_t at = nearest;
    for (std::size_t k = 1; k < n / 2; ++k) {
      const std::size_t next = (at + step) % n;
      if (!sees(proximity, next) ||
          std::fabs(static_cast<double>(proximity.distance_m[next] - proximity.distance_m[at])) > kStep_m)
        break;
      at = next;
    }
    return at;
  };
  const auto point = [&](std::size_t i) {
    const double d_m = static_cast<double>(proximity.distance_m[i]);
    return hal::Vector2(hal::Vector2(mounts[i].x_m, mounts[i].y_m) + hal::polar(d_m, mounts[i].bearing_rad));
  };
  const std::size_t right = end_of(n - 1);
  const std::size_t left = end_of(1);
  hal::Vector2 middle = hal::Vector2::Zero();
  for (std::size_t i = right;; i = (i + 1) % n) {
    middle += hal::polar(static_cast<double>(proximity.closeness(i)), mounts[i].bearing_rad);
    if (i == left) break;
  }
  return {true, hal::bearing_of(middle), static_cast<double>(proximity.distance_m[nearest]),
          hal::length_of(point(right) - point(left))};
}

hal::Vector2 push_away(const hal::Proximity& proximity, std::span<const hal::Mount> mounts, double from_rad) noexcept {
  hal::Vector2 push = hal::Vector2::Zero();
  const std::size_t n = std::min<std::size_t>(proximity.count, mounts.size());
  for (std::size_t i = 0; i < n; ++i) {
    if (std::fabs(hal::wrapped(mounts[i].bearing_rad)) < from_rad) continue;
    const double closeness = static_cast<double>(proximity.closeness(i));
    push -= hal::polar(closeness, mounts[i].bearing_rad) / static_cast<double>(n);
  }
  return push;
}

hal::Vector2 to_light(const hal::Light& light, std::span<const hal::Mount> mounts) noexcept {
  hal::Vector2 sum = hal::Vector2::Zero();
  const std::size_t n = std::min<std::size_t>(light.count, mounts.size());
  for (std::size_t i = 0; i < n; ++i) sum += hal::polar(static_cast<double>(light.level[i]), mounts[i].bearing_rad);
  return sum;
}

double mean_reflectance(const hal::Ground& ground) noexcept {
  if (ground.count == 0) return 1.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < ground.count; ++i) sum += static_cast<double>(ground.reflectance[i]);
  return sum / static_cast<double>(ground.count);
}

}  // namespace tandem::controllers
