// Entities with a place and no body.
#ifndef ARGOS3_CORE_SIMULATOR_ENTITY_POSITIONAL_ENTITY_H
#define ARGOS3_CORE_SIMULATOR_ENTITY_POSITIONAL_ENTITY_H

#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CPositionalEntity : public CEntity {
 public:
  explicit CPositionalEntity(CComposableEntity* pc_parent);
  CPositionalEntity(CComposableEntity* pc_parent, const std::string& str_id, const CVector3& c_position = CVector3(),
                    const CQuaternion& c_orientation = CQuaternion());
  ~CPositionalEntity() override;

  void Reset() override;
  const CVector3& GetPosition() const { return m_cPosition; }
  const CVector3& GetInitPosition() const { return m_cInitPosition; }
  void SetPosition(const CVector3& c_position) { MoveTo(c_position, m_cOrientation); }
  void SetInitPosition(const CVector3& c_position) { m_cInitPosition = c_position; }
  const CQuaternion& GetOrientation() const { return m_cOrientation; }
  const CQuaternion& GetInitOrientation() const { return m_cInitOrientation; }
  void SetOrientation(const CQuaternion& c_orientation) { MoveTo(m_cPosition, c_orientation); }
  void SetInitOrientation(const CQuaternion& c_orientation) { m_cInitOrientation = c_orientation; }
  virtual void MoveTo(const CVector3& c_position, const CQuaternion& c_orientation);
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

 protected:
  CVector3 m_cPosition, m_cInitPosition;
  CQuaternion m_cOrientation, m_cInitOrientation;
};

}  // namespace argos

#endif
