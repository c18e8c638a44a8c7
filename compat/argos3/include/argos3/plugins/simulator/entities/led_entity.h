// Lights that cameras see.
#ifndef TANDEM_ARGOS3_LED_ENTITY_H
#define TANDEM_ARGOS3_LED_ENTITY_H
#include <argos3/core/simulator/entity/positional_entity.h>
#include <argos3/core/utility/datatypes/color.h>

namespace argos {

class CLEDEquippedEntity;

class CLEDEntity : public CPositionalEntity {
 public:
  explicit CLEDEntity(CComposableEntity* parent);
  CLEDEntity(CComposableEntity* parent, const std::string& id, const CVector3& position, const CColor& color);
  ~CLEDEntity() override;

  const CColor& GetColor() const;
  /// Cameras see LEDs that the robot's configuration lists.
  const CColor& GetInitColor() const { return m_cInitColor; }
  virtual void SetColor(const CColor& color);
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

 protected:
  friend class CLEDEquippedEntity;
  mutable CColor m_cColor;
  CColor m_cInitColor;
  CLEDEquippedEntity* m_pcOwner = nullptr;  ///< whose LED it is
  UInt32 m_unNumber = 0;
  bool m_bUnlisted = false;
};

}  // namespace argos

#endif
