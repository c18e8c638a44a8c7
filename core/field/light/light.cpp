#include "core/field/light/light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/scenario/field_type.hpp"
#include "core/space/sight.hpp"
#include "core/space/stores.hpp"
#include "hal/elementary.hpp"

namespace tandem::core {
namespace {

/// Of a lamp that is faced at this distance.
double strength_at(const LightSource& lamp, double distance2_m2) noexcept {
  return std::min(lamp.intensity * lamp.intensity / std::max(distance2_m2, 1e-6), 1.0);
}

/// Calls `see(lamp, strength)` for every lamp in sight of a point of W.
template <class See>
void each_lamp(const SpaceStores& stores, double x_m, double y_m, double z_m, See&& see) noexcept {
  for (const LightSource& lamp : stores.lights) {
    if (!lamp.alive) continue;
    const double wx = lamp.x_m - x_m;
    const double wy = lamp.y_m - y_m;
    const double wz = lamp.z_m - z_m;
    const double strength = strength_at(lamp, wx * wx + wy * wy + wz * wz);
    if (strength < 1e-4) continue;  // below a twelve-bit converter's resolution
    if (in_sight(stores, x_m, y_m, z_m, lamp.x_m, lamp.y_m, lamp.z_m)) see(lamp, strength);
  }
}

/// Reading of ARGoS' sensors that fade; the lamp's place is from the middle of the robot's base.
double fading(const FieldSpot& spot, double ahead_m, double aside_m, double above_m, double intensity) noexcept {
  const double reach = std::sqrt(ahead_m * ahead_m + aside_m * aside_m + above_m * above_m) / intensity;
  const double angle_rad =
      hal::atan2(spot.look_x * aside_m - spot.look_y * ahead_m, spot.look_x * ahead_m + spot.look_y * aside_m);
  const double part = 1.0 - std::fabs(angle_rad) * (2.0 / std::numbers::pi);
  return reach > 2.5 || part < 0.0 ? 0.0 : hal::exp(-2.0 * reach) * part;
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
    const double base_m = places.stores.base_m(row);
    // Whether a lamp is hidden is asked once a robot, from its axis; how bright it is, at every sensor.
    const double height_m = places.spots.front().z_m + base_m;
    each_lamp(places.stores, b.x_m[row], b.y_m[row], height_m, [&](const LightSource& lamp, double) {
      const double wx = lamp.x_m - b.x_m[row];
      const double wy = lamp.y_m - b.y_m[row];
      const double bx = b.cos_h[row] * wx + b.sin_h[row] * wy;
      const double by = b.cos_h[row] * wy - b.sin_h[row] * wx;
      for (std::size_t k = 0; k < count; ++k) {
        const FieldSpot& spot = places.spots[k];
        const double ahead = bx - spot.x_m;
        const double aside = by - spot.y_m;
        if (curve_ == LightCurve::ArgosFading) {
          values[k] = added(values[k], fading(spot, bx, by, lamp.z_m - base_m, lamp.intensity));
          continue;
        }
        const double above = lamp.z_m - base_m - spot.z_m;
        const double flat2 = ahead * ahead + aside * aside;
        const double facing = (ahead * spot.look_x + aside * spot.look_y) / std::sqrt(std::max(flat2, 1e-12));
        const double part = curve_ == LightCurve::ArgosGeneric ? 1.0 : facing;
        if (facing > 0.0) values[k] = added(values[k], strength_at(lamp, flat2 + above * above) * part);
      }
    });
  }
}

double LightField::at(const SpaceStores& stores, double x_m, double y_m, double z_m) const noexcept {
  double level = 0.0;
  each_lamp(stores, x_m, y_m, z_m, [&](const LightSource&, double strength) { level = added(level, strength); });
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
