// Loop functions: the code of an experiment around its robots.
#ifndef TANDEM_ARGOS3_LOOP_FUNCTIONS_H
#define TANDEM_ARGOS3_LOOP_FUNCTIONS_H
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/simulator/entity/positional_entity.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/core/utility/math/vector3.h>
#include <argos3/core/utility/plugins/factory.h>
#include <string>

namespace argos {

/// A tick of a run: robots act, bodies move, PreStep, robots sense and step, PostStep, IsExperimentFinished. PostStep
/// sees the poses that controllers sensed. An exception ends the run, with its text.
class CLoopFunctions : public CBaseConfigurableResource {
 public:
  CLoopFunctions();
  virtual ~CLoopFunctions();

  /// Before the first tick, when robots and controllers are there. `tree` is the element <loop_functions>.
  virtual void Init(TConfigurationNode& /*tree*/) {}
  /// The run begins again: robots and things are at their first places, controllers were reset.
  virtual void Reset() {}
  virtual void Destroy() {}
  virtual void PreStep() {}
  virtual void PostStep() {}
  virtual bool IsExperimentFinished() { return false; }
  virtual void PostExperiment() {}
  /// Asked for every pixel of <floor source="loop_functions"/>, and again after CFloorEntity::SetChanged. Ground
  /// sensors see its shade of grey.
  virtual CColor GetFloorColor(const CVector2& /*position*/) { return CColor::WHITE; }

  CSimulator& GetSimulator() { return m_cSimulator; }
  CSpace& GetSpace() { return m_cSpace; }
  const CSpace& GetSpace() const { return m_cSpace; }

  virtual void MoveEntity(CPositionalEntity& entity, const CVector3& position, const CQuaternion& orientation);
  /// As CEmbodiedEntity::MoveTo.
  virtual bool MoveEntity(CEmbodiedEntity& entity, const CVector3& position, const CQuaternion& orientation,
                          bool check_only = false, bool ignore_collisions = false);
  /// Takes the entity over. Its place may be occupied: the engine then parts the bodies. @throws CARGoSException when
  /// its id is taken, its place is outside the arena, its controller cannot be made
  virtual void AddEntity(CEntity& entity);
  /// Deletes the entity at the end of PreStep, PostStep or whatever goes on; until then it can be looked at.
  /// @throws CARGoSException when it is not in the space
  virtual void RemoveEntity(const std::string& id);
  virtual void RemoveEntity(CEntity& entity);
  void IterateOverControllableEntities(const CSpace::TControllableEntityIterCBType& call) const {
    m_cSpace.IterateOverControllableEntities(call);
  }

 private:
  CSimulator& m_cSimulator;
  CSpace& m_cSpace;
};

}  // namespace argos

#define REGISTER_LOOP_FUNCTIONS(CLASSNAME, LABEL) \
  TANDEM_ARGOS3_REGISTER("loop functions", ::argos::CLoopFunctions, CLASSNAME, LABEL, __COUNTER__)

#endif
