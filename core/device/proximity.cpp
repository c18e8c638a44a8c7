#include "core/device/proximity.hpp"

#include <atomic>
#include <optional>

#include "core/device/describe.hpp"
#include "core/device/fitted_rays.hpp"
#include "core/device/leaning_rays.hpp"
#include "core/device/ray_ring.hpp"
#include "core/random/random.hpp"
#include "core/space/sight.hpp"
#include "hal/device/argos_curves.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/open_params.hpp"

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

// Robots are sensed in teams, in three short loops: who may be near, who of them is in reach, what the rays say to
// those. Neighbours come at random, so each loop writes its result always and counts it when it is one: a wrong guess
// of a branch costs more than the writing, and one loop does not wait for what another has not loaded yet.
constexpr std::size_t kTeam = 64;       // its ports stay in the first cache
constexpr std::size_t kWaiting = 1024;  // neighbours found and not met yet; more are met in several goes

/// Whether a body is where rays at this height pass.
bool stands_at(const SpaceStores& stores, std::size_t row, double height_m) noexcept {
  const double low_m = stores.bodies.motion[row].z_m;
  return height_m >= low_m && height_m <= low_m + stores.kind_of_row(row).body.height_m;
}

/// Of the rays above the ground under the arena.
double ray_height_m(const SpaceStores& stores, const RayRing& ring, std::size_t row) noexcept {
  return static_cast<double>(ring.height_m) + stores.base_m(row);
}

/// A body that may be near a robot of the team.
struct Candidate {
  std::uint32_t slot;  ///< the robot's place in the block
  std::uint32_t entry;
};

/// A body in reach, as a disc in the robot's frame.
struct Sight {
  float qx, qy, radius;
  std::uint32_t slot;
};

struct Waiting {
  std::size_t count = 0;
  std::array<Candidate, kWaiting> candidates;
  std::array<Sight, kWaiting> sights;
};

/// Tests the waiting candidates, and shortens the distances of those robots that have one in reach.
[[gnu::always_inline]] inline void meet(const SpaceStores& stores, const RayRing& ring, std::size_t first_row,
                                        hal::Proximity* ports, Waiting& waiting) noexcept {
  const Bodies& b = stores.bodies;
  const IndexEntry* entries = stores.body_index.entries();
  const bool heights = !b.motion.empty();  // else all robots stand on the ground, at the height of the rays
  const bool twins = stores.twins;
  std::size_t count = 0;
  for (std::size_t k = 0; k < waiting.count; ++k) {
    const Candidate candidate = waiting.candidates[k];
    const IndexEntry& o = entries[candidate.entry];
    const std::size_t row = first_row + candidate.slot;
    const float c = static_cast<float>(b.cos_h[row]);
    const float s = static_cast<float>(b.sin_h[row]);
    const float wx = static_cast<float>(o.x_m - b.x_m[row]);
    const float wy = static_cast<float>(o.y_m - b.y_m[row]);
    const float within = ring.reach_m + o.radius_m;
    waiting.sights[count] = {c * wx + s * wy, c * wy - s * wx, o.radius_m, candidate.slot};
    bool in_reach = (wx * wx + wy * wy < within * within) & (o.row() != row);
    if (heights && in_reach) in_reach = stands_at(stores, o.row(), ray_height_m(stores, ring, row));
    if (twins && in_reach) in_reach = !stores.senses_really(row, o.row(), RealSense::Proximity);
    count += in_reach ? 1U : 0U;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Sight& seen = waiting.sights[k];
    float* distances = ports[seen.slot].distance_m.data();
    for (std::size_t g = 0; g < ring.registers; ++g)
      meet_disc(ring, g, seen.qx, seen.qy, seen.radius, distances + g * RayRing::kLanes);
  }
  waiting.count = 0;
}

[[gnu::always_inline]] inline void meet_object(const RayRing& ring, const Object& shape, double height, double x,
                                               double y, float c, float s, float* distances) noexcept {
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
}

/// Notes who may be near the robot in `slot`, and shortens its distances where its rays meet objects. `within_m`: where
/// centres of bodies lie that rays may meet.
[[gnu::always_inline]] inline void look_around(const SpaceStores& stores, const RayRing& ring, std::size_t first_row,
                                               std::uint32_t slot, double within_m, bool lean, hal::Proximity* ports,
                                               Waiting& waiting) noexcept {
  const std::size_t row = first_row + slot;
  const Bodies& b = stores.bodies;
  const double x = b.x_m[row];
  const double y = b.y_m[row];
  stores.body_index.for_each_run_near(
      x, y, within_m, [&](std::uint32_t first, std::uint32_t past) __attribute__((always_inline)) {
        // Most runs are of two at most.
        if (waiting.count + 2 > kWaiting) [[unlikely]]
          meet(stores, ring, first_row, ports, waiting);
        waiting.candidates[waiting.count] = {slot, first};
        waiting.candidates[waiting.count + 1] = {slot, first + 1};
        waiting.count += std::min(past - first, 2U);
        for (first += 2; first < past; ++first) {
          if (waiting.count == kWaiting) [[unlikely]]
            meet(stores, ring, first_row, ports, waiting);
          waiting.candidates[waiting.count++] = {slot, first};
        }
      });
  stores.for_each_object_near(
      x, y, [&](const Object& shape) __attribute__((always_inline)) {
        if (lean && leans(turn_of(stores, shape))) [[unlikely]] {
          meet_leaning(ring, shape, turn_of(stores, shape), ray_height_m(stores, ring, row), x, y, b.cos_h[row],
                       b.sin_h[row], ports[slot].distance_m.data());
          return;
        }
        meet_object(ring, shape, ray_height_m(stores, ring, row), x, y, static_cast<float>(b.cos_h[row]),
                    static_cast<float>(b.sin_h[row]), ports[slot].distance_m.data());
      });
}

[[gnu::always_inline]] inline void sense_block(const DeviceContext& context, const RayRing& ring,
                                               hal::Proximity* ports) noexcept {
  const auto used = static_cast<std::uint32_t>(context.block.used);
  const std::size_t first_row = context.block.first_row;
  const bool lean = anything_may_lean(context.stores);
  const double within_m = static_cast<double>(ring.reach_m) + widest_body_m(context.stores);
  Waiting waiting;
  for (std::uint32_t begin = 0; begin < used; begin += kTeam) {
    const std::uint32_t end = std::min(used, begin + static_cast<std::uint32_t>(kTeam));
    for (std::uint32_t slot = begin; slot < end; ++slot) {
      hal::Proximity& port = ports[slot];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.count = static_cast<std::uint32_t>(ring.count);
      port.range_m = ring.range_m;
      for (std::size_t g = 0; g < ring.registers; ++g) {
        const Lanes nothing = Lanes{} + ring.range_m;
        std::memcpy(port.distance_m.data() + g * RayRing::kLanes, &nothing, sizeof nothing);
      }
    }
    for (std::uint32_t slot = begin; slot < end; ++slot)
      look_around(context.stores, ring, first_row, slot, within_m, lean, ports, waiting);
    meet(context.stores, ring, first_row, ports, waiting);
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
  /// `readings`: the noise is on ARGoS' readings; nothing: on the closeness.
  ProximitySensor(const hal::ProximityPart& part, double noise_level, std::optional<hal::ArgosProximity> readings,
                  std::optional<FittedRays> fitted)
      : ring_(part.mounts, part.range_m),
        noise_(static_cast<float>(noise_level)),
        readings_(readings),
        fitted_(std::move(fitted)) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* proximity = static_cast<hal::Proximity*>(ports);
    if (vector_code() == VectorCode::Avx2)
      sense_block_avx2(context, ring_, proximity);
    else
      sense_block_baseline(context, ring_, proximity);
    if (fitted_) fitted_->read(context, proximity);
    if (noise_ > 0.0F) add_noise(context, proximity);
  }

 private:
  /// Uniform noise of +-level on the closeness, which is 0 far and 1 near, or on the reading.
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
          if (readings_) {
            port.distance_m[j] = with_noisy_reading(port.distance_m[j], unit);
            continue;
          }
          const float noisy = port.distance_m[j] + noise_ * unit * ring_.range_m;
          port.distance_m[j] = std::min(std::max(noisy, 0.0F), ring_.range_m);
        }
      }
    }
  }
  float with_noisy_reading(float distance_m, float unit) const noexcept {
    const double exact =
        distance_m < ring_.range_m ? hal::argos_reading(*readings_, static_cast<double>(distance_m)) : 0.0;
    const double noisy = std::min(exact + static_cast<double>(noise_ * unit), 1.0);
    return noisy > 0.0 ? static_cast<float>(hal::argos_distance_m(*readings_, noisy)) : ring_.range_m;
  }

  RayRing ring_;
  float noise_;
  std::optional<hal::ArgosProximity> readings_;
  std::optional<FittedRays> fitted_;  // nothing: they are as their kind says
};

struct ProximityErrors {
  bool show_rays = false;
  double noise_level = 0.0;
  std::string noise_of = "closeness";
  static ProximityErrors noisy() { return {.noise_level = 20 * 1e-3}; }
  void describe_always(hal::ParamVisitor& v) {
    v.flag("show_rays", show_rays, "Draw the rays in a view; no effect on readings.");
  }
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kOf = {"closeness", "reading"};
    if (hal::in_argos_file(v)) noise_of = "reading";
    v.number("noise_level", noise_level, hal::unit::none, {0.0, 1.0}, "Uniform noise of +-level.");
    v.choice("noise_of", noise_of, kOf,
             "What it is on: the closeness (0 nothing in range, 1 contact), or ARGoS' reading, which is not linear in "
             "the distance. Left out in an ARGoS file: the reading.");
  }
};

template <Level kLevel>
BlockFactory<Sensor> make_proximity(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto errors = read_options<LevelOptions<ProximityErrors, kLevel>>(element, problems);
  const double noise = errors.noise_level;
  std::optional<hal::ArgosProximity> readings;
  if (errors.noise_of == "reading") readings = hal::argos_proximity(element.name);
  const auto& part = *setup.kind.part<hal::ProximityPart>();
  const auto* const fitted = setup.kind.part<hal::FittedProximity>();
  if (fitted == nullptr || kLevel == Level::Ideal)
    return [&part, noise, readings](const BlockColumns&) {
      return std::make_unique<ProximitySensor>(part, noise, readings, std::nullopt);
    };
  if (const std::string flaw = FittedRays::flaw(*fitted, setup.tick_s); !flaw.empty())
    problems.push_back(problem_at(element, flaw));
  const auto make = [&part, noise, readings, fitted](const BlockColumns& columns) {
    return std::make_unique<ProximitySensor>(part, noise, readings, FittedRays(*fitted, columns));
  };
  return {make, FittedRays::columns()};
}

template <Level kLevel>
DeviceType proximity_type(std::string_view implementation, std::string_view summary) {
  return sensor_type("proximity", implementation, summary, &has<hal::ProximityPart>, &make_proximity<kLevel>,
                     &describe_options<LevelOptions<ProximityErrors, kLevel>>);
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
  return {proximity_type<Level::Default>("default", "Exact rays; noise only where noise_level asks for it."),
          proximity_type<Level::Ideal>("ideal", "Exact rays against bodies, boxes and cylinders."),
          proximity_type<Level::Noisy>("noisy", "Rays with uniform noise."),
          proximity_type<Level::Default>("rot_z_only", "ARGoS' name for the default.")};
}

}  // namespace tandem::core
