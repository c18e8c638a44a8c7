// The emulated camera: its file, and where it shows points. Written from docs/trackers.md, in one direction alone: an
// emulator never asks which point a pixel shows.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "hal/result.hpp"
#include "hal/vector.hpp"

namespace tandem::bridges::tracker_emulator {

struct Lens {
  std::size_t width = 0, height = 0;
  std::array<double, 2> focal_px{}, centre_px{};
  std::array<double, 5> distortion{};
  hal::Vector3 p_W = hal::Vector3::Zero();
  hal::Matrix3 axes_W = hal::Matrix3::Identity();  ///< its columns: to the right, down, forward

  /// In pixels from the upper left corner. Nothing: behind the camera, or far beside the picture.
  std::optional<hal::Vector2> shows(const hal::Vector3& point_W) const noexcept;
};

/// Errors: no such file, no such form.
hal::Result<Lens> read_lens(const std::string& path);

}  // namespace tandem::bridges::tracker_emulator
