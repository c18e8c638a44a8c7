// Values between 0 and 1 over the arena, as pixels of a byte each.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/rgb.hpp"

namespace tandem::core {

/// A rectangle of W.
struct RasterArea {
  double min_x_m = 0.0, min_y_m = 0.0, size_x_m = 1.0, size_y_m = 1.0;
};

/// Never changes; copies share the pixels. Row 0 is the south edge.
class Raster {
 public:
  static constexpr double kMostPixels = 1e8;

  Raster() = default;
  /// Lays the image over the whole rectangle, its top to the north. The values are the luminance [ITU-R BT.601] of its
  /// colours, which are kept for pictures.
  static hal::Result<Raster> from_png(const std::string& path, const RasterArea& area);
  /// Asks `value(x, y)` for the middle of every pixel.
  static Raster painted(const RasterArea& area, double pixels_per_m,
                        const std::function<double(double, double)>& value);

  bool empty() const noexcept { return pixels_ == nullptr; }
  /// Where it has pixels: of the nearest.
  float at(double x_m, double y_m) const noexcept;
  /// Nothing: there are no colours.
  std::optional<hal::Rgb> color_at(double x_m, double y_m) const noexcept;
  std::size_t columns() const noexcept { return columns_; }
  std::size_t lines() const noexcept { return lines_; }
  /// Fingerprint of all pixels; 0: there are none.
  std::uint64_t mark() const noexcept { return mark_; }
  void remember(auto& archive) {
    std::vector<std::uint8_t> pixels = empty() ? std::vector<std::uint8_t>() : *pixels_;
    archive(min_x_m_, min_y_m_, columns_per_m_, lines_per_m_, columns_, lines_, pixels);
    if (!archive.reads() || pixels.empty() || pixels.size() != columns_ * lines_) return;
    const std::uint64_t before = mark_;
    take(std::move(pixels));
    if (mark_ != before) colors_.reset();
  }

 private:
  Raster(const RasterArea& area, std::size_t columns, std::size_t lines);
  void take(std::vector<std::uint8_t> pixels);
  std::size_t pixel_at(double x_m, double y_m) const noexcept;

  double min_x_m_ = 0.0, min_y_m_ = 0.0;
  double columns_per_m_ = 1.0, lines_per_m_ = 1.0;
  std::size_t columns_ = 0, lines_ = 0;
  std::shared_ptr<const std::vector<std::uint8_t>> pixels_;
  std::shared_ptr<const std::vector<hal::Rgb>> colors_;  // null: all are grey
  std::uint64_t mark_ = 0;
};

}  // namespace tandem::core
