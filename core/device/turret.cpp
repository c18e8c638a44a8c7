// Turrets: the actuator that turns them, and the encoder that tells where they look.
#include "hal/device/turret.hpp"

#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

struct TurretErrors {
  double noise_std_dev = 0.0;
  static TurretErrors noisy() { return {.noise_std_dev = 50 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::none, {0.0, 1.0},
             "Standard deviation of the turn rate's relative error, drawn every tick.");
  }
};

/// Turns what carries no load at once; a turret that holds something is turned by the physics engine.
class TurretActuator final : public Actuator {
 public:
  using Port = hal::TurretDrive;
  using Part = hal::TurretPart;
  using Errors = TurretErrors;
  using Kept = TurretState;

  TurretActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : fastest_rad_s_(setup.kind.part<Part>()->turn_rad_s),
        noise_(errors.noise_std_dev),
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

// --- encoder ---

struct AngleNoise {
  double noise_range_rad = 0.0;
  static AngleNoise noisy() { return {.noise_range_rad = 10 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on the angle.");
  }
};

class TurretEncoderSensor final : public Sensor {
 public:
  using Port = hal::TurretEncoder;
  using Part = hal::TurretPart;
  using Errors = AngleNoise;
  using Kept = TurretState;

  TurretEncoderSensor(const DeviceSetup&, const Errors& errors, const BlockColumns& columns)
      : noise_rad_(errors.noise_range_rad), turrets_(columns.find<TurretState>()) {}

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

}  // namespace

std::vector<DeviceType> turret_types() {
  std::vector<DeviceType> types;
  add_levels<TurretActuator>(types, "Turns as told; errors where asked for.", "Turns as told.",
                             "Turns with an error of its speed every tick.");
  add_levels<TurretEncoderSensor>(types, "The turret's angle; noise where asked for.", "The turret's angle.",
                                  "The turret's angle, with uniform noise.");
  return types;
}

}  // namespace tandem::core
