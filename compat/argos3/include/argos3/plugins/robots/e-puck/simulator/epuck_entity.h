// E-pucks.
#ifndef TANDEM_ARGOS3_EPUCK_ENTITY_H
#define TANDEM_ARGOS3_EPUCK_ENTITY_H
#include <argos3/plugins/robots/generic/simulator/robot_entity.h>

namespace argos {

class CEPuckEntity : public CRobotEntity {
 public:
  CEPuckEntity();
  /// As for foot-bots.
  CEPuckEntity(const std::string& id, const std::string& controller, const CVector3& position = CVector3(),
               const CQuaternion& orientation = CQuaternion(), Real rab_range = 0.8, size_t rab_data_size = 2,
               const std::string& battery_model = "");
  ~CEPuckEntity() override;
  CWheeledEntity& GetWheeledEntity() { return Wheels(); }
  CAny AsAny() override;
};

}  // namespace argos

#endif
