#include "core/device/fitted_rays.hpp"

#include <cmath>

#include "core/device/describe.hpp"
#include "core/device/fitted_values.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kWide = hal::Proximity::kCapacity;

}  // namespace

FittedRays::FittedRays(const hal::FittedProximity& part, const BlockColumns& columns)
    : part_(part), states_(columns.find<RaysState>()) {}

std::string FittedRays::flaw(const hal::FittedProximity& part, double tick_s) {
  const double most_s = static_cast<double>(RaysState::kLine - 2) * tick_s;
  const auto too_long = [&](double delay_s) { return delay_s > most_s; };
  bool longer = too_long(part.mean.of.delay_s);
  for (const auto& robot : part.robots) longer = longer || too_long(robot.value.of.delay_s);
  if (!longer) return {};
  return "the fitted delay of proximity sensors is longer than " + std::to_string(RaysState::kLine - 2) +
         " ticks; use fewer ticks_per_second";
}

void FittedRays::read(const DeviceContext& context, hal::Proximity* ports) noexcept {
  for (std::size_t i = 0; i < context.block.used; ++i) {
    const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
    RaysState& s = states_[i];
    if (!s.known) {
      const hal::ProximityModel v = fitted_values(part_, hal::FittedProximity::kName, context.stores, entity);
      s.known = true;
      s.gain = v.gain;
      s.exponent = v.exponent;
      s.offset_m = v.offset_m;
      s.noise_m = v.noise_m;
      s.delay_ticks = v.delay_s / context.tick_s;
    }
    // What a twin sees of the simulated world is told exactly; its real sensors err by themselves.
    remember(s, ports[i]);
    if (!led_from_outside(context, i)) read_one(context, entity, s, ports[i]);
  }
}

void FittedRays::remember(RaysState& s, const hal::Proximity& port) noexcept {
  s.newest = static_cast<std::uint32_t>((s.newest + 1) % RaysState::kLine);
  s.ticks = std::min<std::uint32_t>(s.ticks + 1, RaysState::kLine);
  for (std::size_t k = 0; k < kWide; ++k) s.seen_m[s.newest * kWide + k] = port.distance_m[k];
}

void FittedRays::read_one(const DeviceContext& context, std::uint32_t entity, const RaysState& s,
                          hal::Proximity& port) noexcept {
  const double ticks = std::min(s.delay_ticks, static_cast<double>(s.ticks - 1));
  const double range_m = static_cast<double>(port.range_m);
  port.taken_ns = context.now_ns - static_cast<hal::TimeNs>(ticks * context.tick_s * 1e9);
  for (std::size_t k = 0; k < port.count; ++k) {
    const double seen_m = delayed(ticks, RaysState::kLine, [&](std::size_t n) {
      const std::size_t at = (s.newest + RaysState::kLine - n) % RaysState::kLine;
      // Before the first tick it stood where it was then.
      return static_cast<double>(s.seen_m[(n < s.ticks ? at : s.newest) * kWide + k]);
    });
    double read_m = range_m;
    if (seen_m < range_m) read_m = range_m * s.gain * std::pow(seen_m / range_m, s.exponent) + s.offset_m;
    if (s.noise_m > 0.0) {
      const auto bits =
          draw(context.seed, entity, Stream::ProximityNoise, context.tick, static_cast<std::uint32_t>(64 + k));
      read_m += s.noise_m * to_normal(bits[0], bits[1])[0];
    }
    port.distance_m[k] = static_cast<float>(std::clamp(read_m, 0.0, range_m));
  }
}

}  // namespace tandem::core
