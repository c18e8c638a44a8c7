// Fields whose value depends on the place alone.
#pragma once
#include "core/space/field.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// `Own` has `double at(const SpaceStores&, double x_m, double y_m, double z_m) const noexcept`.
template <class Own>
class PointField : public Field {
 public:
  void sample(const FieldPlaces& places, double* values) const noexcept final {
    const Bodies& b = places.stores.bodies;
    for (std::size_t row = places.first_row; row < places.first_row + places.rows; ++row) {
      const double base_m = places.stores.base_m(row);
      for (const FieldSpot& spot : places.spots) {
        *values++ = static_cast<const Own*>(this)->Own::at(
            places.stores, b.x_m[row] + b.cos_h[row] * spot.x_m - b.sin_h[row] * spot.y_m,
            b.y_m[row] + b.sin_h[row] * spot.x_m + b.cos_h[row] * spot.y_m, spot.z_m + base_m);
      }
    }
  }
};

}  // namespace tandem::core
