// Colours that robots tell apart.
#pragma once
#include "hal/device/leds.hpp"

namespace tandem::controllers {

/// Mainly red: what LEDs that were told `hal::kRed` look like, and neither yellow nor white lamps.
constexpr bool is_red(hal::Rgb c) noexcept {
  return c.r >= 128 && 2 * c.g <= c.r && 2 * c.b <= c.r;
}

}  // namespace tandem::controllers
