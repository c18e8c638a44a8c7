// Static equilibrium: whether objects that lie on one another can stay where they are.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/physics/dynamics3d/body_proxy.hpp"

namespace tandem::core {

/// A place where an object touches another, or something that does not move.
struct Support {
  BodyProxy* a = nullptr;
  BodyProxy* b = nullptr;  ///< null: does not move
  Vector3 p_m{};           ///< in W
  Vector3 normal{};        ///< unit vector in W from b to a
  double friction = 0.0;
  double depth_m = 0.0;  ///< negative: the gap
};

/// Whether forces at the contacts, pushing and within the friction's pyramid, can carry the objects against gravity.
/// Where they can, rigid bodies at rest stay at rest. ODE's passes come near to that, but never quite, and not the same
/// way every time: over minutes, a stack walks and topples.
///
/// The forces are those with which the objects would have the least energy after a sub-step; each pyramid's force is a
/// sum of pushes along its edges. That is a least-squares problem with bounds. It is solved in its dual, which has six
/// unknowns an object and is smooth, by Newton's method [Hiriart-Urruty et al. 1984]. A pure function of its arguments.
class Standing {
 public:
  static constexpr std::size_t kMostObjects = 40;  ///< the time that it takes grows with their cube

  /// `objects`, where they were before the sub-step, are all those of `supports`. False for more than kMostObjects.
  bool stands(const std::vector<BodyProxy*>& objects, const std::vector<Support>& supports, double gravity_m_s2);

 private:
  /// Momenta are in units in which every object's energy is half their square.
  struct Body {
    double mass_root = 0.0, reach_m = 0.0;
    std::array<double, 9> spin_root{};  ///< the inverse root of the inertia about each axis, times that axis in W
    Vector3 p_m{};
  };
  /// What a push along one edge of a pyramid does to the one or two bodies that it acts on.
  struct Edge {
    std::size_t a = 0, b = 0;  ///< first of a body's six numbers; kNobody: does not move
    std::array<double, 6> on_a{}, on_b{};
  };
  void add_edges(const Support& support, std::size_t a, std::size_t b);
  double along(const Edge& edge, const std::vector<double>& x) const noexcept;
  double dual_energy(const std::vector<double>& x) const noexcept;
  bool newton_target(bool all) noexcept;
  double fastest_left() noexcept;

  std::vector<Body> bodies_;
  std::vector<Edge> edges_;
  std::vector<double> weight_;  // what gravity gives
  std::vector<double> x_, target_, tried_, matrix_;
  double softness_ = 0.0;
};

}  // namespace tandem::core
