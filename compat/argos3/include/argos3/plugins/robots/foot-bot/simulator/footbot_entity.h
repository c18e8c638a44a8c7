// Foot-bots.
#ifndef TANDEM_ARGOS3_FOOTBOT_ENTITY_H
#define TANDEM_ARGOS3_FOOTBOT_ENTITY_H
#include <argos3/core/utility/math/angles.h>
#include <argos3/plugins/robots/generic/simulator/robot_entity.h>

namespace argos {

class CFootBotEntity : public CRobotEntity {
 public:
  CFootBotEntity();
  /// `controller` is the id of a configuration of the experiment file. Radio, cameras and battery are those of the
  /// file's first foot-bot with it, or the defaults: what is asked for here beyond that is told once.
  CFootBotEntity(const std::string& id, const std::string& controller, const CVector3& position = CVector3(),
                 const CQuaternion& orientation = CQuaternion(), Real rab_range = 3.0, size_t rab_data_size = 10,
                 const std::string& battery_model = "",
                 const CRadians& omnidirectional_aperture = ToRadians(CDegrees(70.0)), bool perspective_front = true,
                 const CRadians& perspective_aperture = ToRadians(CDegrees(30.0)), Real focal_length = 0.035,
                 Real perspective_range = 2.0);
  ~CFootBotEntity() override;
  CWheeledEntity& GetWheeledEntity() { return Wheels(); }
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(GetTurretEntity, "ask the controller for its turret encoder")
  ARGOS3_NO_FUNCTION(GetGripperEquippedEntity, "ask the controller for its gripper")
  ARGOS3_NO_FUNCTION(GetDistanceScannerEquippedEntity, "ask the controller for its distance scanner")
  ARGOS3_NO_FUNCTION(GetOmnidirectionalCameraEquippedEntity, "ask the controller for its camera")
  ARGOS3_NO_FUNCTION(GetPerspectiveCameraEquippedEntity, "ask the controller for its camera")
};

}  // namespace argos

#endif
