// The light of lamps.
#pragma once
#include "core/space/field.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// A sensor that faces a lamp of intensity I at distance d reads (I / d)^2, at most 1; less by the cosine of the angle
/// to it, seen from above. Levels of several lamps add up, at most to 1. Boxes and cylinders cast shadows: on a whole
/// robot, by whether they hide its axis, as high as the first of its sensors is.
class LightField final : public Field {
 public:
  void sample(const FieldPlaces& places, double* values) const noexcept override;
  /// Of a sensor that faced every lamp.
  double at(const SpaceStores& stores, double x_m, double y_m, double z_m) const noexcept override;
};

void register_light(hal::Registrar& registrar);

}  // namespace tandem::core
