// The level of steady sounds.
#pragma once
#include "core/field/point_field.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// A source of level L is heard at L / (1 + (d / 10 cm)^2): full level at the source, falling with the square of the
/// distance in the far field. Sources add up.
class SoundField final : public PointField<SoundField> {
 public:
  double at(const SpaceStores& stores, double x_m, double y_m, double z_m) const noexcept override {
    double level = 0.0;
    for (const SoundSource& s : stores.sounds) {
      if (!s.alive) continue;
      const double d2 = (s.x_m - x_m) * (s.x_m - x_m) + (s.y_m - y_m) * (s.y_m - y_m) + (s.z_m - z_m) * (s.z_m - z_m);
      level += s.level / (1.0 + d2 / (kNear_m * kNear_m));
    }
    return level;
  }

 private:
  static constexpr double kNear_m = 0.1;
};

void register_sound(hal::Registrar& registrar);

}  // namespace tandem::core
