// Bodies of robots, boxes and cylinders.
#ifndef ARGOS3_CORE_SIMULATOR_ENTITY_EMBODIED_ENTITY_H
#define ARGOS3_CORE_SIMULATOR_ENTITY_EMBODIED_ENTITY_H

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/simulator/physics_engine/physics_model.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/vector3.h>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace argos {

/// A body of the world, under the number by which the world knows it. Stands on the ground or on its base, upright:
/// of an orientation the turn about z counts.
class CEmbodiedEntity : public CEntity {
 public:
  /// Number of a body in the world.
  struct SBody {
    enum EKind { NONE, ROBOT, OBJECT } Kind = NONE;
    std::uint32_t Index = 0, Generation = 0;
  };

  explicit CEmbodiedEntity(CComposableEntity* pc_parent);
  CEmbodiedEntity(CComposableEntity* pc_parent, const std::string& str_id, const CVector3& c_position = CVector3(),
                  const CQuaternion& c_orientation = CQuaternion(), bool b_movable = true);
  ~CEmbodiedEntity() override;

  bool IsMovable() const;
  /// Throws on a robot.
  void SetMovable(bool b_movable);

  /// Anchors are where their body was in this phase of the tick.
  const SAnchor& GetOriginAnchor() const { return *m_psOriginAnchor; }
  SAnchor& GetOriginAnchor() { return *m_psOriginAnchor; }
  SAnchor& AddAnchor(const std::string& str_id, const CVector3& c_offset_position = CVector3(),
                     const CQuaternion& c_offset_orientation = CQuaternion());
  void EnableAnchor(const std::string& str_id);
  void DisableAnchor(const std::string& str_id);
  bool IsAnchorEnabled(const std::string& str_id);
  /// Throws: there is none of that name.
  const SAnchor& GetAnchor(const std::string& str_id) const;
  SAnchor& GetAnchor(const std::string& str_id);
  std::map<std::string, SAnchor*>& GetAnchors() { return m_mapAnchors; }
  const SBoundingBox& GetBoundingBox() const;
  void CalculateBoundingBox();

  /// Puts the body there at once. False: something is in the way, or the place is outside the arena; the body stays
  /// where it is. `b_check_only`: it stays in any case. `b_ignore_collisions`: what is in the way does not matter.
  virtual bool MoveTo(const CVector3& c_position, const CQuaternion& c_orientation, bool b_check_only = false,
                      bool b_ignore_collisions = false);
  virtual bool IsCollidingWithSomething() const;
  std::string GetTypeDescription() const override;
  void Reset() override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(GetPhysicsModel, "bodies belong to Tandem's engines; use GetOriginAnchor, MoveTo, GetBoundingBox")
  ARGOS3_NO_FUNCTION(AddPhysicsModel, "bodies belong to Tandem's engines; use CLoopFunctions::AddEntity")
  ARGOS3_NO_FUNCTION(RemovePhysicsModel, "bodies belong to Tandem's engines; use CLoopFunctions::RemoveEntity")
  ARGOS3_NO_FUNCTION(GetPhysicsModelsNum, "bodies belong to Tandem's engines")

  // --- for the space ---
  const SBody& GetBody() const { return m_sBody; }
  void SetBody(const SBody& s_body);
  const CVector3& GetInitPosition() const { return m_cInitPosition; }
  const CQuaternion& GetInitOrientation() const { return m_cInitOrientation; }
  /// Takes the anchors over from the world.
  void ReadWorld() const;

 private:
  SBody m_sBody;
  SAnchor* m_psOriginAnchor;
  std::map<std::string, SAnchor*> m_mapAnchors;
  CVector3 m_cInitPosition;
  CQuaternion m_cInitOrientation;
  bool m_bMovable;
  mutable SBoundingBox m_sBoundingBox;
};

typedef std::vector<CEmbodiedEntity*> TEmbodiedEntityVector;
typedef std::map<std::string, CEmbodiedEntity*> TEmbodiedEntityMap;

bool operator==(const SAnchor* ps_anchor, const std::string& str_id);

}  // namespace argos

#endif
