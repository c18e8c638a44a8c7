// Eye-bots.
#ifndef TANDEM_ARGOS3_EYEBOT_ENTITY_H
#define TANDEM_ARGOS3_EYEBOT_ENTITY_H
#include <argos3/core/utility/math/angles.h>
#include <argos3/plugins/robots/generic/simulator/robot_entity.h>

namespace argos {

class CEyeBotEntity : public CRobotEntity {
 public:
  CEyeBotEntity();
  /// As for foot-bots.
  CEyeBotEntity(const std::string& id, const std::string& controller, const CVector3& position = CVector3(),
                const CQuaternion& orientation = CQuaternion(), Real rab_range = 3.0, size_t rab_data_size = 10,
                const std::string& battery_model = "", const CRadians& perspective_aperture = ToRadians(CDegrees(30.0)),
                Real focal_length = 0.035, Real perspective_range = 2.0);
  ~CEyeBotEntity() override;
  CAny AsAny() override;

  ARGOS3_NO_FUNCTION(GetQuadRotorEntity, "ask the controller for its quad-rotor actuator")
  ARGOS3_NO_FUNCTION(GetPerspectiveCameraEquippedEntity, "ask the controller for its camera")
};

}  // namespace argos

#endif
