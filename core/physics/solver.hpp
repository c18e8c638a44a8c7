// Engines that give every region a world of its own, and run these in parallel.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/physics/engine.hpp"
#include "core/physics/ground_crowd.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// Context of a solver in each phase. `load` may run at the same time as other regions' `load`, `advance` as other
/// regions' `advance`; never one as the other. So `load` reads any part of the stores and writes none, and `advance`
/// writes the rows of `region.owned` and nothing else, and reads no row of other regions.
struct SolverContext {
  SpaceStores& stores;
  const Region& region;
  double tick_s;
  hal::Tick tick;
};

/// The physics of one region: a world with the region's bodies, doubles of those near its border, and the immovable
/// objects that touch it.
///
/// Mirrored bodies are simulated like own ones, with the same commands, so that a contact across the border unfolds
/// alike on both sides; their results are thrown away, and at the next `load` they are where their owners put them.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Makes its world equal to the stores: creates doubles of bodies that came into `region.owned` or
  /// `region.mirrored`, drops those that went, moves what is elsewhere than it was left (`core/physics/body_table.hpp`
  /// does the bookkeeping), rebuilds immovable ones when `stores.immovables_version` rose, and joints.
  virtual void load(const SolverContext& context) = 0;

  /// One tick, in as many sub-steps as it needs; then writes back poses, motions, rolled distances of `region.owned`.
  /// Anything that is not finite, or faster than physics allows, is reported and not written back.
  virtual void advance(const SolverContext& context) = 0;

  /// As Engine::remember.
  virtual bool remember(hal::Archive& /*archive*/) { return true; }

  PhysicsAccuracy accuracy;      ///< since it was made
  double overlap = 0.0;          ///< of two robots that drive, after the last tick; its engine parts what is too deep
  bool crowds_moved = false;     ///< since then, by its engine; loading resets it
  std::vector<Trouble> trouble;  ///< of the last tick; emptied by its collector
};

/// For EngineType::unfit: what is thinner than `thinnest_m` in any of its `sizes_m`, or lighter or heavier than numbers
/// can follow.
std::string beyond_limits(std::string_view engine, const Object& object, std::initializer_list<double> sizes_m,
                          double thinnest_m);

/// For EngineType::make of kinds that have `make_solver`: a SolverEngine.
std::unique_ptr<Engine> make_solvers(const EngineType& type, const EngineOrder& order);

/// All engines of one such kind in a run: a solver a region, stepped in parallel. Regions that neither hold
/// nor mirror a body rest; few bodies are left to the calling thread.
class SolverEngine final : public Engine {
 public:
  /// `plane`: whether what stands in the way does so at any height.
  SolverEngine(std::string_view kind, bool plane) : kind_(kind), crowds_(plane) {}
  /// `region` is an index into SpaceStores::regions.
  void add(std::size_t region, std::unique_ptr<Solver> solver);

  std::string_view kind() const noexcept override { return kind_; }
  void load(const PhysicsContext& context) override;
  void advance(const PhysicsContext& context) override;
  void collect(std::vector<Trouble>& all) override;
  PhysicsAccuracy accuracy() const override;
  bool remember(hal::Archive& archive) override;

 private:
  struct Part {
    std::size_t region;
    std::unique_ptr<Solver> solver;
  };
  std::string_view kind_;
  template <class Work>
  void each_busy_part(ThreadPool& pool, Work&& work);
  void part_crowds(SpaceStores& stores);

  std::vector<Part> parts_;
  std::vector<std::size_t> busy_;  // parts that hold bodies in this tick
  std::size_t bodies_ = 0;         // of these
  GroundCrowd crowds_;
  PhysicsAccuracy accuracy_;  // of what it does itself
};

}  // namespace tandem::core
