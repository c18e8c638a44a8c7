// The space: entities by id and by type, the clock, the arena.
#ifndef TANDEM_ARGOS3_SPACE_H
#define TANDEM_ARGOS3_SPACE_H
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/simulator/medium/medium.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/any.h>
#include <argos3/core/utility/math/range.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/vector3.h>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace argos {

class CFloorEntity;
class CSimulator;

/// Entities of the world that runs in this process. Components are found under "robot.component".
class CSpace {
 public:
  typedef std::map<std::string, CAny> TMapPerType;
  typedef std::map<std::string, TMapPerType> TMapPerTypePerId;
  typedef std::function<void(CControllableEntity*)> TControllableEntityIterCBType;

  CSpace(const CSpace&) = delete;
  CSpace& operator=(const CSpace&) = delete;

  UInt32 GetNumberEntities();
  CEntity::TVector& GetEntityVector();
  /// Robots, boxes, cylinders, lights, the floor.
  CEntity::TVector& GetRootEntityVector();
  /// @throws CARGoSException when there is none
  CEntity& GetEntity(const std::string& id);
  /// Adds those whose id fits the pattern, a regular expression.
  void GetEntitiesMatching(CEntity::TVector& found, const std::string& pattern);
  CEntity::TMap& GetEntityMapPerId();
  TMapPerTypePerId& GetEntityMapPerTypePerId();
  /// Those of a type: "foot-bot", "e-puck", "eye-bot", "box", "cylinder", "light", "floor", "controller", "body", … A
  /// loop over them may remove the entity that it looks at. @throws CARGoSException when there are none, and names the
  /// types that there are
  TMapPerType& GetEntitiesByType(const std::string& type);
  const TMapPerType& GetEntitiesByType(const std::string& type) const;

  /// @throws CARGoSException when the experiment has no <floor>
  CFloorEntity& GetFloorEntity();

  void AddEntity(CEntity& entity);
  void RemoveEntity(CEntity& entity);
  /// In the order of the robots, by the caller's thread.
  void IterateOverControllableEntities(const TControllableEntityIterCBType& call);

  /// Ticks: 1 in the first one, 0 before it.
  UInt32 GetSimulationClock() const;
  const CVector3& GetArenaSize() const;
  const CVector3& GetArenaCenter() const;
  const CRange<CVector3>& GetArenaLimits() const;

  ARGOS3_NO_FUNCTION(Update, "the run steps the world; a program of one's own calls CSimulator::UpdateSpace")
  ARGOS3_NO_FUNCTION(SetArenaSize, "set the arena's size in the experiment file")
  ARGOS3_NO_FUNCTION(SetArenaCenter, "set the arena's center in the experiment file")
  ARGOS3_NO_FUNCTION(SetSimulationClock, "the run has the clock")
  ARGOS3_NO_FUNCTION(IncreaseSimulationClock, "the run has the clock")

 private:
  friend class CSimulator;
  friend class CSpaceAccess;
  CSpace();
  ~CSpace();
  struct SState;
  SState& Filled() const;
  SState* m_psState;
};

}  // namespace argos

#endif
