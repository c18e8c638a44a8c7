// Couplings: tie devices to bodies once a tick, beyond one device for one block of robots.
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "core/device/device.hpp"

namespace tandem::core {

/// Keeps nothing from tick to tick but in columns.
class Coupling {
 public:
  virtual ~Coupling() = default;
  /// Once all actuators of a block have acted, on any thread. Writes only rows of that block.
  virtual void drive(const DeviceContext& /*context*/, SpaceStores& /*stores*/) noexcept {}
  /// Once all blocks have, and before the engines move anything: for what robots have in common, such as joints. Goes
  /// through them in the order of rows.
  virtual void before_physics(SpaceStores& /*stores*/, double /*tick_s*/) {}
  /// Once all bodies have moved.
  virtual void after_physics(SpaceStores& /*stores*/, double /*tick_s*/) noexcept {}
};

/// One class of couplings. A world has one of each in the catalog, which act in its order; those that nobody's columns
/// ask for find nothing to do.
struct CouplingType {
  static constexpr std::string_view kCategory = "coupling";
  static constexpr std::uint32_t kNumber = 2;
  using Crosses = hal::Layouts<StoreLayouts, Coupling, DeviceContext>;
  std::string_view name;
  std::string_view summary;
  std::unique_ptr<Coupling> (*make)(Columns& columns) = nullptr;
};

// Those of this folder, one a file.
CouplingType piloting_type();
CouplingType gripping_type();

}  // namespace tandem::core
