// Floors as pictures: a byte of grey a pixel, or three of colours, laid over the arena, for records and views.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/space/stores.hpp"
#include "hal/result.hpp"
#include "hal/rgb.hpp"

namespace tandem::core {

/// 0 black, 255 white. The first line is the north edge, as in pictures.
struct FloorImage {
  static constexpr std::size_t kMostPixels = std::size_t{1} << 24;

  std::size_t columns = 0, lines = 0;
  std::vector<std::uint8_t> pixels = {};
  std::vector<hal::Rgb> colors = {};  ///< of the same pixels; none: they are grey
  /// Of the pixel at this place, as a part of the arena from its south-west corner: 0 black to 1 white.
  double at(double east, double north) const noexcept;
  std::optional<hal::Rgb> color_at(double east, double north) const noexcept;

 private:
  std::size_t pixel_at(double east, double north) const noexcept;
};

/// Differs when the floor's shades do; 0: it is uniform. Cheap enough for every tick.
std::uint64_t floor_mark(const SpaceStores& stores) noexcept;
/// The floor with the pixels that it is made of; one of more than kMostPixels as fine as those allow.
FloorImage floor_image(const SpaceStores& stores);

/// A PNG file of it.
std::string png_of(const FloorImage& image);
/// Reads what `png_of` wrote. Errors: it is something else, or damaged.
hal::Result<FloorImage> floor_of_png(std::string_view png);
/// A field that shows it over the whole arena; `mark` tells floors apart.
std::unique_ptr<Field> floor_of_image(std::shared_ptr<const FloorImage> image, std::uint64_t mark);

}  // namespace tandem::core
