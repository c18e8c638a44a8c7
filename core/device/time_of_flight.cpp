// Time-of-flight sensor: the nearest thing that a fan of rays meets.
#include "hal/device/time_of_flight.hpp"

#include <algorithm>

#include "core/device/each_robot.hpp"
#include "core/device/far_rays.hpp"
#include "core/device/types.hpp"
#include "core/space/sight.hpp"

namespace tandem::core {
namespace {

constexpr ErrorText kDistanceNoise{
    "noise_level", 40 * 1e-3, hal::unit::none, {0.0, 1.0}, "Standard deviation of the distance, as a part of it."};
using DistanceNoise = OneError<kDistanceNoise>;

/// Sees bodies, boxes and cylinders at the height of its mount, in a fan as wide as its cone: 23 rays, of 25 degrees
/// 4 cm from one another at 2 m.
class TimeOfFlightSensor final : public Sensor {
 public:
  using Port = hal::TimeOfFlight;
  using Part = hal::TimeOfFlightPart;
  using Errors = DistanceNoise;

  TimeOfFlightSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : part_(*setup.kind.part<Part>()), noise_(errors.amount) {
    const Part& part = part_;
    count_ = part.cone_rad > 0.0 ? kRays : 1;
    rays_.aim(static_cast<std::size_t>(count_), part.mount.z_m);
    for (std::ptrdiff_t k = 0; k < count_; ++k) {
      const double aside = count_ > 1 ? part.cone_rad * (static_cast<double>(k) / (kRays - 1) - 0.5) : 0.0;
      rays_.set(static_cast<std::size_t>(k), part.mount.bearing_rad + aside, part.range_m, part.mount.x_m,
                part.mount.y_m);
    }
  }

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* sensors = static_cast<hal::TimeOfFlight*>(ports);
    const double widest_m = widest_body_m(context.stores);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      rays_.distance_m.fill(1e9F);
      rays_.look(context.stores, row, widest_m, RealSense::TimeOfFlight);
      double distance_m =
          static_cast<double>(*std::min_element(rays_.distance_m.begin(), rays_.distance_m.begin() + count_));
      if (noise_ > 0.0 && distance_m < part_.range_m) {
        const auto bits =
            draw(context.seed, context.stores.bodies.entity[row], Stream::TimeOfFlightNoise, context.tick);
        distance_m *= 1.0 + noise_ * to_normal(bits[0], bits[1])[0];
      }
      stamp(context, sensors[i]);
      sensors[i].range_m = static_cast<float>(part_.range_m);
      sensors[i].distance_m = static_cast<float>(std::clamp(distance_m, 0.0, part_.range_m));
    }
  }

 private:
  static constexpr std::ptrdiff_t kRays = 23;
  static_assert(kRays <= FarRays::kCapacity);

  const hal::TimeOfFlightPart& part_;
  double noise_;
  std::ptrdiff_t count_ = 0;
  FarRays rays_;
};

}  // namespace

std::vector<DeviceType> time_of_flight_types() {
  // The data sheet of the VL53L0X has a standard deviation of 4 % for white targets indoors.
  std::vector<DeviceType> types;
  add_levels<TimeOfFlightSensor>(types, "Exact distances; noise where asked for.",
                                 "Exact distances to bodies, boxes and cylinders.", "Distances with normal noise.");
  return types;
}

}  // namespace tandem::core
