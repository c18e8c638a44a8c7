#include "core/space/floor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <png.h>

namespace tandem::core {

hal::Status Floor::load_png(const std::string& path, double min_x_m, double min_y_m, double size_x_m, double size_y_m) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) {
    return hal::Error{"floor image '" + path + "' cannot be read: " + image.message + ". Give the path of a PNG file."};
  }
  if (static_cast<double>(image.width) * image.height > kMostPixels) {
    const hal::Status too_large = hal::Error{"floor image '" + path + "' has " + std::to_string(image.width) + " x " +
                                             std::to_string(image.height) + " pixels; at most 100 million can be used"};
    png_image_free(&image);
    return too_large;
  }
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr) == 0) {
    return hal::Error{"floor image '" + path + "' is damaged: " + image.message};
  }
  columns_ = image.width;
  lines_ = image.height;
  min_x_m_ = min_x_m;
  min_y_m_ = min_y_m;
  columns_per_m_ = static_cast<double>(columns_) / size_x_m;
  lines_per_m_ = static_cast<double>(lines_) / size_y_m;
  shade_.resize(columns_ * lines_);
  for (std::size_t line = 0; line < lines_; ++line) {
    for (std::size_t column = 0; column < columns_; ++column) {
      const std::uint8_t* p = &rgb[3 * ((lines_ - 1 - line) * columns_ + column)];
      shade_[line * columns_ + column] = static_cast<std::uint8_t>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  }
  take_mark();
  return {};
}

/// Eight pixels at a time.
void Floor::take_mark() noexcept {
  std::uint64_t mark = (columns_ << 32) ^ lines_;
  for (std::size_t at = 0; at < shade_.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, shade_.data() + at, std::min(sizeof word, shade_.size() - at));
    mark = (mark ^ word) * 0x9E3779B97F4A7C15ULL;
    mark ^= mark >> 32;
  }
  mark_ = mark;
}

void Floor::paint(double min_x_m, double min_y_m, double size_x_m, double size_y_m, double pixels_per_m,
                  const std::function<double(double, double)>& shade) {
  columns_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(size_x_m * pixels_per_m)));
  lines_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(size_y_m * pixels_per_m)));
  min_x_m_ = min_x_m;
  min_y_m_ = min_y_m;
  columns_per_m_ = static_cast<double>(columns_) / size_x_m;
  lines_per_m_ = static_cast<double>(lines_) / size_y_m;
  shade_.resize(columns_ * lines_);
  for (std::size_t line = 0; line < lines_; ++line) {
    const double y = min_y_m + (static_cast<double>(line) + 0.5) / lines_per_m_;
    for (std::size_t column = 0; column < columns_; ++column) {
      const double x = min_x_m + (static_cast<double>(column) + 0.5) / columns_per_m_;
      shade_[line * columns_ + column] =
          static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(shade(x, y), 0.0, 1.0)));
    }
  }
  take_mark();
}

float Floor::at(double x_m, double y_m) const noexcept {
  if (shade_.empty()) return kGrey;
  const auto cell = [](double offset, std::size_t count) {
    const auto last = static_cast<double>(count - 1);
    return static_cast<std::size_t>(offset > 0.0 ? std::min(offset, last) : 0.0);  // what is no number counts to cell 0
  };
  const std::size_t column = cell((x_m - min_x_m_) * columns_per_m_, columns_);
  const std::size_t line = cell((y_m - min_y_m_) * lines_per_m_, lines_);
  return static_cast<float>(shade_[line * columns_ + column]) * (1.0F / 255.0F);
}

}  // namespace tandem::core
