// Kinematics in the plane: wheels roll without slip, discs that overlap are pushed apart. No forces, no masses.
#pragma once
#include <cstdint>
#include <vector>

#include "core/physics/engine.hpp"

namespace tandem::core {

/// Differential-drive kinematics [Siegwart et al. 2011, ch. 3], exact for constant wheel speeds over a tick. Contacts
/// are resolved by moving overlapping discs apart by half the overlap each, and out of walls, objects and the bodies of
/// other engines wholly: a few passes a tick, each computed from the positions of the one before, so that neither
/// order nor threads matter. All its regions are worked on as one: a split changes nothing.
class Kinematics2d final : public Engine {
 public:
  struct Params {
    std::int64_t iterations = 4;
    void describe(hal::ParamVisitor& v) {
      v.integer("iterations", iterations, {1, 100}, "Passes of contact resolution a tick, at most.");
    }
  };
  explicit Kinematics2d(const Params& params) : params_(params) {}

  std::string_view kind() const noexcept override { return "kinematics2d"; }
  void advance(const PhysicsContext& context) override;
  void settle(const PhysicsContext& context) override;

 private:
  struct Push {
    double x_m = 0.0;
    double y_m = 0.0;
  };

  Params params_;
  std::vector<Push> push_;            // by entry of the index
  std::vector<std::uint8_t> active_;  // by entry: near enough to touch something
};

}  // namespace tandem::core
