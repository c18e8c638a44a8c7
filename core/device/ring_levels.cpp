// Ambient light, ground reflectance, cliffs: one level a sensor of the ring.
#include "core/device/field_ring.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::core {
namespace {

/// Uniform noise on levels in [0, 1]. With `kShowRays`, ARGoS' switch for its view is accepted too.
template <int kPerMille, bool kShowRays>
struct LevelNoise {
  double noise_level = kPerMille * 1e-3;
  bool show_rays = false;
  void describe(hal::ParamVisitor& v) {
    if constexpr (kShowRays) v.flag("show_rays", show_rays, "Draw the rays in a view; no effect on readings.");
    if constexpr (kPerMille >= 0)
      v.number("noise_level", noise_level, hal::unit::none, {0.0, 1.0}, "Uniform noise of +-level.");
  }
  double level() const { return kPerMille >= 0 ? noise_level : 0.0; }
};

/// Adds noise to `count` levels and keeps them within [0, 1].
void add_noise(const DeviceContext& context, std::size_t i, Stream stream, float noise, float* levels,
               std::size_t count) noexcept {
  const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
  for (std::size_t k = 0; k < count; ++k) {
    const auto bits = draw(context.seed, entity, stream, context.tick, static_cast<std::uint32_t>(k / 4));
    const float noisy = levels[k] + noise * (2.0F * to_unit_float(bits[k % 4]) - 1.0F);
    levels[k] = std::min(std::max(noisy, 0.0F), 1.0F);
  }
}

/// One value of a field a sensor of the ring, and one port a robot.
template <class Port>
class LevelSensor : public Sensor {
 public:
  LevelSensor(const Field& field, std::span<const hal::Mount> mounts, Stream noise_stream, double noise)
      : ring_(field, mounts), stream_(noise_stream), noise_(static_cast<float>(noise)) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    ring_.sample(context, [&](std::size_t i, const double* values) {
      Port& port = static_cast<Port*>(ports)[i];
      stamp(context, port);
      port.count = static_cast<std::uint32_t>(ring_.size());
      float* const levels = levels_of(port);
      for (std::size_t k = 0; k < ring_.size(); ++k) levels[k] = static_cast<float>(values[k]);
      if constexpr (std::is_same_v<Port, hal::Cliff>) drop_beyond_edge(context, i, levels);
      if (noise_ > 0.0F) add_noise(context, i, stream_, noise_, levels, ring_.size());
    });
  }

 private:
  static float* levels_of(hal::Light& port) noexcept { return port.level.data(); }
  static float* levels_of(hal::Ground& port) noexcept { return port.reflectance.data(); }
  static float* levels_of(hal::Cliff& port) noexcept { return port.reflectance.data(); }

  /// The floor ends where the arena does: from beyond nothing comes back.
  void drop_beyond_edge(const DeviceContext& context, std::size_t i, float* levels) const noexcept {
    const SpaceStores& s = context.stores;
    const std::size_t row = context.block.first_row + i;
    const Bodies& b = s.bodies;
    for (std::size_t k = 0; k < ring_.size(); ++k) {
      const FieldSpot& spot = ring_.spot(k);
      const double x_m = b.x_m[row] + b.cos_h[row] * spot.x_m - b.sin_h[row] * spot.y_m;
      const double y_m = b.y_m[row] + b.sin_h[row] * spot.x_m + b.cos_h[row] * spot.y_m;
      if (x_m < s.min_x_m || x_m > s.max_x_m || y_m < s.min_y_m || y_m > s.max_y_m) levels[k] = 0.0F;
    }
  }

  FieldRing ring_;
  Stream stream_;
  float noise_;
};

class LightSensor final : public LevelSensor<hal::Light> {
 public:
  static constexpr std::string_view kField = "light";
  using Part = hal::LightPart;
  LightSensor(const Field& field, const Part& part, double noise)
      : LevelSensor(field, part.mounts, Stream::LightNoise, noise) {}
};

/// For each of the ports that a robot may have for its floor: they differ in name and mounts only.
class GroundSensor : public LevelSensor<hal::Ground> {
 public:
  static constexpr std::string_view kField = "floor";
  using LevelSensor::LevelSensor;
};

class PlainGround final : public GroundSensor {
 public:
  using Part = hal::GroundPart;
  PlainGround(const Field& field, const Part& part, double noise)
      : GroundSensor(field, part.mounts, Stream::GroundNoise, noise) {}
};
class BaseGround final : public GroundSensor {
 public:
  using Part = hal::BaseGroundPart;
  BaseGround(const Field& field, const Part& part, double noise)
      : GroundSensor(field, part.mounts, Stream::GroundNoise, noise) {}
};
class MotorGround final : public GroundSensor {
 public:
  using Part = hal::MotorGroundPart;
  MotorGround(const Field& field, const Part& part, double noise)
      : GroundSensor(field, part.mounts, Stream::MotorGroundNoise, noise) {}
};
class CliffSensor final : public LevelSensor<hal::Cliff> {
 public:
  static constexpr std::string_view kField = "floor";
  using Part = hal::CliffPart;
  CliffSensor(const Field& field, const Part& part, double noise)
      : LevelSensor(field, part.mounts, Stream::CliffNoise, noise) {}
};
static_assert(sizeof(hal::BaseGround) == sizeof(hal::Ground) && sizeof(hal::MotorGround) == sizeof(hal::Ground));

template <class Device, class Options>
BlockFactory<Sensor> make_levels(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const double noise = read_options<Options>(element, problems).level();
  const Field* const field = setup.field(Device::kField, element, problems);
  return [field, &part = *setup.kind.part<typename Device::Part>(), noise](const BlockColumns&) {
    return std::make_unique<Device>(*field, part, noise);
  };
}

template <class Device, class Options>
DeviceType levels_type(std::string_view device, std::string_view implementation, std::string_view summary) {
  return sensor_type(device, implementation, summary, &has<typename Device::Part>, &make_levels<Device, Options>,
                     &describe_options<Options>);
}

template <class Device>
void add_grounds(std::string_view device, std::vector<DeviceType>& types) {
  types.push_back(
      levels_type<Device, LevelNoise<0, false>>(device, "default", "The floor's shade; noise where asked for."));
  types.push_back(levels_type<Device, LevelNoise<-1, false>>(device, "ideal", "The floor's shade."));
  types.push_back(levels_type<Device, LevelNoise<20, false>>(device, "noisy", "The floor's shade, with noise."));
  types.push_back(levels_type<Device, LevelNoise<0, false>>(device, "rot_z_only", "ARGoS' name for the default."));
}

}  // namespace

std::vector<DeviceType> ring_level_types() {
  std::vector<DeviceType> types = {
      levels_type<LightSensor, LevelNoise<0, true>>("light", "default", "Lamps in sight; noise where asked for."),
      levels_type<LightSensor, LevelNoise<-1, true>>("light", "ideal", "Lamps in sight."),
      levels_type<LightSensor, LevelNoise<20, true>>("light", "noisy", "Lamps in sight, with noise."),
      levels_type<LightSensor, LevelNoise<0, true>>("light", "rot_z_only", "ARGoS' name for the default.")};
  const std::string_view cliff = hal::Cliff::kName;
  types.push_back(levels_type<CliffSensor, LevelNoise<0, false>>(
      cliff, "default", "The floor's shade, 0 beyond the arena's edge; noise where asked for."));
  types.push_back(
      levels_type<CliffSensor, LevelNoise<-1, false>>(cliff, "ideal", "The floor's shade, 0 beyond the arena's edge."));
  types.push_back(levels_type<CliffSensor, LevelNoise<20, false>>(
      cliff, "noisy", "The floor's shade, 0 beyond the arena's edge, with noise."));
  add_grounds<PlainGround>(hal::Ground::kName, types);
  add_grounds<BaseGround>(hal::BaseGround::kName, types);
  add_grounds<MotorGround>(hal::MotorGround::kName, types);
  return types;
}

}  // namespace tandem::core
