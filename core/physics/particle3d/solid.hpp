// Solids that do not give way: immovable objects, the walls of a region, ground and ceiling.
#pragma once
#include "core/space/stores.hpp"

namespace tandem::core::particle3d {

/// An upright cylinder that moves; position of the middle of its base.
struct Mover {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double vx_m_s = 0.0, vy_m_s = 0.0, vz_m_s = 0.0;
  double radius_m = 0.0, height_m = 0.0;
  bool landed = false;  ///< came to stand on something
};

/// The solid things of one region, as they are in the stores.
class Solid {
 public:
  Solid(const SpaceStores& stores, const Region& region) : stores_(stores), region_(region) {}

  double ground_m() const noexcept { return region_.bottom_m > -1e9 ? region_.bottom_m : 0.0; }
  double ceiling_m() const noexcept { return std::min(region_.top_m, stores_.max_z_m); }

  /// Whether anything solid but ground and ceiling may be met within `way_m`.
  bool near(const Mover& body, double way_m) const noexcept;
  /// Whether the body stands on an object.
  bool carries(const Mover& body) const noexcept;
  /// Moves `body`, which is where it wants to be, to where it gets from (x, y, z) without entering anything: it slides
  /// along what it meets, and loses the speed towards it.
  void stop(Mover& body, double x_m, double y_m, double z_m) const noexcept;

 private:
  struct Meeting;
  template <class Visit>
  void each_meeting(const Mover& body, Visit&& visit) const noexcept;
  bool inside_something(const Mover& body) const noexcept;
  void stop_short(Mover& body, double x_m, double y_m, double z_m) const noexcept;
  void keep_between(Mover& body) const noexcept;

  const SpaceStores& stores_;
  const Region& region_;
};

}  // namespace tandem::core::particle3d
