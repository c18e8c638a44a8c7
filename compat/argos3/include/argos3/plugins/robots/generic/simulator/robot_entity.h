// What all robots of the space have in common.
#ifndef TANDEM_ARGOS3_ROBOT_ENTITY_H
#define TANDEM_ARGOS3_ROBOT_ENTITY_H
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/plugins/simulator/entities/battery_equipped_entity.h>
#include <argos3/plugins/simulator/entities/led_equipped_entity.h>
#include <argos3/plugins/simulator/entities/rab_equipped_entity.h>
#include <argos3/plugins/simulator/entities/wheeled_entity.h>
#include <string>

namespace argos {

/// A robot of any of Tandem's kinds; foot-bot, e-puck and eye-bot have classes of their own.
class CRobotEntity : public CComposableEntity {
 public:
  CRobotEntity(const std::string& kind, const std::string& id, const std::string& controller,
               const CVector3& position = CVector3(), const CQuaternion& orientation = CQuaternion());
  ~CRobotEntity() override;

  CControllableEntity& GetControllableEntity() { return *m_pcController; }
  const CControllableEntity& GetControllableEntity() const { return *m_pcController; }
  CEmbodiedEntity& GetEmbodiedEntity() { return *m_pcBody; }
  const CEmbodiedEntity& GetEmbodiedEntity() const { return *m_pcBody; }
  CLEDEquippedEntity& GetLEDEquippedEntity() { return *m_pcLEDs; }
  CRABEquippedEntity& GetRABEquippedEntity() { return *m_pcRAB; }
  CBatteryEquippedEntity& GetBatterySensorEquippedEntity() { return *m_pcBattery; }
  std::string GetTypeDescription() const override { return m_strKind; }
  CAny AsAny() override;
  void JoinWorld() override;
  void LeaveWorld() override;
  bool FindInWorld() override;

  /// ARGoS gives the id of a robot that was removed again, Tandem once: a second "fb" is "fb~2" in the world.
  const std::string& GetIdInWorld() const { return m_strIdInWorld; }

  ARGOS3_NO_FUNCTION(GetGroundSensorEquippedEntity, "ask the controller for its sensor")
  ARGOS3_NO_FUNCTION(GetLightSensorEquippedEntity, "ask the controller for its sensor")
  ARGOS3_NO_FUNCTION(GetProximitySensorEquippedEntity, "ask the controller for its sensor")

 protected:
  CWheeledEntity& Wheels();

 private:
  std::string m_strKind, m_strIdInWorld;
  CControllableEntity* m_pcController;
  CEmbodiedEntity* m_pcBody;
  CLEDEquippedEntity* m_pcLEDs;
  CRABEquippedEntity* m_pcRAB;
  CBatteryEquippedEntity* m_pcBattery;
  CWheeledEntity* m_pcWheels;
};

}  // namespace argos

#endif
