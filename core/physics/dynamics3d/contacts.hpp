// Contacts of one sub-step: where bodies are near one another, constraints that keep them from passing into each other.
#pragma once
#include <array>
#include <vector>

#include "core/physics/dynamics3d/body_proxy.hpp"
#include "core/physics/dynamics3d/residual.hpp"
#include "core/physics/dynamics3d/standing.hpp"

namespace tandem::core {

/// Something that does not move.
struct Still {
  Prism prism;
  double height_m = 0.0;
  bool wall = false;                              ///< of the region: holds the region's own bodies only
  std::array<double, 4> q_W{1.0, 0.0, 0.0, 0.0};  ///< of one that leans: as it stands in W
  OdeGeom geom;                                   ///< made when something that leans comes near
};

/// Contact parameters.
struct Surfaces {
  double floor_m = 0.0;
  double ceiling_m = 0.0;        ///< infinite where there is none
  double floor_friction = 1.0;   ///< Coulomb's coefficients: objects on the floor
  double wheel_friction = 1.0;   ///< wheels on the floor
  double object_friction = 1.0;  ///< objects on one another and on what does not move
  double robot_friction = 0.1;   ///< the rims of robots on whatever they touch
};

/// The one that stands for all objects of its heap: those that touch one another, directly or through others. Shortens
/// the way for the next caller.
inline BodyProxy& top_of_heap(BodyProxy& proxy) noexcept {
  BodyProxy* top = &proxy;
  while (top->heap != nullptr) {
    if (top->heap->heap != nullptr) top->heap = top->heap->heap;
    top = top->heap;
  }
  return *top;
}

/// Makes ODE's contact joints. ODE itself sees a contact when bodies overlap already; those made here start while there
/// is a gap, and allow just the approach that closes it within the sub-step. So bodies meet instead of overlapping and
/// being pushed apart.
class Contacts {
 public:
  /// Call once a world is made.
  void make_group() { group_ = OdeJointGroup(dJointGroupCreate(0)); }

  OdeJointGroup& group() noexcept { return group_; }

  /// `residual` gets to know every contact.
  void begin(dWorldID world, double dt_s, Residual& residual) noexcept {
    overlap_ = overlap_in_flight_ = 0.0;
    world_ = world;
    dt_s_ = dt_s;
    residual_ = &residual;
    supports_.clear();
  }
  void between(BodyProxy& a, BodyProxy& b, const Surfaces& surfaces);
  void with_still(BodyProxy& a, Still& still, const Surfaces& surfaces);
  /// With floor and ceiling; of what lives in ODE.
  void with_ground(BodyProxy& a, const Surfaces& surfaces);
  /// Where objects touch one another and what does not move, in this sub-step.
  const std::vector<Support>& supports() const noexcept { return supports_; }
  /// How deep two robots that drive are in one another, at most, in parts of the narrower one's diameter.
  double overlap() const noexcept { return overlap_; }
  /// As `overlap`, of robots of which one flies.
  double overlap_in_flight() const noexcept { return overlap_in_flight_; }
  /// Ends the sub-step.
  void clear() { dJointGroupEmpty(group_.get()); }

 private:
  struct Grip {
    double along = 0.0;  ///< friction along the first direction, and across it
    double across = 0.0;
    bool level = false;  ///< the first direction is level, whichever way the bodies slide
  };
  void touch(BodyProxy& a, BodyProxy* b);
  void note_support(BodyProxy& a, BodyProxy* b, const Touch& at, const Grip& grip);
  void add(BodyProxy& a, BodyProxy* b, const Touch& touch, const Grip& grip);
  void join(dBodyID a, dBodyID b, const Touch& touch, const Grip& grip, const Vector3& first);
  void lean(BodyProxy& a, BodyProxy* b, dGeomID geom_b, const Prism& prism_b, const Grip& grip);
  void support(BodyProxy& a, double level_m, double up, const Grip& grip);
  void ends_of_cylinder(BodyProxy& a, double level_m, double up, const Grip& grip);
  void point_on_level(BodyProxy& a, const Vector3& p_m, double level_m, double up, const Grip& grip);
  void wheels_on_floor(BodyProxy& a, const Surfaces& surfaces);

  dWorldID world_ = nullptr;
  double dt_s_ = 0.0;
  Residual* residual_ = nullptr;  // of the sub-step
  OdeJointGroup group_;
  std::vector<Support> supports_;
  double overlap_ = 0.0, overlap_in_flight_ = 0.0;
};

}  // namespace tandem::core
