// The light of lamps.
#pragma once
#include <cstdint>

#include "core/space/field.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// A sensor that faces a lamp of intensity I at distance d reads (I / d)^2, at most 1; less by the cosine of the angle
/// to it, seen from above. Levels of several lamps add up, at most to 1. Boxes and cylinders cast shadows: on a whole
/// robot, by whether they hide its axis, as high as the first of its sensors is.
///
/// Sensors of ARGoS read otherwise: the generic ones (I / d)^2 of every lamp before them, whatever the angle; others,
/// which fade, exp(-2 d / I), d from the robot's middle and up to 2.5 I, less by the angle in right angles.
enum class LightCurve : std::uint8_t { Facing, ArgosGeneric, ArgosFading };

class LightField final : public Field {
 public:
  explicit LightField(LightCurve curve = LightCurve::Facing) : curve_(curve) {}
  void sample(const FieldPlaces& places, double* values) const noexcept override;
  /// Of a sensor that faced every lamp.
  double at(const SpaceStores& stores, double x_m, double y_m, double z_m) const noexcept override;

 private:
  LightCurve curve_;
};

void register_light(hal::Registrar& registrar);

}  // namespace tandem::core
