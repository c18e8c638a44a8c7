// The light of LEDs and lamps, which cameras see.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/medium/medium.hpp"
#include "core/space/object_index.hpp"
#include "hal/device/leds.hpp"

namespace tandem::core {

/// Light of a robot's LEDs and lamps in a tick.
struct ShownLeds {
  static constexpr std::size_t kBody = hal::RingLeds::kCapacity;             ///< after the ring: the body's lamp
  static constexpr std::size_t kFront = kBody + 1;                           ///< … and the one at the front
  static constexpr std::size_t kUpper = kFront + 1;                          ///< the upper ring
  static constexpr std::size_t kCamera = kUpper + hal::RingLeds::kCapacity;  ///< the light beside the camera
  static constexpr std::size_t kCount = kCamera + 1;

  std::uint64_t lit = 0;  ///< bit i: number i is not black
  std::array<hal::Rgb, kCount> color{};
  std::uint16_t ring_medium = 0, body_medium = 0, front_medium = 0, upper_medium = 0,
                camera_medium = 0;  ///< as ObjectLed::medium

  void show(std::size_t i, hal::Rgb c) noexcept {
    color[i] = c;
    const std::uint64_t bit = std::uint64_t{1} << i;
    lit = c == hal::kBlack ? lit & ~bit : lit | bit;
  }
  std::uint16_t medium(std::size_t i) const noexcept {
    return i < kBody     ? ring_medium
           : i == kBody  ? body_medium
           : i == kFront ? front_medium
           : i < kCamera ? upper_medium
                         : camera_medium;
  }
};

class LedMedium final : public RowMedium<ShownLeds> {
 public:
  static constexpr std::string_view kKind = "led";

  /// Numbers of objects with a lit LED: all that a camera at (x, y) may see, and more.
  std::span<const std::uint32_t> objects_near(double x_m, double y_m) const noexcept {
    return objects_.empty() ? std::span<const std::uint32_t>{} : objects_.near(x_m, y_m);
  }
  void index(const SpaceStores& stores) override;

 private:
  ObjectIndex objects_;
  // What it was made for.
  double reach_m_ = 0.0;
  std::uint64_t immovables_version_ = 0, leds_version_ = 0;
};

void register_led_medium(hal::Registrar& registrar);

}  // namespace tandem::core
