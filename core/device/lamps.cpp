// Lamps: LEDs on rings, beside cameras, in bodies. They show cameras, where there are any, what the ports say; views
// and pictures read the ports.
#include <algorithm>

#include "core/device/types.hpp"
#include "core/medium/led/led.hpp"
#include "core/random/random.hpp"
#include "hal/device/leds.hpp"

namespace tandem::core {
namespace {

struct IdealLamp {
  std::string medium;
  void describe(hal::ParamVisitor& v) {
    v.text("medium", medium, "Id of the LED medium: cameras of others do not see them.");
  }
};

/// What becomes of a colour, lamp by lamp and for the whole run: LEDs of one batch are not equally bright, and some are
/// dead.
template <int kPerMille>
struct Lamp : IdealLamp {
  double brightness_std_dev = 5.0 * kPerMille * 1e-3;
  double dead_prob = kPerMille * 1e-3;
  void describe(hal::ParamVisitor& v) {
    IdealLamp::describe(v);
    v.number("brightness_std_dev", brightness_std_dev, hal::unit::none, hal::kNotNegative,
             "Standard deviation of a lamp's brightness, as a part of what it is told; drawn once, at most 1 in all.");
    v.number("dead_prob", dead_prob, hal::unit::none, {0.0, 1.0}, "Probability that a lamp never shines.");
  }
};

class Shine {
 public:
  Shine(const Lamp<0>& errors, const DeviceSetup& setup)
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
  Lamp<0> errors_;
  bool exact_;
  LedMedium* leds_;
  std::uint16_t medium_;
};

/// The ring, or the upper of two.
template <class Port>
class RingLamps final : public Actuator {
  static constexpr bool kUpper = std::is_same_v<Port, hal::UpperRingLeds>;

 public:
  using Part = std::conditional_t<kUpper, hal::UpperLedsPart, hal::LedsPart>;

  RingLamps(const hal::RobotKind& kind, const Shine& shine)
      : count_(std::min(kind.part<Part>()->mounts.size(), hal::RingLeds::kCapacity)), shine_(shine) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    ShownLeds* const shining = shine_.publish(context.block);
    if (shining == nullptr) return;
    const auto* leds = static_cast<const Port*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      ShownLeds& shown = shining[i];
      for (std::size_t k = 0; k < count_; ++k) {
        const std::size_t lamp = kUpper ? ShownLeds::kUpper + k : k;
        shown.show(lamp, shine_(context, row, lamp, leds[i].color(k)));
      }
      (kUpper ? shown.upper_medium : shown.ring_medium) = shine_.medium();
    }
  }

 private:
  std::size_t count_;
  Shine shine_;
};

/// The light beside a camera.
class CameraLamp final : public Actuator {
 public:
  CameraLamp(const hal::RobotKind&, const Shine& shine) : shine_(shine) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    ShownLeds* const shining = shine_.publish(context.block);
    if (shining == nullptr) return;
    const auto* lamps = static_cast<const hal::CameraLed*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      ShownLeds& shown = shining[i];
      const hal::Rgb told{lamps[i].rgb[0], lamps[i].rgb[1], lamps[i].rgb[2]};
      shown.show(ShownLeds::kCamera, shine_(context, row, ShownLeds::kCamera, told));
      shown.camera_medium = shine_.medium();
    }
  }

 private:
  Shine shine_;
};

/// One of the lamps in the body and at the front.
template <class Port>
class BodyLamp final : public Actuator {
 public:
  BodyLamp(const hal::RobotKind&, const Shine& shine) : shine_(shine) {}

  void act(const DeviceContext& context, SpaceStores& /*stores*/, const void* ports) noexcept override {
    ShownLeds* const shining = shine_.publish(context.block);
    if (shining == nullptr) return;
    constexpr bool kIsFront = std::is_same_v<Port, hal::FrontLed>;
    constexpr std::size_t kLamp = kIsFront ? ShownLeds::kFront : ShownLeds::kBody;
    const auto* lamps = static_cast<const Port*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      ShownLeds& shown = shining[i];
      const hal::Rgb told = !lamps[i].on ? hal::kBlack : kIsFront ? hal::kRed : hal::kGreen;
      shown.show(kLamp, shine_(context, row, kLamp, told));
      (kIsFront ? shown.front_medium : shown.body_medium) = shine_.medium();
    }
  }

 private:
  Shine shine_;
};

template <class Device, class Options>
BlockFactory<Actuator> make_lamp(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const auto read = read_options<Options>(element, problems);
  Lamp<0> errors;
  if constexpr (requires { read.dead_prob; }) {
    errors.brightness_std_dev = read.brightness_std_dev;
    errors.dead_prob = read.dead_prob;
  }
  BlockFactory<Actuator> factory([&kind = setup.kind, shine = Shine(errors, setup)](const BlockColumns&) {
    return std::make_unique<Device>(kind, shine);
  });
  factory.publishes = true;
  return factory;
}

template <class Device>
void add(std::vector<DeviceType>& types, std::string_view lamp, bool (*fits)(const hal::RobotKind&)) {
  const auto add_one = [&](const DeviceType& type) { types.push_back(in_medium(LedMedium::kKind, type)); };
  add_one(actuator_type(lamp, "default", "Shines; unevenly where asked for.", fits, &make_lamp<Device, Lamp<0>>,
                        &describe_options<Lamp<0>>));
  add_one(actuator_type(lamp, "ideal", "Shines.", fits, &make_lamp<Device, IdealLamp>, &describe_options<IdealLamp>));
  add_one(actuator_type(lamp, "noisy", "Shines; some lamps are dimmer than others, and some dead.", fits,
                        &make_lamp<Device, Lamp<10>>, &describe_options<Lamp<10>>));
}

}  // namespace

std::vector<DeviceType> lamp_types() {
  std::vector<DeviceType> types;
  add<RingLamps<hal::RingLeds>>(types, hal::RingLeds::kName, &has<hal::LedsPart>);
  add<RingLamps<hal::UpperRingLeds>>(types, hal::UpperRingLeds::kName, &has<hal::UpperLedsPart>);
  add<CameraLamp>(types, hal::CameraLed::kName, &has<hal::CameraLedPart>);
  add<BodyLamp<hal::BodyLed>>(types, hal::BodyLed::kName, &has<hal::BodyLedPart>);
  add<BodyLamp<hal::FrontLed>>(types, hal::FrontLed::kName, &has<hal::FrontLedPart>);
  return types;
}

}  // namespace tandem::core
