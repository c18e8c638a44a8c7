// Pictures that the emulated camera takes: flat shapes in perspective, blurred, with noise.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bridges/apriltag/family.hpp"
#include "bridges/emulation/fault_spec.hpp"
#include "bridges/tracker_emulator/lens.hpp"

namespace tandem::bridges::tracker_emulator {

struct PictureOptions {
  double blur_px = 0.6;  ///< standard deviation
  double noise = 3.0;    ///< of a pixel's grey, of 255: standard deviation
  bool mirrored = false;
};

/// A tag that lies somewhere: its x axis along its lower edge, its y axis along its left one, z out of the paper.
struct PlacedTag {
  apriltag::Pattern pattern;
  double size_m = 0.05;
  hal::Vector3 p_W = hal::Vector3::Zero();  ///< of its centre
  hal::Matrix3 axes_W = hal::Matrix3::Identity();
};

class Artist {
 public:
  Artist(const Lens& lens, const PictureOptions& options, std::uint64_t seed);

  /// Grey, lines from the top. Tags that come later hide earlier ones; edges are as sharp as the blur lets them be.
  std::vector<std::uint8_t> draw(const std::vector<PlacedTag>& tags);
  /// For the next pictures.
  void set_mirrored(bool mirrored) noexcept { options_.mirrored = mirrored; }

 private:
  struct Shape {
    std::array<hal::Vector2, 4> corners;
    double left, right, top, bottom;
    float grey;
  };
  void add(const PlacedTag& tag);
  void draw_tile(std::size_t left, std::size_t top, const std::vector<std::size_t>& shapes);
  double floor(double x, double y) const noexcept;

  Lens lens_;
  PictureOptions options_;
  Chance chance_;
  std::vector<float> kernel_;  // of the blur, from its middle on
  std::vector<float> noise_;
  std::vector<float> picture_;
  std::vector<float> bare_;  // without anything on the floor
  std::vector<Shape> shapes_;
};

}  // namespace tandem::bridges::tracker_emulator
