// Sensors that ask a field for its value, several on each robot.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/device/device.hpp"

namespace tandem::core {

class FieldRing {
 public:
  FieldRing(const Field& field, std::span<const hal::Mount> mounts) : field_(field) {
    for (const hal::Mount& m : mounts)
      spots_.push_back({m.x_m, m.y_m, m.z_m, std::cos(m.bearing_rad), std::sin(m.bearing_rad)});
  }

  std::size_t size() const noexcept { return spots_.size(); }
  const FieldSpot& spot(std::size_t k) const noexcept { return spots_[k]; }

  /// Calls `use(i, values)` for every robot i of the block, with one value a sensor.
  template <class Use>
  void sample(const DeviceContext& context, Use&& use) const noexcept {
    std::array<double, kAtOnce> values;
    const std::size_t most = kAtOnce / spots_.size();
    for (std::size_t begin = 0; begin < context.block.used; begin += most) {
      const std::size_t rows = std::min(most, context.block.used - begin);
      field_.sample({context.stores, context.block.first_row + begin, rows, spots_}, values.data());
      for (std::size_t i = 0; i < rows; ++i) use(begin + i, values.data() + i * spots_.size());
    }
  }

 private:
  static constexpr std::size_t kAtOnce = 512;

  const Field& field_;
  std::vector<FieldSpot> spots_;
};

}  // namespace tandem::core
