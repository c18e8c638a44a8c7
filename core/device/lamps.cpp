// Lamps: LEDs on rings, beside cameras, in bodies. They show cameras, where there are any, what the ports say; views
// and pictures read the ports.
#include <algorithm>

#include "core/device/types.hpp"
#include "core/medium/led/led.hpp"
#include "core/random/random.hpp"
#include "hal/device/leds.hpp"

namespace tandem::core {
namespace {

/// What becomes of a colour, lamp by lamp and for the whole run: LEDs of one batch are not equally bright, and some are
/// dead.
struct LampErrors {
  std::string medium = {};
  double brightness_std_dev = 0.0;
  double dead_prob = 0.0;
  static LampErrors noisy() { return {.brightness_std_dev = 5.0 * 10 * 1e-3, .dead_prob = 10 * 1e-3}; }
  void describe_always(hal::ParamVisitor& v) {
    v.text("medium", medium, "Id of the LED medium: cameras of others do not see them.");
  }
  void describe(hal::ParamVisitor& v) {
    v.number("brightness_std_dev", brightness_std_dev, hal::unit::none, hal::kNotNegative,
             "Standard deviation of a lamp's brightness, as a part of what it is told; drawn once, at most 1 in all.");
    v.number("dead_prob", dead_prob, hal::unit::none, {0.0, 1.0}, "Probability that a lamp never shines.");
  }
};

class Shine {
 public:
  Shine(const DeviceSetup& setup, const LampErrors& errors)
      : errors_(errors),
        exact_(errors.brightness_std_dev == 0.0 && errors.dead_prob == 0.0),
        leds_(&setup.medium_as<LedMedium>()),
        medium_(setup.channel) {}

  std::uint16_t medium() const noexcept { return medium_; }
  /// Where the block's robots shine; null: nobody sees them.
  ShownLeds* publish(const RobotBlock& block) const noexcept { return leds_->publish(block); }

  /// What lamp `i` of ShownLeds shows when told to show `c`.
  hal::Rgb operator()(const DeviceContext& context, std::size_t row, std::size_t i, hal::Rgb c) const noexcept {
    if (exact_ || c == hal::kBlack) return c;
    const auto bits =
        draw(context.seed, context.stores.bodies.entity[row], Stream::LampNoise, 0, static_cast<std::uint32_t>(i));
    if (to_unit(bits[2]) < errors_.dead_prob) return hal::kBlack;
    const double factor = std::max(0.0, 1.0 + errors_.brightness_std_dev * to_normal(bits[0], bits[1])[0]);
    const auto scaled = [factor](std::uint8_t v) {
      return static_cast<std::uint8_t>(std::min(255.0, std::round(factor * v)));
    };
    return {scaled(c.r), scaled(c.g), scaled(c.b)};
  }

 private:
  LampErrors errors_;
  bool exact_;
  LedMedium* leds_;
  std::uint16_t medium_;
};

/// What lamps of all kinds are to the world. `Self` has `light(context, row, port, shown)`.
template <class Self, class OfPort>
class LampActuator : public Actuator {
 public:
  using Port = OfPort;
  using Errors = LampErrors;
  static constexpr std::string_view kMedium = LedMedium::kKind;

  LampActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns&) : shine_(setup, errors) {}
  static void prepare(BlockFactory<Actuator>& factory, const DeviceSetup&, const Errors&) { factory.publishes = true; }

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept final {
    ShownLeds* const shining = shine_.publish(context.block);
    if (shining == nullptr) return;
    for (std::size_t i = 0; i < context.block.used; ++i)
      static_cast<const Self&>(*this).light(context, context.block.first_row + i, static_cast<const Port*>(ports)[i],
                                            shining[i]);
  }

 protected:
  Shine shine_;
};

/// The ring, or the upper of two.
template <class OfPort>
class RingLamps final : public LampActuator<RingLamps<OfPort>, OfPort> {
  using Base = LampActuator<RingLamps<OfPort>, OfPort>;
  static constexpr bool kUpper = std::is_same_v<OfPort, hal::UpperRingLeds>;

 public:
  using Part = std::conditional_t<kUpper, hal::UpperLedsPart, hal::LedsPart>;

  RingLamps(const DeviceSetup& setup, const LampErrors& errors, const BlockColumns& columns)
      : Base(setup, errors, columns),
        count_(std::min(setup.kind.part<Part>()->mounts.size(), hal::RingLeds::kCapacity)) {}

  void light(const DeviceContext& context, std::size_t row, const OfPort& leds, ShownLeds& shown) const noexcept {
    for (std::size_t k = 0; k < count_; ++k) {
      const std::size_t lamp = kUpper ? ShownLeds::kUpper + k : k;
      shown.show(lamp, this->shine_(context, row, lamp, leds.color(k)));
    }
    (kUpper ? shown.upper_medium : shown.ring_medium) = this->shine_.medium();
  }

 private:
  std::size_t count_;
};

/// The light beside a camera.
class CameraLamp final : public LampActuator<CameraLamp, hal::CameraLed> {
 public:
  using Part = hal::CameraLedPart;
  using LampActuator::LampActuator;

  void light(const DeviceContext& context, std::size_t row, const hal::CameraLed& lamp,
             ShownLeds& shown) const noexcept {
    const hal::Rgb told{lamp.rgb[0], lamp.rgb[1], lamp.rgb[2]};
    shown.show(ShownLeds::kCamera, shine_(context, row, ShownLeds::kCamera, told));
    shown.camera_medium = shine_.medium();
  }
};

/// One of the lamps in the body and at the front.
template <class OfPort, class OfPart>
class BodyLamp final : public LampActuator<BodyLamp<OfPort, OfPart>, OfPort> {
 public:
  using Part = OfPart;
  using LampActuator<BodyLamp<OfPort, OfPart>, OfPort>::LampActuator;

  void light(const DeviceContext& context, std::size_t row, const OfPort& lamp, ShownLeds& shown) const noexcept {
    constexpr bool kIsFront = std::is_same_v<OfPort, hal::FrontLed>;
    constexpr std::size_t kLamp = kIsFront ? ShownLeds::kFront : ShownLeds::kBody;
    const hal::Rgb told = !lamp.on ? hal::kBlack : kIsFront ? hal::kRed : hal::kGreen;
    shown.show(kLamp, this->shine_(context, row, kLamp, told));
    (kIsFront ? shown.front_medium : shown.body_medium) = this->shine_.medium();
  }
};

template <class Device>
void add(std::vector<DeviceType>& types) {
  add_levels<Device>(types, "Shines; unevenly where asked for.", "Shines.",
                     "Shines; some lamps are dimmer than others, and some dead.");
}

}  // namespace

std::vector<DeviceType> lamp_types() {
  std::vector<DeviceType> types;
  add<RingLamps<hal::RingLeds>>(types);
  add<RingLamps<hal::UpperRingLeds>>(types);
  add<CameraLamp>(types);
  add<BodyLamp<hal::BodyLed, hal::BodyLedPart>>(types);
  add<BodyLamp<hal::FrontLed, hal::FrontLedPart>>(types);
  return types;
}

}  // namespace tandem::core
