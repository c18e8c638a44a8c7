// Finds AprilTags in grey pictures.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/vector2.hpp"

namespace tandem::bridges::apriltag {

struct DetectorOptions {
  std::string family = "tag36h11";
  double decimate = 1.0;  ///< tags are looked for in a picture so many times smaller: 1, 1.5, or a whole number
  int threads = 1;
  int contrast = 30;  ///< between a tag's black and white, of 255, at least: noise of the floor has less
};

struct Detection {
  std::size_t id = 0;
  /// In pixels from the picture's upper left corner; lower left, lower right, upper right and upper left of the tag as
  /// it is printed.
  std::array<hal::Vector2, 4> corners;

  hal::Vector2 centre() const noexcept;  ///< of the tag, in perspective
  double side_px() const noexcept;       ///< mean length of its sides
};

/// One thread at a time.
class Detector {
 public:
  /// Errors: no such family; pictures are not made smaller in that way.
  static hal::Result<std::unique_ptr<Detector>> make(const DetectorOptions& options);
  ~Detector();

  /// `grey`: lines from the top, without gaps. Of a tag that is found twice, both are left out, and counted.
  std::vector<Detection> detect(std::span<const std::uint8_t> grey, std::size_t width, std::size_t height);
  std::uint64_t doubled() const noexcept { return doubled_; }

 private:
  struct Impl;
  explicit Detector(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
  std::uint64_t doubled_ = 0;
};

}  // namespace tandem::bridges::apriltag
