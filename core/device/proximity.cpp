#include "core/device/proximity.hpp"

#include <atomic>

#include "core/device/describe.hpp"
#include "core/device/ray_ring.hpp"
#include "core/random/random.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::core {
namespace {

bool detect_avx2() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

std::atomic<VectorCode> chosen_code{detect_avx2() ? VectorCode::Avx2 : VectorCode::Baseline};

/// Whether a body is where rays at this height pass.
bool stands_at(const SpaceStores& stores, std::size_t row, double height_m) noexcept {
  const double low_m = stores.bodies.motion[row].z_m;
  return height_m >= low_m && height_m <= low_m + stores.sheet_of_row(row).body_height_m;
}

/// Distances of one register of rays for the robot in `row`, nothing in range reading `range`.
[[gnu::always_inline]] inline void sense_row(const SpaceStores& stores, const RayRing& ring, std::size_t row,
                                             float* __restrict distances) noexcept {
  const Bodies& b = stores.bodies;
  const double x = b.x_m[row];
  const double y = b.y_m[row];
  const float c = static_cast<float>(b.cos_h[row]);
  const float s = static_cast<float>(b.sin_h[row]);
  const auto row32 = static_cast<std::uint32_t>(row);
  for (std::size_t k = 0; k < ring.registers * RayRing::kLanes; ++k) distances[k] = ring.range_m;

  const bool heights = !b.motion.empty();  // else all robots stand on the ground, at the height of the rays
  const double height = static_cast<double>(ring.height_m) + stores.base_m(row);
  const double reach = static_cast<double>(ring.reach_m);
  stores.body_index.for_each_near(
      x, y, reach + static_cast<double>(b.radius_m[row]), [&](const IndexEntry& o) __attribute__((always_inline)) {
        const float wx = static_cast<float>(o.x_m - x);
        const float wy = static_cast<float>(o.y_m - y);
        const float within = ring.reach_m + o.radius_m;
        if (wx * wx + wy * wy >= within * within || o.row() == row32) return;
        if (heights && !stands_at(stores, o.row(), height)) return;
        const float qx = c * wx + s * wy;
        const float qy = c * wy - s * wx;
        for (std::size_t g = 0; g < ring.registers; ++g)
          meet_disc(ring, g, qx, qy, o.radius_m, distances + g * RayRing::kLanes);
      });
  stores.for_each_object_near(
      x, y, [&](const Object& shape) __attribute__((always_inline)) {
        if (height < shape.z_low_m || height > shape.z_high_m) return;
        const float wx = static_cast<float>(shape.x_m - x);
        const float wy = static_cast<float>(shape.y_m - y);
        const float qx = c * wx + s * wy;
        const float qy = c * wy - s * wx;
        if (shape.kind == Object::Kind::Cylinder) {
          const auto radius = static_cast<float>(shape.radius_m);
          for (std::size_t g = 0; g < ring.registers; ++g)
            meet_disc(ring, g, qx, qy, radius, distances + g * RayRing::kLanes);
        } else {
          const auto bc = static_cast<float>(shape.cos_h);
          const auto bs = static_cast<float>(shape.sin_h);
          const float ax = c * bc + s * bs;
          const float ay = c * bs - s * bc;
          for (std::size_t g = 0; g < ring.registers; ++g) {
            meet_box(ring, g, qx, qy, ax, ay, static_cast<float>(shape.half_x_m), static_cast<float>(shape.half_y_m),
                     distances + g * RayRing::kLanes);
          }
        }
      });
}

[[gnu::always_inline]] inline void sense_block(const DeviceContext& context, const RayRing& ring,
                                               hal::Proximity* ports) noexcept {
  for (std::size_t i = 0; i < context.block.used; ++i) {
    hal::Proximity& port = ports[i];
    port.taken_ns = context.now_ns;
    port.validity = hal::Validity::Fresh;
    port.count = static_cast<std::uint32_t>(ring.count);
    port.range_m = ring.range_m;
    sense_row(context.stores, ring, context.block.first_row + i, port.distance_m.data());
  }
}

void sense_block_baseline(const DeviceContext& context, const RayRing& ring, hal::Proximity* ports) noexcept {
  sense_block(context, ring, ports);
}

#if defined(__x86_64__) || defined(__i386__)
// The same source once more, for wider registers. No fused multiply-add: the bits stay those of the baseline.
__attribute__((target("avx2"))) void sense_block_avx2(const DeviceContext& context, const RayRing& ring,
                                                      hal::Proximity* ports) noexcept {
  sense_block(context, ring, ports);
}
#else
void sense_block_avx2(const DeviceContext& context, const RayRing& ring, hal::Proximity* ports) noexcept {
  sense_block(context, ring, ports);
}
#endif

class ProximitySensor final : public Sensor {
 public:
  ProximitySensor(const hal::DataSheet& sheet, double noise_level)
      : ring_(sheet.proximity, sheet.proximity_range_m), noise_(static_cast<float>(noise_level)) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* proximity = static_cast<hal::Proximity*>(ports);
    if (vector_code() == VectorCode::Avx2)
      sense_block_avx2(context, ring_, proximity);
    else
      sense_block_baseline(context, ring_, proximity);
    if (noise_ > 0.0F) add_noise(context, proximity);
  }

 private:
  /// Uniform noise of +-level on the closeness, which is 0 far and 1 near.
  void add_noise(const DeviceContext& context, hal::Proximity* ports) const noexcept {
    for (std::size_t i = 0; i < context.block.used; ++i) {
      hal::Proximity& port = ports[i];
      const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
      for (std::size_t k = 0; k < ring_.count; k += 8) {  // eight 16-bit numbers a draw
        const auto bits =
            draw(context.seed, entity, Stream::ProximityNoise, context.tick, static_cast<std::uint32_t>(k));
        for (std::size_t j = k; j < std::min(ring_.count, k + 8); ++j) {
          const std::uint32_t half = (bits[(j - k) / 2] >> (16 * (j & 1))) & 0xFFFFU;
          const float unit = (static_cast<float>(half) + 0.5F) * 0x1p-15F - 1.0F;  // in (-1, 1)
          const float noisy = port.distance_m[j] + noise_ * unit * ring_.range_m;
          port.distance_m[j] = std::min(std::max(noisy, 0.0F), ring_.range_m);
        }
      }
    }
  }

  RayRing ring_;
  float noise_;
};

struct NoOptions {
  bool show_rays = false;
  void describe(hal::ParamVisitor& v) {
    v.flag("show_rays", show_rays, "Draw the rays in a view; no effect on readings.");
  }
};

template <int kPerMille>
struct NoiseOptions : NoOptions {
  double noise_level = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    NoOptions::describe(v);
    v.number("noise_level", noise_level, hal::unit::none, {0.0, 1.0},
             "Uniform noise of +-level on the closeness (0 nothing in range, 1 contact).");
  }
};

bool has_proximity(const hal::DataSheet& sheet) {
  return !sheet.proximity.empty();
}

template <class Options>
Recipe<Sensor> make_proximity(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_level; }) noise = options.noise_level;
  return [&sheet = setup.sheet, noise](std::size_t) { return std::make_unique<ProximitySensor>(sheet, noise); };
}

template <class Options>
DeviceType proximity_type(std::string_view implementation, std::string_view summary) {
  return sensor_type("proximity", implementation, summary, &has_proximity, &make_proximity<Options>,
                     &describe_options<Options>);
}

}  // namespace

VectorCode vector_code() noexcept {
  return chosen_code.load(std::memory_order_relaxed);
}
void use_vector_code(VectorCode code) noexcept {
  chosen_code.store(code, std::memory_order_relaxed);
}
bool has_avx2() noexcept {
  return detect_avx2();
}

std::vector<DeviceType> proximity_types() {
  return {proximity_type<NoiseOptions<0>>("default", "Exact rays; noise only where noise_level asks for it."),
          proximity_type<NoOptions>("ideal", "Exact rays against bodies, boxes and cylinders."),
          proximity_type<NoiseOptions<20>>("noisy", "Rays with uniform noise."),
          proximity_type<NoiseOptions<0>>("rot_z_only", "ARGoS' name for the default.")};
}

}  // namespace tandem::core
