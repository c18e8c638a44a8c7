#include "bridges/tracker_emulator/picture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tandem::bridges::tracker_emulator {
namespace {

constexpr std::size_t kTile_px = 64;
constexpr std::size_t kFine = 4;  // parts of a pixel, along each side
constexpr float kWhite = 225.0F, kBlack = 30.0F;

}  // namespace

Artist::Artist(const Lens& lens, const PictureOptions& options, std::uint64_t seed)
    : lens_(lens), options_(options), chance_(seed) {
  const auto reach = static_cast<std::size_t>(std::ceil(3.0 * options.blur_px));
  double sum = 0.0;
  for (std::size_t i = 0; i <= reach; ++i) {
    const double part =
        i == 0 ? 1.0 : std::exp(-0.5 * static_cast<double>(i * i) / (options.blur_px * options.blur_px));
    kernel_.push_back(static_cast<float>(part));
    sum += i == 0 ? part : 2.0 * part;
  }
  for (float& part : kernel_) part /= static_cast<float>(sum);
  // Box and Muller's way, once; each line of a picture begins elsewhere in it.
  noise_.resize(std::size_t{1} << 16U);
  const auto uniform = [&] { return (static_cast<double>(chance_.draw() >> 11U) + 0.5) * 0x1p-53; };
  for (float& n : noise_)
    n = static_cast<float>(options.noise * std::sqrt(-2.0 * std::log(uniform())) *
                           std::cos(2.0 * std::numbers::pi * uniform()));
  bare_.resize(lens.width * lens.height);
  for (std::size_t y = 0; y < lens.height; ++y) {
    for (std::size_t x = 0; x < lens.width; ++x)
      bare_[y * lens.width + x] = static_cast<float>(floor(static_cast<double>(x), static_cast<double>(y)));
  }
}

/// Light from one side, and some grain.
double Artist::floor(double x, double y) const noexcept {
  const double w = static_cast<double>(lens_.width), h = static_cast<double>(lens_.height);
  return 120.0 + 25.0 * x / w - 15.0 * y / h + 4.0 * std::sin(0.11 * x) * std::sin(0.07 * y);
}

void Artist::add(const PlacedTag& tag) {
  const std::size_t cells = tag.pattern.cells;
  const double cell_m = tag.size_m / static_cast<double>(tag.pattern.size_cells);
  std::vector<hal::Vector2> lattice;
  for (std::size_t row = 0; row <= cells; ++row) {
    for (std::size_t column = 0; column <= cells; ++column) {
      const double x_m = (static_cast<double>(column) - 0.5 * static_cast<double>(cells)) * cell_m;
      const double y_m = (0.5 * static_cast<double>(cells) - static_cast<double>(row)) * cell_m;
      const auto at = lens_.shows(tag.p_W + x_m * tag.axes_W.col(0) + y_m * tag.axes_W.col(1));
      if (!at) return;
      lattice.push_back(*at);
    }
  }
  for (std::size_t row = 0; row < cells; ++row) {
    for (std::size_t column = 0; column < cells; ++column) {
      const std::size_t i = row * (cells + 1) + column;
      Shape shape;
      shape.corners = {lattice[i], lattice[i + 1], lattice[i + cells + 2], lattice[i + cells + 1]};
      shape.left = shape.right = shape.corners[0].x();
      shape.top = shape.bottom = shape.corners[0].y();
      for (const hal::Vector2& c : shape.corners) {
        shape.left = std::min(shape.left, c.x());
        shape.right = std::max(shape.right, c.x());
        shape.top = std::min(shape.top, c.y());
        shape.bottom = std::max(shape.bottom, c.y());
      }
      shape.grey = tag.pattern.white[row * cells + column] != 0 ? kWhite : kBlack;
      shapes_.push_back(shape);
    }
  }
}

std::vector<std::uint8_t> Artist::draw(const std::vector<PlacedTag>& tags) {
  shapes_.clear();
  for (const PlacedTag& tag : tags) add(tag);
  picture_ = bare_;
  const double reach = static_cast<double>(kernel_.size());
  std::vector<std::size_t> here;
  for (std::size_t top = 0; top < lens_.height; top += kTile_px) {
    for (std::size_t left = 0; left < lens_.width; left += kTile_px) {
      here.clear();
      for (std::size_t i = 0; i < shapes_.size(); ++i) {
        const Shape& s = shapes_[i];
        if (s.right > static_cast<double>(left) - reach && s.left < static_cast<double>(left + kTile_px) + reach &&
            s.bottom > static_cast<double>(top) - reach && s.top < static_cast<double>(top + kTile_px) + reach)
          here.push_back(i);
      }
      if (!here.empty()) draw_tile(left, top, here);
    }
  }
  std::vector<std::uint8_t> grey(picture_.size());
  for (std::size_t y = 0; y < lens_.height; ++y) {
    std::size_t n = chance_.draw() % noise_.size();
    for (std::size_t x = 0; x < lens_.width; ++x) {
      const float value = picture_[y * lens_.width + x] + noise_[n];
      n = n + 1 == noise_.size() ? 0 : n + 1;
      const std::size_t column = options_.mirrored ? lens_.width - 1 - x : x;
      grey[y * lens_.width + column] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  }
  return grey;
}

/// Fine grid, mean of each pixel's parts, blur; the tile is drawn with a margin that the blur reaches into.
void Artist::draw_tile(std::size_t left, std::size_t top, const std::vector<std::size_t>& shapes) {
  const std::size_t margin = kernel_.size() - 1, side = kTile_px + 2 * margin, fine = side * kFine;
  const double x0 = static_cast<double>(left) - static_cast<double>(margin);
  const double y0 = static_cast<double>(top) - static_cast<double>(margin);
  std::vector<float> parts(fine * fine);
  for (std::size_t y = 0; y < fine; ++y) {
    const double at_y =
        std::clamp(std::floor(y0 + static_cast<double>(y / kFine)), 0.0, static_cast<double>(lens_.height - 1));
    for (std::size_t x = 0; x < fine; ++x) {
      const double at_x =
          std::clamp(std::floor(x0 + static_cast<double>(x / kFine)), 0.0, static_cast<double>(lens_.width - 1));
      parts[y * fine + x] = bare_[static_cast<std::size_t>(at_y) * lens_.width + static_cast<std::size_t>(at_x)];
    }
  }
  constexpr double kStep = 1.0 / kFine;
  const auto place = [&](double at, double begin) {  // of the first part whose middle is not before `at`
    return static_cast<std::ptrdiff_t>(std::ceil((at - begin) / kStep - 0.5));
  };
  const auto limit = [&](std::ptrdiff_t i) {
    return static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(fine)));
  };
  for (const std::size_t i : shapes) {
    const Shape& s = shapes_[i];
    for (std::size_t y = limit(place(s.top, y0)); y < limit(place(s.bottom, y0)); ++y) {
      const double at_y = y0 + (static_cast<double>(y) + 0.5) * kStep;
      double from = s.right, until = s.left;
      for (std::size_t k = 0; k < 4; ++k) {
        const hal::Vector2 &a = s.corners[k], &b = s.corners[(k + 1) % 4];
        if ((a.y() <= at_y) == (b.y() <= at_y)) continue;
        const double at_x = a.x() + (at_y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
        from = std::min(from, at_x);
        until = std::max(until, at_x);
      }
      const std::size_t end = limit(place(until, x0));
      for (std::size_t x = limit(place(from, x0)); x < end; ++x) parts[y * fine + x] = s.grey;
    }
  }
  std::vector<float> whole(side * side, 0.0F), across(side * side, 0.0F);
  for (std::size_t y = 0; y < fine; ++y) {
    for (std::size_t x = 0; x < fine; ++x)
      whole[(y / kFine) * side + x / kFine] += parts[y * fine + x] / static_cast<float>(kFine * kFine);
  }
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = margin; x < side - margin; ++x) {
      float sum = kernel_[0] * whole[y * side + x];
      for (std::size_t k = 1; k < kernel_.size(); ++k)
        sum += kernel_[k] * (whole[y * side + x - k] + whole[y * side + x + k]);
      across[y * side + x] = sum;
    }
  }
  for (std::size_t y = 0; y < kTile_px && top + y < lens_.height; ++y) {
    for (std::size_t x = 0; x < kTile_px && left + x < lens_.width; ++x) {
      const std::size_t at = (y + margin) * side + x + margin;
      float sum = kernel_[0] * across[at];
      for (std::size_t k = 1; k < kernel_.size(); ++k)
        sum += kernel_[k] * (across[at - k * side] + across[at + k * side]);
      picture_[(top + y) * lens_.width + left + x] = sum;
    }
  }
}

}  // namespace tandem::bridges::tracker_emulator
