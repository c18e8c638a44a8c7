// Interface of a physics engine: advances the bodies of its regions by one tick.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/physics/accuracy.hpp"
#include "core/scenario/element.hpp"
#include "core/scenario/engine_traits.hpp"
#include "core/schedule/thread_pool.hpp"
#include "core/space/stores.hpp"
#include "hal/archive.hpp"
#include "hal/result.hpp"
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

  /// Of this engine, in this process: going back in a run takes nothing back of it.
  virtual PhysicsAccuracy accuracy() const { return {}; }

  /// Writes what the engine holds beyond the stores, as it is between two ticks, or goes on from what it reads, in this
  /// process or another of the same program; the stores are as they were then. Changes nothing of the run. False: what
  /// was read is not of this program and its libraries.
  virtual bool remember(hal::Archive& /*archive*/) { return true; }
};

class Solver;  // core/physics/solver.hpp

/// Input of an engine's factory: its regions in this run, each with the options of its element.
struct EngineOrder {
  struct Part {
    std::size_t region;                  ///< index into SpaceStores::regions
    std::shared_ptr<const void> params;  ///< of `EngineType::read`
    int line;                            ///< of the element
  };
  std::vector<Part> parts;  ///< at least one
  const SpaceStores& stores;
  double tick_s;
  const std::string& file;
  Problems& problems;
};

/// A kind of physics engine.
struct EngineType : KnownEngine {
  static constexpr std::string_view kCategory = "engine";
  static constexpr std::uint32_t kNumber = 4;
  using Crosses = hal::Layouts<StoreLayouts, Engine, PhysicsContext, Trouble, EngineOrder, EngineOrder::Part, Element,
                               Problem, hal::ParamVisitor>;
  std::string_view summary;  ///< for the manual
  bool whole = false;  ///< works on all its regions as one: a split changes nothing, and they need no lists of bodies
  /// Reads an engine element's own attributes and children (`id`, `regions` and <boundaries> are read by others), and
  /// checks them; problems are reported with their lines.
  std::shared_ptr<const void> (*read)(const Element& options, Problems& problems) = nullptr;
  void (*describe)(hal::ParamVisitor& visitor) = nullptr;
  /// What it pulls bodies down with, in m/s2, by what `read` gave. Null: 9.81.
  double (*gravity)(const void* params) = nullptr;
  /// Why it cannot move an object of this size and mass; empty: it can. Null: it moves none or all.
  std::string (*unfit)(const Object& object) = nullptr;
  /// All of this kind in a run. Problems: parts that cannot work together.
  std::unique_ptr<Engine> (*make)(const EngineType& type, const EngineOrder& order) = nullptr;
  /// For `make_solvers`, which is then its `make`.
  std::unique_ptr<Solver> (*make_solver)(const std::shared_ptr<const void>& params, const SpaceStores& stores,
                                         const Region& region, double tick_s) = nullptr;
};

/// Adds an engine, and what readers of files need of it.
inline void register_engine(hal::Registrar& registrar, const EngineType& type) {
  registrar.add<KnownEngine>(type);
  registrar.add(type);
}

}  // namespace tandem::core
