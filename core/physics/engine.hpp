// What every physics engine is to the step: something that moves the bodies of its regions.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/element.hpp"
#include "core/schedule/thread_pool.hpp"
#include "core/space/stores.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Something that an engine cannot go on with: the run ends in this tick, and the message names the body.
struct Trouble {
  BodyKey body;
  std::string what;  ///< follows the body's name, as in "has a speed that is not a number"
};

struct PhysicsContext {
  SpaceStores& stores;
  ThreadPool& pool;
  double tick_s;
  hal::Tick tick;
};

/// All engines of one kind in a run: what moves the bodies in the regions that they were given. The stores are the
/// truth: an engine takes over whatever changed there since its last tick (poses that a hook set, bodies that came,
/// went, were renewed or restored), and writes back the poses, motions and rolled distances of the bodies that its
/// regions own. Bodies flagged kExternal keep the pose that they were given; others bump into them.
class Engine {
 public:
  virtual ~Engine() = default;

  virtual std::string_view kind() const noexcept = 0;

  /// Before anything moves in this tick: takes over the bodies of every region, and the mirrored ones, whose owners may
  /// be engines of another kind. Reads the stores only.
  virtual void load(const PhysicsContext& /*context*/) {}

  /// In how many parts the tick is to go, so that none of its bodies jumps over anything before contacts are resolved:
  /// `advance` is called so often, each time for a part of the tick, and `settle` after each.
  virtual int parts(const PhysicsContext& /*context*/) const { return 1; }

  /// Moves every body of its regions by one part of a tick, which lasts `context.tick_s`. Between this and `settle` the
  /// step treats bodies that left their region or the arena and rebuilds the indices.
  virtual void advance(const PhysicsContext& context) = 0;

  /// Resolves contacts on up-to-date indices, for engines that need those; entries of the index are moved along with
  /// their bodies.
  virtual void settle(const PhysicsContext& /*context*/) {}

  /// Adds what went wrong in the last tick, in the order of regions and bodies.
  virtual void collect(std::vector<Trouble>& /*all*/) {}

  /// What the engine holds beyond the stores, as it is between two ticks; null: nothing. Changes nothing of the run.
  virtual std::shared_ptr<const void> keep() { return nullptr; }
  /// Goes on from what `keep` of this engine gave. The stores are as they were then.
  virtual void put_back(const std::shared_ptr<const void>& /*kept*/) {}
};

}  // namespace tandem::core
