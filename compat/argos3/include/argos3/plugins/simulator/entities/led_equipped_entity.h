// The LEDs of a robot, a box or a cylinder.
#ifndef TANDEM_ARGOS3_LED_EQUIPPED_ENTITY_H
#define TANDEM_ARGOS3_LED_EQUIPPED_ENTITY_H
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/physics_engine/physics_model.h>
#include <argos3/plugins/simulator/entities/led_entity.h>
#include <map>
#include <string>
#include <vector>

namespace argos {

/// A robot shows the colours of its LED actuator: colours that are set here last until its controller sets others. Without that
/// actuator in its configuration they cannot be set.
class CLEDEquippedEntity : public CComposableEntity {
 public:
  typedef std::map<std::string, CLEDEquippedEntity*> TMap;
  struct SActuator {
    typedef std::vector<SActuator*> TList;
    CLEDEntity& LED;
    CVector3 Offset;
    SAnchor& Anchor;
    SActuator(CLEDEntity& led, const CVector3& offset, SAnchor& anchor) : LED(led), Offset(offset), Anchor(anchor) {}
  };

  explicit CLEDEquippedEntity(CComposableEntity* parent);
  CLEDEquippedEntity(CComposableEntity* parent, const std::string& id);
  ~CLEDEquippedEntity() override;

  /// Before the box or cylinder is added to the space.
  void AddLED(const CVector3& offset, SAnchor& anchor, const CColor& color = CColor::BLACK);
  CLEDEntity& GetLED(UInt32 number);
  SActuator::TList& GetLEDs();
  const CVector3& GetLEDOffset(size_t number);
  void SetLEDColor(UInt32 number, const CColor& color);
  void SetAllLEDsColors(const CColor& color);
  void SetAllLEDsColors(const std::vector<CColor>& colors);
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(SetLEDOffset, "LEDs stay where the robot's kind or the file puts them")
  ARGOS3_NO_FUNCTION(SetMedium, "name the medium in the experiment file: <leds medium=\"…\"/>")

 private:
  void FindLEDs();
  SActuator::TList m_tLEDs;
};

}  // namespace argos

#endif
