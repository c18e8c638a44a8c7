// Ambient light and ground reflectance: one level a sensor of the ring.
#include "core/device/sight.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
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

// --- light ---

/// A sensor that faces a lamp of intensity I at distance d reads (I / d)^2, at most 1; less by the cosine of the angle
/// to it. Levels of several lamps add up. Boxes and cylinders cast shadows.
class LightSensor final : public Sensor {
 public:
  using Part = hal::LightPart;
  LightSensor(const Part& part, double noise) : mounts_(part.mounts), noise_(static_cast<float>(noise)) {
    for (const hal::Mount& m : mounts_) looks_.push_back({std::cos(m.bearing_rad), std::sin(m.bearing_rad)});
  }

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* lights = static_cast<hal::Light*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      hal::Light& port = lights[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.count = static_cast<std::uint32_t>(mounts_.size());
      port.level.fill(0.0F);
      for (const LightSource& lamp : context.stores.lights) {
        if (lamp.alive) add_lamp(context, i, lamp, port);
      }
      if (noise_ > 0.0F) add_noise(context, i, Stream::LightNoise, noise_, port.level.data(), mounts_.size());
    }
  }

 private:
  struct Direction {
    double x, y;
  };

  void add_lamp(const DeviceContext& context, std::size_t i, const LightSource& lamp, hal::Light& port) const noexcept {
    const Bodies& b = context.stores.bodies;
    const std::size_t row = context.block.first_row + i;
    const double wx = lamp.x_m - b.x_m[row];
    const double wy = lamp.y_m - b.y_m[row];
    const double height = mounts_.front().z_m + context.stores.base_m(row);
    const double wz = lamp.z_m - height;
    const double d2 = std::max(wx * wx + wy * wy + wz * wz, 1e-6);
    const double strength = std::min(lamp.intensity * lamp.intensity / d2, 1.0);
    if (strength < 1e-4) return;  // below a twelve-bit converter's resolution
    if (!in_sight(context.stores, b.x_m[row], b.y_m[row], height, lamp.x_m, lamp.y_m, lamp.z_m)) return;
    const double bx = b.cos_h[row] * wx + b.sin_h[row] * wy;
    const double by = b.cos_h[row] * wy - b.sin_h[row] * wx;
    const double flat = std::sqrt(std::max(wx * wx + wy * wy, 1e-12));
    for (std::size_t k = 0; k < mounts_.size(); ++k) {
      const double facing = (bx * looks_[k].x + by * looks_[k].y) / flat;
      if (facing > 0.0) port.level[k] = std::min(1.0F, port.level[k] + static_cast<float>(strength * facing));
    }
  }

  std::span<const hal::Mount> mounts_;
  std::vector<Direction> looks_;
  float noise_;
};

// --- ground ---

/// For each of the ports that a robot may have for its floor: they differ in name and mounts only.
class GroundSensor : public Sensor {
 public:
  GroundSensor(std::span<const hal::Mount> mounts, Stream noise_stream, double noise)
      : mounts_(mounts), stream_(noise_stream), noise_(static_cast<float>(noise)) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* grounds = static_cast<hal::Ground*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::Ground& port = grounds[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.count = static_cast<std::uint32_t>(mounts_.size());
      for (std::size_t k = 0; k < mounts_.size(); ++k) {
        const hal::Mount& m = mounts_[k];
        port.reflectance[k] = context.stores.floor.at(b.x_m[row] + b.cos_h[row] * m.x_m - b.sin_h[row] * m.y_m,
                                                      b.y_m[row] + b.sin_h[row] * m.x_m + b.cos_h[row] * m.y_m);
      }
      if (noise_ > 0.0F) add_noise(context, i, stream_, noise_, port.reflectance.data(), mounts_.size());
    }
  }

 private:
  std::span<const hal::Mount> mounts_;
  Stream stream_;
  float noise_;
};

class PlainGround final : public GroundSensor {
 public:
  using Part = hal::GroundPart;
  PlainGround(const Part& part, double noise) : GroundSensor(part.mounts, Stream::GroundNoise, noise) {}
};
class BaseGround final : public GroundSensor {
 public:
  using Part = hal::BaseGroundPart;
  BaseGround(const Part& part, double noise) : GroundSensor(part.mounts, Stream::GroundNoise, noise) {}
};
class MotorGround final : public GroundSensor {
 public:
  using Part = hal::MotorGroundPart;
  MotorGround(const Part& part, double noise) : GroundSensor(part.mounts, Stream::MotorGroundNoise, noise) {}
};
static_assert(sizeof(hal::BaseGround) == sizeof(hal::Ground) && sizeof(hal::MotorGround) == sizeof(hal::Ground));

template <class Device, class Options>
Recipe<Sensor> make_levels(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const double noise = read_options<Options>(element, problems).level();
  return [&part = *setup.kind.part<typename Device::Part>(), noise](const BlockColumns&) {
    return std::make_unique<Device>(part, noise);
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
  add_grounds<PlainGround>(hal::Ground::kName, types);
  add_grounds<BaseGround>(hal::BaseGround::kName, types);
  add_grounds<MotorGround>(hal::MotorGround::kName, types);
  return types;
}

}  // namespace tandem::core
