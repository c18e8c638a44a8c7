// Boxes.
#ifndef TANDEM_ARGOS3_BOX_ENTITY_H
#define TANDEM_ARGOS3_BOX_ENTITY_H
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/plugins/simulator/entities/led_equipped_entity.h>
#include <argos3/plugins/simulator/media/led_medium.h>
#include <string>

namespace argos {

/// In m and kg.
class CBoxEntity : public CComposableEntity {
 public:
  CBoxEntity();
  CBoxEntity(const std::string& id, const CVector3& position, const CQuaternion& orientation, bool movable,
             const CVector3& size, Real mass = 1.0);
  ~CBoxEntity() override;

  /// Cameras see LEDs of all boxes that have some; the medium is that of the experiment file.
  void EnableLEDs(CLEDMedium& medium);
  void DisableLEDs();
  /// Before the box is added to the space.
  void AddLED(const CVector3& offset, const CColor& color = CColor::BLACK);
  CEmbodiedEntity& GetEmbodiedEntity() { return *m_pcBody; }
  const CEmbodiedEntity& GetEmbodiedEntity() const { return *m_pcBody; }
  CLEDEquippedEntity& GetLEDEquippedEntity() { return *m_pcLEDs; }
  const CLEDEquippedEntity& GetLEDEquippedEntity() const { return *m_pcLEDs; }
  const CVector3& GetSize() const { return m_cSize; }
  /// @throws CARGoSException for what is no size
  void Resize(const CVector3& size);
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
  CVector3 m_cSize;
  Real m_fMass;
};

}  // namespace argos

#endif
