#include "core/device/far_rays.hpp"

#include <algorithm>
#include <cmath>

#include "core/device/leaning_rays.hpp"
#include "core/device/proximity.hpp"

namespace tandem::core {
namespace {

[[gnu::always_inline]] inline void meet_object(const RayRing& ring, const Object& o, double x_m, double y_m, float c,
                                               float s, float* distances) noexcept {
  const float wx = static_cast<float>(o.x_m - x_m);
  const float wy = static_cast<float>(o.y_m - y_m);
  const float qx = c * wx + s * wy;
  const float qy = c * wy - s * wx;
  const float ax = static_cast<float>(o.cos_h) * c + static_cast<float>(o.sin_h) * s;
  const float ay = static_cast<float>(o.sin_h) * c - static_cast<float>(o.cos_h) * s;
  for (std::size_t g = 0; g < ring.registers; ++g) {
    float* best = distances + g * RayRing::kLanes;
    if (o.kind == Object::Kind::Cylinder)
      meet_disc(ring, g, qx, qy, static_cast<float>(o.radius_m), best);
    else
      meet_box(ring, g, qx, qy, ax, ay, static_cast<float>(o.half_x_m), static_cast<float>(o.half_y_m), best);
  }
}

template <class Discs>
[[gnu::always_inline]] inline void meet_all(const SpaceStores& stores, std::size_t row, const RayRing& ring,
                                            double height_m, const Discs& discs, const std::vector<std::size_t>& near,
                                            float* distances) noexcept {
  for (const auto& disc : discs) {
    for (std::size_t g = 0; g < ring.registers; ++g)
      meet_disc(ring, g, disc.x, disc.y, disc.radius, distances + g * RayRing::kLanes);
  }
  const Bodies& b = stores.bodies;
  const bool lean = anything_may_lean(stores);
  for (const std::size_t number : near) {
    const Object& o = stores.objects[number];
    if (lean && leans(stores.object_motion[number].q_WB)) {
      meet_leaning(ring, o, stores.object_motion[number].q_WB, height_m, b.x_m[row], b.y_m[row], b.cos_h[row],
                   b.sin_h[row], distances);
      continue;
    }
    if (height_m < o.z_low_m || height_m > o.z_high_m) continue;
    meet_object(ring, o, b.x_m[row], b.y_m[row], static_cast<float>(b.cos_h[row]), static_cast<float>(b.sin_h[row]),
                distances);
  }
}

}  // namespace

FarRays::FarRays() : ring_(std::array<hal::Mount, kCapacity>{}, 0.0) {
  bodies_.reserve(256);
  near_.reserve(256);
}

void FarRays::aim(std::size_t count, double height_m) noexcept {
  ring_.count = count;
  ring_.registers = (count + RayRing::kLanes - 1) / RayRing::kLanes;
  height_m_ = height_m;
  farthest_m_ = 0.0;
  distance_m.fill(1e9F);
}

void FarRays::set(std::size_t ray, double bearing_rad, double length_m, double x_m, double y_m) noexcept {
  ring_.ox[ray] = static_cast<float>(x_m);
  ring_.oy[ray] = static_cast<float>(y_m);
  ring_.dx[ray] = static_cast<float>(std::cos(bearing_rad));
  ring_.dy[ray] = static_cast<float>(std::sin(bearing_rad));
  length_m_[ray] = length_m;
  farthest_m_ = std::max(farthest_m_, length_m + std::hypot(x_m, y_m));
}

void FarRays::look(const SpaceStores& stores, std::size_t row, double widest_m, RealSense sense) noexcept {
  const Bodies& b = stores.bodies;
  const double height = height_m_ + stores.base_m(row);
  bodies_.clear();
  stores.body_index.for_each_near(b.x_m[row], b.y_m[row], farthest_m_ + widest_m, [&](const IndexEntry& o) {
    const double wx = o.x_m - b.x_m[row];
    const double wy = o.y_m - b.y_m[row];
    const double within = farthest_m_ + static_cast<double>(o.radius_m);
    if (o.row() == row || wx * wx + wy * wy > within * within) return;
    if (stores.senses_really(row, o.row(), sense)) return;
    const double low = stores.base_m(o.row());
    if (height < low || height > low + stores.kind_of_row(o.row()).body.height_m) return;
    bodies_.push_back({static_cast<float>(b.cos_h[row] * wx + b.sin_h[row] * wy),
                       static_cast<float>(b.cos_h[row] * wy - b.sin_h[row] * wx), o.radius_m});
  });
  near_.clear();
  if (!stores.objects.empty()) list_objects(stores, row);
  if (vector_code() == VectorCode::Avx2)
    meet_avx2(stores, row);
  else
    meet(stores, row);
}

void FarRays::meet(const SpaceStores& stores, std::size_t row) noexcept {
  meet_all(stores, row, ring_, height_m_ + stores.base_m(row), bodies_, near_, distance_m.data());
}

#if defined(__x86_64__) || defined(__i386__)
// The same source for wider registers; the bits stay those of the baseline.
__attribute__((target("avx2"))) void FarRays::meet_avx2(const SpaceStores& stores, std::size_t row) noexcept {
  meet_all(stores, row, ring_, height_m_ + stores.base_m(row), bodies_, near_, distance_m.data());
}
#else
void FarRays::meet_avx2(const SpaceStores& stores, std::size_t row) noexcept {
  meet(stores, row);
}
#endif

/// Numbers of the objects that lie near any ray, each once, in rising order.
void FarRays::list_objects(const SpaceStores& stores, std::size_t row) noexcept {
  const Bodies& b = stores.bodies;
  for (std::size_t k = 0; k < ring_.count; ++k) {
    const int hops = 1 + static_cast<int>(length_m_[k] / (1.9 * stores.static_index.reach()));
    const auto ox = static_cast<double>(ring_.ox[k]);
    const auto oy = static_cast<double>(ring_.oy[k]);
    const auto dx = static_cast<double>(ring_.dx[k]);
    const auto dy = static_cast<double>(ring_.dy[k]);
    const double x_m = b.x_m[row] + (b.cos_h[row] * ox - b.sin_h[row] * oy);
    const double y_m = b.y_m[row] + (b.sin_h[row] * ox + b.cos_h[row] * oy);
    const double wx = b.cos_h[row] * dx - b.sin_h[row] * dy;
    const double wy = b.sin_h[row] * dx + b.cos_h[row] * dy;
    for (int hop = 0; hop < hops; ++hop) {
      const double along = length_m_[k] * (hop + 0.5) / hops;
      stores.for_each_object_near(x_m + along * wx, y_m + along * wy, [&](const Object& object) {
        if (near_.size() == near_.capacity()) list_each_once();  // rather than grow: rays share most of theirs
        near_.push_back(static_cast<std::size_t>(&object - stores.objects.data()));
      });
    }
  }
  list_each_once();
}

void FarRays::list_each_once() noexcept {
  std::sort(near_.begin(), near_.end());
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
}

}  // namespace tandem::core
