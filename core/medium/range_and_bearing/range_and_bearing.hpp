// Messages of range-and-bearing boards, which others in range and in sight hear with where they came from.
#pragma once
#include <array>
#include <cstdint>

#include "core/medium/medium.hpp"
#include "hal/device/range_and_bearing.hpp"

namespace tandem::core {

/// Broadcast of a robot in a tick.
struct Broadcast {
  static constexpr std::uint8_t kSilent = 0xFF;  // as a size

  std::uint8_t size = kSilent;
  std::uint8_t channel = 0;  ///< number of its medium in the file; 0: heard by those of all
  std::array<std::uint8_t, hal::kRabPayloadMax> payload{};
  float range_m = 0.0F;  ///< how far the sender reaches
};

class RangeAndBearingMedium final : public RowMedium<Broadcast> {
 public:
  static constexpr std::string_view kKind = "range_and_bearing";
};

void register_range_and_bearing_medium(hal::Registrar& registrar);

}  // namespace tandem::core
