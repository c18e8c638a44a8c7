// One region's world in space: its bodies' doubles, what stands in it, and how a tick goes.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/physics/dynamics3d/contacts.hpp"
#include "core/physics/dynamics3d/drive.hpp"
#include "core/physics/dynamics3d/pair_finder.hpp"
#include "core/physics/dynamics3d/twin.hpp"
#include "core/physics/roster.hpp"
#include "core/physics/solver.hpp"

namespace tandem::core {

/// What the world of a region is made with.
struct World3dSettings {
  std::int64_t sub_steps = 5;
  bool wheels = false;  ///< robots on the ground get turning wheels
  bool rotors = false;  ///< robots that fly get four rotors, and lean
  double gravity_m_s2 = 9.81;
  Surfaces surfaces;
  std::int64_t solver_iterations = 30;
  double erp = 0.2;
  double cfm = 1e-10;
};

/// A solver with a world of ODE's. Light bodies (core/physics/dynamics3d/twin.hpp) take part in it only while they
/// touch something: a robot that drives freely costs ODE nothing.
class World3d final : public Solver {
 public:
  explicit World3d(const World3dSettings& settings) : settings_(settings) {}

  void load(const SolverContext& context) override;
  void advance(const SolverContext& context) override;
  std::shared_ptr<const void> keep() override;
  void put_back(const void* kept) override;

 private:
  using Double = std::unique_ptr<Twin>;
  struct Held {
    std::size_t number;
    std::uint32_t generation;
    BodyKey a, b;
    Twin* twin_a;
    Twin* twin_b;
    OdeJoint joint;
  };
  /// ODE's memory, and what points into it.
  struct Kept {
    std::shared_ptr<const WorldMemory::Image> memory;
    OdeThreading threading;
    OdeWorld world;
    Contacts contacts;
    std::vector<Roster<Twin>::Entry> twins;
    std::vector<Held> held;
  };

  template <class Work>
  void guarded(const SolverContext& context, Work&& work);
  void drop_world() noexcept;
  void report(const Twin& twin, std::string what);

  void make_world();
  void place_stills(const SolverContext& context);
  Double make(const SpaceStores& stores, BodyKey key);
  void drop_double(Double& twin);
  void take_over(const SpaceStores& stores, Double& twin, double tick_s);
  void lead(Twin& twin, const BodyState& at, double tick_s) const;
  void join(const SpaceStores& stores);
  OdeJoint make_joint(const Joint& joint, Twin& a, Twin& b);
  Twin* find(BodyKey key) noexcept;

  void plan(const SpaceStores& stores, Twin& twin, double dt_s);
  void find_candidates();
  bool may_touch(const Twin& a, const Twin& b) const noexcept;
  bool may_touch(const Twin& a, const Still& still) const noexcept;
  void find_contacts();
  void enter(Twin& twin);
  void find_heaps();
  template <class Use>
  void each_heap(Use&& use);
  bool stands(std::size_t first, std::size_t past);
  void rest_heaps();
  void stop_heaps(double dt_s);
  void leave(Twin& twin, double dt_s);
  void check(Twin& twin);
  void write_back(SpaceStores& stores, const Twin& twin, double tick_s) const;

  World3dSettings settings_;
  bool broken_ = false;     // ODE gave up in this tick
  WorldMemory memory_;      // all of ODE's
  OdeThreading threading_;  // of its own: the one that ODE's worlds share is for one thread
  OdeWorld world_;
  Contacts contacts_;
  std::vector<Still> stills_;
  std::uint64_t version_ = 0;  // of the immovable objects
  Surfaces surfaces_, surfaces_in_air_;
  double flight_ceiling_m_ = 0.0;  // the arena's, too: what flies stays below; what stands may be as high as the arena
  Roster<Double> roster_;
  std::vector<Held> held_;
  PairFinder finder_;
  std::vector<PairFinder::Pair> candidates_;

  struct HeapMember {
    const Twin* top;
    Twin* twin;
  };
  std::vector<HeapMember> heaps_;  // of this sub-step, heap by heap
  std::vector<Twin*> heap_;        // the one that is looked at
  std::vector<Support> supports_;
  Standing standing_;
  std::vector<std::uint64_t> stood_, stands_now_;  // fingerprints of heaps that stood in the last sub-step, and in this
};

}  // namespace tandem::core
