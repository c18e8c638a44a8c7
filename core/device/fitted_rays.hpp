// Proximity sensors as they were measured on real robots: curve, noise, and the age of readings.
#pragma once
#include <array>

#include "core/device/device.hpp"
#include "hal/device/fitted.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::core {

/// What simulated proximity sensors work by, and the distances of the last ticks.
struct RaysState {
  static constexpr std::string_view kName = "fitted_proximity";
  static constexpr std::string_view kDoc = "By which proximity sensors read, and the distances of the last ticks.";
  static constexpr std::size_t kLine = 16;
  bool known = false;
  std::uint32_t ticks = 0;   ///< that the ring holds, at most its length
  std::uint32_t newest = 0;  ///< of the ring
  double gain = 1.0, exponent = 1.0, offset_m = 0.0, noise_m = 0.0, delay_ticks = 0.0;
  std::array<float, kLine * hal::Proximity::kCapacity> seen_m{};  ///< a ring of readings

  void describe(hal::FieldList& f) const {
    f.add("known", known, hal::unit::none, "the values were looked up or drawn");
    f.add("ticks", ticks, hal::unit::none, "that the ring holds");
    f.add("newest", newest, hal::unit::none, "place of the newest distances in the ring");
    f.add("gain", gain, hal::unit::none, "of the curve");
    f.add("exponent", exponent, hal::unit::none, "of the curve");
    f.add("offset", offset_m, hal::unit::m, "of the curve");
    f.add("noise", noise_m, hal::unit::m, "standard deviation");
    f.add("delay", delay_ticks, hal::unit::none, "in ticks");
    f.add("seen", seen_m, hal::unit::m, "a ring of distances");
  }
};

/// Turns the exact distances of one block into readings.
class FittedRays {
 public:
  FittedRays(const hal::FittedProximity& part, const BlockColumns& columns);
  void read(const DeviceContext& context, hal::Proximity* ports) noexcept;

  static std::vector<KeptColumn> columns() { return {keeps<RaysState>()}; }
  /// Empty, or why a delay cannot be simulated.
  static std::string flaw(const hal::FittedProximity& part, double tick_s);

 private:
  static void remember(RaysState& state, const hal::Proximity& port) noexcept;
  static void read_one(const DeviceContext& context, std::uint32_t entity, const RaysState& state,
                       hal::Proximity& port) noexcept;

  const hal::FittedProximity& part_;  // of the kind, which lives as long as the world
  RaysState* states_;
};

}  // namespace tandem::core
