// What every physics engine is to the step: something that moves bodies.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "core/schedule/thread_pool.hpp"
#include "core/space/stores.hpp"

namespace tandem::core {

struct PhysicsContext {
  SpaceStores& stores;
  ThreadPool& pool;
  double tick_s;
};

/// A physics engine. Reads the wheel speeds in the stores, writes poses and rolled distances. Bodies flagged kExternal
/// keep the pose that they were given; others bump into them.
class Engine {
 public:
  virtual ~Engine() = default;

  virtual std::string_view kind() const noexcept = 0;

  /// Moves every body by one tick as if it were alone. Between this and `settle` the step treats bodies that left the
  /// arena and rebuilds the index of bodies.
  virtual void move(const PhysicsContext& context) noexcept = 0;

  /// Resolves contacts, on an up-to-date index; entries of the index are moved along with their bodies.
  virtual void settle(const PhysicsContext& context) noexcept = 0;
};

}  // namespace tandem::core
