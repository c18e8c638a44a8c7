// Grippers: the actuator that opens the claws, and the sensor of what they do. What is held is decided between the
// robots' actuators and the physics, for all grippers together.
#include "hal/device/gripper.hpp"

#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

struct IdealGripping {
  void describe(hal::ParamVisitor&) {}
};

template <int kPerMille>
struct Gripping {
  double failure_prob = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("failure_prob", failure_prob, hal::unit::none, {0.0, 1.0},
             "Probability, in each tick, that open claws fail to hold what is before them.");
  }
};

class GripperActuator final : public Actuator {
 public:
  GripperActuator(double failure_prob, const BlockColumns& columns)
      : failure_prob_(failure_prob), grips_(columns.find<GripState>()) {}

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

template <class Options>
BlockFactory<Actuator> make_gripping(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double failure_prob = 0.0;
  if constexpr (requires { options.failure_prob; }) failure_prob = options.failure_prob;
  const auto make = [failure_prob](const BlockColumns& columns) {
    return std::make_unique<GripperActuator>(failure_prob, columns);
  };
  return {make, {keeps<GripState>()}};
}

template <class Options>
DeviceType gripping_type(std::string_view implementation, std::string_view summary) {
  DeviceType type = actuator_type(hal::GripperDrive::kName, implementation, summary, &has<hal::GripperPart>,
                                  &make_gripping<Options>, &describe_options<Options>);
  type.joints = kJointsOfGrips;
  return type;
}

// --- sensor ---

struct IdealAperture {
  void describe(hal::ParamVisitor&) {}
};

template <int kPerMille>
struct ApertureNoise {
  double noise_range_rad = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range_rad, hal::unit::rad, hal::kNotNegative,
             "Uniform noise of +-this on the aperture.");
  }
};

class GripperSensor final : public Sensor {
 public:
  GripperSensor(double noise_rad, const BlockColumns& columns)
      : noise_rad_(noise_rad), grips_(columns.find<GripState>()) {}

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

template <class Options>
BlockFactory<Sensor> make_gripper(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Options>(element, problems);
  double noise_rad = 0.0;
  if constexpr (requires { options.noise_range_rad; }) noise_rad = options.noise_range_rad;
  const auto make = [noise_rad](const BlockColumns& columns) {
    return std::make_unique<GripperSensor>(noise_rad, columns);
  };
  return {make, {keeps<GripState>()}};
}

template <class Options>
DeviceType gripper_type(std::string_view implementation, std::string_view summary) {
  return sensor_type(hal::Gripper::kName, implementation, summary, &has<hal::GripperPart>, &make_gripper<Options>,
                     &describe_options<Options>);
}

}  // namespace

std::vector<DeviceType> gripper_types() {
  return {gripping_type<Gripping<0>>("default", "Open claws hold what is before them; failures where asked for."),
          gripping_type<IdealGripping>("ideal", "Open claws hold what is before them."),
          gripping_type<Gripping<100>>("noisy", "Open claws hold what is before them, not always at once."),
          gripper_type<ApertureNoise<0>>("default", "Aperture and whether something is held; noise where asked for."),
          gripper_type<IdealAperture>("ideal", "Aperture and whether something is held."),
          gripper_type<ApertureNoise<20>>("noisy", "Aperture with uniform noise, and whether something is held.")};
}

}  // namespace tandem::core
