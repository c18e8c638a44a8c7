// ODE as this engine uses it: started once, silent, and with the same results on any thread.
#pragma once
#include <cstdint>
#include <ode/ode.h>
#include <stdexcept>
#include <utility>

#include "core/physics/world_memory.hpp"

namespace tandem::core {

/// ODE found an argument or a state that it cannot go on with. Its world is not to be used any more.
struct OdeError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Call before ODE is used, on every thread that uses it and while no WorldMemory is in use; cheap after a thread's
/// first time. From then on ODE throws OdeError where it would print and end the process, and takes its memory from the
/// WorldMemory in use.
void use_ode();

/// ODE shuffles the order in which it treats constraints, with random numbers that all threads share. Here every thread
/// has its own, which start again from `seed`.
void seed_ode(std::uint64_t seed) noexcept;

/// Names one of ODE's things. These live in the memory of their world and go with it; so may a copy of the name.
template <class Id, void (*kDestroy)(Id)>
class OdeHandle {
 public:
  OdeHandle() = default;
  explicit OdeHandle(Id id) noexcept : id_(id) {}
  /// Ends it before its world.
  void destroy() noexcept {
    if (id_ != nullptr) kDestroy(std::exchange(id_, nullptr));
  }
  Id get() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ != nullptr; }

 private:
  Id id_ = nullptr;
};

/// Writes what a handle names, which lies in `memory`, or reads it.
template <class Id, void (*kDestroy)(Id)>
void remember_handle(const WorldMemory& memory, hal::Archive& archive, OdeHandle<Id, kDestroy>& handle) {
  Id id = handle.get();
  memory.remember_pointer(archive, id);
  handle = OdeHandle<Id, kDestroy>(id);
}

using OdeThreading = OdeHandle<dThreadingImplementationID, &dThreadingFreeImplementation>;
using OdeWorld = OdeHandle<dWorldID, &dWorldDestroy>;
using OdeBody = OdeHandle<dBodyID, &dBodyDestroy>;
using OdeJoint = OdeHandle<dJointID, &dJointDestroy>;
using OdeJointGroup = OdeHandle<dJointGroupID, &dJointGroupDestroy>;

/// Owns a shape for ODE's contact finders. All worlds' shapes share memory within ODE, so they lie on the heap; a copy
/// has none, and is to be given one of its own when that is needed.
class OdeGeom {
 public:
  OdeGeom() = default;
  /// `make` calls ODE.
  template <class Make>
  static OdeGeom made_by(Make&& make) {
    const WorldMemory::Use heap(nullptr);
    OdeGeom geom;
    geom.id_ = make();
    return geom;
  }
  OdeGeom(const OdeGeom& /*other*/) noexcept {}
  OdeGeom(OdeGeom&& other) noexcept : id_(std::exchange(other.id_, nullptr)) {}
  OdeGeom& operator=(OdeGeom other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~OdeGeom() {
    const WorldMemory::Use heap(nullptr);
    if (id_ != nullptr) dGeomDestroy(id_);
  }
  dGeomID get() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ != nullptr; }

 private:
  dGeomID id_ = nullptr;
};

}  // namespace tandem::core
