// Ambient light, ground reflectance, cliffs: one level a sensor of the ring.
#include "core/device/each_robot.hpp"
#include "core/device/field_ring.hpp"
#include "core/device/types.hpp"
#include "core/field/light/light.hpp"
#include "core/random/random.hpp"
#include "hal/device/argos_curves.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/open_params.hpp"

namespace tandem::core {
namespace {

/// Uniform noise on levels in [0, 1].
constexpr ErrorText kLevelNoise{"noise_level", 20 * 1e-3, hal::unit::none, {0.0, 1.0}, "Uniform noise of +-level."};
using LevelNoise = OneError<kLevelNoise>;
/// ARGoS' switch for its view is accepted too.
struct LightNoise : LevelNoise {
  bool show_rays = false;
  std::string curve = "facing", written = {};
  static LightNoise noisy() { return {LevelNoise::noisy()}; }
  void describe_always(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kCurves = {"facing", "argos"};
    if (hal::in_argos_file(v)) curve = "argos";
    v.flag("show_rays", show_rays, "Draw the rays in a view; no effect on readings.");
    v.choice("curve", curve, kCurves,
             "Reading of a lamp: by its brightness and the cosine of the angle to it, or as ARGoS' sensor of this name "
             "has it. Left out in an ARGoS file: argos.");
  }
};

/// As the sensor's name in the file tells.
LightCurve light_curve(const std::string& curve, std::string_view written) noexcept {
  if (curve != "argos") return LightCurve::Facing;
  return hal::argos_light_fades(written) ? LightCurve::ArgosFading : LightCurve::ArgosGeneric;
}

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
template <class OfPort, class OfPart, Stream kNoise>
class LevelSensor final : public Sensor {
  static constexpr bool kOfLight = std::is_same_v<OfPort, hal::Light>;

 public:
  using Port = OfPort;
  using Part = OfPart;
  using Errors = std::conditional_t<kOfLight, LightNoise, LevelNoise>;
  static constexpr std::string_view kField = kOfLight ? "light" : "floor";

  LevelSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : of_argos_(argos_light(errors)),
        ring_(of_argos_ != nullptr ? *of_argos_ : *setup.fields->find(kField), setup.kind.part<Part>()->mounts),
        noise_(static_cast<float>(errors.amount)) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    ring_.sample(context, [&](std::size_t i, const double* values) {
      Port& port = static_cast<Port*>(ports)[i];
      stamp(context, port);
      port.count = static_cast<std::uint32_t>(ring_.size());
      float* const levels = levels_of(port);
      for (std::size_t k = 0; k < ring_.size(); ++k) levels[k] = static_cast<float>(values[k]);
      if constexpr (std::is_same_v<Port, hal::Cliff>) drop_beyond_edge(context, i, levels);
      if (noise_ > 0.0F) add_noise(context, i, kNoise, noise_, levels, ring_.size());
    });
  }

 private:
  /// Null: it sees the world's own field.
  static std::unique_ptr<Field> argos_light(const Errors& errors) {
    if constexpr (kOfLight) {
      const LightCurve curve = light_curve(errors.curve, errors.written);
      if (curve != LightCurve::Facing) return std::make_unique<LightField>(curve);
    }
    return nullptr;
  }
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

  std::unique_ptr<Field> of_argos_;  // of a sensor of light that reads as ARGoS' do
  FieldRing ring_;
  float noise_;
};

using LightSensor = LevelSensor<hal::Light, hal::LightPart, Stream::LightNoise>;
using CliffSensor = LevelSensor<hal::Cliff, hal::CliffPart, Stream::CliffNoise>;
// The ports that a robot may have for its floor differ in name and mounts only.
using PlainGround = LevelSensor<hal::Ground, hal::GroundPart, Stream::GroundNoise>;
using BaseGround = LevelSensor<hal::BaseGround, hal::BaseGroundPart, Stream::GroundNoise>;
using MotorGround = LevelSensor<hal::MotorGround, hal::MotorGroundPart, Stream::MotorGroundNoise>;
static_assert(sizeof(hal::BaseGround) == sizeof(hal::Ground) && sizeof(hal::MotorGround) == sizeof(hal::Ground));

template <class Device>
void add_ground(std::vector<DeviceType>& types) {
  add_levels<Device>(types, "The floor's shade; noise where asked for.", "The floor's shade.",
                     "The floor's shade, with noise.");
  types.push_back(device_type<Device, Level::Default>("rot_z_only", "ARGoS' name for the default."));
}

}  // namespace

std::vector<DeviceType> ring_level_types() {
  std::vector<DeviceType> types;
  add_levels<LightSensor>(types, "Lamps in sight; noise where asked for.", "Lamps in sight.",
                          "Lamps in sight, with noise.");
  types.push_back(device_type<LightSensor, Level::Default>("rot_z_only", "ARGoS' name for the default."));
  add_levels<CliffSensor>(types, "The floor's shade, 0 beyond the arena's edge; noise where asked for.",
                          "The floor's shade, 0 beyond the arena's edge.",
                          "The floor's shade, 0 beyond the arena's edge, with noise.");
  add_ground<PlainGround>(types);
  add_ground<BaseGround>(types);
  add_ground<MotorGround>(types);
  return types;
}

}  // namespace tandem::core
