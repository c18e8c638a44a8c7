// The floor's shade: uniform grey, an image, or painted by a hook.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::core {

/// Reflectance over the arena, 0 black to 1 white. Row 0 of the pixels is the south edge.
class Floor {
 public:
  static constexpr float kGrey = 0.5F;
  static constexpr double kMostPixels = 1e8;  ///< one byte each

  /// Lays the image over the whole rectangle, its top to the north. Colours become their luminance [ITU-R BT.601].
  hal::Status load_png(const std::string& path, double min_x_m, double min_y_m, double size_x_m, double size_y_m);

  /// Asks `shade(x, y)` for every pixel.
  void paint(double min_x_m, double min_y_m, double size_x_m, double size_y_m, double pixels_per_m,
             const std::function<double(double, double)>& shade);

  float at(double x_m, double y_m) const noexcept;
  bool uniform() const noexcept { return shade_.empty(); }
  /// Fingerprint of all pixels; 0 of a uniform one.
  std::uint64_t mark() const noexcept { return mark_; }

 private:
  void take_mark() noexcept;

  double min_x_m_ = 0.0, min_y_m_ = 0.0;
  double columns_per_m_ = 1.0, lines_per_m_ = 1.0;
  std::size_t columns_ = 0, lines_ = 0;
  std::vector<std::uint8_t> shade_;
  std::uint64_t mark_ = 0;
};

}  // namespace tandem::core
