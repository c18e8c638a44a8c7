// One run of a scene: a world is made, driven, and the scene's quantities are measured.
#pragma once
#include "hal/result.hpp"
#include "validate/scene.hpp"

namespace tandem::validate {

/// What was measured, in SI units. Error: the world cannot be made, or the run failed, with the reason.
hal::Result<double> measure(const Scene& scene, const Series& series, double value);

}  // namespace tandem::validate
