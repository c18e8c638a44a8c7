// Messages of range-and-bearing boards, which others in range and in sight hear with where they came from.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

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

/// What a longer message has beyond the payload of its Broadcast.
using LongPart = std::array<std::uint8_t, hal::kLongRabPayloadMax - hal::kRabPayloadMax>;

class RangeAndBearingMedium final : public RowMedium<Broadcast> {
 public:
  static constexpr std::string_view kKind = "range_and_bearing";
  void fit(const SpaceStores& stores) override;
  /// Where the robots of a block put the rest of longer messages, one row each; null: none sends such.
  LongPart* publish_long(const RobotBlock& block) noexcept {
    return long_.empty() ? nullptr : &long_[block.first_row - first_row()];
  }
  const LongPart& long_of(std::size_t row) const noexcept { return long_[row - first_row()]; }

 private:
  std::vector<LongPart> long_;
};

void register_range_and_bearing_medium(hal::Registrar& registrar);

}  // namespace tandem::core
