// Cylinders.
#ifndef TANDEM_ARGOS3_CYLINDER_ENTITY_H
#define TANDEM_ARGOS3_CYLINDER_ENTITY_H
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/plugins/simulator/entities/led_equipped_entity.h>
#include <argos3/plugins/simulator/media/led_medium.h>
#include <string>

namespace argos {

/// In m and kg.
class CCylinderEntity : public CComposableEntity {
 public:
  CCylinderEntity();
  CCylinderEntity(const std::string& id, const CVector3& position, const CQuaternion& orientation, bool movable,
                  Real radius, Real height, Real mass = 1.0);
  ~CCylinderEntity() override;

  void EnableLEDs(CLEDMedium& medium);
  void DisableLEDs();
  /// Before the cylinder is added to the space.
  void AddLED(const CVector3& offset, const CColor& color = CColor::BLACK);
  CEmbodiedEntity& GetEmbodiedEntity() { return *m_pcBody; }
  const CEmbodiedEntity& GetEmbodiedEntity() const { return *m_pcBody; }
  CLEDEquippedEntity& GetLEDEquippedEntity() { return *m_pcLEDs; }
  const CLEDEquippedEntity& GetLEDEquippedEntity() const { return *m_pcLEDs; }
  Real GetRadius() const { return m_fRadius; }
  Real GetHeight() const { return m_fHeight; }
  /// @throws CARGoSException for what is no size
  void Resize(Real radius, Real height);
  Real GetMass() const { return m_fMass; }
  void SetMass(Real mass);
  std::string GetTypeDescription() const override;
  CAny AsAny() override;
  void JoinWorld() override;
  void LeaveWorld() override;
  bool FindInWorld() override;

 private:
  CEmbodiedEntity* m_pcBody;
  CLEDEquippedEntity* m_pcLEDs;
  Real m_fRadius, m_fHeight, m_fMass;
};

}  // namespace argos

#endif
