// Files of cameras, as `tandem calibrate` writes them (docs/trackers.md).
#pragma once
#include <string>

#include "bridges/camera/camera.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::camera {

struct CameraFile {
  Lens lens;
  double residual_px = 0.0;          ///< of the lens: RMS
  std::size_t views = 0;             ///< that it was found from
  std::optional<Placement> place{};  ///< nothing: only the lens is known
  double place_residual_px = 0.0;
};

/// Errors: no such file, no such form, numbers that make no sense.
hal::Result<CameraFile> read_camera_file(const std::string& path);
hal::Status write_camera_file(const std::string& path, const CameraFile& file);

/// A camera that hangs in an arena. Errors: as above; where it hangs is not in the file.
hal::Result<Camera> read_camera(const std::string& path);

}  // namespace tandem::bridges::camera
