#include "bridges/apriltag/detector.hpp"

#include <algorithm>
#include <apriltag/apriltag.h>
#include <cmath>

#include "bridges/apriltag/family.hpp"

namespace tandem::bridges::apriltag {
namespace {

constexpr int kWrongBits = 1;          // that are put right; more, and tags are seen where there are none
constexpr float kLeastMargin = 15.0F;  // of brightness, between a tag's bits

}  // namespace

hal::Vector2 Detection::centre() const noexcept {
  // Where the diagonals cross.
  const hal::Vector2 a = corners[2] - corners[0], b = corners[3] - corners[1], between = corners[1] - corners[0];
  const double cross = a.x() * b.y() - a.y() * b.x();
  const double part = (between.x() * b.y() - between.y() * b.x()) / cross;
  return corners[0] + part * a;
}

double Detection::side_px() const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum += (corners[(i + 1) % 4] - corners[i]).norm();
  return sum / 4.0;
}

struct Detector::Impl {
  std::shared_ptr<apriltag_family> family;
  apriltag_detector_t* detector = nullptr;
  std::vector<std::uint8_t> copy;  // the library takes what it may write to

  ~Impl() {
    if (detector != nullptr) apriltag_detector_destroy(detector);
  }
};

Detector::Detector(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Detector::~Detector() = default;

hal::Result<std::unique_ptr<Detector>> Detector::make(const DetectorOptions& options) {
  if (const auto count = count_of_tags(options.family); !count.ok()) return count.error();
  const bool whole = options.decimate >= 1.0 && options.decimate == std::floor(options.decimate);
  if (!whole && options.decimate != 1.5)
    return hal::Error{"'decimate' is 1, 1.5 or a whole number; nothing else is done well"};
  auto impl = std::make_unique<Impl>();
  impl->family = make_family(options.family);
  impl->detector = apriltag_detector_create();
  apriltag_detector_add_family_bits(impl->detector, impl->family.get(), kWrongBits);
  impl->detector->quad_decimate = static_cast<float>(options.decimate);
  impl->detector->nthreads = options.threads;
  impl->detector->refine_edges = true;
  impl->detector->qtp.min_white_black_diff = options.contrast;
  return std::unique_ptr<Detector>(new Detector(std::move(impl)));
}

std::vector<Detection> Detector::detect(std::span<const std::uint8_t> grey, std::size_t width, std::size_t height) {
  std::vector<Detection> found;
  constexpr std::size_t kLeast = 16;
  if (width < kLeast || height < kLeast || grey.size() != width * height) return found;
  impl_->copy.assign(grey.begin(), grey.end());
  image_u8_t image{static_cast<std::int32_t>(width), static_cast<std::int32_t>(height),
                   static_cast<std::int32_t>(width), impl_->copy.data()};
  zarray_t* const all = apriltag_detector_detect(impl_->detector, &image);
  for (int i = 0; i < zarray_size(all); ++i) {
    apriltag_detection_t* d = nullptr;
    zarray_get(all, i, static_cast<void*>(&d));
    if (d->hamming > kWrongBits || d->decision_margin < kLeastMargin) continue;
    Detection detection;
    detection.id = static_cast<std::size_t>(d->id);
    for (std::size_t k = 0; k < 4; ++k) detection.corners[k] = {d->p[k][0], d->p[k][1]};
    found.push_back(detection);
  }
  apriltag_detections_destroy(all);
  std::sort(found.begin(), found.end(), [](const Detection& a, const Detection& b) { return a.id < b.id; });
  std::vector<Detection> once;
  for (std::size_t i = 0; i < found.size();) {
    std::size_t end = i + 1;
    while (end < found.size() && found[end].id == found[i].id) ++end;
    if (end == i + 1)
      once.push_back(found[i]);
    else
      ++doubled_;
    i = end;
  }
  return once;
}

}  // namespace tandem::bridges::apriltag
