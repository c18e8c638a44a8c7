// One region's world in space: its bodies, what stands in it, and how a tick goes.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/physics/body_table.hpp"
#include "core/physics/dynamics3d/body_proxy.hpp"
#include "core/physics/dynamics3d/contacts.hpp"
#include "core/physics/dynamics3d/drive.hpp"
#include "core/physics/dynamics3d/pair_finder.hpp"
#include "core/physics/dynamics3d/residual.hpp"
#include "core/physics/solver.hpp"

namespace tandem::core {

/// Input of a region's world.
struct World3dSettings {
  std::int64_t sub_steps = 5;
  bool wheels = false;  ///< robots on the ground get turning wheels
  bool rotors = false;  ///< robots that fly get four rotors, and lean
  double gravity_m_s2 = 9.81;
  Surfaces surfaces;
  std::int64_t solver_iterations = 30;  ///< to begin with
  double solver_error_m_s = 0.01;       ///< that passes are to come to
  double erp = 0.2;
  double cfm = 1e-10;
};

/// A solver with a world of ODE's. Light bodies (core/physics/dynamics3d/body_proxy.hpp) take part in it only while
/// they touch something: a robot that drives freely costs ODE nothing.
class World3d final : public Solver {
 public:
  explicit World3d(const World3dSettings& settings) : settings_(settings) {}

  void load(const SolverContext& context) override;
  void advance(const SolverContext& context) override;
  bool remember(hal::Archive& archive) override;

 private:
  using OwnedProxy = std::unique_ptr<BodyProxy>;
  struct Held {
    std::size_t number;
    std::uint32_t generation;
    BodyKey a, b;
    BodyProxy* twin_a;
    BodyProxy* twin_b;
    OdeJoint joint;
    Vector3 at_a_m{}, at_b_m{};  // in the frames of ODE's bodies
    Vector3 free{};              // of a sliding one: where it slides, in a's frame; else 0
  };

  template <class Work>
  void guarded(const SolverContext& context, Work&& work);
  void drop_world() noexcept;
  void report(const BodyProxy& proxy, std::string what);

  void make_world();
  void place_stills(const SolverContext& context);
  OwnedProxy make(const SpaceStores& stores, BodyKey key);
  void drop_proxy(OwnedProxy& proxy);
  void take_over(const SpaceStores& stores, OwnedProxy& proxy, double tick_s);
  void lead(BodyProxy& proxy, const BodyState& at, double tick_s) const;
  void join(const SpaceStores& stores);
  OdeJoint make_joint(const Joint& joint, BodyProxy& a, BodyProxy& b);
  BodyProxy* find(BodyKey key) noexcept;
  void remember(hal::Archive& archive, BodyProxy& proxy) const;
  void find_kinds(const SpaceStores& stores);

  void plan(const SpaceStores& stores, BodyProxy& proxy, double dt_s);
  void find_candidates();
  bool may_touch(const BodyProxy& a, const BodyProxy& b) const noexcept;
  bool may_touch(const BodyProxy& a, const Still& still) const noexcept;
  void find_contacts();
  void enter(BodyProxy& proxy);
  void find_heaps();
  template <class Use>
  void each_heap(Use&& use);
  bool stands(std::size_t first, std::size_t past);
  void rest_heaps();
  void stop_heaps(double dt_s);
  void solve(double dt_s, std::uint64_t seed);
  void add_to_residual(const BodyProxy& proxy);
  void add_to_residual(const Held& held);
  void leave(BodyProxy& proxy, double dt_s);
  void check(BodyProxy& proxy);
  void write_back(SpaceStores& stores, const BodyProxy& proxy, double tick_s) const;

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
  BodyTable<OwnedProxy> bodies_table_;
  std::vector<Held> held_;
  std::vector<BodyProxy*> solved_;  // those that are in ODE in this sub-step
  Residual residual_;
  PairFinder finder_;
  std::vector<PairFinder::Pair> candidates_;

  struct HeapMember {
    const BodyProxy* top;
    BodyProxy* proxy;
  };
  struct HeapSupport {
    BodyKey top;           // of the heap's top
    std::uint32_t number;  // of the contacts' supports
  };
  std::vector<HeapMember> heaps_;           // of this sub-step, heap by heap
  std::vector<HeapSupport> heap_supports_;  // of these, heap by heap
  std::vector<BodyProxy*> heap_;            // the one that is looked at
  std::vector<Support> supports_;
  Standing standing_;
  std::vector<std::uint64_t> stood_, stands_now_;  // fingerprints of heaps that stood in the last sub-step, and in this
};

}  // namespace tandem::core
