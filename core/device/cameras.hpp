// What cameras are like once the file has had its say, and how far they see.
#pragma once
#include "core/scenario/scenario.hpp"
#include "hal/spec/data_sheet.hpp"

namespace tandem::core {

/// Radius of the disc on the ground that the camera on the axis sees; 0 without one.
double omni_reach_m(const hal::DataSheet& sheet, const CameraConfig& config) noexcept;

/// The camera with a lens, with what the file says in the place of the data sheet's figures.
hal::CameraSheet camera_of(const hal::DataSheet& sheet, const CameraConfig& config) noexcept;

}  // namespace tandem::core
