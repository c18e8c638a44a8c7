// The tick of the physics, engines by name, and rays through the space.
#ifndef ARGOS3_CORE_SIMULATOR_PHYSICS_ENGINE_PHYSICS_ENGINE_H
#define ARGOS3_CORE_SIMULATOR_PHYSICS_ENGINE_PHYSICS_ENGINE_H

#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/ray2.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/vector3.h>
#include <map>
#include <string>
#include <vector>

namespace argos {

class CEmbodiedEntity;
class CEntity;

/// A body that a ray hits, and where: 0 at the ray's start, 1 at its end.
struct SEmbodiedEntityIntersectionItem {
  CEmbodiedEntity* IntersectedEntity;
  Real TOnRay;

  SEmbodiedEntityIntersectionItem() : IntersectedEntity(nullptr), TOnRay(1) {}
  SEmbodiedEntityIntersectionItem(CEmbodiedEntity* pc_entity, Real f_t_on_ray)
      : IntersectedEntity(pc_entity), TOnRay(f_t_on_ray) {}
  bool operator<(const SEmbodiedEntityIntersectionItem& s_other) const { return TOnRay < s_other.TOnRay; }
};
typedef std::vector<SEmbodiedEntityIntersectionItem> TEmbodiedEntityIntersectionData;

/// All bodies that the ray hits, nearest first. Bodies are upright cylinders and boxes. @returns whether there are any.
bool GetEmbodiedEntitiesIntersectedByRay(TEmbodiedEntityIntersectionData& t_data, const CRay3& c_ray);
/// The nearest one.
bool GetClosestEmbodiedEntityIntersectedByRay(SEmbodiedEntityIntersectionItem& s_item, const CRay3& c_ray);
/// The nearest one except `c_entity`.
bool GetClosestEmbodiedEntityIntersectedByRay(SEmbodiedEntityIntersectionItem& s_item, const CRay3& c_ray,
                                              CEmbodiedEntity& c_entity);

/// An engine that the experiment file names. Tandem's own do the work: what belongs to an ARGoS engine alone is not
/// here.
class CPhysicsEngine {
 public:
  typedef std::vector<CPhysicsEngine*> TVector;
  typedef std::map<std::string, CPhysicsEngine*> TMap;

  CPhysicsEngine(const std::string& str_id, UInt32 un_iterations) : m_strId(str_id), m_unIterations(un_iterations) {}

  /// In s.
  static Real GetSimulationClockTick();
  /// In 1/s.
  static Real GetInverseSimulationClockTick();
  UInt32 GetIterations() const { return m_unIterations; }
  Real GetPhysicsClockTick() const { return GetSimulationClockTick() / static_cast<Real>(m_unIterations); }
  const std::string& GetId() const { return m_strId; }

  ARGOS3_NO_FUNCTION(AddEntity, "use CLoopFunctions::AddEntity")
  ARGOS3_NO_FUNCTION(RemoveEntity, "use CLoopFunctions::RemoveEntity")
  ARGOS3_NO_FUNCTION(Update, "the engines are Tandem's, and step with the run")
  ARGOS3_NO_FUNCTION(SetSimulationClockTick, "set ticks_per_second in the experiment file")
  ARGOS3_NO_FUNCTION(CheckIntersectionWithRay, "use GetEmbodiedEntitiesIntersectedByRay")

 private:
  std::string m_strId;
  UInt32 m_unIterations;
};

}  // namespace argos

#define REGISTER_PHYSICS_ENGINE(...) \
  ARGOS3_NOT_CARRIED_OVER("own physics engines: make a Tandem plug-in, docs/plugins.md")

#endif
