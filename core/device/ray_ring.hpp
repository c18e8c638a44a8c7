// All rays of one robot against one obstacle at a time: eight rays are one AVX register.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include "hal/robot_kind.hpp"

namespace tandem::core {

/// The rays of a ring of range sensors, in the body frame (metres, unit directions), padded to whole registers with
/// rays that never hit.
struct RayRing {
  static constexpr std::size_t kLanes = 8;
  static constexpr std::size_t kCapacity = 24;

  std::size_t count = 0;
  std::size_t registers = 0;  ///< count / kLanes, rounded up
  float range_m = 0.0F;
  float reach_m = 0.0F;   ///< farthest point of any ray from the robot's centre
  float height_m = 0.0F;  ///< of the rays above the ground
  alignas(32) std::array<float, kCapacity> ox{}, oy{}, dx{}, dy{};

  RayRing(std::span<const hal::Mount> mounts, double range)
      : count(mounts.size()), registers((count + kLanes - 1) / kLanes), range_m(static_cast<float>(range)) {
    dx.fill(1.0F);
    ox.fill(1e6F);  // padding starts far away and looks further away
    for (std::size_t i = 0; i < count; ++i) {
      const hal::Mount& m = mounts[i];
      ox[i] = static_cast<float>(m.x_m);
      oy[i] = static_cast<float>(m.y_m);
      dx[i] = static_cast<float>(std::cos(m.bearing_rad));
      dy[i] = static_cast<float>(std::sin(m.bearing_rad));
      height_m = static_cast<float>(m.z_m);
      reach_m = std::max(reach_m, static_cast<float>(std::hypot(m.x_m, m.y_m)) + range_m);
    }
  }
};

/// Eight floats that are worked on together. Compiled to one AVX register or two SSE ones; the bits are the same.
using Lanes = float __attribute__((vector_size(32)));

[[gnu::always_inline]] inline void load_lanes(const float* from, Lanes& lanes) noexcept {
  std::memcpy(&lanes, from, sizeof lanes);
}
[[gnu::always_inline]] inline void store_nearer(const Lanes& distance, float* best) noexcept {
  Lanes b;
  std::memcpy(&b, best, sizeof b);
  b = distance < b ? distance : b;
  std::memcpy(best, &b, sizeof b);
}

/// Shortens `best` (kLanes distances from the sensors) where ray register `g` of the ring meets a disc with centre (qx,
/// qy) in the body frame. A sensor inside the disc reads 0.
[[gnu::always_inline]] inline void meet_disc(const RayRing& ring, std::size_t g, float qx, float qy, float radius,
                                             float* best) noexcept {
  Lanes ox, oy, dx, dy;
  load_lanes(ring.ox.data() + g * RayRing::kLanes, ox);
  load_lanes(ring.oy.data() + g * RayRing::kLanes, oy);
  load_lanes(ring.dx.data() + g * RayRing::kLanes, dx);
  load_lanes(ring.dy.data() + g * RayRing::kLanes, dy);
  const Lanes zero{};
  const Lanes rx = qx - ox;
  const Lanes ry = qy - oy;
  const Lanes along = rx * dx + ry * dy;
  const Lanes cross = rx * dy - ry * dx;
  const Lanes h2 = radius * radius - cross * cross;  // half chord, squared
  Lanes h = h2 > zero ? h2 : zero;
  for (std::size_t k = 0; k < RayRing::kLanes; ++k) h[k] = __builtin_sqrtf(h[k]);
  const Lanes enter = along - h;
  const Lanes hit = enter > zero ? enter : zero;
  const Lanes miss = zero + 1e9F;
  const Lanes front = along + h > zero ? hit : miss;
  store_nearer(h2 > zero ? front : miss, best);
}

/// The same for a rectangle with centre (qx, qy) in the body frame, its own x axis along (ax, ay), half extents hx, hy.
[[gnu::always_inline]] inline void meet_box(const RayRing& ring, std::size_t g, float qx, float qy, float ax, float ay,
                                            float hx, float hy, float* best) noexcept {
  Lanes ox, oy, dx, dy;
  load_lanes(ring.ox.data() + g * RayRing::kLanes, ox);
  load_lanes(ring.oy.data() + g * RayRing::kLanes, oy);
  load_lanes(ring.dx.data() + g * RayRing::kLanes, dx);
  load_lanes(ring.dy.data() + g * RayRing::kLanes, dy);
  const Lanes zero{};
  const Lanes tiny = zero + 1e-12F;
  const Lanes rx = ox - qx;
  const Lanes ry = oy - qy;
  const Lanes px = ax * rx + ay * ry;  // origin and direction in the rectangle's frame
  const Lanes py = ax * ry - ay * rx;
  Lanes vx = ax * dx + ay * dy;
  Lanes vy = ax * dy - ay * dx;
  // A parallel ray gets a trace of slope: it then misses or covers the whole slab.
  vx = vx * vx < tiny * tiny ? tiny : vx;
  vy = vy * vy < tiny * tiny ? tiny : vy;
  const Lanes x1 = (-hx - px) / vx;
  const Lanes x2 = (hx - px) / vx;
  const Lanes y1 = (-hy - py) / vy;
  const Lanes y2 = (hy - py) / vy;
  const Lanes xn = x1 < x2 ? x1 : x2;
  const Lanes xf = x1 < x2 ? x2 : x1;
  const Lanes yn = y1 < y2 ? y1 : y2;
  const Lanes yf = y1 < y2 ? y2 : y1;
  const Lanes enter = xn > yn ? xn : yn;
  const Lanes leave = xf < yf ? xf : yf;
  const Lanes hit = enter > zero ? enter : zero;
  const Lanes miss = zero + 1e9F;
  const Lanes front = leave > zero ? hit : miss;
  store_nearer(leave >= enter ? front : miss, best);
}

}  // namespace tandem::core
