// Crowds of robots on the ground, pushed apart wherever they stand: across the borders of regions, too.
#pragma once
#include <cstdint>
#include <vector>

#include "core/physics/crowd_passes.hpp"
#include "core/physics/near_pairs.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

/// For engines whose solvers know only a region each. Works on places alone; velocities stay as they are. Robots that
/// fly, and those that lean (on a slope, or fallen over), are left alone and count for nothing.
class GroundCrowd {
 public:
  /// `plane`: objects are in the way at any height.
  explicit GroundCrowd(bool plane) : plane_(plane) {}

  /// Robots in region i are pushed if so.
  void moves(std::size_t region);

  /// Remembers where robots are before the tick. Later, nothing allocates that lasts.
  void start(const SpaceStores& stores);

  /// The deepest overlap among robots that two regions of these engines share: solvers move the others' as they would
  /// go without their own neighbours, and do not see how deep they come to be.
  double overlap_at_borders(const SpaceStores& stores);

  /// Pushes robots apart in the stores. Those of other engines, led ones and joined ones give no way; objects and walls
  /// neither, movable ones included: what a robot is in, it is pushed out of.
  /// @returns the deepest overlap of two robots that is left.
  double settle(SpaceStores& stores);

 private:
  void gather(const SpaceStores& stores);
  void hold_joined(const SpaceStores& stores);
  const std::vector<std::uint32_t>& find(bool back);
  double overlap(const SpaceStores& stores, std::uint32_t i, std::uint32_t k) const;
  void push(const SpaceStores& stores, const std::vector<std::uint32_t>& who);
  double move(const SpaceStores& stores, const std::vector<std::uint32_t>& who);
  void leave_objects(const SpaceStores& stores, std::uint32_t i);
  void write_back(SpaceStores& stores) const;

  bool plane_;
  std::vector<std::uint8_t> mine_;  // by region
  // By row.
  std::vector<double> start_x_m_, start_y_m_;
  // By number, in the order of their rows.
  std::vector<std::uint32_t> row_, near_others_;
  std::vector<double> x_m_, y_m_, z_m_, radius_m_, height_m_, slack_m_, push_x_m_, push_y_m_;
  std::vector<std::uint8_t> firm_;
  NearPairs pairs_;
  CrowdPasses crowd_;
};

}  // namespace tandem::core
