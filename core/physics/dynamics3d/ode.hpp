// ODE as this engine uses it: started once, silent, and with the same results on any thread.
#pragma once
#include <cstdint>
#include <ode/ode.h>
#include <stdexcept>
#include <utility>

namespace tandem::core {

/// ODE found an argument or a state that it cannot go on with. Its world is not to be used any more.
struct OdeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Call before ODE is used, on every thread that uses it; cheap after a thread's first time. From then on ODE throws
/// OdeError where it would print and end the process.
void use_ode();

/// ODE shuffles the order in which it treats constraints, with random numbers that all threads share. Here every thread
/// has its own, which start anew from `seed`.
void seed_ode(std::uint64_t seed) noexcept;

/// Owns one of ODE's things.
template <class Id, void (*kDestroy)(Id)>
class OdeOwner {
 public:
  OdeOwner() = default;
  explicit OdeOwner(Id id) noexcept : id_(id) {}
  OdeOwner(OdeOwner&& other) noexcept : id_(std::exchange(other.id_, nullptr)) {}
  OdeOwner& operator=(OdeOwner&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~OdeOwner() {
    if (id_ != nullptr) kDestroy(id_);
  }
  void reset() noexcept { *this = OdeOwner(); }
  Id get() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ != nullptr; }

 private:
  Id id_ = nullptr;
};

using OdeThreading = OdeOwner<dThreadingImplementationID, &dThreadingFreeImplementation>;
using OdeWorld = OdeOwner<dWorldID, &dWorldDestroy>;
using OdeBody = OdeOwner<dBodyID, &dBodyDestroy>;
using OdeJoint = OdeOwner<dJointID, &dJointDestroy>;
using OdeJointGroup = OdeOwner<dJointGroupID, &dJointGroupDestroy>;
using OdeGeom = OdeOwner<dGeomID, &dGeomDestroy>;

}  // namespace tandem::core
