// The battery of a robot.
#ifndef TANDEM_ARGOS3_BATTERY_EQUIPPED_ENTITY_H
#define TANDEM_ARGOS3_BATTERY_EQUIPPED_ENTITY_H
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

/// The charge is that of the battery sensor's robot: 1 where its configuration has no such sensor.
class CBatteryEquippedEntity : public CEntity {
 public:
  CBatteryEquippedEntity(CComposableEntity* parent, const std::string& id);
  ~CBatteryEquippedEntity() override;

  Real GetFullCharge() const { return 1; }
  Real GetAvailableCharge() const;
  /// @throws CARGoSException when the robot's configuration has no battery sensor
  void SetAvailableCharge(Real charge);
  std::string GetTypeDescription() const override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(SetFullCharge, "set full_charge of <battery> in the experiment file")
  ARGOS3_NO_FUNCTION(SetDischargeModel, "set model of <battery> in the experiment file")
};

}  // namespace argos

#define REGISTER_BATTERY_DISCHARGE_MODEL(...) \
  ARGOS3_NOT_CARRIED_OVER("own discharge models: set the factors of <battery> in the experiment file")

#endif
