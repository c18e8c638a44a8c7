// Turrets: the actuator that turns them, and the encoder that tells where they look.
#include "hal/device/turret.hpp"

#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

struct IdealTurret {
  void describe(hal::ParamVisitor&) {}
};

template <int kPerMille>
struct TurretErrors {
  double noise_std_dev = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::none, {0.0, 1.0},
             "Standard deviation of the turn rate's relative error, drawn every tick.");
  }
};

/// Turns what carries no load at once; a turret that holds something is turned by the physics engine.
class TurretActuator final : public Actuator {
 public:
  TurretActuator(double fastest_rad_s, double noise, const BlockColumns& columns)
      : fastest_rad_s_(fastest_rad_s),
        noise_(noise),
        turrets_(columns.find<TurretState>()),
        grips_(columns.find<GripState>()) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    const auto* drives = static_cast<const hal::TurretDrive*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      if (led_from_outside(context, i)) continue;
      command(context, i, drives[i], turrets_[i]);
      if (grips_ == nullptr || !grips_[i].holding()) turn(turrets_[i], context.tick_s);
    }
  }

 private:
  void command(const DeviceContext& context, std::size_t i, const hal::TurretDrive& drive,
               TurretState& turret) const noexcept {
    turret.mode = obeys(context, i) ? drive.mode : hal::TurretMode::Off;
    turret.target = turret.mode == hal::TurretMode::Position ? drive.angle_rad : drive.speed_rad_s;
    if (noise_ == 0.0 || turret.mode != hal::TurretMode::Speed) return;
    const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
    const auto bits = draw(context.seed, entity, Stream::TurretNoise, context.tick);
    turret.target *= 1.0 + noise_ * to_normal(bits[0], bits[1])[0];
  }
  void turn(TurretState& turret, double tick_s) const noexcept {
    double step_rad = 0.0;
    if (turret.mode == hal::TurretMode::Speed) step_rad = turret.target * tick_s;
    if (turret.mode == hal::TurretMode::Position) {
      const double most_rad = fastest_rad_s_ * tick_s;
      step_rad = std::clamp(hal::wrapped(turret.target - turret.angle_rad), -most_rad, most_rad);
    }
    turret.angle_rad = hal::wrapped(turret.angle_rad + step_rad);
    turret.speed_rad_s = step_rad / tick_s;
  }

  double fastest_rad_s_;
  double noise_;
  TurretState* turrets_;
  const GripState* grips_;  // null: they have no grippers
};

template <class Options>
BlockFactory<Actuator> make_turret(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto options = read_options<Options>(element, problems);
  double noise = 0.0;
  if constexpr (requires { options.noise_std_dev; }) noise = options.noise_std_dev;
  const auto make = [fastest = setup.kind.part<hal::TurretPart>()->turn_rad_s, noise](const BlockColumns& columns) {
    return std::make_unique<TurretActuator>(fastest, noise, columns);
  };
  return {make, {keeps<TurretState>()}};
}

template <class Options>
DeviceType turret_type(std::string_view implementation, std::string_view summary) {
  return actuator_type(hal::TurretDrive::kName, implementation, summary, &has<hal::TurretPart>, &make_turret<Options>,
                       &describe_options<Options>);
}

// --- encoder ---

struct IdealEncoder {
  void describe(hal::ParamVisitor&) {}
};

template <int kPerMille>
struct AngleNoise {
  double noise_range_rad = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on the angle.");
  }
};

class TurretEncoderSensor final : public Sensor {
 public:
  TurretEncoderSensor(double noise_rad, const BlockColumns& columns)
      : noise_rad_(noise_rad), turrets_(columns.find<TurretState>()) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* encoders = static_cast<hal::TurretEncoder*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      hal::TurretEncoder& port = encoders[i];
      stamp(context, port);
      port.angle_rad = turrets_[i].angle_rad;
      port.speed_rad_s = static_cast<float>(turrets_[i].speed_rad_s);
      if (noise_rad_ == 0.0) continue;
      const auto bits = draw(context.seed, b.entity[row], Stream::TurretEncoderNoise, context.tick);
      port.angle_rad = hal::wrapped(port.angle_rad + noise_rad_ * to_symmetric(bits[0]));
    }
  }

 private:
  double noise_rad_;
  const TurretState* turrets_;
};

template <class Options>
BlockFactory<Sensor> make_encoder(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double noise_rad = 0.0;
  if constexpr (requires { options.noise_range_rad; }) noise_rad = options.noise_range_rad;
  const auto make = [noise_rad](const BlockColumns& columns) {
    return std::make_unique<TurretEncoderSensor>(noise_rad, columns);
  };
  return {make, {keeps<TurretState>()}};
}

template <class Options>
DeviceType encoder_type(std::string_view implementation, std::string_view summary) {
  return sensor_type(hal::TurretEncoder::kName, implementation, summary, &has<hal::TurretPart>, &make_encoder<Options>,
                     &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> turret_types() {
  return {turret_type<TurretErrors<0>>("default", "Turns as told; errors where asked for."),
          turret_type<IdealTurret>("ideal", "Turns as told."),
          turret_type<TurretErrors<50>>("noisy", "Turns with an error of its speed every tick."),
          encoder_type<AngleNoise<0>>("default", "The turret's angle; noise where asked for."),
          encoder_type<IdealEncoder>("ideal", "The turret's angle."),
          encoder_type<AngleNoise<10>>("noisy", "The turret's angle, with uniform noise.")};
}

}  // namespace tandem::core
