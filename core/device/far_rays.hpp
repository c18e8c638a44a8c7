// Rays that reach farther than the index of objects: those of scanners and time-of-flight sensors.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "core/device/ray_ring.hpp"
#include "core/space/real_sense.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// The rays of one robot at a time, all at one height: `aim`, `set` each, `look`, then read `distance_m`.
class FarRays {
 public:
  static constexpr std::size_t kCapacity = RayRing::kCapacity;

  FarRays();

  /// `count` rays, `height_m` above the robot's base.
  void aim(std::size_t count, double height_m) noexcept;
  /// Which way one of them goes, how far, and from where in the body frame.
  void set(std::size_t ray, double bearing_rad, double length_m, double x_m = 0.0, double y_m = 0.0) noexcept;
  /// How far each is from the nearest body, box or cylinder that it meets, also beyond its length. `widest_m`: the
  /// largest radius of any body. Other robots that the one in `row` senses really by `sense` are left out.
  void look(const SpaceStores& stores, std::size_t row, double widest_m, RealSense sense) noexcept;

  /// From where each begins; 1e9: it meets nothing.
  alignas(32) std::array<float, kCapacity> distance_m{};

 private:
  struct Disc {
    float x, y, radius;  // in the body frame
  };
  void meet(const SpaceStores& stores, std::size_t row) noexcept;
  void meet_avx2(const SpaceStores& stores, std::size_t row) noexcept;
  void list_objects(const SpaceStores& stores, std::size_t row) noexcept;
  void list_each_once() noexcept;

  RayRing ring_;
  std::array<double, kCapacity> length_m_{};
  double height_m_ = 0.0;    // above the robot's base
  double farthest_m_ = 0.0;  // of all rays' ends, from the robot's axis
  std::vector<Disc> bodies_;
  std::vector<std::size_t> near_;
};

}  // namespace tandem::core
