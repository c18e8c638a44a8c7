// Assigns bodies to regions: at the start, when hooks put bodies elsewhere, and as bodies cross gates.
#pragma once
#include <cstdint>
#include <vector>

#include "core/schedule/thread_pool.hpp"
#include "core/space/region_map.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// Keeps Bodies::region, SpaceStores::object_region and the lists of every Region true. Nothing here depends on the
/// number of threads.
class RegionAssigner {
 public:
  /// Call when the regions, robots and objects of `stores` are made. `tick_s` bounds how far a body moves in a tick.
  void build(SpaceStores& stores, double tick_s);
  /// Call when bodies came or went: larger ones are noticed from farther away. What it keeps depends on the stores as
  /// they are now, not on what was there before.
  void fit(SpaceStores& stores, double tick_s);

  /// Finds the regions of all bodies that were put somewhere (rows flagged kMoved, objects whose region is kNoRegion).
  /// Those that no region can hold are added to `nowhere`; they stay where they are, and in no region's lists.
  void place(SpaceStores& stores, std::vector<BodyKey>& nowhere);

  /// After bodies moved: hands those that crossed an open side to the region behind it, and puts those that passed a
  /// wall back. Bodies that crossed where no region lies behind are added to `left`; they stay their region's.
  void migrate(SpaceStores& stores, ThreadPool& pool, std::vector<BodyKey>& left);

  /// Brings Region::owned and Region::mirrored up to date.
  void list(SpaceStores& stores, ThreadPool& pool);

  /// Puts a body back onto the nearest point inside its region's outline; one without a region gets the nearest that
  /// can hold it.
  static void put_back(SpaceStores& stores, BodyKey body) noexcept;

  /// The region for a body where it is now; kNoRegion when none can hold it.
  std::uint16_t find(const SpaceStores& stores, BodyKey body) const noexcept;

 private:
  std::uint16_t behind(const SpaceStores& stores, const Region& from, const RegionSide& side, double x_m, double y_m,
                       double z_m) const noexcept;
  void cross(SpaceStores& stores, BodyKey body, std::vector<BodyKey>& left);
  void keep_joined_together(SpaceStores& stores);
  bool led_by_another(const SpaceStores& stores, BodyKey body) const noexcept;
  void find_border_rows(const SpaceStores& stores, ThreadPool& pool);
  void list_body(SpaceStores& stores, BodyKey body);

  RegionMap map_;
  bool borders_ = false;  // some region ends somewhere
  bool lists_ = false;    // some region wants lists
  double extra_reach_m_ = 0.0;
  std::vector<std::uint8_t> near_border_;  // by row
};

}  // namespace tandem::core
