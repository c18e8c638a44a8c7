#include "core/field/light/light.hpp"

#include <algorithm>
#include <cmath>

#include "core/scenario/field_type.hpp"
#include "core/space/sight.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {
namespace {

/// Calls `see(wx, wy, strength)` for every lamp in sight of a point of W, with the way to it.
template <class See>
void each_lamp(const SpaceStores& stores, double x_m, double y_m, double z_m, See&& see) noexcept {
  for (const LightSource& lamp : stores.lights) {
    if (!lamp.alive) continue;
    const double wx = lamp.x_m - x_m;
    const double wy = lamp.y_m - y_m;
    const double wz = lamp.z_m - z_m;
    const double d2 = std::max(wx * wx + wy * wy + wz * wz, 1e-6);
    const double strength = std::min(lamp.intensity * lamp.intensity / d2, 1.0);
    if (strength < 1e-4) continue;  // below a twelve-bit converter's resolution
    if (in_sight(stores, x_m, y_m, z_m, lamp.x_m, lamp.y_m, lamp.z_m)) see(wx, wy, strength);
  }
}

/// Single precision, as a reading has.
double added(double level, double more) noexcept {
  return static_cast<double>(std::min(1.0F, static_cast<float>(level) + static_cast<float>(more)));
}

}  // namespace

void LightField::sample(const FieldPlaces& places, double* values) const noexcept {
  const Bodies& b = places.stores.bodies;
  const std::size_t count = places.spots.size();
  for (std::size_t row = places.first_row; row < places.first_row + places.rows; ++row, values += count) {
    std::fill(values, values + count, 0.0);
    const double height_m = places.spots.front().z_m + places.stores.base_m(row);
    each_lamp(places.stores, b.x_m[row], b.y_m[row], height_m, [&](double wx, double wy, double strength) {
      const double bx = b.cos_h[row] * wx + b.sin_h[row] * wy;
      const double by = b.cos_h[row] * wy - b.sin_h[row] * wx;
      const double flat = std::sqrt(std::max(wx * wx + wy * wy, 1e-12));
      for (std::size_t k = 0; k < count; ++k) {
        const double facing = (bx * places.spots[k].look_x + by * places.spots[k].look_y) / flat;
        if (facing > 0.0) values[k] = added(values[k], strength * facing);
      }
    });
  }
}

double LightField::at(const SpaceStores& stores, double x_m, double y_m, double z_m) const noexcept {
  double level = 0.0;
  each_lamp(stores, x_m, y_m, z_m, [&](double, double, double strength) { level = added(level, strength); });
  return level;
}

void register_light(hal::Registrar& registrar) {
  static constexpr FieldType kType{"light", "The light of lamps; what a sensor sees of it depends on where it looks.",
                                   nullptr, [](const Element&, const FieldArea&, Problems&) -> std::unique_ptr<Field> {
                                     return std::make_unique<LightField>();
                                   }};
  registrar.add(kType);
}

}  // namespace tandem::core
