// Kinematics in the plane: wheels roll without slip, discs that overlap are pushed apart. No forces, no masses.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/physics/solver.hpp"

namespace tandem::core {

/// Differential-drive kinematics [Siegwart et al. 2011, ch. 3], exact for constant wheel speeds over a tick. Contacts
/// are resolved by moving overlapping discs apart by half the overlap each, and out of walls, objects and the bodies of
/// other engines wholly: a few passes a tick, each computed from the positions of the one before, so that neither
/// order nor threads matter. Where a crowd is so dense that these leave overlaps, it gets more passes, alone, and who
/// is deep in another even then goes back towards where it was before the tick. All its regions are worked on as one: a
/// split changes nothing.
class Kinematics2d final : public Engine {
 public:
  struct Params {
    std::int64_t iterations = 0;
    void describe(hal::ParamVisitor& v) {
      v.integer(
          "iterations", iterations, {0, 1000},
          "Passes of contact resolution a tick, at most. 0: 4, and up to 400 where robots are then still in one "
          "another by more than 1 % of their diameter; who is that deep even then goes back towards where it was.");
    }
  };
  explicit Kinematics2d(const Params& params) : params_(params) {}

  std::string_view kind() const noexcept override { return "kinematics2d"; }
  /// One, but for ticks so long that a robot rolls farther than half its radius in one.
  int parts(const PhysicsContext& context) const override;
  void advance(const PhysicsContext& context) override;
  void settle(const PhysicsContext& context) override;
  void collect(std::vector<Trouble>& all) override;
  PhysicsAccuracy accuracy() const override { return accuracy_; }

 private:
  /// An entry of the index that is near enough to something to touch it, and where it is pushed to in this pass.
  struct Active {
    std::uint32_t entry;
    double push_x_m, push_y_m;
  };
  class Settling;

  Params params_;
  std::atomic<const SpaceStores*> too_fast_in_{nullptr};  // where bodies are, in this tick
  std::unique_ptr<Active[]>
      active_;  // a list for every chunk of entries, with room for all; unused ends stay untouched
  std::vector<std::uint32_t> counts_;  // how long each is
  /// By entry: in a dense place, which has passes beyond the first ones: in this pass, and in the next.
  std::vector<std::uint8_t> dense_, dense_next_;
  std::vector<std::uint8_t> went_back_;  // by entry: how often, in this tick
  double part_s_ = 0.0;                  // of the tick, in which bodies rolled last
  PhysicsAccuracy accuracy_;
};

/// `<kinematics2d>`.
const EngineType& kinematics2d_type();

inline void register_kinematics2d(hal::Registrar& registrar) {
  register_engine(registrar, kinematics2d_type());
}

}  // namespace tandem::core
