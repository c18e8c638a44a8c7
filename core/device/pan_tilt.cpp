// The head that a camera hangs in: the actuator that turns it, and the encoder that tells where it looks.
#include "hal/device/pan_tilt.hpp"

#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

struct AimErrors {
  double noise_std_dev = 0.0;
  static AimErrors noisy() { return {.noise_std_dev = 10 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev, hal::unit::rad, hal::kNotNegative,
             "Standard deviation of both angles that the head turns to, drawn every tick.");
  }
};

/// Turns about both axes at once, pan the shorter way round.
class HeadActuator final : public Actuator {
 public:
  using Port = hal::PanTiltDrive;
  using Part = hal::HeadPart;
  using Errors = AimErrors;
  using Kept = HeadState;

  HeadActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : part_(*setup.kind.part<Part>()), noise_rad_(errors.noise_std_dev), heads_(columns.find<HeadState>()) {}

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* drives = static_cast<const hal::PanTiltDrive*>(ports);
    const double most_rad = part_.turn_rad_s * context.tick_s;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      if (led_from_outside(context, i)) continue;
      const std::size_t row = context.block.first_row + i;
      hal::PanTiltDrive drive = obeys(context, i) ? drives[i] : hal::PanTiltDrive{};
      if (noise_rad_ > 0.0) {
        const auto bits = draw(context.seed, stores.bodies.entity[row], Stream::HeadNoise, context.tick);
        const auto error = to_normal(bits[0], bits[1]);
        drive.pan_rad += noise_rad_ * error[0];
        drive.tilt_rad += noise_rad_ * error[1];
      }
      HeadState& head = heads_[i];
      const double tilt = std::clamp(drive.tilt_rad, -part_.max_tilt_rad, part_.max_tilt_rad);
      head.pan_rad =
          hal::wrapped(head.pan_rad + std::clamp(hal::wrapped(drive.pan_rad - head.pan_rad), -most_rad, most_rad));
      head.tilt_rad += std::clamp(tilt - head.tilt_rad, -most_rad, most_rad);
      head.laser = drive.laser;
    }
  }

 private:
  const hal::HeadPart& part_;
  double noise_rad_;
  HeadState* heads_;
};

// --- encoder ---

struct AngleNoise {
  double noise_range_rad = 0.0;
  static AngleNoise noisy() { return {.noise_range_rad = 10 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on both angles.");
  }
};

class HeadEncoderSensor final : public Sensor {
 public:
  using Port = hal::PanTiltEncoder;
  using Part = hal::HeadPart;
  using Errors = AngleNoise;
  using Kept = HeadState;

  HeadEncoderSensor(const DeviceSetup&, const Errors& errors, const BlockColumns& columns)
      : noise_rad_(errors.noise_range_rad), heads_(columns.find<HeadState>()) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* encoders = static_cast<hal::PanTiltEncoder*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      stamp(context, encoders[i]);
      double pan_rad = heads_[i].pan_rad;
      double tilt_rad = heads_[i].tilt_rad;
      if (noise_rad_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::HeadEncoderNoise, context.tick);
        pan_rad = hal::wrapped(pan_rad + noise_rad_ * to_symmetric(bits[0]));
        tilt_rad += noise_rad_ * to_symmetric(bits[1]);
      }
      encoders[i].pan_rad = pan_rad;
      encoders[i].tilt_rad = tilt_rad;
    }
  }

 private:
  double noise_rad_;
  const HeadState* heads_;
};

}  // namespace

std::vector<DeviceType> pan_tilt_types() {
  std::vector<DeviceType> types;
  add_levels<HeadActuator>(types, "Turns as fast as it can; errors where asked for.", "Turns as fast as it can.",
                           "Turns to angles with an error every tick.");
  add_levels<HeadEncoderSensor>(types, "Both angles; noise where asked for.", "Both angles.",
                                "Both angles, with uniform noise.");
  return types;
}

}  // namespace tandem::core
