// Grippers: the actuator that opens the claws, and the sensor of what they do. What is held is decided between the
// robots' actuators and the physics, for all grippers together.
#include "hal/device/gripper.hpp"

#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

struct Gripping {
  double failure_prob = 0.0;
  static Gripping noisy() { return {.failure_prob = 100 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("failure_prob", failure_prob, hal::unit::none, {0.0, 1.0},
             "Probability, in each tick, that open claws fail to hold what is before them.");
  }
};

class GripperActuator final : public Actuator {
 public:
  using Port = hal::GripperDrive;
  using Part = hal::GripperPart;
  using Errors = Gripping;
  using Kept = GripState;

  GripperActuator(const DeviceSetup&, const Errors& errors, const BlockColumns& columns)
      : failure_prob_(errors.failure_prob), grips_(columns.find<GripState>()) {}

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* drives = static_cast<const hal::GripperDrive*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      GripState& grip = grips_[i];
      const bool able = obeys(context, i);
      if (!led_from_outside(context, i)) grip.aperture_rad = able ? drives[i].aperture_rad : 0.0;
      grip.wants = able && drives[i].locks();
      grip.slips = grip.wants && failure_prob_ > 0.0 && slips(context, stores.bodies.entity[row]);
    }
  }

 private:
  bool slips(const DeviceContext& context, std::uint32_t entity) const noexcept {
    return to_unit(draw(context.seed, entity, Stream::GripperSlip, context.tick)[0]) < failure_prob_;
  }

  double failure_prob_;
  GripState* grips_;
};

// --- sensor ---

struct ApertureNoise {
  double noise_range_rad = 0.0;
  static ApertureNoise noisy() { return {.noise_range_rad = 20 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on the aperture.");
  }
};

class GripperSensor final : public Sensor {
 public:
  using Port = hal::Gripper;
  using Part = hal::GripperPart;
  using Errors = ApertureNoise;
  using Kept = GripState;

  GripperSensor(const DeviceSetup&, const Errors& errors, const BlockColumns& columns)
      : noise_rad_(errors.noise_range_rad), grips_(columns.find<GripState>()) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* grippers = static_cast<hal::Gripper*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      const GripState& grip = grips_[i];
      hal::Gripper& port = grippers[i];
      stamp(context, port);
      double aperture_rad = grip.aperture_rad;
      if (noise_rad_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::GripperNoise, context.tick);
        aperture_rad += noise_rad_ * to_symmetric(bits[0]);
      }
      port.aperture_rad = static_cast<float>(aperture_rad);
      port.holding = grip.holding();
      port.busy = false;
    }
  }

 private:
  double noise_rad_;
  const GripState* grips_;
};

}  // namespace

std::vector<DeviceType> gripper_types() {
  std::vector<DeviceType> types;
  add_levels<GripperActuator>(types, "Open claws hold what is before them; failures where asked for.",
                              "Open claws hold what is before them.",
                              "Open claws hold what is before them, not always at once.");
  for (DeviceType& type : types) type.joints = kJointsOfGrips;
  add_levels<GripperSensor>(types, "Aperture and whether something is held; noise where asked for.",
                            "Aperture and whether something is held.",
                            "Aperture with uniform noise, and whether something is held.");
  return types;
}

}  // namespace tandem::core
