// Floor images are PNG, as people draw them, read by libpng's simplified interface: two calls, linked by this folder
// alone.
#include "core/field/raster.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <png.h>

#include "hal/input_file.hpp"

namespace tandem::core {
namespace {

/// Eight pixels at a time.
std::uint64_t mark_of(const std::vector<std::uint8_t>& pixels, std::size_t columns, std::size_t lines) noexcept {
  std::uint64_t mark = (columns << 32) ^ lines;
  for (std::size_t at = 0; at < pixels.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, pixels.data() + at, std::min(sizeof word, pixels.size() - at));
    mark = (mark ^ word) * 0x9E3779B97F4A7C15ULL;
    mark ^= mark >> 32;
  }
  return mark;
}

}  // namespace

Raster::Raster(const RasterArea& area, std::size_t columns, std::size_t lines)
    : min_x_m_(area.min_x_m),
      min_y_m_(area.min_y_m),
      columns_per_m_(static_cast<double>(columns) / area.size_x_m),
      lines_per_m_(static_cast<double>(lines) / area.size_y_m),
      columns_(columns),
      lines_(lines) {}

void Raster::take(std::vector<std::uint8_t> pixels) {
  mark_ = mark_of(pixels, columns_, lines_);
  pixels_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(pixels));
}

hal::Result<Raster> Raster::from_png(const std::string& path, const RasterArea& area) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto bytes = hal::read_whole_file(path, "image");
  if (!bytes.ok()) return hal::Error{bytes.error().message + ". Give the path of a PNG file."};
  if (png_image_begin_read_from_memory(&image, bytes.value().data(), bytes.value().size()) == 0)
    return hal::Error{"image '" + path + "' cannot be read: " + image.message + ". Give the path of a PNG file."};
  if (static_cast<double>(image.width) * image.height > kMostPixels) {
    const hal::Error too_large{"image '" + path + "' has " + std::to_string(image.width) + " x " +
                               std::to_string(image.height) + " pixels; at most 100 million can be used"};
    png_image_free(&image);
    return too_large;
  }
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr) == 0)
    return hal::Error{"image '" + path + "' is damaged: " + image.message};
  Raster raster(area, image.width, image.height);
  std::vector<std::uint8_t> pixels(raster.columns_ * raster.lines_);
  std::vector<hal::Rgb> colors(pixels.size());
  bool grey = true;
  for (std::size_t line = 0; line < raster.lines_; ++line) {
    for (std::size_t column = 0; column < raster.columns_; ++column) {
      const std::uint8_t* p = &rgb[3 * ((raster.lines_ - 1 - line) * raster.columns_ + column)];
      colors[line * raster.columns_ + column] = {p[0], p[1], p[2]};
      grey = grey && p[0] == p[1] && p[1] == p[2];
      pixels[line * raster.columns_ + column] =
          static_cast<std::uint8_t>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  }
  raster.take(std::move(pixels));
  if (!grey) raster.colors_ = std::make_shared<const std::vector<hal::Rgb>>(std::move(colors));
  return raster;
}

Raster Raster::painted(const RasterArea& area, double pixels_per_m,
                       const std::function<double(double, double)>& value) {
  const auto count = [pixels_per_m](double size_m) {
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(size_m * pixels_per_m)));
  };
  Raster raster(area, count(area.size_x_m), count(area.size_y_m));
  std::vector<std::uint8_t> pixels(raster.columns_ * raster.lines_);
  for (std::size_t line = 0; line < raster.lines_; ++line) {
    const double y = area.min_y_m + (static_cast<double>(line) + 0.5) / raster.lines_per_m_;
    for (std::size_t column = 0; column < raster.columns_; ++column) {
      const double x = area.min_x_m + (static_cast<double>(column) + 0.5) / raster.columns_per_m_;
      pixels[line * raster.columns_ + column] =
          static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value(x, y), 0.0, 1.0)));
    }
  }
  raster.take(std::move(pixels));
  return raster;
}

std::size_t Raster::pixel_at(double x_m, double y_m) const noexcept {
  const auto cell = [](double offset, std::size_t count) {
    const auto last = static_cast<double>(count - 1);
    return static_cast<std::size_t>(offset > 0.0 ? std::min(offset, last) : 0.0);  // what is no number counts to cell 0
  };
  const std::size_t column = cell((x_m - min_x_m_) * columns_per_m_, columns_);
  const std::size_t line = cell((y_m - min_y_m_) * lines_per_m_, lines_);
  return line * columns_ + column;
}

float Raster::at(double x_m, double y_m) const noexcept {
  return static_cast<float>((*pixels_)[pixel_at(x_m, y_m)]) * (1.0F / 255.0F);
}

std::optional<hal::Rgb> Raster::color_at(double x_m, double y_m) const noexcept {
  if (colors_ == nullptr) return std::nullopt;
  return (*colors_)[pixel_at(x_m, y_m)];
}

}  // namespace tandem::core
