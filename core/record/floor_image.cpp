#include "core/record/floor_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <libdeflate.h>
#include <memory>

#include "hal/check.hpp"

namespace tandem::core {
namespace {

/// The floor of an image, over the whole arena.
class ImageFloor final : public Field {
 public:
  ImageFloor(std::shared_ptr<const FloorImage> image, std::uint64_t mark) : image_(std::move(image)), mark_(mark) {}

  void sample(const FieldPlaces& places, double* values) const noexcept override {
    const Bodies& b = places.stores.bodies;
    for (std::size_t row = places.first_row; row < places.first_row + places.rows; ++row) {
      for (const FieldSpot& p : places.spots)
        *values++ = at(places.stores, b.x_m[row] + b.cos_h[row] * p.x_m - b.sin_h[row] * p.y_m,
                       b.y_m[row] + b.sin_h[row] * p.x_m + b.cos_h[row] * p.y_m, p.z_m);
    }
  }
  double at(const SpaceStores& s, double x_m, double y_m, double /*z_m*/) const noexcept override {
    return image_->at((x_m - s.min_x_m) / (s.max_x_m - s.min_x_m), (y_m - s.min_y_m) / (s.max_y_m - s.min_y_m));
  }
  std::optional<hal::Rgb> color(const SpaceStores& s, double x_m, double y_m) const noexcept override {
    return image_->color_at((x_m - s.min_x_m) / (s.max_x_m - s.min_x_m), (y_m - s.min_y_m) / (s.max_y_m - s.min_y_m));
  }
  std::uint64_t mark() const noexcept override { return mark_; }
  FieldGrid grid() const noexcept override { return {image_->columns, image_->lines}; }

 private:
  std::shared_ptr<const FloorImage> image_;
  std::uint64_t mark_;
};

constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t kHeaderBytes = 13;
constexpr std::string_view kGrey8("\x08\x00\x00\x00\x00", 5);  // bits a pixel, grey, deflate, filters by line, one pass
constexpr std::string_view kRgb8("\x08\x02\x00\x00\x00", 5);
constexpr int kQuick = 1;  // of libdeflate's levels

std::string be32(std::size_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>((value >> shift) & 0xFFU);
  return bytes;
}
std::size_t from_be32(std::string_view bytes) {
  std::size_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = (value << 8) | static_cast<unsigned char>(c);
  return value;
}

void append_chunk(std::string& png, std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  png += be32(data.size()) + body + be32(libdeflate_crc32(0, body.data(), body.size()));
}

/// As floors take it from images (core/field/raster.cpp).
std::uint8_t luminance(std::uint8_t r, std::uint8_t g, std::uint8_t b) noexcept {
  return static_cast<std::uint8_t>((299 * r + 587 * g + 114 * b + 500) / 1000);
}

const Field* floor_of(const SpaceStores& stores) noexcept {
  return stores.fields.find("floor");
}

}  // namespace

std::size_t FloorImage::pixel_at(double east, double north) const noexcept {
  const auto cell = [](double offset, std::size_t count) {
    const auto last = static_cast<double>(count - 1);
    return static_cast<std::size_t>(offset > 0.0 ? std::min(offset, last) : 0.0);
  };
  const std::size_t column = cell(east * static_cast<double>(columns), columns);
  const std::size_t line = cell(north * static_cast<double>(lines), lines);
  return (lines - 1 - line) * columns + column;
}

double FloorImage::at(double east, double north) const noexcept {
  return static_cast<double>(static_cast<float>(pixels[pixel_at(east, north)]) * (1.0F / 255.0F));
}

std::optional<hal::Rgb> FloorImage::color_at(double east, double north) const noexcept {
  if (colors.empty()) return std::nullopt;
  return colors[pixel_at(east, north)];
}

std::uint64_t floor_mark(const SpaceStores& stores) noexcept {
  const Field* const floor = floor_of(stores);
  return floor == nullptr ? 0 : floor->mark();
}

FloorImage floor_image(const SpaceStores& s) {
  const Field* const floor = floor_of(s);
  if (floor == nullptr || floor->mark() == 0) return {};
  constexpr std::size_t kUnknown = 1000;  // along the longer side, where it does not say what it is made of
  const double size_x_m = s.max_x_m - s.min_x_m, size_y_m = s.max_y_m - s.min_y_m;
  FieldGrid grid = floor->grid();
  if (grid.columns == 0 || grid.lines == 0) {
    const double cell_m = std::max(size_x_m, size_y_m) / static_cast<double>(kUnknown);
    grid = {static_cast<std::size_t>(std::ceil(size_x_m / cell_m)),
            static_cast<std::size_t>(std::ceil(size_y_m / cell_m))};
  }
  const double pixels = static_cast<double>(grid.columns) * static_cast<double>(grid.lines);
  if (pixels > static_cast<double>(FloorImage::kMostPixels)) {
    const double coarser = std::sqrt(static_cast<double>(FloorImage::kMostPixels) / pixels);
    const auto fewer = [coarser](std::size_t n) {
      return std::max<std::size_t>(
          1, std::min(FloorImage::kMostPixels, static_cast<std::size_t>(static_cast<double>(n) * coarser)));
    };
    grid = {fewer(grid.columns), fewer(grid.lines)};
  }
  FloorImage image{grid.columns, grid.lines, std::vector<std::uint8_t>(grid.columns * grid.lines)};
  auto pixel = image.pixels.begin();
  for (std::size_t line = 0; line < grid.lines; ++line) {
    const double y_m = s.max_y_m - (static_cast<double>(line) + 0.5) / static_cast<double>(grid.lines) * size_y_m;
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const double x_m = s.min_x_m + (static_cast<double>(column) + 0.5) / static_cast<double>(grid.columns) * size_x_m;
      const double level = std::clamp(floor->at(s, x_m, y_m, 0.0), 0.0, 1.0);
      *pixel++ = static_cast<std::uint8_t>(std::lround(255.0 * level));
      if (const auto color = floor->color(s, x_m, y_m)) image.colors.push_back(*color);
    }
  }
  return image;
}

std::string png_of(const FloorImage& image) {
  std::string lines;
  const bool grey = image.colors.size() != image.pixels.size();
  lines.reserve(((grey ? 1 : 3) * image.columns + 1) * image.lines);
  for (std::size_t line = 0; line < image.lines; ++line) {
    lines += '\0';  // as it is, without a filter
    if (grey) {
      lines.append(reinterpret_cast<const char*>(image.pixels.data() + line * image.columns), image.columns);
      continue;
    }
    for (std::size_t column = 0; column < image.columns; ++column) {
      const hal::Rgb color = image.colors[line * image.columns + column];
      for (const std::uint8_t part : {color.r, color.g, color.b}) lines += static_cast<char>(part);
    }
  }
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kQuick), &libdeflate_free_compressor);
  TANDEM_CHECK(compressor != nullptr, "no memory to pack a floor");
  std::string packed(libdeflate_zlib_compress_bound(compressor.get(), lines.size()), '\0');
  packed.resize(libdeflate_zlib_compress(compressor.get(), lines.data(), lines.size(), packed.data(), packed.size()));
  std::string png(kPngStart);
  append_chunk(png, "IHDR", be32(image.columns) + be32(image.lines) + std::string(grey ? kGrey8 : kRgb8));
  append_chunk(png, "IDAT", packed);
  append_chunk(png, "IEND", "");
  return png;
}

hal::Result<FloorImage> floor_of_png(std::string_view png) {
  const hal::Error refused{"the floor is no PNG picture as records hold them"};
  const std::size_t body = kPngStart.size() + 8;  // of the header
  const std::size_t data = body + kHeaderBytes + 4;
  if (png.size() < data + 8 || !png.starts_with(kPngStart)) return refused;
  const std::string_view form = png.substr(body + 8, kGrey8.size());
  if (form != kGrey8 && form != kRgb8) return refused;
  const std::size_t bytes = form == kGrey8 ? 1 : 3;  // of a pixel
  const std::size_t columns = from_be32(png.substr(body)), lines = from_be32(png.substr(body + 4));
  const std::size_t packed = from_be32(png.substr(data));
  if (columns == 0 || lines == 0 || columns > FloorImage::kMostPixels || lines > FloorImage::kMostPixels / columns ||
      png.substr(data + 4, 4) != "IDAT" || packed > png.size() - data - 8)
    return refused;
  std::string raw((bytes * columns + 1) * lines, '\0');
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (decompressor == nullptr || libdeflate_zlib_decompress(decompressor.get(), png.data() + data + 8, packed,
                                                            raw.data(), raw.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return refused;
  FloorImage image{columns, lines, std::vector<std::uint8_t>(columns * lines)};
  for (std::size_t line = 0; line < lines; ++line) {
    const auto* from = reinterpret_cast<const std::uint8_t*>(raw.data()) + line * (bytes * columns + 1);
    if (*from++ != 0) return refused;
    if (bytes == 1) std::copy_n(from, columns, image.pixels.data() + line * columns);
    for (std::size_t column = 0; bytes == 3 && column < columns; ++column, from += 3) {
      image.pixels[line * columns + column] = luminance(from[0], from[1], from[2]);
      image.colors.push_back({from[0], from[1], from[2]});
    }
  }
  return image;
}

std::unique_ptr<Field> floor_of_image(std::shared_ptr<const FloorImage> image, std::uint64_t mark) {
  return std::make_unique<ImageFloor>(std::move(image), mark);
}

}  // namespace tandem::core
